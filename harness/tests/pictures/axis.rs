//! Axes: ticks at round values, and labels that equal them.

use riprap_harness::picture::{Axis, Scale};

/// The number that a label shows; powers of ten are printed with raised digits.
fn parse(label: &str) -> f64 {
    let plain = label.replace('−', "-");
    plain.parse().expect("a label is a number")
}

/// The factor in an axis's title, such as 10⁻³.
fn factor(title: &str) -> f64 {
    let raised = |sign: char| "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|digit| digit == sign);
    let digits = title.chars().filter_map(raised);
    let power = digits.fold(0, |power, digit| 10 * power + digit as i32);
    10_f64.powi(if title.contains('⁻') { -power } else { power })
}

#[test]
fn labels_times_the_titles_factor_are_the_ticks_values() {
    for magnitude in [1e-12, 1e-7, 3e-3, 0.02, 1.0, 77.0, 9.9e3, 1.01e5, 4e9] {
        for [low, high] in [
            [0.0, 1.0],
            [-1.0, 1.0],
            [0.3, 0.37],
            [0.99, 1.0],
            [-5.0, -4.2],
        ] {
            let range = [low * magnitude, high * magnitude];
            let axis = Axis::new("length", "m", range, Scale::Linear);
            let factor = factor(&axis.title());
            for most in 1..=10 {
                let ticks = axis.ticks(most);
                assert!(ticks.len() <= most, "{most}: {ticks:?}");
                // Five ticks hold −4 to 4 in steps of 2; fewer may leave only 0 of that range.
                assert!(most < 5 || ticks.len() >= 2, "{range:?} {most}: {ticks:?}");
                for (value, label) in &ticks {
                    let shown = parse(label) * factor;
                    // Labels and values differ by rounding of decimals only.
                    assert!(
                        (shown - value).abs() <= 1e-9 * magnitude,
                        "{label} for {value}"
                    );
                    assert!((-1e-5..=1.0 + 1e-5).contains(&axis.fraction(*value)));
                }
                let labels: Vec<&String> = ticks.iter().map(|(_, label)| label).collect();
                assert!(
                    labels.windows(2).all(|pair| pair[0] != pair[1]),
                    "{labels:?}"
                );
            }
        }
    }
}

#[test]
fn a_power_of_ten_stands_in_the_title_only_when_needed() {
    let title = |unit, range| Axis::new("speed", unit, range, Scale::Linear).title();
    assert_eq!(title("m/s", [0.0, 2.0]), "speed (m/s)");
    assert_eq!(title("m/s", [0.0, 2e-3]), "speed (10⁻³ m/s)");
    assert_eq!(title("", [-2e7, 1.0]), "speed (10⁶)");
    assert_eq!(title("", [0.0, 1.0]), "speed");
}

#[test]
fn logarithmic_ticks_are_decades_or_parts_of_one() {
    let labels = |range, most| -> Vec<String> {
        let axis = Axis::new("error", "", range, Scale::Logarithmic);
        axis.ticks(most)
            .into_iter()
            .map(|(_, label)| label)
            .collect()
    };
    assert_eq!(labels([1e-4, 0.1], 10), ["10⁻⁴", "10⁻³", "10⁻²", "10⁻¹"]);
    assert_eq!(labels([1e-4, 0.1], 2), ["10⁻⁴", "10⁻²"]);
    assert_eq!(labels([6.0, 60.0], 10), ["10", "20", "50"]);
    assert_eq!(labels([0.04, 0.3], 10), ["0.05", "0.1", "0.2"]);
}

#[test]
fn an_axis_has_room_for_all_values_it_can_hold() {
    let values = [3.0, f64::NAN, -1.0, f64::INFINITY];
    for (scale, held) in [
        (Scale::Linear, vec![3.0, -1.0]),
        (Scale::Logarithmic, vec![3.0]),
    ] {
        let axis = Axis::around("x", "", values, scale);
        for value in values {
            assert_eq!(axis.holds(value), held.contains(&value), "{value}");
        }
        for value in held {
            assert!((0.0..=1.0).contains(&axis.fraction(value)), "{value}");
        }
    }
    for none in [vec![], vec![f64::NAN], vec![0.0], vec![5.0, 5.0]] {
        for scale in [Scale::Linear, Scale::Logarithmic] {
            let axis = Axis::around("x", "", none.clone(), scale);
            assert!(axis.fraction(5.0).is_finite(), "{none:?}");
        }
    }
}
