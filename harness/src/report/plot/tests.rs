use super::*;
use crate::report::class::Reference;

fn class() -> Class {
    Class {
        name: "a",
        title: "Drag & \"lift\" <of a cube>",
        error: "error",
        resolution: "cells",
        update: "cell",
        reference: Reference::None,
        seconds: None,
        points: Vec::new(),
    }
}

fn row(setting: &str, resolution: f64, error: Option<f64>, seconds: f64) -> Row {
    Row {
        setting: setting.into(),
        default: setting == "default",
        resolution,
        error,
        updates: (1e6 * seconds) as u64,
        cpu_seconds: seconds,
        ..Row::default()
    }
}

/// Names of elements open at the end, and attributes without closing quotation marks.
fn faults(text: &str) -> Vec<String> {
    let (mut open, mut faults): (Vec<String>, Vec<String>) = (Vec::new(), Vec::new());
    for piece in text.split('<').skip(1) {
        let Some((tag, rest)) = piece.split_once('>') else {
            faults.push(format!("`<{piece}` does not end"));
            continue;
        };
        if tag.matches('"').count() % 2 != 0 || rest.contains('>') {
            faults.push(tag.into());
        }
        let name = tag.split([' ', '/']).find(|name| !name.is_empty());
        let name = String::from(name.unwrap_or_default());
        match (tag.starts_with('/'), tag.ends_with('/')) {
            (true, _) if open.last() == Some(&name) => drop(open.pop()),
            (true, _) => faults.push(format!("{name} ends and did not begin")),
            (false, false) => open.push(name),
            (false, true) => {}
        }
    }
    faults.extend(open);
    faults
}

#[test]
fn diagrams_are_well_formed() {
    let rows = [
        row("default", 8.0, Some(0.03), 0.1),
        row("default", 16.0, Some(0.0), 1.0),
        row("a < b & c", 8.0, Some(f64::INFINITY), 1.0),
        row("diverged", 8.0, None, 0.0),
    ];
    let rows: Vec<&Row> = rows.iter().collect();
    let text = diagram(&class(), &rows, ("CPU time, s", |row| row.cpu_seconds)).unwrap();
    assert_eq!(faults(&text), Vec::<String>::new());
    assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
    assert!(text.contains("diverged (no result)"));
}

#[test]
fn an_empty_diagram_is_well_formed() {
    let text = diagram(&class(), &[], ("s", |row| row.cpu_seconds)).unwrap();
    assert_eq!(faults(&text), Vec::<String>::new());
}

#[test]
fn faults_are_found() {
    assert_eq!(faults("<a><b/></a>").len(), 0);
    assert_ne!(faults("<a><b></a>").len(), 0);
    assert_ne!(faults("<a x=\"1>").len(), 0);
}

#[test]
fn axes_hold_whole_powers_of_ten() {
    let axis = Axis::around([0.02, 3.0, 0.0, f64::NAN].into_iter());
    assert_eq!(axis, Axis { low: -2, high: 1 });
    assert!((axis.place(0.1) - 1.0 / 3.0).abs() < 1e-12);
    assert_eq!(axis.place(0.0), 0.0);
}

#[test]
fn numbers_at_axes_are_read_at_a_glance() {
    assert_eq!(
        [0, 1, 6, -12].map(power_of_ten),
        ["1", "10", "10⁶", "10⁻¹²"]
    );
    assert_eq!(
        [0, -1, -2, -3, -5, -6].map(percent),
        ["100 %", "10 %", "1 %", "0.1 %", "0.001 %", "10⁻⁴ %"]
    );
}
