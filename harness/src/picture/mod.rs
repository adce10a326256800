//! Pictures of results, as PNG files: a [`Slice`] through the flow, a [`ColourGrid`] of runs, and a [`Chart`] of
//! curves — the [history](Chart::history) of a probe or the [profile](Chart::profile) of a quantity.

mod axis;
pub(crate) mod canvas;
mod chart;
pub(crate) mod colour;
pub(crate) mod colour_bar;
mod curve;
pub(crate) mod field_lines;
pub(crate) mod frame;
mod grid;
mod placed;
mod section;
mod slice;
mod streamlines;
mod traces;

pub(crate) use axis::extremes;
pub use axis::{Axis, Scale};
pub use chart::{Chart, Measure, Track};
pub use colour::Palette;
pub use curve::{Curve, Mark};
pub use grid::{ColourGrid, GridPanel, Square};
pub use placed::Placed;
pub use section::{Plane, Quantity, Section};
pub use slice::Slice;
pub(crate) use slice::short;
pub use streamlines::streamlines;
pub use traces::{Trace, traces};
