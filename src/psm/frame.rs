//! Conversion between blocks in SI and the lattice.

use super::Motion;
use crate::{
    Error, Result,
    geometry::{Load, Pose},
    units::Units,
};
use glam::{DMat3, DVec3};

/// Position and units of the lattice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Lower corner of the domain, m.
    pub origin: DVec3,
    /// Units of the lattice.
    pub units: Units,
}

impl Frame {
    /// Checks origin and units.
    ///
    /// # Errors
    /// [`Error::Argument`] if they are invalid.
    pub(super) fn check(&self) -> Result<()> {
        if !self.origin.is_finite() {
            let message = format!("is {}; give a finite place", self.origin);
            return Err(Error::argument("frame.origin", message));
        }
        self.units.check()
    }

    /// A point in cells from the lower corner.
    pub fn place(&self, x: DVec3) -> DVec3 {
        (x - self.origin) / self.units.cell
    }

    /// The same, split into whole cells and a fraction.
    pub fn split(&self, x: DVec3) -> ([i32; 3], [f32; 3]) {
        let place = self.place(x);
        let base = place.floor();
        (whole(base), (place - base).as_vec3().to_array())
    }

    /// How a block moves.
    pub fn motion(&self, pose: &Pose) -> Motion {
        let (base, fraction) = self.split(pose.centre);
        let to_lattice = |v: f64| self.units.velocity_to_lattice(v) as f32;
        // u = v + Ḟ X with X = F⁻¹ r.
        let gradient = pose.deformation_rate * pose.deformation.inverse();
        let rate = |v: DVec3| v.to_array().map(|v| self.units.rate_to_lattice(v) as f32);
        Motion {
            base,
            fraction,
            velocity: pose.velocity.to_array().map(to_lattice),
            gradient_x: rate(gradient.x_axis),
            gradient_y: rate(gradient.y_axis),
            gradient_z: rate(gradient.z_axis),
            ..Motion::default()
        }
    }

    /// Converts the [`super::WRENCH`] sums of a block to SI.
    pub fn load(&self, wrench: &[f32]) -> Load {
        let at = |n: usize| f64::from(wrench[n]);
        let vector = |n: usize| DVec3::new(at(n), at(n + 1), at(n + 2));
        let volume = self.units.cell.powi(3);
        let force = self.units.force_from_lattice(1.0);
        let rows = [3, 6, 9].map(|n| vector(n) * self.units.torque_from_lattice(1.0));
        Load {
            force: vector(0) * force,
            moment: DMat3::from_cols(rows[0], rows[1], rows[2]).transpose(),
            entrained: at(12) * volume,
            missing: at(13) * volume,
            entrained_moment: vector(14) * volume * self.units.cell,
            missing_moment: vector(17) * volume * self.units.cell,
        }
    }
}

/// Largest distance of a block from the domain, cells: the device counts whole cells in 32 bits.
pub(super) const MAX_DISTANCE: f64 = 1e9;

/// Rounds to whole cells, saturating at the range of the integers.
pub(super) fn whole(base: DVec3) -> [i32; 3] {
    base.to_array().map(|x| x as i32)
}

/// Spin of a rigid pose, rad/s.
pub fn spin(pose: &Pose) -> DVec3 {
    let gradient = pose.deformation_rate * pose.deformation.transpose();
    let w = 0.5 * (gradient - gradient.transpose());
    DVec3::new(w.y_axis.z, w.z_axis.x, w.x_axis.y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::skew;
    use glam::DQuat;

    #[test]
    fn the_spin_of_a_turned_pose_is_its_spin() {
        let spin_in = DVec3::new(0.3, -0.7, 1.1);
        let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, -1.0).normalize(), 0.8);
        let pose = Pose::rigid(DVec3::ZERO, turn, DVec3::ONE, spin_in);
        assert!((spin(&pose) - spin_in).length() < 1e-15);
        assert!((skew(spin_in) * DVec3::X - spin_in.cross(DVec3::X)).length() < 1e-15);
    }
}
