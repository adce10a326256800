//! The colour scales of a drawing.

use super::drawing::Drawing;
use crate::picture::colour_bar::ColourBar;
use crate::picture::{Axis, Scale};
use plotters::style::RGBColor;
use riprap::{Error, Result};

/// What the colours of a drawing mean.
#[derive(Clone, Debug, PartialEq)]
pub struct Scales {
    /// Of bodies.
    bodies: ColourBar,
    /// Whether the colours of bodies are told.
    told: bool,
    /// Of each plane through a fluid.
    pub planes: Vec<ColourBar>,
    /// Of traces of a flow, if there are any.
    traces: Option<ColourBar>,
    /// Of small balls, if there are any.
    drops: Option<ColourBar>,
}

impl Scales {
    /// Those of `drawing`.
    pub fn of(drawing: &Drawing<'_>) -> Result<Self> {
        let (palette, range) = drawing.palette()?;
        let (label, unit) = match &drawing.colours {
            Some(colours) => (colours.label.as_str(), colours.unit.as_str()),
            None => ("", ""),
        };
        let planes = drawing.planes.iter().enumerate();
        let planes = planes.map(|(index, plane)| named(&format!("planes[{index}]"), plane.bar()));
        let traces = drawing.traces.as_ref().map(|traces| traces.bar());
        let drops = drawing.drops.as_ref().map(|drops| drops.bar());
        Ok(Self {
            bodies: ColourBar {
                axis: Axis::new(label, unit, range, Scale::Linear),
                palette,
            },
            told: drawing.colours.is_some(),
            planes: planes.collect::<Result<_>>()?,
            traces: traces.map(|bar| named("traces", bar)).transpose()?,
            drops: drops.map(|bar| named("drops", bar)).transpose()?,
        })
    }

    /// The bars to be drawn, each once.
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

    /// Colour of a trace at a speed (m/s).
    pub fn trace(&self, speed: f64) -> [u8; 3] {
        self.traces
            .as_ref()
            .map_or([0; 3], |bar| channels(bar.colour(speed)))
    }
}

/// What is wrong with the colours of something, in the words of the other faults of drawings.
fn named(name: &str, bar: anyhow::Result<ColourBar>) -> Result<ColourBar> {
    bar.map_err(|error| Error::argument(format!("{name}.colours.range"), error.to_string()))
}

fn channels(RGBColor(r, g, b): RGBColor) -> [u8; 3] {
    [r, g, b]
}
