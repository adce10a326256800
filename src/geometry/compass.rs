//! Dip and dip direction in the axes of a scene.

use crate::{Error, Result};
use glam::DVec3;

/// Directions of up and north.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compass {
    /// Against gravity, of any length.
    pub up: DVec3,
    /// Where the dip direction is 0°, of any length; only its level part counts.
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
pub(super) struct Attitude {
    /// Level, the plane falling to the right of it.
    pub strike: DVec3,
    /// Up the plane.
    pub rise: DVec3,
    /// Upwards normal.
    pub normal: DVec3,
}

impl Compass {
    /// Upward unit normal of a plane that falls by `dip` (°, 0 level to 90 upright) towards
    /// `dip_direction` (°, from north to the east, which is right of north seen from above).
    ///
    /// # Errors
    /// If up and north are no axes, or the dip is not between 0 and 90, or an angle is not finite.
    pub fn normal(&self, dip: f64, dip_direction: f64) -> Result<DVec3> {
        Ok(self.attitude(dip, dip_direction)?.normal)
    }

    pub(super) fn attitude(&self, dip: f64, dip_direction: f64) -> Result<Attitude> {
        let axes = self.up.try_normalize().and_then(|up| {
            let north = self.north.try_normalize()?.reject_from_normalized(up);
            // Within a hundredth of a degree of up, north would be a matter of rounding.
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

/// Sine and cosine of an angle in degrees, exact at right angles, so that upright is upright.
fn sin_cos(degrees: f64) -> (f64, f64) {
    match degrees.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        other => other.to_radians().sin_cos(),
    }
}
