//! Curves over one shared axis: profiles, convergence plots, histories.

use super::axis::{Axis, Scale, extremes};
use super::canvas::{Anchor, Canvas};
use super::curve::{self, Curve, Mark};
use super::frame::{self, FOOT, Frame, INK, TITLE};
use anyhow::{Context, Result, bail};
use riprap::output::Table;
use std::path::Path;

/// Space around everything and between panels, pixels.
const MARGIN: f64 = 18.0;

/// One frame of curves, or several stacked ones.
#[derive(Clone, Debug)]
pub struct Chart {
    /// Title above all frames.
    title: String,
    /// The shared horizontal axis.
    x: Measure,
    /// The frames, from top to bottom.
    panels: Vec<Panel>,
    /// Width of the picture, pixels.
    width: u32,
    /// Height of each frame, pixels.
    panel_height: u32,
    /// Whether the horizontal axis ends with the data, without a margin.
    tight: bool,
}

/// What an axis measures.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Measure {
    /// Name of the quantity.
    pub quantity: String,
    /// Its unit; empty for a pure number.
    pub unit: String,
    /// Scale of the axis.
    pub scale: Scale,
}

/// A frame with its own vertical axis.
#[derive(Clone, Debug)]
struct Panel {
    /// The vertical axis.
    y: Measure,
    /// Curves, named in a legend if more than one.
    curves: Vec<Curve>,
}

/// Columns of a table in one frame of a history.
#[derive(Clone, Debug)]
pub struct Track {
    /// The quantity that the columns have in common.
    y: Measure,
    /// Names of the columns, each a curve.
    pub columns: Vec<String>,
}

impl Track {
    /// `columns` with a `quantity` in `unit`.
    pub fn new(quantity: &str, unit: &str, columns: &[&str]) -> Self {
        Self {
            y: Measure::linear(quantity, unit),
            columns: columns.iter().map(|column| (*column).into()).collect(),
        }
    }

    /// The same with a logarithmic scale.
    pub fn logarithmic(quantity: &str, unit: &str, columns: &[&str]) -> Self {
        Self {
            y: Measure::logarithmic(quantity, unit),
            ..Self::new(quantity, unit, columns)
        }
    }
}

impl Measure {
    /// A quantity in `unit` on a linear scale.
    pub fn linear(quantity: &str, unit: &str) -> Self {
        Self {
            quantity: quantity.to_owned(),
            unit: unit.to_owned(),
            scale: Scale::Linear,
        }
    }

    /// A positive quantity in `unit` on a logarithmic scale.
    pub fn logarithmic(quantity: &str, unit: &str) -> Self {
        Self {
            scale: Scale::Logarithmic,
            ..Self::linear(quantity, unit)
        }
    }

    fn around(&self, values: impl Iterator<Item = f64>) -> Axis {
        Axis::around(&self.quantity, &self.unit, values, self.scale)
    }

    fn between(&self, values: impl Iterator<Item = f64>) -> Axis {
        Axis::new(&self.quantity, &self.unit, extremes(values), self.scale)
    }
}

impl Chart {
    /// A single frame, 1100 × 700 pixels.
    pub fn profile(title: &str, x: Measure, y: Measure, curves: Vec<Curve>) -> Self {
        Self {
            title: title.to_owned(),
            x,
            panels: vec![Panel { y, curves }],
            width: 1100,
            panel_height: 700,
            tight: false,
        }
    }

    /// `tracks` of `table` over its column `time` (s), stacked, 1400 pixels wide.
    pub fn history(title: &str, table: &Table, tracks: &[Track]) -> Result<Self> {
        Self::tracks(title, table, ("time", Measure::linear("time", "s")), tracks)
    }

    /// The same over another column, which measures `x`.
    pub fn tracks(
        title: &str,
        table: &Table,
        (shared, x): (&str, Measure),
        tracks: &[Track],
    ) -> Result<Self> {
        let column = |name: &str| {
            table.column(name).with_context(|| {
                let names = table.columns.iter().map(|(name, _)| name.as_str());
                let names = names.collect::<Vec<_>>().join(", ");
                format!("the table has no column `{name}`; it has {names}")
            })
        };
        let places = column(shared)?;
        let curve = |name: &String| {
            let values = places.iter().zip(column(name)?);
            Ok(Curve {
                name: name.replace('_', " "),
                points: values.map(|(&place, &value)| [place, value]).collect(),
                mark: Mark::Line,
            })
        };
        let panels = tracks.iter().map(|track| {
            Ok(Panel {
                y: track.y.clone(),
                curves: track.columns.iter().map(curve).collect::<Result<_>>()?,
            })
        });
        Ok(Self {
            title: title.to_owned(),
            x,
            panels: panels.collect::<Result<_>>()?,
            width: 1400,
            panel_height: 230,
            tight: true,
        })
    }

    /// Draws the chart into a PNG file.
    pub fn draw(&self, path: &Path) -> Result<()> {
        self.paint(Canvas::new)?.save(path)
    }

    /// The chart as SVG.
    pub fn svg(&self) -> Result<String> {
        let mut text = String::new();
        drop(self.paint(|width, height| Canvas::svg(&mut text, width, height))?);
        Ok(text)
    }

    fn paint<'a>(&self, canvas: impl FnOnce(u32, u32) -> Canvas<'a>) -> Result<Canvas<'a>> {
        if self.panels.is_empty() {
            bail!("{}: a chart without panels; give one at least", self.title);
        }
        let height = f64::from(self.panel_height);
        let points = |axis: usize| {
            move |panel: &Panel| -> Vec<f64> {
                let points = panel.curves.iter().flat_map(|curve| &curve.points);
                points.map(|point| point[axis]).collect()
            }
        };
        let along = self.panels.iter().flat_map(points(0));
        let x = if self.tight {
            self.x.between(along)
        } else {
            self.x.around(along)
        };
        let ys: Vec<Axis> = self
            .panels
            .iter()
            .map(|panel| panel.y.around(points(1)(panel).into_iter()))
            .collect();
        let sides = ys
            .iter()
            .map(|y| frame::side(y, height))
            .collect::<Result<Vec<_>>>()?;
        let left = MARGIN + sides.into_iter().fold(0.0, f64::max);
        // Half of the last number extends beyond the end of the axis.
        let width = (f64::from(self.width) - left - 2.0 * MARGIN).floor();
        let legends = self
            .panels
            .iter()
            .map(|panel| curve::legend_height(&panel.curves, width))
            .collect::<Result<Vec<_>>>()?;
        let panels = legends
            .iter()
            .map(|legend| legend + height + MARGIN)
            .sum::<f64>();
        let whole = MARGIN + TITLE + MARGIN + panels + FOOT;
        let mut canvas = canvas(self.width, whole as u32);
        let size = frame::fitting(&self.title, TITLE, canvas.width() - 2.0 * MARGIN)?;
        let at = [0.5 * canvas.width(), MARGIN + 0.5 * TITLE];
        canvas.text(&self.title, at, size, Anchor::Centre, INK)?;
        let mut top = MARGIN + TITLE + MARGIN;
        for (number, (panel, y)) in self.panels.iter().zip(ys).enumerate() {
            curve::draw_legend(&mut canvas, &panel.curves, [left.round(), top], width)?;
            let frame = Frame {
                corner: [left.round(), (top + legends[number]).round()],
                size: [width, height],
                side: left - MARGIN,
                x: x.clone(),
                y,
            };
            frame.draw_grid(&mut canvas)?;
            for (number, curve) in panel.curves.iter().enumerate() {
                curve.draw(&mut canvas, &frame, number)?;
            }
            frame.draw(&mut canvas, number + 1 == self.panels.len())?;
            top += legends[number] + height + MARGIN;
        }
        Ok(canvas)
    }
}
