//! The colour scales of a drawing.

use super::drawing::{Drawing, Traces};
use super::drops::Drops;
use crate::picture::Palette;
use crate::picture::colour_bar::ColourBar;
use plotters::style::RGBColor;
use riprap::Result;

/// Colour scales of a drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Scales {
    /// Scale of the bodies.
    bodies: ColourBar,
    /// Whether the scale of the bodies is shown.
    told: bool,
    /// Scale of each plane through a fluid.
    pub planes: Vec<ColourBar>,
    /// Scale of streamlines, if there are any.
    traces: Option<ColourBar>,
    /// Scale of small balls, if there are any.
    drops: Option<ColourBar>,
}

impl Scales {
    /// The scales of `drawing`.
    pub fn of(drawing: &Drawing<'_>) -> Result<Self> {
        let colours = drawing.colours.clone().unwrap_or_default();
        let free = drawing.instances.iter().filter(|body| !body.fixed);
        let values = free.filter_map(|body| body.value);
        let planes = drawing.planes.iter().enumerate();
        Ok(Self {
            bodies: colours.bar("", values, Palette::FromPale, false)?,
            told: drawing.colours.is_some(),
            planes: planes
                .map(|(index, plane)| plane.bar(index))
                .collect::<Result<_>>()?,
            traces: drawing.traces.as_ref().map(Traces::bar).transpose()?,
            drops: drawing.drops.as_ref().map(Drops::bar).transpose()?,
        })
    }

    /// The bars to draw, without duplicates.
    pub fn bars(&self) -> Vec<&ColourBar> {
        let bodies = self.told.then_some(&self.bodies);
        let mut bars: Vec<&ColourBar> = Vec::new();
        let flow = self.planes.iter().chain(&self.traces).chain(&self.drops);
        for bar in bodies.into_iter().chain(flow) {
            if !bars.contains(&bar) {
                bars.push(bar);
            }
        }
        bars
    }

    /// Colour of a body.
    pub fn body(&self, value: f64) -> [u8; 3] {
        channels(self.bodies.colour(value))
    }

    /// Colour of a small ball.
    pub fn drop(&self, value: f64) -> [u8; 3] {
        self.drops
            .as_ref()
            .map_or([0; 3], |bar| channels(bar.colour(value)))
    }

    /// Colour of a streamline at a speed (m/s).
    pub fn trace(&self, speed: f64) -> [u8; 3] {
        self.traces
            .as_ref()
            .map_or([0; 3], |bar| channels(bar.colour(speed)))
    }
}

fn channels(RGBColor(r, g, b): RGBColor) -> [u8; 3] {
    [r, g, b]
}
