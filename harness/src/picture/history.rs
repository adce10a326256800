//! Columns of a probe's table over time, one frame a quantity.

use super::chart::{Chart, Measure, Panel};
use super::curve::{Curve, Mark};
use anyhow::{Context, Result};
use riprap::output::Table;

/// Width of the picture, pixels.
const WIDTH: u32 = 1400;
/// Height of a frame, pixels.
const PANEL: u32 = 230;

/// A frame of a history.
#[derive(Clone, Debug)]
pub struct Track<'a> {
    /// The quantity that the columns have in common.
    pub quantity: &'a str,
    /// Its unit.
    pub unit: &'a str,
    /// Names of the columns, each a curve.
    pub columns: &'a [&'a str],
}

impl Chart {
    /// `tracks` of `table` over its column `time` (s), on top of each other.
    pub fn history(title: &str, table: &Table, tracks: &[Track<'_>]) -> Result<Self> {
        let column = |name: &str| {
            table.column(name).with_context(|| {
                let names: Vec<&str> = table
                    .columns
                    .iter()
                    .map(|(name, _)| name.as_str())
                    .collect();
                format!(
                    "the table has no column `{name}`; it has {}",
                    names.join(", ")
                )
            })
        };
        let time = column("time")?;
        let panels = tracks
            .iter()
            .map(|track| {
                let curves = track
                    .columns
                    .iter()
                    .map(|name| {
                        let values = time.iter().zip(column(name)?);
                        Ok(Curve {
                            name: (*name).replace('_', " "),
                            points: values.map(|(&time, &value)| [time, value]).collect(),
                            mark: Mark::Line,
                        })
                    })
                    .collect::<Result<Vec<_>>>()?;
                Ok(Panel {
                    y: Measure::linear(track.quantity, track.unit),
                    curves,
                })
            })
            .collect::<Result<Vec<_>>>()?;
        Ok(Self {
            title: title.to_owned(),
            x: Measure::linear("time", "s"),
            panels,
            width: WIDTH,
            panel_height: PANEL,
            tight: true,
        })
    }
}
