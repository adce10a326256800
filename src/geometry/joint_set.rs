//! Joint sets: parallel planes of weakness through a rock mass, by dip and dip direction.

use super::{HalfSpace, polyhedron::positive};
use crate::{Error, Result, random::uniform};
use glam::DVec3;
use std::f64::consts::TAU;

/// Largest index of a joint, counted from the origin of its set.
const MOST: f64 = 1e6;

/// Parallel joints. Joint 0 passes through `origin`; the others follow on both sides.
#[derive(Clone, Debug, PartialEq)]
pub struct JointSet {
    /// Dip, °: 0 is horizontal, 90 vertical.
    pub dip: f64,
    /// Dip direction, ° from north to the east.
    pub dip_direction: f64,
    /// Mean distance from joint to joint, m.
    pub spacing: f64,
    /// Distribution of the distances.
    pub scatter: Scatter,
    /// A point of joint 0, m.
    pub origin: DVec3,
    /// Seed of the random distances and open squares.
    pub seed: u64,
    /// Persistence; if `None`, joints are open everywhere.
    pub persistence: Option<Persistence>,
}

/// Distribution of the distances from joint to joint; their mean is the spacing of the set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scatter {
    /// All distances are equal.
    None,
    /// Uniform between spacing ± `range`.
    Uniform {
        /// Half the width of the distribution, m, less than the spacing.
        range: f64,
    },
    /// Normal, cut off at 0.1 and 1.9 times the spacing, so that the mean stays.
    Normal {
        /// Standard deviation before the cut, m, at most the spacing.
        deviation: f64,
    },
    /// Lognormal.
    Lognormal {
        /// Standard deviation, m.
        deviation: f64,
    },
    /// Negative exponential: joints placed independently (Priest & Hudson 1976, Int. J. Rock Mech.
    /// Min. Sci. 13:135). Makes slivers.
    Exponential,
}

/// Joints that are not open everywhere. Each joint is divided into squares along strike and dip; the seed chooses the
/// shift of this grid and the open squares. A joint cuts a block completely if the mean of the section's corners is
/// in an open square, otherwise not at all, so that blocks stay convex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Persistence {
    /// Fraction of the squares that are open, 0 to 1.
    pub fraction: f64,
    /// Side of the squares, m.
    pub length: f64,
}

/// The joints of a set that cross a rock mass.
pub(super) struct Joints<'a> {
    set: &'a JointSet,
    attitude: Attitude,
    /// Index in the set and plane, ascending.
    pub planes: Vec<(i64, HalfSpace)>,
}

impl JointSet {
    /// The joints of the set between the two heights (m) that `range` gives for their normal.
    pub(super) fn joints(
        &self,
        compass: &Compass,
        range: impl Fn(DVec3) -> [f64; 2],
    ) -> Result<Joints<'_>> {
        self.check()?;
        let attitude = compass.attitude(self.dip, self.dip_direction)?;
        let normal = attitude.normal;
        let base = normal.dot(self.origin);
        let [low, high] = range(normal).map(|d| d - base);
        let mut heights = Vec::new();
        if let Scatter::None = self.scatter {
            // Each is computed from the origin, so that rounding does not accumulate.
            let first = self.counted((low / self.spacing).ceil())?;
            let last = self.counted((high / self.spacing).floor())?;
            heights.extend((first..=last).map(|k| (k, k as f64 * self.spacing)));
        } else {
            let (mut k, mut at) = (0_i64, 0.0);
            while at >= low {
                k = self.counted((k - 1) as f64)?;
                at -= self.distance(k);
                heights.push((k, at));
            }
            heights.reverse();
            (k, at) = (0, 0.0);
            while at <= high {
                heights.push((k, at));
                at += self.distance(k);
                k = self.counted((k + 1) as f64)?;
            }
            heights.retain(|(_, at)| (low..=high).contains(at));
        }
        let plane = |(k, at)| {
            let distance = base + at;
            (k, HalfSpace { normal, distance })
        };
        Ok(Joints {
            set: self,
            attitude,
            planes: heights.into_iter().map(plane).collect(),
        })
    }

    /// The index of a joint, if it is within the limit.
    fn counted(&self, k: f64) -> Result<i64> {
        if k.abs() <= MOST {
            return Ok(k as i64);
        }
        let message = format!(
            "the rock reaches more than {MOST} joints away from the origin of the set; move the \
             origin into the rock or widen the spacing"
        );
        Err(Error::argument("spacing", message))
    }

    /// Distance from joint k to joint k + 1, m.
    fn distance(&self, k: i64) -> f64 {
        let mean = self.spacing;
        let draw = |n: i64| uniform(self.seed, &[k, n]);
        // Box & Muller 1958.
        let normal = |n: i64| (-2.0 * draw(n).ln()).sqrt() * (TAU * draw(n + 1)).cos();
        match self.scatter {
            Scatter::None => mean,
            Scatter::Uniform { range } => mean + range * (2.0 * draw(0) - 1.0),
            Scatter::Normal { deviation } => {
                // Two draws in three are inside even for the largest deviation.
                let draws = (0..).step_by(2).map(|n| mean + deviation * normal(n));
                let inside = |d: &f64| (0.1 * mean..=1.9 * mean).contains(d);
                draws.take(1000).find(inside).unwrap_or(mean)
            }
            Scatter::Lognormal { deviation } => {
                let square = (deviation / mean).powi(2).ln_1p();
                mean * (square.sqrt() * normal(0) - square / 2.0).exp()
            }
            Scatter::Exponential => -mean * draw(0).ln(),
        }
    }

    fn check(&self) -> Result<()> {
        positive("spacing", self.spacing)?;
        if !self.origin.is_finite() {
            let message = format!("{} is not finite; give a point in m", self.origin);
            return Err(Error::argument("origin", message));
        }
        let (least, most, width) = match self.scatter {
            Scatter::Uniform { range } => (0.0, self.spacing.next_down(), range),
            Scatter::Normal { deviation } => (0.0, self.spacing, deviation),
            Scatter::Lognormal { deviation } => (0.0, 10.0 * self.spacing, deviation),
            Scatter::None | Scatter::Exponential => (0.0, 0.0, 0.0),
        };
        if !(least..=most).contains(&width) {
            let message =
                format!("{width} m is not between 0 and {most:.6} m; change it or the spacing");
            return Err(Error::argument("scatter", message));
        }
        let Some(Persistence { fraction, length }) = self.persistence else {
            return Ok(());
        };
        positive("persistence.length", length)?;
        if !(0.0..=1.0).contains(&fraction) {
            let message = format!("{fraction} is no share; give a number from 0 to 1");
            return Err(Error::argument("persistence.fraction", message));
        }
        Ok(())
    }
}

impl Joints<'_> {
    /// Whether joint `k` is open at `point`, m.
    pub fn open(&self, k: i64, point: DVec3) -> bool {
        let Some(Persistence { fraction, length }) = self.set.persistence else {
            return true;
        };
        // Keys of another length than those of the distances, so that the random numbers differ.
        let draw = |key: [i64; 4]| uniform(self.set.seed, &key);
        let from = point - self.set.origin;
        let square = |axis: DVec3, which: i64| {
            let shift = draw([k, 0, 0, 1 + which]);
            (from.dot(axis) / length + shift).floor() as i64
        };
        let [i, j] = [
            square(self.attitude.strike, 0),
            square(self.attitude.rise, 1),
        ];
        draw([k, i, j, 0]) < fraction
    }
}

/// Directions of up and north.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compass {
    /// Upward direction, against gravity, of any length.
    pub up: DVec3,
    /// Direction of the dip direction 0°, of any length; only its horizontal part counts.
    pub north: DVec3,
}

impl Default for Compass {
    /// z up, y north, x east.
    fn default() -> Self {
        Self {
            up: DVec3::Z,
            north: DVec3::Y,
        }
    }
}

/// The axes of a plane: unit vectors, `strike` × `rise` = `normal`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Attitude {
    /// Horizontal; the plane dips to the right of it.
    pub strike: DVec3,
    /// Upwards along the plane.
    pub rise: DVec3,
    /// Upward normal.
    pub normal: DVec3,
}

impl Compass {
    /// Upward unit normal of a plane that dips by `dip` (°, 0 horizontal to 90 vertical) towards `dip_direction` (°,
    /// from north to the east, which is right of north seen from above).
    ///
    /// # Errors
    /// If up and north do not define axes, or the dip is not between 0 and 90, or an angle is not finite.
    pub fn normal(&self, dip: f64, dip_direction: f64) -> Result<DVec3> {
        Ok(self.attitude(dip, dip_direction)?.normal)
    }

    fn attitude(&self, dip: f64, dip_direction: f64) -> Result<Attitude> {
        let axes = self.up.try_normalize().and_then(|up| {
            let north = self.north.try_normalize()?.reject_from_normalized(up);
            // If north is within a hundredth of a degree of up, rounding determines its horizontal part.
            (north.length() > 2e-4).then(|| (up, north.normalize()))
        });
        let Some((up, north)) = axes else {
            let message = format!(
                "up {} and north {} must be two finite directions that are not parallel",
                self.up, self.north
            );
            return Err(Error::argument("compass", message));
        };
        if !(0.0..=90.0).contains(&dip) {
            let message = format!(
                "{dip}° is not between 0 (level) and 90 (upright); turn the dip direction by 180° instead"
            );
            return Err(Error::argument("dip", message));
        }
        if !dip_direction.is_finite() {
            let message = format!("{dip_direction}° is no direction; give degrees from north");
            return Err(Error::argument("dip_direction", message));
        }
        let east = north.cross(up);
        let (sin_dip, cos_dip) = sin_cos(dip);
        let (sin, cos) = sin_cos(dip_direction);
        let towards = north * cos + east * sin;
        Ok(Attitude {
            strike: north * sin - east * cos,
            rise: up * sin_dip - towards * cos_dip,
            normal: towards * sin_dip + up * cos_dip,
        })
    }
}

/// Sine and cosine of an angle in degrees, exact at right angles, so that vertical planes are exactly vertical.
fn sin_cos(degrees: f64) -> (f64, f64) {
    match degrees.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        other => other.to_radians().sin_cos(),
    }
}
