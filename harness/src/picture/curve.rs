//! Curves in a frame, and their legend.

use super::canvas::{Anchor, Canvas};
use super::colour::CURVES;
use super::frame::{Frame, INK, TEXT};
use anyhow::Result;

/// Height of a row of a legend, pixels.
const ROW: f64 = 1.5 * TEXT;
/// Length of the sample of a curve in a legend, pixels.
const SAMPLE: f64 = 44.0;
/// Gap around a name in a legend, pixels.
const GAP: f64 = 10.0;
/// Stroke, pixels.
const STROKE: f64 = 2.2;
/// Radius of a point, pixels.
const RADIUS: f64 = 5.0;
/// Corners of the other marker shapes, in radii.
const SQUARE: [[f64; 2]; 4] = [[-0.9, -0.9], [0.9, -0.9], [0.9, 0.9], [-0.9, 0.9]];
const TRIANGLE: [[f64; 2]; 3] = [[0.0, -1.2], [1.2, 1.0], [-1.2, 1.0]];
/// Lengths of dash and gap, pixels.
const DASH: [f64; 2] = [12.0, 8.0];

/// Points drawn in one colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Name in the legend.
    pub name: String,
    /// Points (x, y) in the units of the axes; the curve has a gap at points that are not finite.
    pub points: Vec<[f64; 2]>,
    /// How they are drawn.
    pub mark: Mark,
}

/// How a curve's points are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mark {
    /// Joined by a line.
    #[default]
    Line,
    /// Joined by a dashed line, for theory.
    Dashed,
    /// Each by itself, for measurements.
    Points,
    /// Each by itself, and joined by a line.
    LinePoints,
}

impl Curve {
    /// Draws the curve with index `number` in its frame.
    pub fn draw(&self, canvas: &mut Canvas<'_>, frame: &Frame, number: usize) -> Result<()> {
        let holds = |[x, y]: &[f64; 2]| frame.x.holds(*x) && frame.y.holds(*y);
        for piece in self.points.split(|point| !holds(point)) {
            let places: Vec<[f64; 2]> = piece.iter().map(|&point| frame.place(point)).collect();
            self.mark.draw(canvas, &places, number)?;
        }
        Ok(())
    }
}

impl Mark {
    /// Draws the points of the curve with index `number`: when the colours repeat, the marker shape changes.
    fn draw(self, canvas: &mut Canvas<'_>, places: &[[f64; 2]], number: usize) -> Result<()> {
        let colour = CURVES[number % CURVES.len()];
        match self {
            Self::Line | Self::LinePoints => canvas.line(places, STROKE, colour)?,
            Self::Dashed => canvas.dashed(places, STROKE, DASH, colour)?,
            Self::Points => {}
        }
        if matches!(self, Self::Points | Self::LinePoints) {
            for &[x, y] in places {
                let around = |corners: &[[f64; 2]]| -> Vec<[f64; 2]> {
                    let corner = |[u, v]: &[f64; 2]| [x + RADIUS * u, y + RADIUS * v];
                    corners.iter().map(corner).collect()
                };
                match number / CURVES.len() % 3 {
                    0 => canvas.disc([x, y], RADIUS, colour)?,
                    1 => canvas.polygon(&around(&SQUARE), colour)?,
                    _ => canvas.polygon(&around(&TRIANGLE), colour)?,
                }
            }
        }
        Ok(())
    }
}

/// Height of the legend of `curves` in rows as wide as `width`, pixels; none for a single curve.
pub fn legend_height(curves: &[Curve], width: f64) -> Result<f64> {
    let rows = legend_rows(curves, width)?.len();
    Ok(rows as f64 * ROW)
}

/// Draws the legend of `curves` from `corner` on, in rows as wide as `width`.
pub fn draw_legend(
    canvas: &mut Canvas<'_>,
    curves: &[Curve],
    corner: [f64; 2],
    width: f64,
) -> Result<()> {
    for (row, entries) in legend_rows(curves, width)?.into_iter().enumerate() {
        let y = corner[1] + (row as f64 + 0.5) * ROW;
        for (number, x) in entries {
            let x = corner[0] + x;
            let ends = [x + RADIUS, x + SAMPLE - RADIUS];
            let places = match curves[number].mark {
                Mark::Points | Mark::LinePoints => {
                    vec![[ends[0], y], [x + 0.5 * SAMPLE, y], [ends[1], y]]
                }
                Mark::Line | Mark::Dashed => vec![[x, y], [x + SAMPLE, y]],
            };
            curves[number].mark.draw(canvas, &places, number)?;
            let at = [x + SAMPLE + GAP, y];
            canvas.text(&curves[number].name, at, TEXT, Anchor::Left, INK)?;
        }
    }
    Ok(())
}

/// Indices of the curves in each row of the legend, with their positions in it, pixels.
fn legend_rows(curves: &[Curve], width: f64) -> Result<Vec<Vec<(usize, f64)>>> {
    let mut rows: Vec<Vec<(usize, f64)>> = Vec::new();
    let mut used = f64::INFINITY;
    if curves.len() < 2 {
        return Ok(rows);
    }
    for (number, curve) in curves.iter().enumerate() {
        let wants = SAMPLE + GAP + Canvas::text_width(&curve.name, TEXT)?;
        if used + wants > width {
            used = 0.0;
            rows.push(Vec::new());
        }
        if let Some(row) = rows.last_mut() {
            row.push((number, used));
        }
        used += wants + 3.0 * GAP;
    }
    Ok(rows)
}
