//! The legend of a colour map.

use super::axis::{Axis, Scale, extremes};
use super::canvas::Canvas;
use super::colour::Palette;
use super::frame::{self, FOOT, Frame};
use anyhow::{Result, bail};
use plotters::style::RGBColor;

/// Thickness of the bar, pixels.
const THICK: f64 = 26.0;
/// Gap between map and bar, pixels.
const GAP: f64 = 26.0;

/// A palette over the range of an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct ColourBar {
    /// The quantity.
    pub axis: Axis,
    /// Its colours.
    pub palette: Palette,
}

impl ColourBar {
    /// The bar of a quantity over `range`, diverging if its ends are equal and opposite. Without a range, over the extremes of
    /// `values`, or from zero to their maximum for a `length`.
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

    /// Width next to a map of `height`, pixels.
    pub fn width(&self, height: f64) -> Result<f64> {
        Ok(GAP + THICK + frame::side(&self.axis, height)?)
    }

    /// Height below a map, pixels.
    pub fn height(&self) -> f64 {
        0.5 * GAP + THICK + FOOT
    }

    /// Draws a vertical bar to the right of `map`.
    pub fn draw_beside(&self, canvas: &mut Canvas<'_>, map: &Frame) -> Result<()> {
        let ([right, bottom], top) = (map.opposite(), map.corner[1]);
        let (near, far) = (right + GAP, right + GAP + THICK);
        canvas.shade([near, top], [far, bottom], |[_, y]| {
            self.palette.colour((bottom - y) / (bottom - top))
        });
        frame::border(canvas, [near, top], [far, bottom])?;
        let side = frame::side(&self.axis, bottom - top)?;
        frame::draw_vertical(canvas, &self.axis, [top, bottom], far, [1.0, side])
    }

    /// Draws a horizontal bar under the x axis of `map`.
    pub fn draw_below(&self, canvas: &mut Canvas<'_>, map: &Frame) -> Result<()> {
        let ([right, bottom], left) = (map.opposite(), map.corner[0]);
        let (near, far) = (bottom + FOOT + 0.5 * GAP, bottom + FOOT + 0.5 * GAP + THICK);
        canvas.shade([left, near], [right, far], |[x, _]| {
            self.palette.colour((x - left) / (right - left))
        });
        frame::border(canvas, [left, near], [right, far])?;
        frame::draw_horizontal(canvas, &self.axis, [left, right], far, true)
    }
}
