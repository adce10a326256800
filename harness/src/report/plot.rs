//! Error against cost on logarithmic axes: two frames side by side with one legend, as SVG.

use super::{
    class::Class,
    finding::TARGETS,
    page::escape,
    row::{Cost, Row},
};
use anyhow::{Result, anyhow};
use plotters::{
    coord::Shift,
    element::DashedPathElement,
    prelude::*,
    style::{
        FontTransform, register_font,
        text_anchor::{HPos, Pos, VPos},
    },
};

/// A drawing in pixels, y downwards.
type Canvas<'a> = DrawingArea<SVGBackend<'a>, Shift>;

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
const FONT: &str = "sans-serif";
const TEXT: f64 = 14.0;
const RADIUS: f64 = 4.5;

/// Colours that also the colour-blind tell apart (Okabe & Ito 2008); black is for the default.
const COLOURS: [RGBColor; 7] = [
    RGBColor(0xd5, 0x5e, 0x00),
    RGBColor(0x00, 0x72, 0xb2),
    RGBColor(0x00, 0x9e, 0x73),
    RGBColor(0xcc, 0x79, 0xa7),
    RGBColor(0xe6, 0x9f, 0x00),
    RGBColor(0x56, 0xb4, 0xe9),
    RGBColor(0x96, 0x8c, 0x1e),
];
const GRID: RGBColor = RGBColor(0xdd, 0xdd, 0xdd);
const EDGE: RGBColor = RGBColor(0x22, 0x22, 0x22);
const TARGET: RGBColor = RGBColor(0x88, 0x88, 0x88);

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
///
/// # Errors
/// If the font of its texts cannot be read.
pub fn diagram(class: &Class, rows: &[&Row], (name, time): (&str, Cost)) -> Result<String> {
    // Texts are measured in the font of pictures; a page shows them in its own.
    register_font(FONT, FontStyle::Normal, dejavu::sans::regular())
        .map_err(|_| anyhow!("the font of diagrams cannot be read"))?;
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
    let mut svg = String::new();
    {
        let size = (width as u32, height.max(legend) as u32);
        let canvas = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        let updates = format!("{} updates", class.update);
        let costs: [(&str, Cost); 2] = [(name, time), (&updates, |row| row.updates as f64)];
        for (n, (name, cost)) in costs.into_iter().enumerate() {
            let left = SIDE + n as f64 * (SIDE + FRAME[0]);
            let known = rows.iter().filter(|row| row.error.is_some());
            let x = Axis::around(known.map(|row| cost(row)));
            frame(&canvas, left, (x, name), y)?;
            for (number, curve) in curves.iter().enumerate() {
                let place = |row: &&Row| {
                    let error = row.certain_error().unwrap_or_default();
                    pixel([
                        left + FRAME[0] * x.place(cost(row)),
                        TOP + FRAME[1] * (1.0 - y.place(error)),
                    ])
                };
                draw(
                    &canvas,
                    curve,
                    number,
                    curve.rows.iter().map(place).collect(),
                )?;
            }
        }
        let left = 2.0 * (SIDE + FRAME[0]) + 16.0;
        for (number, curve) in curves.iter().enumerate() {
            let at = TOP + ENTRY * (number as f64 + 0.5);
            let line = [[left, at], [left + 30.0, at]].map(pixel);
            draw(&canvas, curve, number, line.into())?;
            let name = match curve.rows.is_empty() {
                true => format!("{} (no result)", curve.name),
                false => curve.name.into(),
            };
            text(&canvas, &name, [left + 40.0, at], TEXT, HPos::Left)?;
        }
        canvas.present()?;
    }
    // What readers of screens say.
    let title = escape(&format!("{}: error against cost", class.title));
    Ok(svg.replacen('>', &format!(" role=\"img\">\n<title>{title}</title>"), 1))
}

fn pixel([x, y]: [f64; 2]) -> (i32, i32) {
    (x.round() as i32, y.round() as i32)
}

fn line(canvas: &Canvas<'_>, places: &[[f64; 2]], style: ShapeStyle) -> Result<()> {
    let places: Vec<_> = places.iter().copied().map(pixel).collect();
    Ok(canvas.draw(&PathElement::new(places, style))?)
}

fn text(canvas: &Canvas<'_>, text: &str, at: [f64; 2], size: f64, side: HPos) -> Result<()> {
    let style = TextStyle::from((FONT, size).into_font()).pos(Pos::new(side, VPos::Center));
    Ok(canvas.draw(&Text::new(text, pixel(at), style))?)
}

/// Grid, numbers and names of a frame whose left edge is at `left`.
fn frame(canvas: &Canvas<'_>, left: f64, (x, name): (Axis, &str), y: Axis) -> Result<()> {
    let (right, bottom) = (left + FRAME[0], TOP + FRAME[1]);
    for power in x.low..=x.high {
        let at = left + FRAME[0] * x.place(10f64.powi(power));
        line(canvas, &[[at, TOP], [at, bottom]], GRID.into())?;
        // Many powers of ten stand too close.
        if x.high - x.low <= 7 || (power - x.low) % 2 == 0 {
            text(
                canvas,
                &power_of_ten(power),
                [at, bottom + 16.0],
                TEXT,
                HPos::Center,
            )?;
        }
    }
    for power in y.low..=y.high {
        let at = TOP + FRAME[1] * (1.0 - y.place(10f64.powi(power)));
        line(canvas, &[[left, at], [right, at]], GRID.into())?;
        text(canvas, &percent(power), [left - 8.0, at], TEXT, HPos::Right)?;
    }
    for target in TARGETS {
        if target > 10f64.powi(y.low) {
            let at = TOP + FRAME[1] * (1.0 - y.place(target));
            let ends = [[left, at], [right, at]].map(pixel);
            canvas.draw(&DashedPathElement::new(ends, 6, 4, TARGET))?;
        }
    }
    let corners = [[left, TOP], [right, bottom]].map(pixel);
    canvas.draw(&Rectangle::new(corners, EDGE))?;
    let middle = [0.5 * (left + right), bottom + 42.0];
    text(canvas, name, middle, TEXT + 1.0, HPos::Center)?;
    let side = pixel([left - SIDE + 14.0, 0.5 * (TOP + bottom)]);
    let upwards = TextStyle::from((FONT, TEXT + 1.0).into_font())
        .transform(FontTransform::Rotate270)
        .pos(Pos::new(HPos::Center, VPos::Center));
    Ok(canvas.draw(&Text::new("error", side, upwards))?)
}

/// A curve, the `number`th of its diagram, counted from 0.
fn draw(
    canvas: &Canvas<'_>,
    curve: &Curve<'_>,
    number: usize,
    places: Vec<(i32, i32)>,
) -> Result<()> {
    let plain = curve.default && !curve.name.contains(" at ");
    let colour = match plain {
        true => BLACK,
        false => COLOURS[number % COLOURS.len()],
    };
    let style = colour.stroke_width(if plain { 3 } else { 2 });
    if curve.default && !plain {
        canvas.draw(&DashedPathElement::new(places.clone(), 7, 4, style))?;
    } else {
        canvas.draw(&PathElement::new(places.clone(), style))?;
    }
    for place in places {
        let around = |corners: &[[f64; 2]]| {
            let corners = corners.iter().copied().map(pixel);
            let all = corners.map(|(x, y)| (place.0 + x, place.1 + y)).collect();
            Polygon::<(i32, i32)>::new::<Vec<_>, _>(all, colour.filled())
        };
        // Neighbours of one colour differ in shape.
        match (number / COLOURS.len() + number) % 3 {
            0 => canvas.draw(&Circle::new(place, RADIUS.round(), colour.filled()))?,
            1 => canvas.draw(&around(&[
                [-4.0, -4.0],
                [4.0, -4.0],
                [4.0, 4.0],
                [-4.0, 4.0],
            ]))?,
            _ => canvas.draw(&around(&[[0.0, -5.4], [5.4, 5.4], [-5.4, 5.4]]))?,
        }
    }
    Ok(())
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
