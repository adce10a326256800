//! What deforming blocks bear.

use super::Blocks;
use crate::rock::law;
use glam::{DMat3, DVec3};

impl Blocks {
    /// Whether some block deforms.
    pub fn any_deforms(&self) -> bool {
        !self.deforming.is_empty()
    }

    /// Cauchy stress in a block that deforms, along the axes of the world, Pa; tension is positive.
    pub fn stress(&self, block: usize) -> Option<DMat3> {
        let (one, strain) = self.deforming.of(&self.bodies[block])?;
        Some(one.affine.stress(strain.deformation))
    }

    /// Von Mises stress in a block that deforms, Pa.
    pub fn von_mises(&self, block: usize) -> Option<f64> {
        self.stress(block).map(law::von_mises)
    }

    /// Strain E = ½(FᵀF − 1) of a block that deforms, in its own frame.
    pub fn strain(&self, block: usize) -> Option<DMat3> {
        let (one, strain) = self.deforming.of(&self.bodies[block])?;
        Some(one.affine.strain(strain.deformation))
    }

    /// Strain energy of a block that deforms, J.
    pub fn strain_energy(&self, block: usize) -> Option<f64> {
        let (one, strain) = self.deforming.of(&self.bodies[block])?;
        Some(one.affine.strain_energy(strain.deformation))
    }

    /// Force with which the fixed points of a block hold it, N; none if it has no fixed points.
    pub fn support(&self, block: usize) -> Option<DVec3> {
        let body = &self.bodies[block];
        let (one, strain) = self.deforming.of(body)?;
        let state = &self.states[block];
        let rate = one.accelerations(body, state, strain, self.gravity, self.time);
        (!one.constraints.is_empty()).then_some(rate.support)
    }
}
