//! The scale that tells which colour means which value.

use super::axis::{Axis, Scale, extremes};
use super::canvas::{Anchor, Canvas};
use super::colour::Palette;
use super::frame::{self, FOOT, Frame, INK, TEXT};
use anyhow::{Result, bail};
use plotters::style::RGBColor;

/// Thickness of the bar, pixels.
const THICK: f64 = 26.0;
/// Gap between map and bar, and bar, numbers and title, pixels.
const GAP: f64 = 26.0;
/// Length of a tick, pixels.
const TICK: f64 = 6.0;

/// A palette over the range of an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct ColourBar {
    /// The quantity.
    pub axis: Axis,
    /// Its colours.
    pub palette: Palette,
}

impl ColourBar {
    /// The bar of a quantity over `range`, whose middle is special only where its ends are equal and opposite; without
    /// one over what `values` reach, for a `length` from zero, against which alone it means something.
    pub fn fitting(
        quantity: &str,
        unit: &str,
        range: Option<[f64; 2]>,
        values: impl Iterator<Item = f64>,
        length: bool,
    ) -> Result<Self> {
        let (palette, range) = match range {
            Some([low, high]) if !(low.is_finite() && high.is_finite() && low < high) => {
                bail!("colours from {low} to {high} {unit}: give two numbers, the lower first")
            }
            Some([low, high]) if low == -high => (Palette::Diverging, [low, high]),
            Some(range) => (Palette::Sequential, range),
            None => match extremes(values) {
                [_, high] if length => (Palette::Sequential, [0.0, high]),
                range => Palette::fitting(range),
            },
        };
        Ok(Self {
            axis: Axis::new(quantity, unit, range, Scale::Linear),
            palette,
        })
    }

    /// The colour of a value.
    pub fn colour(&self, value: f64) -> RGBColor {
        self.palette.colour(self.axis.fraction(value))
    }

    /// Width beside a map of `height`, pixels.
    pub fn width(&self, height: f64) -> Result<f64> {
        Ok(GAP + THICK + frame::side(&self.axis, height)?)
    }

    /// Height below a map, pixels.
    pub fn height(&self) -> f64 {
        0.5 * GAP + THICK + FOOT
    }

    /// An upright bar to the right of `map`.
    pub fn draw_beside(&self, canvas: &mut Canvas, map: &Frame) -> Result<()> {
        let [right, bottom] = map.opposite();
        let top = map.corner[1];
        let (near, far) = (right + GAP, right + GAP + THICK);
        canvas.shade([near, top], [far, bottom], |[_, y]| {
            self.palette.colour((bottom - y) / (bottom - top))
        });
        frame::border(canvas, [near, top], [far, bottom])?;
        let mut widest = 0.0_f64;
        for (value, label) in frame::y_ticks(&self.axis, map.size[1]) {
            let y = bottom - self.axis.fraction(value) * (bottom - top);
            canvas.line(&[[far, y], [far + TICK, y]], 1.0, INK)?;
            canvas.text(&label, [far + 2.0 * TICK, y], TEXT, Anchor::Left, INK)?;
            widest = widest.max(Canvas::text_width(&label, TEXT)?);
        }
        let title = self.axis.title();
        let size = frame::fitting(&title, TEXT, map.size[1])?;
        let x = far + 3.0 * TICK + widest + 0.5 * TEXT;
        canvas.text(
            &title,
            [x, 0.5 * (top + bottom)],
            size,
            Anchor::Upwards,
            INK,
        )
    }

    /// A lying bar under the x axis of `map`.
    pub fn draw_below(&self, canvas: &mut Canvas, map: &Frame) -> Result<()> {
        let [right, bottom] = map.opposite();
        let left = map.corner[0];
        let (near, far) = (bottom + FOOT + 0.5 * GAP, bottom + FOOT + 0.5 * GAP + THICK);
        canvas.shade([left, near], [right, far], |[x, _]| {
            self.palette.colour((x - left) / (right - left))
        });
        frame::border(canvas, [left, near], [right, far])?;
        for (value, label) in frame::x_ticks(&self.axis, map.size[0])? {
            let x = left + self.axis.fraction(value) * (right - left);
            canvas.line(&[[x, far], [x, far + TICK]], 1.0, INK)?;
            let at = [x, far + 2.0 * TICK + 0.5 * TEXT];
            canvas.text(&label, at, TEXT, Anchor::Centre, INK)?;
        }
        let at = [0.5 * (left + right), far + FOOT - TICK - 0.5 * TEXT];
        canvas.text(&self.axis.title(), at, TEXT, Anchor::Centre, INK)
    }
}
