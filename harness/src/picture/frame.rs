//! The rectangle that a plot is drawn in, with ticks along two edges.

use super::axis::{Axis, Tick};
use super::canvas::{Anchor, Canvas};
use anyhow::Result;
use plotters::style::RGBColor;

/// Height of labels and tick numbers, pixels.
pub const TEXT: f64 = 20.0;
/// Height of a picture's title, pixels.
pub const TITLE: f64 = 25.0;
/// Colour of text and edges.
pub const INK: RGBColor = RGBColor(38, 38, 38);
/// Colour of the grid lines behind curves.
const GRID: RGBColor = RGBColor(225, 225, 225);
/// Length of a tick, pixels.
const TICK: f64 = 6.0;
/// Gap between a tick and its number, and between number and title, pixels.
const GAP: f64 = 6.0;
/// Height below a frame that its x ticks, numbers and title take, pixels.
pub const FOOT: f64 = TICK + GAP + 2.0 * TEXT + 2.0 * GAP;

/// A plot's rectangle on the canvas, pixels, and its axes.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Upper left corner.
    pub corner: [f64; 2],
    /// Width and height.
    pub size: [f64; 2],
    /// Width beside it for the vertical axis's numbers and title, at least [`side`].
    pub side: f64,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis, upwards.
    pub y: Axis,
}

impl Frame {
    /// Place of the values (x, y) on the canvas.
    pub fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [
            self.corner[0] + self.x.fraction(x) * self.size[0],
            self.corner[1] + (1.0 - self.y.fraction(y)) * self.size[1],
        ]
    }

    /// The values (x, y) at a place on the canvas, for linear axes.
    pub fn values(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [
            self.x.value((x - self.corner[0]) / self.size[0]),
            self.y.value(1.0 - (y - self.corner[1]) / self.size[1]),
        ]
    }

    /// Lower right corner.
    pub fn opposite(&self) -> [f64; 2] {
        [self.corner[0] + self.size[0], self.corner[1] + self.size[1]]
    }

    /// Lines across the frame at every tick, to be drawn before the content.
    pub fn draw_grid(&self, canvas: &mut Canvas<'_>) -> Result<()> {
        let [right, bottom] = self.opposite();
        for (value, _) in x_ticks(&self.x, self.size[0])? {
            let x = self.corner[0] + self.x.fraction(value) * self.size[0];
            canvas.line(&[[x, self.corner[1]], [x, bottom]], 1.0, GRID)?;
        }
        for (value, _) in y_ticks(&self.y, self.size[1]) {
            let y = self.corner[1] + (1.0 - self.y.fraction(value)) * self.size[1];
            canvas.line(&[[self.corner[0], y], [right, y]], 1.0, GRID)?;
        }
        Ok(())
    }

    /// The border, ticks and y labels, and x labels if `labelled`, to be drawn after the content.
    pub fn draw(&self, canvas: &mut Canvas<'_>, labelled: bool) -> Result<()> {
        let ([left, top], [right, bottom]) = (self.corner, self.opposite());
        border(canvas, self.corner, self.opposite())?;
        draw_horizontal(canvas, &self.x, [left, right], bottom, labelled)?;
        draw_vertical(canvas, &self.y, [top, bottom], left, [-1.0, self.side])
    }
}

/// Ticks of a horizontal axis between `left` and `right`, under the edge at `y`; numbers and title if `labelled`.
pub fn draw_horizontal(
    canvas: &mut Canvas<'_>,
    axis: &Axis,
    [left, right]: [f64; 2],
    y: f64,
    labelled: bool,
) -> Result<()> {
    for (value, label) in x_ticks(axis, right - left)? {
        let x = left + axis.fraction(value) * (right - left);
        canvas.line(&[[x, y], [x, y + TICK]], 1.0, INK)?;
        if labelled {
            let at = [x, y + TICK + GAP + 0.5 * TEXT];
            canvas.text(&label, at, TEXT, Anchor::Centre, INK)?;
        }
    }
    if labelled {
        let at = [0.5 * (left + right), y + FOOT - GAP - 0.5 * TEXT];
        canvas.text(&axis.title(), at, TEXT, Anchor::Centre, INK)?;
    }
    Ok(())
}

/// Ticks, numbers and title of a vertical axis between `top` and `bottom`, next to the edge at `x`: left of it if `outwards`
/// is −1, right of it if 1, within the width `side`.
pub fn draw_vertical(
    canvas: &mut Canvas<'_>,
    axis: &Axis,
    [top, bottom]: [f64; 2],
    x: f64,
    [outwards, side]: [f64; 2],
) -> Result<()> {
    let anchor = match outwards > 0.0 {
        true => Anchor::Left,
        false => Anchor::Right,
    };
    for (value, label) in y_ticks(axis, bottom - top) {
        let y = bottom - axis.fraction(value) * (bottom - top);
        canvas.line(&[[x, y], [x + outwards * TICK, y]], 1.0, INK)?;
        let at = [x + outwards * (TICK + GAP), y];
        canvas.text(&label, at, TEXT, anchor, INK)?;
    }
    let title = axis.title();
    let size = fitting(&title, TEXT, bottom - top)?;
    let at = [
        x + outwards * (side - 0.5 * TEXT - GAP),
        0.5 * (top + bottom),
    ];
    canvas.text(&title, at, size, Anchor::Upwards, INK)
}

/// Width of ticks, numbers and title of a vertical axis of `height`, pixels.
pub fn side(axis: &Axis, height: f64) -> Result<f64> {
    let widths = y_ticks(axis, height)
        .iter()
        .map(|(_, label)| Canvas::text_width(label, TEXT))
        .collect::<Result<Vec<_>>>()?;
    let widest = widths.into_iter().fold(0.0, f64::max);
    Ok(TICK + GAP + widest + GAP + TEXT + 2.0 * GAP)
}

/// As many ticks as their numbers fit along `width` pixels.
fn x_ticks(axis: &Axis, width: f64) -> Result<Vec<Tick>> {
    // More than ten numbers do not help the reader.
    for most in (3..=10).rev() {
        let ticks = axis.ticks(most);
        let mut room = 0.0;
        for (_, label) in &ticks {
            // The width of two digits keeps neighbouring numbers apart.
            room += Canvas::text_width(label, TEXT)? + 1.5 * TEXT;
        }
        if room <= width {
            return Ok(ticks);
        }
    }
    Ok(axis.ticks(2))
}

/// As many ticks as their numbers fit along `height` pixels.
fn y_ticks(axis: &Axis, height: f64) -> Vec<Tick> {
    axis.ticks(((height / (1.8 * TEXT)) as usize).clamp(2, 10))
}

/// A thin line around a rectangle.
pub fn border(canvas: &mut Canvas<'_>, from: [f64; 2], to: [f64; 2]) -> Result<()> {
    let corners = [from, [to[0], from[1]], to, [from[0], to[1]], from];
    canvas.line(&corners, 1.0, INK)
}

/// `size`, or a smaller one at which `text` is at most `length` pixels long.
pub fn fitting(text: &str, size: f64, length: f64) -> Result<f64> {
    let width = Canvas::text_width(text, size)?;
    // Less than half of the size is not readable.
    Ok(size * (length / width).clamp(0.5, 1.0))
}
