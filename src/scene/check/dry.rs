//! Without fluid, nothing asks for one.

use super::rules::refuse;
use crate::error::Result;
use crate::scene::{
    Boundaries, Coupling, Initial, Numerics, Output, ProbePlace, Quantity, Scene, Shape,
};

impl Scene {
    /// What a scene without fluid must not have.
    pub(super) fn check_dry(&self) -> Result<()> {
        let of_fluid = [
            ("numerics", self.numerics != Numerics::default()),
            ("boundaries", self.boundaries != Boundaries::default()),
            ("initial", self.initial != Initial::default()),
            ("coupling", self.coupling != Coupling::default()),
            (
                "output.fields",
                self.output.fields != Output::default().fields,
            ),
            ("output.slices", !self.output.slices.is_empty()),
        ];
        for (key, given) in of_fluid {
            if given {
                return refuse(
                    key,
                    "says something about the fluid, and there is none; remove it or add [fluid]",
                );
            }
        }
        for (index, solid) in self.solids.iter().enumerate() {
            if matches!(solid.shape, Shape::HalfSpace { .. }) && !self.domain.is_given() {
                return refuse(
                    format!("solids[{index}]"),
                    "a half-space needs a domain that says how far it reaches; add [domain] with \
                     size, or give a box",
                );
            }
        }
        for (index, history) in self.output.histories.iter().enumerate() {
            let wrong = |quantity: &&_| !Quantity::is_of_blocks(**quantity);
            if let Some(quantity) = history.quantities.iter().find(wrong) {
                return refuse(
                    format!("output.histories[{index}].quantities"),
                    format!(
                        "{} is of the fluid, and there is none; for blocks there are \
                         block_kinetic_energy, block_max_speed and others",
                        quantity.name()
                    ),
                );
            }
        }
        for (index, probe) in self.probes.iter().enumerate() {
            if !matches!(probe.place, ProbePlace::Block { .. }) {
                return refuse(
                    format!("probes[{index}]"),
                    "measures the fluid, and there is none; give kind = \"block\" and the name of \
                     a block",
                );
            }
        }
        Ok(())
    }
}
