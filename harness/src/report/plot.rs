//! Error against cost on logarithmic axes: two frames side by side with one legend.

use super::{
    class::Class,
    finding::TARGETS,
    row::{Cost, Row},
    svg::{Anchor, Stroke, Svg},
};

/// Size of a frame, pixels.
const FRAME: [f64; 2] = [400.0, 340.0];
/// Room to the left of a frame for its numbers, above and below it.
const SIDE: f64 = 88.0;
const TOP: f64 = 14.0;
const FOOT: f64 = 58.0;
/// Room for the legend.
const LEGEND: f64 = 220.0;
/// Height of a row of the legend.
const ENTRY: f64 = 21.0;
const TEXT: f64 = 14.0;
const RADIUS: f64 = 4.5;

/// Colours that also the colour-blind tell apart (Okabe & Ito 2008); black is for the default.
const COLOURS: [&str; 7] = [
    "#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#968c1e",
];
const GRID: Stroke = Stroke {
    colour: "#ddd",
    width: 1.0,
    dash: "",
};
const EDGE: Stroke = Stroke {
    colour: "#222",
    width: 1.2,
    dash: "",
};
const TARGET: Stroke = Stroke {
    colour: "#888",
    width: 1.2,
    dash: "6 4",
};

/// A logarithmic axis over whole powers of ten.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Axis {
    low: i32,
    high: i32,
}

impl Axis {
    /// Around the positive ones of some values.
    fn around(values: impl Iterator<Item = f64>) -> Self {
        let logs = values.filter(|v| *v > 0.0 && v.is_finite()).map(f64::log10);
        let (low, high) = logs.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), log| {
            (low.min(log), high.max(log))
        });
        if low > high {
            return Self { low: 0, high: 1 };
        }
        let low = low.floor() as i32;
        Self {
            low,
            high: (high.ceil() as i32).max(low + 1),
        }
    }

    /// Where a value lies, from 0 to 1; one that is not positive, or is below, at 0.
    fn place(self, value: f64) -> f64 {
        let log = value.max(f64::MIN_POSITIVE).log10();
        ((log - f64::from(self.low)) / f64::from(self.high - self.low)).clamp(0.0, 1.0)
    }
}

/// A curve.
struct Curve<'a> {
    name: &'a str,
    default: bool,
    rows: Vec<&'a Row>,
}

/// The settings of a class, each with the rows that have an error, coarse ones first.
fn curves<'a>(rows: &[&'a Row]) -> Vec<Curve<'a>> {
    let mut curves: Vec<Curve<'a>> = Vec::new();
    for row in rows {
        let at = curves.iter().position(|curve| curve.name == row.setting);
        let at = at.unwrap_or_else(|| {
            curves.push(Curve {
                name: &row.setting,
                default: row.default,
                rows: Vec::new(),
            });
            curves.len() - 1
        });
        if row.error.is_some() {
            curves[at].rows.push(row);
        }
    }
    for curve in &mut curves {
        curve
            .rows
            .sort_by(|a, b| a.resolution.total_cmp(&b.resolution));
    }
    curves
}

/// The diagram of a class: error against `time` (of this name), and against updates.
pub fn diagram(class: &Class, rows: &[&Row], (name, time): (&str, Cost)) -> String {
    let curves = curves(rows);
    // Far beyond the method's range nothing is to be read off.
    let errors = rows
        .iter()
        .filter_map(|row| row.error)
        .filter(|e| *e < 10.0);
    let y = Axis::around(errors.chain([TARGETS[0], TARGETS[1]]));
    let height = TOP + FRAME[1] + FOOT;
    let legend = TOP + ENTRY * curves.len() as f64 + TOP;
    let width = 2.0 * (SIDE + FRAME[0]) + LEGEND;
    let mut svg = Svg::new([width, height.max(legend)]);
    let updates = format!("{} updates", class.update);
    let costs: [(&str, Cost); 2] = [(name, time), (&updates, |row| row.updates as f64)];
    for (n, (name, cost)) in costs.into_iter().enumerate() {
        let left = SIDE + n as f64 * (SIDE + FRAME[0]);
        let known = rows.iter().filter(|row| row.error.is_some());
        let x = Axis::around(known.map(|row| cost(row)));
        frame(&mut svg, left, (x, name), y);
        for (number, curve) in curves.iter().enumerate() {
            let places: Vec<[f64; 2]> = curve
                .rows
                .iter()
                .map(|row| {
                    let error = row.certain_error().unwrap_or_default();
                    [
                        left + FRAME[0] * x.place(cost(row)),
                        TOP + FRAME[1] * (1.0 - y.place(error)),
                    ]
                })
                .collect();
            draw(&mut svg, curve, number, &places);
        }
    }
    let left = 2.0 * (SIDE + FRAME[0]) + 16.0;
    for (number, curve) in curves.iter().enumerate() {
        let at = TOP + ENTRY * (number as f64 + 0.5);
        draw(&mut svg, curve, number, &[[left, at], [left + 30.0, at]]);
        let name = match curve.rows.is_empty() {
            true => format!("{} (no result)", curve.name),
            false => curve.name.into(),
        };
        svg.text(&name, [left + 40.0, at], TEXT, Anchor::Start, false);
    }
    svg.finish(&format!("{}: error against cost", class.title))
}

/// Grid, numbers and names of a frame whose left edge is at `left`.
fn frame(svg: &mut Svg, left: f64, (x, name): (Axis, &str), y: Axis) {
    let (right, bottom) = (left + FRAME[0], TOP + FRAME[1]);
    for power in x.low..=x.high {
        let at = left + FRAME[0] * x.place(10f64.powi(power));
        svg.line(&[[at, TOP], [at, bottom]], GRID);
        // Many powers of ten stand too close.
        if x.high - x.low <= 7 || (power - x.low) % 2 == 0 {
            let place = [at, bottom + 16.0];
            svg.text(&power_of_ten(power), place, TEXT, Anchor::Middle, false);
        }
    }
    for power in y.low..=y.high {
        let at = TOP + FRAME[1] * (1.0 - y.place(10f64.powi(power)));
        svg.line(&[[left, at], [right, at]], GRID);
        svg.text(&percent(power), [left - 8.0, at], TEXT, Anchor::End, false);
    }
    for target in TARGETS {
        if target > 10f64.powi(y.low) {
            let at = TOP + FRAME[1] * (1.0 - y.place(target));
            svg.line(&[[left, at], [right, at]], TARGET);
        }
    }
    let corners = [
        [left, TOP],
        [right, TOP],
        [right, bottom],
        [left, bottom],
        [left, TOP],
    ];
    svg.line(&corners, EDGE);
    let middle = [0.5 * (left + right), bottom + 42.0];
    svg.text(name, middle, TEXT + 1.0, Anchor::Middle, false);
    let beside = [left - SIDE + 14.0, 0.5 * (TOP + bottom)];
    svg.text("error", beside, TEXT + 1.0, Anchor::Middle, true);
}

/// A curve, the `number`th of its diagram, counted from 0.
fn draw(svg: &mut Svg, curve: &Curve<'_>, number: usize, places: &[[f64; 2]]) {
    let plain = curve.default && !curve.name.contains(" at ");
    let colour = match plain {
        true => "#000",
        false => COLOURS[number % COLOURS.len()],
    };
    let stroke = Stroke {
        colour,
        width: if plain { 2.8 } else { 1.6 },
        dash: if curve.default && !plain { "7 4" } else { "" },
    };
    svg.line(places, stroke);
    for &[x, y] in places {
        // Neighbours of one colour differ in shape.
        match (number / COLOURS.len() + number) % 3 {
            0 => svg.disc([x, y], RADIUS, colour),
            1 => {
                let r = 0.9 * RADIUS;
                let square = [
                    [x - r, y - r],
                    [x + r, y - r],
                    [x + r, y + r],
                    [x - r, y + r],
                ];
                svg.shape(&square, colour);
            }
            _ => {
                let r = 1.2 * RADIUS;
                svg.shape(&[[x, y - r], [x + r, y + r], [x - r, y + r]], colour);
            }
        }
    }
}

/// 10ⁿ.
fn power_of_ten(power: i32) -> String {
    match power {
        0 => "1".into(),
        1 => "10".into(),
        power => {
            let digits = power.to_string();
            let raised = digits.chars().map(|c| match c {
                '-' => '⁻',
                '1' => '¹',
                '2' => '²',
                '3' => '³',
                // Those from 4 on, and 0, follow each other in Unicode.
                c => char::from_u32(0x2070 + c.to_digit(10).unwrap_or_default()).unwrap_or(c),
            });
            format!("10{}", raised.collect::<String>())
        }
    }
}

/// 10ⁿ as a percentage.
fn percent(power: i32) -> String {
    match power + 2 {
        n @ 0..=4 => format!("{} %", 10i32.pow(n as u32)),
        n @ -3..=-1 => format!("{:.*} %", n.unsigned_abs() as usize, 10f64.powi(n)),
        n => format!("{} %", power_of_ten(n)),
    }
}

#[cfg(test)]
mod tests;
