//! The fluid.

use schemars::JsonSchema;
use serde::Deserialize;

use super::rules::{finite_constants, no_time, not_negative, positive, refuse};
use super::{
    Boundaries, Boundary, Coupling, Face, Initial, Numerics, Output, ProbePlace, Quantity, Scene,
    Shape,
};
use crate::error::Result;
use crate::formula::Formula;

/// The fluid and the body force on it. The default is none: density and viscosity 0.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Fluid {
    /// Density, kg/m³. Default 1000.
    #[serde(default = "water")]
    pub density: f64,
    /// Kinematic viscosity, m²/s. Optional for particles, which otherwise slide along walls and blocks; default 0.
    #[serde(default)]
    pub viscosity: f64,
    /// Body force per mass, m/s²: three numbers or formulas of x, y, z; for particles three
    /// numbers: their gravity. Default none.
    #[serde(default)]
    pub acceleration: [Formula; 3],
    /// Mean velocity along a periodic axis, m/s, three numbers of which one is not 0. A controlled body force along that axis, in
    /// addition to `acceleration`, maintains it. The force per mass is the history `driving_acceleration`.
    pub bulk_velocity: Option<[f64; 3]>,
}

impl Fluid {
    /// Axis and value, m/s, of the prescribed bulk velocity.
    pub fn kept_velocity(&self) -> Option<(usize, f64)> {
        let velocity = self.bulk_velocity?;
        let axis = velocity.iter().position(|u| *u != 0.0)?;
        Some((axis, velocity[axis]))
    }
}

fn water() -> f64 {
    1000.0
}

impl Scene {
    pub(super) fn check_fluid(&self) -> Result<()> {
        positive("fluid.density", self.fluid.density, "kg/m³")?;
        let viscosity = self.fluid.viscosity;
        match (self.has_particles(), viscosity) {
            (true, _) => not_negative("fluid.viscosity", viscosity, "m²/s")?,
            (false, 0.0) => {
                return refuse(
                    "fluid.viscosity",
                    "is 0 m²/s, or `viscosity` is missing; a lattice needs a number greater than 0",
                );
            }
            (false, _) => positive("fluid.viscosity", viscosity, "m²/s")?,
        }
        self.check_bulk_velocity()?;
        no_time("fluid.acceleration", &self.fluid.acceleration)?;
        finite_constants("fluid.acceleration", &self.fluid.acceleration)
    }

    fn check_bulk_velocity(&self) -> Result<()> {
        const KEY: &str = "fluid.bulk_velocity";
        let Some(velocity) = self.fluid.bulk_velocity else {
            let of_control = |quantity: &Quantity| {
                matches!(
                    quantity,
                    Quantity::BulkVelocity | Quantity::DrivingAcceleration
                )
            };
            return self.refuse_quantities(of_control, |name| {
                format!(
                    "{name} is of a flow with `fluid.bulk_velocity`, which this scene lacks: give it, or \
                     leave {name} out"
                )
            });
        };
        if self.has_particles() {
            return refuse(
                KEY,
                "is for a fluid on a lattice; particles have `acceleration`",
            );
        }
        let along = velocity.iter().filter(|u| **u != 0.0).count();
        let usable = along == 1 && velocity.iter().all(|u| u.is_finite());
        let Some((axis, _)) = self.fluid.kept_velocity().filter(|_| usable) else {
            return refuse(
                KEY,
                format!(
                    "is {velocity:?} m/s; give finite numbers of which one is not 0: the flow is along that axis"
                ),
            );
        };
        if *self.boundaries.face(Face::ALL[2 * axis]) != Boundary::Periodic {
            let name = ["x", "y", "z"][axis];
            return refuse(
                KEY,
                format!(
                    "drives a flow along {name}, which has boundaries: remove {name}_min and {name}_max, or give the \
                         velocity at an inlet"
                ),
            );
        }
        if !self.fluid.acceleration.iter().all(Formula::is_constant) {
            return refuse(
                KEY,
                "adds to an acceleration that is the same everywhere; give `fluid.acceleration` numbers",
            );
        }
        Ok(())
    }

    /// Refuses keys that a scene without fluid must not have.
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
                    "applies to the fluid, and there is none; remove it or add [fluid]",
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
        let of_fluid = |quantity: &Quantity| !quantity.is_of_blocks();
        self.refuse_quantities(of_fluid, |name| {
            format!(
                "{name} is of the fluid, and there is none; for blocks there are block_kinetic_energy, block_max_speed and others"
            )
        })?;
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
