//! What a scene must satisfy before anything is computed from it.

mod blocks;
mod boundaries;
mod coupling;
mod deformable;
mod domain;
mod dry;
mod materials;
mod numerics;
mod output;
mod particles;
mod probes;
mod rock;
mod rock_masses;
mod rules;
mod solids;
mod views;

use super::{InitialPressure, Scene};
use crate::error::Result;
use rules::{finite_constants, no_time, not_negative, positive, refuse};

impl Scene {
    /// Whether the scene agrees with itself.
    ///
    /// # Errors
    /// Names the first key that does not, why, and what would be right.
    pub fn check(&self) -> Result<()> {
        if let (Some(_), false) = (&self.particles, self.has_fluid()) {
            return refuse(
                "particles",
                "need to know of what they are; add [fluid] with its density and acceleration",
            );
        }
        if !self.has_fluid() && !self.has_blocks() {
            return refuse(
                "fluid",
                "the scene has neither a fluid nor blocks; add [fluid], [[blocks]] or \
                 [[rock_masses]]",
            );
        }
        if !self.has_particles() {
            self.check_no_particles()?;
        }
        self.check_domain()?;
        if let Some(particles) = &self.particles {
            self.check_particles(particles)?;
        }
        if self.has_fluid() {
            self.check_fluid()?;
            self.check_numerics()?;
        } else {
            self.check_dry()?;
        }
        self.check_coupling()?;
        self.check_solids()?;
        self.check_initial()?;
        self.check_run()?;
        self.check_output()?;
        self.check_probes()?;
        self.check_rock()?;
        self.check_materials()?;
        self.check_blocks()?;
        self.check_rock_masses()?;
        self.check_views()?;
        // Last, since the balance of flows needs the solids.
        if self.has_particles() {
            self.check_particle_boundaries()?;
            return self.check_boundaries();
        }
        self.check_boundaries()?;
        self.check_balance()
    }

    fn check_fluid(&self) -> Result<()> {
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
        no_time("fluid.acceleration", &self.fluid.acceleration)?;
        finite_constants("fluid.acceleration", &self.fluid.acceleration)
    }

    fn check_initial(&self) -> Result<()> {
        no_time("initial.velocity", &self.initial.velocity)?;
        finite_constants("initial.velocity", &self.initial.velocity)?;
        match &self.initial.pressure {
            InitialPressure::Hydrostatic => Ok(()),
            InitialPressure::Given(formula) => {
                no_time("initial.pressure", std::slice::from_ref(formula))?;
                finite_constants("initial.pressure", std::slice::from_ref(formula))
            }
        }
    }

    fn check_run(&self) -> Result<()> {
        match (self.run.duration, self.run.steps) {
            (Some(_), Some(_)) => refuse(
                "run.steps",
                "the run has both `duration` and `steps`; keep one of them",
            ),
            (None, None) => refuse(
                "run",
                "the run has no end; give `duration` (s) or `steps` (a whole number)",
            ),
            (Some(duration), None) => positive("run.duration", duration, "s"),
            (None, Some(0)) => refuse("run.steps", "the run has no steps; give at least 1"),
            (None, Some(_)) => Ok(()),
        }?;
        rules::interval("run.checkpoint_every", self.run.checkpoint_every)
    }
}
