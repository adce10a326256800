use super::*;

fn row(class: &str, resolution: f64, tau: f64, error: f64) -> Row {
    Row {
        class: class.into(),
        default: true,
        resolution,
        tau: Some(tau),
        y_plus: Some(1.0),
        error: Some(error),
        ..Row::default()
    }
}

fn table() -> Vec<Row> {
    vec![
        row("sphere-array", 5.0, 0.6, 0.07),
        row("sphere-array", 10.0, 0.6, 0.01),
        row("sphere-array", 10.0, 1.0, 0.02),
        row("sphere-array", 20.0, 0.6, 0.004),
        row("cube-re20", 10.0, 0.55, 0.03),
        row("cube-re100", 10.0, 0.51, 0.11),
    ]
}

fn band(across: f64, tau: f64, reynolds: Option<f64>) -> [f64; 2] {
    let conditions = Conditions {
        across,
        tau,
        reynolds,
        friction: Friction::default(),
    };
    of_blocks(&table(), conditions).map_or([f64::NAN; 2], |found| found.band)
}

#[test]
fn a_band_is_that_of_the_runs_around() {
    assert_eq!(band(10.0, 0.6, None), [0.01, 0.01]);
    assert_eq!(band(10.0, 0.7, None), [0.01, 0.02]);
    assert_eq!(band(7.0, 0.6, None), [0.01, 0.07]);
    assert_eq!(band(15.0, 0.6, None), [0.004, 0.01]);
    // Faster ones lie between creeping flow and the streams.
    assert_eq!(band(10.0, 0.6, Some(10.0)), [0.01, 0.03]);
    assert_eq!(band(10.0, 0.52, Some(60.0)), [0.03, 0.11]);
    assert_eq!(band(10.0, 0.52, Some(1e6)), [0.11, 0.11]);
}

#[test]
fn what_lies_beyond_the_table_is_said() {
    let text = |across, tau, reynolds| {
        let conditions = Conditions {
            across,
            tau,
            reynolds,
            friction: Friction::default(),
        };
        of_blocks(&table(), conditions).map_or(String::new(), |found| found.text())
    };
    assert_eq!(
        text(10.0, 0.6, None),
        "expected error of drag on blocks: about 1 % (10.0 cells, τ = 0.600; measured on sphere arrays)"
    );
    assert!(text(2.0, 0.6, None).contains("coarser than those, 5.0 cells"));
    assert!(text(90.0, 0.6, None).contains("finer than those, 20.0 cells"));
    assert!(text(10.0, 2.0, None).contains("τ = 1.000 there"));
    let fast = text(10.0, 0.52, Some(1e6));
    assert!(
        fast.contains("beyond those") && fast.contains("y⁺ about 223.6"),
        "{fast}"
    );
    assert!(fast.contains("friction is not resolved"), "{fast}");
    assert!(
        fast.contains("not measured at this speed, about 11 % below it"),
        "{fast}"
    );
}

#[test]
fn a_spread_of_the_density_is_added() {
    let rows = [row(CHANNEL, 12.0, 2.5, 0.01)];
    let found = of_walls(&rows, 12.0, 2.5).unwrap();
    assert_eq!(found.clone().compressed(0.01), found);
    let dense = found.compressed(0.25);
    assert!((dense.band[1] - 0.135).abs() < 1e-12, "{dense:?}");
    let text = dense.text();
    assert!(text.contains("12 % of it for the density"), "{text}");
}

#[test]
fn the_report_that_ships_is_whole() {
    let rows: Vec<Row> = MEASURED.lines().filter_map(Row::parse).collect();
    assert_eq!(rows.len(), MEASURED.lines().count() - 1);
    let known = |class: &str, least: usize| {
        let of = rows.iter().filter(|row| row.class == class && row.default);
        let errors = of.filter(|row| row.error.is_some()).count();
        assert!(errors >= least, "{class}: {errors}");
    };
    for (class, ..) in BLOCKS {
        known(class, 3);
    }
    known(CHANNEL, 3);
}

#[test]
fn y_plus_is_that_of_the_runs_in_streams() {
    let rows: Vec<Row> = MEASURED.lines().filter_map(Row::parse).collect();
    for (class, reynolds, _) in BLOCKS.into_iter().skip(1) {
        let default = rows.iter().filter(|row| row.class == class && row.default);
        for (row, measured) in default.filter_map(|row| Some((row, row.y_plus?))) {
            let predicted = (reynolds / (2.0 * row.resolution)).sqrt();
            // Streams speed up around a body and slow down next to it.
            assert!(
                (0.6..1.6).contains(&(predicted / measured)),
                "{class} on {}: {predicted}, measured {measured}",
                row.resolution
            );
        }
    }
}

/// The arrays of spheres at τ = 1 with known errors: 12 cells from centre to centre with c = 0.45 and 0.343, and
/// body-centred with 0.343 on 16 cells. The loose array of the report alone has less than 1 %.
#[test]
fn neighbours_count_in_the_error_of_dense_arrays() {
    let rows: Vec<Row> = MEASURED.lines().filter_map(Row::parse).collect();
    let known = [
        (11.41, 12.0, 0.09),
        (10.42, 12.0, 0.038),
        (11.03, 13.86, 0.036),
    ];
    for (across, apart, error) in known {
        let conditions = Conditions {
            across,
            tau: 1.0,
            reynolds: None,
            friction: Friction::default(),
        };
        let alone = of_blocks(&rows, conditions).unwrap();
        assert!(alone.band[1] < 0.01, "{alone:?}");
        let found = alone.crowded(apart - across, "ball and its image");
        assert_eq!(found.gap, Some(apart - across));
        let [low, high] = found.band;
        assert!(
            low < error && (0.95 * error..1.3 * error).contains(&high),
            "{found:?}"
        );
        let text = found.text();
        assert!(text.contains("between ball and its image"), "{text}");
    }
}

#[test]
fn wide_gaps_add_nothing_and_what_is_not_measured_is_said() {
    let rows = table();
    let conditions = |tau| Conditions {
        across: 10.0,
        tau,
        reynolds: None,
        friction: Friction::default(),
    };
    let alone = |tau| of_blocks(&rows, conditions(tau)).unwrap();
    assert_eq!(alone(1.0).crowded(6.1, "a and b"), alone(1.0));
    let text = |tau, gap| alone(tau).crowded(gap, "a and b").text();
    assert!(text(1.0, 0.2).contains("narrower than 0.59 cells are not measured"));
    assert!(text(1.3, 2.0).contains("gaps at this τ are not measured"));
    assert!(!text(1.0, 2.0).contains("not measured"));
}
