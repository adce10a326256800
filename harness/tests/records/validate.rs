//! Names, selection and records of cases.

use kit::assert_near;

use riprap_harness::validate::{CASES, Trial, list, record, select};

fn names(pattern: Option<&str>) -> Vec<&'static str> {
    let cases = select(pattern).unwrap();
    cases.iter().map(|case| case.name).collect()
}

#[test]
fn a_glob_selects_cases_by_family_and_name() {
    assert_eq!(names(Some("cavity/re100")), ["cavity/re100"]);
    assert_eq!(names(Some("cavity/*")), ["cavity/re100", "cavity/re1000"]);
    assert_eq!(names(Some("*/convergence")).len(), 2);
    assert_eq!(names(None).len(), CASES.len());
}

#[test]
fn a_glob_without_a_case_names_all_cases() {
    let error = select(Some("dam-break")).unwrap_err().to_string();
    assert!(error.contains("dam-break"), "{error}");
    assert!(
        CASES.iter().all(|case| error.contains(case.name)),
        "{error}"
    );
}

#[test]
fn names_are_family_and_case_and_occur_once() {
    for case in CASES {
        assert_eq!(case.name.split('/').count(), 2, "{}", case.name);
        let same = CASES.iter().filter(|other| other.name == case.name);
        assert_eq!(same.count(), 1, "{}", case.name);
    }
}

#[test]
fn the_list_has_a_line_a_case_with_its_form_and_what_it_computes() {
    let text = list(CASES);
    assert_eq!(text.lines().count(), CASES.len());
    for (line, case) in text.lines().zip(CASES) {
        let mut words = line.split_whitespace();
        assert_eq!(words.next(), Some(case.name));
        let form = if case.only_full { "full" } else { "short" };
        assert_eq!(words.next(), Some(form));
        assert!(words.count() >= 3, "{line}");
        assert!(line.chars().count() <= 120, "{line}");
    }
    let one = list(&select(Some("cavity/*")).unwrap());
    assert_eq!(one.lines().count(), 2);
}

fn trial() -> Trial {
    Trial {
        setup: "8x8x8".into(),
        cells: 512,
        steps: 100,
        seconds: 0.5,
        ..Trial::default()
    }
}

#[test]
fn a_record_has_the_fields_that_readers_of_the_json_look_for() {
    let json = serde_json::to_value(trial().relative("ν", 1.02, 1.0, 0.01)).unwrap();
    let mut keys: Vec<_> = json.as_object().unwrap().keys().cloned().collect();
    keys.sort();
    assert_eq!(
        keys,
        [
            "case",
            "cells",
            "error",
            "limit",
            "passed",
            "quantity",
            "reference",
            "seconds",
            "setup",
            "steps",
            "value"
        ]
    );
    assert_eq!(json["cells"], 512);
    assert_eq!(json["passed"], false);
    assert_near(json["error"].as_f64().unwrap(), 0.02, 1e-12);
}

#[test]
fn each_measure_judges_in_its_own_way() {
    let trial = trial();
    assert!(trial.relative("", 0.995, 1.0, 0.01).passed);
    assert!(!trial.absolute("", 3.2, 3.0, 0.1).passed);
    assert!(trial.at_most("", 1e-6, 1e-6).passed);
    assert!(trial.at_least("", 2.0, 1.95).passed);
    assert!(!trial.at_least("", 1.9, 1.95).passed);
    assert!(trial.relative("", 17.0, 1.0, None).passed);
}

#[test]
fn what_is_not_a_number_does_not_pass() {
    let trial = trial();
    assert!(!trial.relative("", f64::NAN, 1.0, 0.01).passed);
    assert!(!trial.at_most("", f64::NAN, 1.0).passed);
    assert!(!trial.at_least("", f64::NAN, 1.0).passed);
}

#[test]
fn a_row_says_how_the_record_went() {
    let failed = record::row(&trial().at_most("drift", 2.0, 1.0));
    assert!(failed.starts_with("FAIL drift"), "{failed}");
    let told = record::row(&trial().report("drift", 2.0));
    assert!(told.starts_with("info drift"), "{told}");
}
