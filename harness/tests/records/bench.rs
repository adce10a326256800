//! Output of the rock part of the benchmark, and its fit of exponents. Times are not checked.

use kit::assert_near;

use riprap_harness::bench::{
    Machine,
    rock::{self, Plan, exponent},
};
use serde_json::Value;

#[test]
fn exponents_are_of_least_squares() {
    for p in [0.0, 1.1, 2.0] {
        let points = [1e2, 1e3, 1e5].map(|n: f64| (n, 3e-7 * n.powf(p)));
        // Logarithms of at most 25 are rounded to 2e-16 of that, and their range is 7.
        assert_near(exponent(&points).unwrap(), p, 1e-14);
    }
    // ln y = 0, 0, 3 over ln x = 0, 1, 2: by hand, the slope is ((-1)(-1) + (1)(2)) / 2.
    let e = std::f64::consts::E;
    let points = [(1.0, 1.0), (e, 1.0), (e * e, e.powi(3))];
    assert_near(exponent(&points).unwrap(), 1.5, 1e-14);
    for one_count in [&[][..], &[(10.0, 1.0)], &[(10.0, 1.0), (10.0, 2.0)]] {
        assert_eq!(exponent(one_count), None);
    }
}

fn rows() -> Vec<Value> {
    let plan = Plan {
        piles: vec![6, 24],
        items: vec![60, 120],
        rounds: 1,
    };
    let (rows, _) = rock::measure(&plan, None).unwrap();
    let text = Machine::host().json(rows).unwrap();
    serde_json::from_str(&text).unwrap()
}

#[test]
fn rows_have_the_fields_that_readers_of_the_json_look_for() {
    let rows = rows();
    let variants: Vec<_> = rows
        .iter()
        .map(|row| {
            let text = |key: &str| row[key].as_str().unwrap().to_string();
            format!("{}: {}", text("kernel"), text("variant"))
        })
        .collect();
    let pile = [
        "contact: pile at rest, warm",
        "contact: pile at rest, cold",
        "step: pile at rest, one core",
        "step: pile at rest, all cores",
    ];
    let mut expected = vec!["cut: cube by three joint sets"; 2];
    expected.extend(["broadphase: host, sizes 1:1"; 2]);
    expected.extend(["broadphase: host, sizes 1:100"; 2]);
    expected.extend([
        "step: one block on a plane",
        "step: one block among five fixed",
    ]);
    expected.extend(pile);
    expected.extend(pile);
    assert_eq!(variants, expected);
    for row in &rows {
        for key in ["count", "pairs", "contacts", "ms_cpu", "ms_wall", "ms"] {
            assert!(row[key].as_f64().unwrap() >= 0.0, "{key}: {row}");
        }
        for key in ["adapter", "cores", "version", "date"] {
            assert!(!row[key].is_null(), "{key}: {row}");
        }
    }

    // The second count of a variant has an exponent, the first has none.
    assert!(rows[0]["exponent"].is_null() && rows[1]["exponent"].is_f64());
    let last = &rows[rows.len() - 2];
    assert!(last["exponent"].is_f64());

    // Besides fixed blocks, the resolver is called for the one that the block stands on.
    for row in &rows[6..8] {
        assert_eq!(
            (row["pairs"].as_u64(), row["contacts"].as_u64()),
            (Some(1), Some(1))
        );
        assert!(row["ratio"].is_f64());
    }

    // The pile has contacts and reports how they were decided, and the times of the parts of a step.
    assert!(last["contacts"].as_u64() > last["count"].as_u64());
    assert!(last["share_of_programs"].as_f64().unwrap() <= 1.0);
    assert!(last["largest_speed"].as_f64().unwrap() < 0.01);
    let split = last["split"].as_object().unwrap();
    let mut parts: Vec<_> = split.keys().map(String::as_str).collect();
    parts.sort_unstable();
    assert_eq!(
        parts,
        [
            "lists_a_step",
            "ms_broadphase",
            "ms_contact",
            "ms_decision",
            "ms_law",
            "ms_motion",
            "ms_rest",
        ]
    );
}
