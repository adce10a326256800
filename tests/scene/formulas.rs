//! Formulas follow the rules of mathematics, and errors give the position at which they do not parse.

use riprap::formula::Formula;

fn at(text: &str, x: f64, y: f64, z: f64, t: f64) -> f64 {
    text.parse::<Formula>().unwrap().eval(x, y, z, t)
}

#[test]
fn precedence_is_that_of_mathematics() {
    for (text, value) in [
        ("-2^2", -4.0),
        ("2^3^2", 512.0),
        ("2^-1", 0.5),
        ("2*-3", -6.0),
        ("8/-2^2", -2.0),
        ("8/4/2", 1.0),
        ("8-4-2", 2.0),
        ("8 - 4 + 2", 6.0),
        ("1 + 2*3", 7.0),
        ("--1", 1.0),
        ("1e-3 + .5 + 2.", 2.501),
        ("1E+2*1.5e0", 150.0),
        ("2*e", 2.0 * std::f64::consts::E),
        ("cos(pi) + sin(pi/2)", 0.0),
        ("min(max(1, 2), 3) + max(min(5, 4), 0)", 6.0),
        ("1 - min(1, 2)*2", -1.0),
        ("sqrt(abs(-9)) + exp(0) + tanh(0) + log(e) + ln(1)", 5.0),
        (
            "atan2(1, 1)*4/pi + mod(-1, 3) + floor(1.9) + ceil(0.1) + sign(0)",
            5.0,
        ),
    ] {
        let found = at(text, 0.0, 0.0, 0.0, 0.0);
        assert!(
            (found - value).abs() < 1e-14,
            "{text} = {found}, not {value}"
        );
    }
}

#[test]
fn variables_are_position_and_time() {
    assert_eq!(at("1-(y/0.1)^2", 9.0, 0.05, 9.0, 9.0), 0.75);
    assert_eq!(at("x + 10*y + 100*z + 1000*t", 1.0, 2.0, 3.0, 4.0), 4321.0);
    let ramp: Formula = "min(t, 1)".parse().unwrap();
    assert!(ramp.uses_time() && !ramp.is_constant());
    let number: Formula = "2*pi".parse().unwrap();
    assert!(number.is_constant() && number.constant().is_some());
    let place: Formula = "x".parse().unwrap();
    assert!(!place.uses_time() && place.constant().is_none());
}

#[test]
fn series_are_linear_between_their_points_and_constant_beyond_them() {
    let text = "2*interpolate(t + 1, 0, 0.5, 10, 2.5, 10.5, -1, 2e1, pi) + x";
    for (t, value) in [
        (-9.0, 0.5),
        (-1.0, 0.5),
        (1.5, 1.0),
        (9.0, 2.5),
        (9.25, 0.75),
        (9.5, -1.0),
        (19.0, std::f64::consts::PI),
        (1e9, std::f64::consts::PI),
    ] {
        let found = at(text, 3.0, 0.0, 0.0, t);
        assert!((found - 2.0 * value - 3.0).abs() < 1e-12, "{t}: {found}");
    }
    let formula: Formula = text.parse().unwrap();
    assert!(formula.uses_time() && formula.uses_place());
    let constant: Formula = "interpolate(1, 0, 0, 2, 2)".parse().unwrap();
    assert_eq!(constant.constant(), Some(1.0));
    let two = "interpolate(x, 0, 0, 1, 1) + interpolate(interpolate(y, 0, 1, 1, 0), 0, 5, 1, 6)";
    assert_eq!(at(two, 0.5, 0.25, 0.0, 0.0), 0.5 + 5.75);
    assert!(at("interpolate(x/x, 0, 0, 1, 1)", 0.0, 0.0, 0.0, 0.0).is_nan());
}

#[test]
fn errors_point_at_the_character() {
    for (text, column, part) in [
        ("1-(y", 5, "`)` is missing"),
        ("2x", 2, "operator"),
        ("1 + q", 5, "no variable `q`; allowed are x, y, z, t"),
        ("sinus(x)", 1, "no function `sinus`; use sin"),
        ("interpolate(t, 1, 2)", 20, "at least two points"),
        ("interpolate(t, 0, 1, 2, 3, 4)", 29, "5 numbers"),
        ("interpolate(t, 1, 0, 1, 5)", 26, "ascend, and 1 follows 1"),
        ("interpolate(t, 0, 1, x, 5)", 23, "finite numbers"),
        ("sin x", 5, "`(` must follow"),
        ("min(x)", 6, "takes 2 arguments"),
        ("sin(x, y)", 6, "takes 1 argument"),
        ("", 1, "the text ends"),
        ("1 + * 2", 5, "not `*`"),
        ("1..2", 3, "operator"),
        (".", 1, "not a number"),
        ("π + é", 5, "no variable `é`"),
    ] {
        let error = text.parse::<Formula>().unwrap_err();
        assert_eq!(error.column, column, "{error}");
        assert!(error.to_string().contains(part), "{error}");
    }
}

#[test]
fn nesting_is_bounded() {
    let deep = format!("{}1{}", "(".repeat(100_000), ")".repeat(100_000));
    assert!(deep.parse::<Formula>().unwrap_err().message.contains("64"));
    let long = vec!["1"; 10_000].join("+");
    assert_eq!(at(&long, 0.0, 0.0, 0.0, 0.0), 10_000.0);
    let right = vec!["1"; 60].join("^");
    assert_eq!(at(&right, 0.0, 0.0, 0.0, 0.0), 1.0);
}

proptest::proptest! {
    #[test]
    fn no_text_panics(text in "[-+*/^(), .0-9extyzπe]{0,40}|(sin|min|mod|pi|q)?\\(?.{0,20}") {
        if let Ok(formula) = text.parse::<Formula>() {
            formula.eval(0.1, 0.2, 0.3, 0.4);
        }
    }
}
