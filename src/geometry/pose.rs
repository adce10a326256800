//! Poses and loads: the interface between blocks and whatever loads them (Gardner & Sitar 2018, eqs. 11–12).

use crate::{Error, Result};
use glam::{DMat3, DQuat, DVec3};

/// Position and motion of a block, SI. `deformation` is a rotation for a rigid block and any matrix for a deformable
/// one, so that one formula gives the velocity of a point of either.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct Pose {
    /// Centroid, m.
    pub centre: DVec3,
    /// Deformation gradient F: a point X of the block, m from its centroid in its own frame, is at `centre` + F X.
    pub deformation: DMat3,
    /// Velocity of the centroid, m/s.
    pub velocity: DVec3,
    /// Rate of the deformation gradient, Ḟ, 1/s.
    pub deformation_rate: DMat3,
}

impl Pose {
    /// Pose of a rigid block with this `rotation`, `velocity` (m/s) and angular velocity `spin` (rad/s, about the
    /// axes of the world).
    pub fn rigid(centre: DVec3, rotation: DQuat, velocity: DVec3, spin: DVec3) -> Self {
        let deformation = DMat3::from_quat(rotation);
        Self {
            centre,
            deformation,
            velocity,
            deformation_rate: skew(spin) * deformation,
        }
    }

    /// Pose of a rigid block that does not move.
    pub fn at_rest(centre: DVec3, rotation: DQuat) -> Self {
        Self::rigid(centre, rotation, DVec3::ZERO, DVec3::ZERO)
    }

    /// Whether all numbers are finite.
    pub(crate) fn is_finite(&self) -> bool {
        self.centre.is_finite()
            && self.deformation.is_finite()
            && self.velocity.is_finite()
            && self.deformation_rate.is_finite()
    }

    /// Checks that the deformation keeps a volume and does not invert the block.
    ///
    /// # Errors
    /// [`Error::Argument`] at `place` if the determinant of the deformation is not positive.
    pub(crate) fn check_volume(&self, place: impl FnOnce() -> String) -> Result<()> {
        let determinant = self.deformation.determinant();
        if determinant > 0.0 {
            return Ok(());
        }
        let message = format!(
            "the determinant of its deformation F is {determinant}, which leaves no volume; give a matrix whose \
             determinant is greater than 0, for a rigid block a rotation"
        );
        Err(Error::argument(place(), message))
    }

    /// Position of the point X of the block, m.
    pub fn point(&self, x: DVec3) -> DVec3 {
        self.centre + self.deformation * x
    }

    /// The pose `time` (s) later, at constant velocity and deformation rate.
    pub fn after(&self, time: f64) -> Self {
        Self {
            centre: self.centre + time * self.velocity,
            deformation: self.deformation + self.deformation_rate * time,
            ..*self
        }
    }

    /// The pose in a plane flow, which does not vary along y: all points of the block are in the plane at `y` (m).
    pub(crate) fn in_plane(&self, y: f64) -> Self {
        Self {
            centre: self.centre.with_y(y),
            velocity: in_plane(self.velocity),
            deformation: plane_part(self.deformation),
            deformation_rate: plane_part(self.deformation_rate),
        }
    }

    /// Velocity of the point X of the block, m/s.
    pub fn point_velocity(&self, x: DVec3) -> DVec3 {
        self.velocity + self.deformation_rate * x
    }
}

/// The matrix W with W x = w × x.
pub fn skew(w: DVec3) -> DMat3 {
    DMat3::from_cols(
        DVec3::new(0.0, w.z, -w.y),
        DVec3::new(-w.z, 0.0, w.x),
        DVec3::new(w.y, -w.x, 0.0),
    )
}

fn in_plane(v: DVec3) -> DVec3 {
    v.with_y(0.0)
}

/// The matrix without the row and the column of y.
fn plane_part(m: DMat3) -> DMat3 {
    DMat3::from_cols(in_plane(m.x_axis), DVec3::ZERO, in_plane(m.z_axis))
}

/// a ⊗ b, entry i, j being a_i b_j.
pub(crate) fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

/// Torque Σ r × f of the moment Σ f ⊗ r.
pub(crate) fn axial(m: DMat3) -> DVec3 {
    DVec3::new(
        m.y_axis.z - m.z_axis.y,
        m.z_axis.x - m.x_axis.z,
        m.x_axis.y - m.y_axis.x,
    )
}

/// A:B, the sum of the products of the entries.
pub(crate) fn inner(a: DMat3, b: DMat3) -> f64 {
    a.x_axis.dot(b.x_axis) + a.y_axis.dot(b.y_axis) + a.z_axis.dot(b.z_axis)
}

/// Load of a fluid on a block in one step, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct Load {
    /// Force, N.
    pub force: DVec3,
    /// Σ f ⊗ r (entry i, j is f_i r_j), r from the centroid, N m; the torque is its skew part.
    pub moment: DMat3,
    /// Volume in which the fluid moves with the block, ΣB, m³.
    pub entrained: f64,
    /// Volume of the block in which the fluid does not move with it, Σ(ε − B), m³. `force` lacks the part ρ b ΣB of a body
    /// force b on the fluid, and the buoyancy −ρ g Σε is that of both volumes.
    pub missing: f64,
    /// First moment of the entrained volume about the centroid, m⁴.
    pub entrained_moment: DVec3,
    /// First moment of the volume `missing` about the centroid, m⁴.
    pub missing_moment: DVec3,
}

impl Default for Load {
    /// No load. Not derived: the default of a matrix is the identity.
    fn default() -> Self {
        Self {
            force: DVec3::ZERO,
            moment: DMat3::ZERO,
            entrained: 0.0,
            missing: 0.0,
            entrained_moment: DVec3::ZERO,
            missing_moment: DVec3::ZERO,
        }
    }
}

impl Load {
    /// A force (N) at the offset `r` (m) from the centroid.
    pub fn at(force: DVec3, r: DVec3) -> Self {
        Self {
            force,
            moment: outer(force, r),
            ..Self::default()
        }
    }

    /// The load in a plane flow, which does not vary along y: its components in x and z.
    pub(crate) fn in_plane(&self) -> Self {
        Self {
            force: in_plane(self.force),
            moment: plane_part(self.moment),
            ..*self
        }
    }

    /// Work (J) of this load on a block that moves at constant rates from one pose to another: F·Δc + Σ f ⊗ r : ΔF F⁻¹, with
    /// the deformation gradient at mid-step.
    pub fn work(&self, from: &Pose, to: &Pose) -> f64 {
        let change = to.deformation - from.deformation;
        let translation = self.force.dot(to.centre - from.centre);
        if change == DMat3::ZERO {
            return translation;
        }
        let middle = 0.5 * (from.deformation + to.deformation);
        translation + inner(self.moment, change * middle.inverse())
    }

    /// Torque about the centroid, Σ r × f, N m.
    pub fn torque(&self) -> DVec3 {
        axial(self.moment)
    }
}
