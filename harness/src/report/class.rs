//! Classes of scenes, and the settings with which each is computed.

use super::{blocks, flows, water};
use crate::validate::{CaseContext, Method, Trial};

/// Result of a point.
pub struct Found {
    /// Setup and cost of the run.
    pub trial: Trial,
    /// The number that the class judges.
    pub value: f64,
    /// Relaxation time, for a lattice.
    pub tau: Option<f64>,
    /// Largest y⁺ half a cell from a block.
    pub y_plus: Option<f64>,
}

/// Function that computes a point.
pub type Run = Box<dyn Fn(&CaseContext) -> anyhow::Result<Found>>;

/// One point of a diagram: a setting on a grid.
pub struct Point {
    /// Name of the setting: that of the curve.
    pub setting: String,
    /// Whether all settings are the defaults of the library.
    pub default: bool,
    /// Resolution of the grid, in the measure of the class.
    pub resolution: f64,
    /// Computes the point.
    pub run: Run,
}

/// Reference for the value of a class.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reference {
    /// The value is the error.
    None,
    /// A known number, and its relative uncertainty.
    Known(f64, f64),
    /// The limit of the first three points, which have the default setting on grids each twice as fine as the one
    /// before.
    Limit,
    /// The limit of three such values, recorded on finer grids than those of the class.
    Recorded([f64; 3]),
}

/// A class of scenes.
pub struct Class {
    /// Short name, as in the table.
    pub name: &'static str,
    /// Its title.
    pub title: &'static str,
    /// The error, and its reference.
    pub error: &'static str,
    /// Unit of the resolution.
    pub resolution: &'static str,
    /// What an update counts: a cell or a particle.
    pub update: &'static str,
    /// Reference for the value.
    pub reference: Reference,
    /// Wall time on two quiet cores with lavapipe, including compilation and the repeat, s; `None` if it has not been measured.
    pub seconds: Option<f64>,
    /// Its points, in their order.
    pub points: Vec<Point>,
}

/// All classes; with `full` on the grids for a GPU.
///
/// The short form is a fraction of that design: each axis (collision, equilibrium, storage, operator, interval, scheme) is
/// crossed with the grids only, except in classes made for another axis (τ of the spheres). The finest grids are those on which
/// the default still takes seconds; a limit that needs finer ones is recorded.
pub fn classes(full: bool) -> Vec<Class> {
    vec![
        flows::taylor_green(full),
        flows::poiseuille(full),
        flows::cavity(full),
        blocks::array(full),
        blocks::cube(full, 20.0),
        blocks::cube(full, 100.0),
        blocks::settling(full),
        water::still(full),
        water::wave(full),
        water::dam(full),
    ]
}

/// Time of the short form of a class; `None` for the full form, which has not been timed.
pub fn seconds(full: bool, short: f64) -> Option<f64> {
    (!full).then_some(short)
}

impl Point {
    /// A lattice computed by `method` on a grid.
    pub fn by(
        method: Method,
        resolution: f64,
        run: impl Fn(&CaseContext) -> anyhow::Result<Found> + 'static,
    ) -> Self {
        Self {
            setting: method.name.into(),
            default: method.name == Method::DEFAULT.name,
            resolution,
            run: Box::new(run),
        }
    }

    /// The same with `what` added to its name; without a comma, since tables contain it.
    pub fn with(mut self, what: &str) -> Self {
        self.setting = format!("{} at {what}", self.setting);
        self
    }
}

/// Plausible orders of a method; an observed order outside is due to rounding or a change of sign.
const ORDERS: [f64; 2] = [0.5, 3.0];

/// The limit of a number over three grids, each twice as fine as the one before (Richardson 1911), and its relative uncertainty:
/// the part added by the extrapolation, or the last change if the numbers oscillate.
pub fn limit([coarse, middle, fine]: [f64; 3]) -> (f64, f64) {
    let ratio = (coarse - middle) / (middle - fine);
    if !(ratio.is_finite() && ratio > 0.0) {
        return (fine, ((middle - fine) / fine).abs());
    }
    let order = ratio.log2().clamp(ORDERS[0], ORDERS[1]);
    let limit = fine + (fine - middle) / (order.exp2() - 1.0);
    (limit, (fine / limit - 1.0).abs())
}

#[cfg(test)]
mod tests {
    use super::limit;

    /// 2 (1 + h²/10) at h = 4, 2, 1.
    #[test]
    fn a_power_law_has_its_limit() {
        let (found, uncertainty) = limit([5.2, 2.8, 2.2]);
        assert!((found - 2.0).abs() < 1e-12);
        assert!((uncertainty - 0.1).abs() < 1e-12);
    }

    #[test]
    fn numbers_that_swing_have_their_last() {
        assert_eq!(limit([1.0, 3.0, 2.0]), (2.0, 0.5));
        assert_eq!(limit([2.0, 2.0, 2.0]), (2.0, 0.0));
    }
}
