//! Causes and remedies of a run that left the range of the method.

use super::lattice_fluid::LatticeFluid;
use crate::{
    Error,
    coupling::{Coupled, Rock},
    lattice::{self, Fault},
    scene::Face,
};

impl LatticeFluid {
    /// The error of a fault, with its likely cause in numbers.
    pub fn diverged(&self, rock: Option<&Rock>, fault: Fault) -> Error {
        let setup = self.lattice.setup();
        let coupled = self.coupled(rock);
        if let Some([cause, remedy]) = coupled.and_then(|coupled| self.block_at_inlet(coupled)) {
            return self.fault(fault, cause, remedy);
        }
        if let Some((cause, remedy)) = coupled.and_then(|coupled| self.fast_block(coupled)) {
            return self.fault(fault, cause, remedy);
        }
        let excess = setup.tau() - 0.5;
        let Ok(scale) = self.scene.velocity_scale() else {
            return self.fault(
                fault,
                "the forces drive the flow too fast".into(),
                "give numerics.velocity_scale".into(),
            );
        };
        let speed = self.units.velocity_to_lattice(scale);
        let mach = self.units.mach(scale);
        // Cell Reynolds number: above about 30 the grid no longer damps the scales that it cannot resolve.
        let reynolds = speed / setup.nu;
        let (cause, remedy) = if setup.wale.is_none() && reynolds > 30.0 {
            (
                format!("the Reynolds number of a cell is {reynolds:.0} without an eddy viscosity"),
                format!(
                    "set numerics.eddy_viscosity = \"wale\", or use cells of {:.2e} m",
                    self.units.cell * 30.0 / reynolds
                ),
            )
        } else if mach > 0.12 {
            (
                format!("the Mach number of the velocity scale is {mach:.2}"),
                format!(
                    "use a time step of {:.2e} s (Mach 0.1) or less",
                    self.units.time_step * 0.1 / mach
                ),
            )
        } else {
            (
                format!(
                    "a speed above {} cells per step, at τ − ½ = {excess:.2e} and Mach {mach:.2}",
                    setup.max_speed
                ),
                format!(
                    "check that numerics.velocity_scale ({scale} m/s) is the largest speed, halve the time \
                     step ({:.2e} s), or start the flow more gently",
                    self.units.time_step
                ),
            )
        };
        self.fault(fault, cause, remedy)
    }

    /// Cause and remedy, if a block lies at a velocity face.
    fn block_at_inlet(&self, coupled: Coupled<'_>) -> Option<[String; 2]> {
        let faces = &self.lattice.setup().faces;
        let through = |face: Face| {
            let axis = face.axis().index();
            match &faces[axis][usize::from(face.is_max())] {
                lattice::Face::Velocity(list) => {
                    let along = list.iter().map(|u| u[axis].into()).collect();
                    Some((face, along))
                }
                _ => None,
            }
        };
        let through: Vec<_> = Face::ALL.into_iter().filter_map(through).collect();
        let Some(found) = coupled.at_inlets(&through).first().copied() else {
            // The flow may since have pushed a block away that lay there at the start.
            return coupled.initial_inlet_message();
        };
        let speed = self.units.velocity_from_lattice(found.speed);
        Some(coupled.inlet_message(&found, speed))
    }

    /// Cause and remedy, if the fastest block is too fast for the lattice.
    fn fast_block(&self, coupled: Coupled<'_>) -> Option<(String, String)> {
        let made = coupled.setup().setup.blocks[..coupled.in_fluid()].iter();
        let moving = coupled.blocks().poses().into_iter();
        let speeds = made.zip(moving).map(|(block, pose)| {
            let spin = crate::psm::spin(&pose).length();
            (
                &block.name,
                pose.velocity.length() + spin * block.shape.radius(),
            )
        });
        let (name, speed) = speeds.max_by(|a, b| a.1.total_cmp(&b.1))?;
        let cells = self.units.velocity_to_lattice(speed);
        (cells > self.lattice.setup().max_speed).then(|| {
            (
                format!("the block {name} moves at {speed:.3e} m/s, {cells:.2} cells per step"),
                format!(
                    "use a time step of {:.2e} s (Mach 0.1 at that speed) or less, or slow the block down",
                    self.units.time_step * 0.1 / self.units.mach(speed)
                ),
            )
        })
    }

    fn fault(&self, fault: Fault, cause: String, remedy: String) -> Error {
        Error::Diverged {
            step: fault.step,
            time: fault.step as f64 * self.units.time_step,
            cell: fault.cell,
            position: self.scene.centre(fault.cell),
            cause,
            remedy,
        }
    }
}
