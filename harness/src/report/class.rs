//! Classes of scenes, and the settings by which each is computed.

use super::{blocks, flows, water};
use crate::validate::{Method, Stand, Trial};

/// What a point shows.
pub struct Found {
    /// What was run.
    pub trial: Trial,
    /// The number that the class judges.
    pub value: f64,
    /// Relaxation time, of a lattice.
    pub tau: Option<f64>,
    /// Largest y⁺ half a cell from a block.
    pub y_plus: Option<f64>,
}

/// Computes a point.
pub type Run = Box<dyn Fn(&Stand) -> anyhow::Result<Found>>;

/// One point of a diagram: a setting on a grid.
pub struct Point {
    /// Name of the setting: that of the curve.
    pub setting: String,
    /// Whether all that the library chooses is as it chooses it.
    pub default: bool,
    /// How fine the grid is, in the measure of the class.
    pub resolution: f64,
    /// Computes it.
    pub run: Run,
}

/// What the value of a class is compared with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reference {
    /// The value is the error.
    None,
    /// A number that is known, and the part of it by which it may be off.
    Known(f64, f64),
    /// The limit of the first three points, which have the default setting on grids each twice as fine as the one
    /// before.
    Limit,
    /// The limit of three values that were found so on finer grids than those of the class.
    Recorded([f64; 3]),
}

/// Scenes of a kind.
pub struct Class {
    /// Short name, as in the table.
    pub name: &'static str,
    /// What it is.
    pub title: &'static str,
    /// What the error is, and of what.
    pub error: &'static str,
    /// What the resolution counts.
    pub resolution: &'static str,
    /// What an update is of.
    pub update: &'static str,
    /// What the value is compared with.
    pub reference: Reference,
    /// By the clock on the wall on two quiet cores with lavapipe, compilation and the repeat included, s; none where
    /// nobody has measured it.
    pub seconds: Option<f64>,
    /// Its points, in their order.
    pub points: Vec<Point>,
}

/// All classes; with `full` on the grids for a GPU.
///
/// The short form is a fraction of that design: each axis (collision, equilibrium, storage, operator, interval, scheme)
/// is crossed with the grids, and with nothing else but where a class is there for it (τ of the spheres). The finest
/// grids are those on which the default still takes seconds; a limit that wants finer ones is a recorded one.
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

/// What the short form of a class takes; of the full one nobody knows.
pub fn seconds(full: bool, short: f64) -> Option<f64> {
    (!full).then_some(short)
}

impl Point {
    /// A lattice by `method` on a grid.
    pub fn by(
        method: Method,
        resolution: f64,
        run: impl Fn(&Stand) -> anyhow::Result<Found> + 'static,
    ) -> Self {
        Self {
            setting: method.name.into(),
            default: method.name == Method::DEFAULT.name,
            resolution,
            run: Box::new(run),
        }
    }

    /// The same under a name that says more; without a comma, since tables hold it.
    pub fn with(mut self, what: &str) -> Self {
        self.setting = format!("{} at {what}", self.setting);
        self
    }
}

/// Orders that a method may show; an observed one beyond is that of rounding or of a change of sign.
const ORDERS: [f64; 2] = [0.5, 3.0];

/// The limit of a number over three grids (Richardson 1911), and the part of it by which it may be off: what the extrapolation adds, or the last change where the
/// numbers swing. Each grid is twice as fine as the one before.
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
