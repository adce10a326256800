//! Density, velocity and derived quantities: fields, sums, the guard.

use super::{
    CellPass, Lattice, State, cell_kernels::CellDispatch, fluid::Dispatch, gather::Gather,
    inside::Kept,
};
use crate::{
    Error, Result,
    gpu::{
        buffers::zeroed,
        kernel::{Kernel, submit_pass},
        readback::Readback,
    },
};
use std::sync::Arc;

/// A quantity that follows from the velocity gradient.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Derived {
    /// Q-criterion (Hunt, Wray & Moin 1988).
    QCriterion,
    /// Eddy viscosity of WALE; the setup must use it.
    EddyViscosity,
    /// A component of the vorticity, 0 to 2.
    Vorticity(u32),
}

impl Derived {
    /// Whether `lattice` has this quantity.
    fn check(self, lattice: &Lattice) -> Result<()> {
        match self {
            Self::EddyViscosity if lattice.setup.wale.is_none() => {
                let message = "this lattice is laminar and has no eddy viscosity; set `wale`, or do not request it";
                Err(Error::argument("derived", message))
            }
            Self::Vorticity(axis) if axis > 2 => {
                let message =
                    format!("there is no component {axis} of the vorticity; give 0, 1 or 2");
                Err(Error::argument("derived", message))
            }
            _ => Ok(()),
        }
    }
}

/// Sums over the fluid cells, lattice units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sums {
    /// Σ (ρ − 1).
    pub excess: f64,
    /// Σ ρu.
    pub momentum: [f64; 3],
    /// Σ ρu²/2.
    pub kinetic_energy: f64,
    /// Σ (curl u)²/2.
    pub enstrophy: f64,
    /// Largest |u|; NaN if any is NaN.
    pub max_speed: f64,
    /// Volume of the fluid cells outside of static solids, cells.
    pub cells: f64,
}

/// The first cell in which the guard found a flow outside the range of the method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Step, from 0.
    pub step: u64,
    /// Domain cell.
    pub cell: [u32; 3],
}

/// Reads a [`Lattice`]: buffers and kernels that only output needs.
#[derive(Debug)]
pub struct Observer {
    /// A buffer of the lattice, which identifies it.
    of: wgpu::Buffer,
    /// Revision of the lattice whose state the fields hold, and whether with the action of solids.
    pub(super) holds: Option<(u64, bool)>,
    density: wgpu::Buffer,
    velocity: [wgpu::Buffer; 3],
    /// Created when first requested.
    derived: Option<wgpu::Buffer>,
    derive: Vec<(Derived, Dispatch)>,
    sums: Option<(wgpu::Buffer, Dispatch)>,
    macroscopic: [Dispatch; 2],
    /// With blocks in the fluid.
    velocity_psm: Option<(wgpu::Device, Arc<Kernel>)>,
    /// Velocities in cells with solid after a restart.
    pub(super) kept: Option<Kept>,
    gather: Gather,
    readback: Readback,
}

pub(super) const VELOCITY_OUT: [&str; 3] = ["velocity_x_out", "velocity_y_out", "velocity_z_out"];
const VELOCITY_IN: [&str; 3] = ["velocity_x", "velocity_y", "velocity_z"];

impl Observer {
    /// Creates the buffers for density and velocity of `lattice`.
    ///
    /// # Errors
    /// If the device does not hold them.
    pub fn new(device: &wgpu::Device, lattice: &Lattice) -> Result<Self> {
        let cells = lattice.grid.cell_count();
        let field = |label| zeroed(device, label, 4 * cells as u64);
        let density = field("density");
        let velocity = ["velocity x", "velocity y", "velocity z"].map(field);
        let mut buffers = vec![("density_out", &density)];
        buffers.extend(VELOCITY_OUT.into_iter().zip(&velocity));
        let program = lattice.cell_program("macroscopic");
        let make = |odd| {
            let dispatch = CellDispatch {
                program: &program,
                entry: "macroscopic",
                pass: CellPass {
                    odd,
                    ..CellPass::default()
                },
                buffers: &buffers,
                constants: &[],
                invocations: cells as u32,
            };
            lattice.cell_dispatch(device, &dispatch)
        };
        let macroscopic = [make(0)?, make(1)?];
        let velocity_psm = match lattice.setup.solid_operator {
            Some(_) => {
                let program = lattice.cell_program("velocity_psm");
                let kernel = lattice.cell_kernel(device, &program, "velocity_psm", &[])?;
                Some((device.clone(), kernel))
            }
            None => None,
        };
        Ok(Self {
            of: lattice.buffers.populations[0].clone(),
            holds: None,
            density,
            velocity,
            derived: None,
            derive: Vec::new(),
            sums: None,
            macroscopic,
            velocity_psm,
            kept: None,
            gather: Gather::new(device, lattice)?,
            readback: Readback::default(),
        })
    }

    /// Records the density and velocity of the present state into [`Observer::density`] and
    /// [`Observer::velocity`]; in cells with solid the velocity is that in the middle of a step, so that in a steady flow the flux through
    /// every plane is the same.
    ///
    /// # Errors
    /// If this observes another lattice, or the device cannot bind the planes of blocks.
    pub fn record(
        &mut self,
        lattice: &mut Lattice,
        pass: &mut wgpu::ComputePass<'_>,
    ) -> Result<()> {
        self.record_cells(lattice, pass)?;
        if self
            .kept
            .as_ref()
            .is_some_and(|kept| kept.record(lattice.step(), pass))
        {
            return Ok(());
        }
        let (Some((device, kernel)), Some((list, slots))) =
            (&self.velocity_psm, lattice.psm_bricks())
        else {
            return Ok(());
        };
        // Both buffers may have changed since the last call.
        let mut buffers = vec![("bricks", list), ("density", &self.density)];
        buffers.extend(lattice.psm_planes());
        buffers.extend(VELOCITY_OUT.into_iter().zip(&self.velocity));
        buffers.extend(lattice.buffers.named(false));
        let bind = kernel.bind(device, &buffers)?;
        let grid = &lattice.grid;
        let cells = slots * grid.brick.iter().product::<u32>() * grid.lanes;
        kernel.record(pass, &bind, cells.div_ceil(64));
        Ok(())
    }

    /// Reads the velocity by the populations alone.
    pub(super) async fn velocity_of_populations(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        lattice: &mut Lattice,
    ) -> Result<[Vec<f32>; 3]> {
        submit_pass(device, queue, |pass| self.hold(lattice, pass, false))?;
        let count = lattice.grid.cell_count();
        let mut velocity = [const { Vec::new() }; 3];
        for (own, buffer) in velocity.iter_mut().zip(&self.velocity) {
            *own = self.readback.read(device, queue, buffer, count).await?;
        }
        Ok(velocity)
    }

    /// The same without the action of solids on the momentum of a cell in the middle of a step.
    fn record_cells(
        &mut self,
        lattice: &mut Lattice,
        pass: &mut wgpu::ComputePass<'_>,
    ) -> Result<()> {
        self.check(lattice)?;
        lattice.close(pass);
        self.macroscopic[lattice.parity()].record(pass);
        self.holds = None;
        Ok(())
    }

    /// Records the present state, with the action of solids or without it, unless the fields hold it. The caller submits the pass.
    fn hold(
        &mut self,
        lattice: &mut Lattice,
        pass: &mut wgpu::ComputePass<'_>,
        with_solids: bool,
    ) -> Result<()> {
        let with_solids = with_solids && self.velocity_psm.is_some();
        let present = Some((lattice.revision, with_solids));
        if self.holds == present {
            return self.check(lattice);
        }
        match with_solids {
            true => self.record(lattice, pass)?,
            false => self.record_cells(lattice, pass)?,
        }
        self.holds = present;
        Ok(())
    }

    /// Whether this was created for `lattice`.
    fn check(&self, lattice: &Lattice) -> Result<()> {
        if lattice.buffers.populations.first() == Some(&self.of) {
            return Ok(());
        }
        let message = "it was made for another lattice; make one for each";
        Err(Error::argument("observer", message))
    }

    /// Density minus one on the domain cells, f32, x fastest.
    pub fn density(&self) -> &wgpu::Buffer {
        &self.density
    }

    /// Components of the velocity on the domain cells, f32, x fastest.
    pub fn velocity(&self) -> &[wgpu::Buffer; 3] {
        &self.velocity
    }

    /// Has the fields hold the present state, then runs a kernel of derived quantities, by its place.
    fn submit(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        lattice: &mut Lattice,
        then: Option<usize>,
    ) -> Result<()> {
        submit_pass(device, queue, |pass| {
            self.hold(lattice, pass, true)?;
            if let Some(derived) = then {
                self.derive[derived].1.record(pass);
            }
            Ok(())
        })
    }

    /// Reads density and velocity of all cells.
    ///
    /// # Errors
    /// If the device is lost.
    pub async fn state(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        lattice: &mut Lattice,
    ) -> Result<State> {
        self.state_on(device, queue, lattice, None).await
    }

    /// Reads density and velocity of the given cells (indices, x fastest), or of all.
    ///
    /// # Errors
    /// If the device is lost.
    pub async fn state_on(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        lattice: &mut Lattice,
        cells: Option<&[u32]>,
    ) -> Result<State> {
        self.submit(device, queue, lattice, None)?;
        let count = lattice.grid.cell_count();
        let mut fields = [const { Vec::new() }; 4];
        let buffers = std::iter::once(&self.density).chain(&self.velocity);
        for (field, buffer) in fields.iter_mut().zip(buffers) {
            let readback = &mut self.readback;
            *field = match cells {
                None => readback.read(device, queue, buffer, count).await?,
                Some(cells) => {
                    let gather = &self.gather;
                    gather.read(device, queue, readback, buffer, cells).await?
                }
            };
        }
        let [excess, x, y, z] = fields;
        Ok(State {
            excess,
            velocity: [x, y, z],
        })
    }

    /// Reads a field derived from the velocity gradient, lattice units.
    ///
    /// # Errors
    /// If the lattice has no such field, or the device is lost or cannot hold it.
    pub async fn derived(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        lattice: &mut Lattice,
        quantity: Derived,
    ) -> Result<Vec<f32>> {
        self.derived_on(device, queue, lattice, quantity, None)
            .await
    }

    /// Reads such a field on the given cells (indices, x fastest), or on all, lattice units.
    ///
    /// # Errors
    /// If the lattice has no such field, or the device is lost or cannot hold it.
    pub async fn derived_on(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        lattice: &mut Lattice,
        quantity: Derived,
        on: Option<&[u32]>,
    ) -> Result<Vec<f32>> {
        self.check(lattice)?;
        quantity.check(lattice)?;
        let cells = lattice.grid.cell_count();
        let buffer = match &self.derived {
            Some(kept) => kept.clone(),
            None => zeroed(device, "derived", 4 * cells as u64),
        };
        let at = match self.derive.iter().position(|(made, _)| *made == quantity) {
            Some(at) => at,
            None => {
                let dispatch = self.derive_dispatch(device, lattice, quantity, &buffer)?;
                self.derive.push((quantity, dispatch));
                self.derive.len() - 1
            }
        };
        self.submit(device, queue, lattice, Some(at))?;
        let readback = &mut self.readback;
        let values = match on {
            None => readback.read(device, queue, &buffer, cells).await,
            Some(on) => {
                let gather = &self.gather;
                gather.read(device, queue, readback, &buffer, on).await
            }
        };
        self.derived = Some(buffer);
        values
    }

    fn derive_dispatch(
        &self,
        device: &wgpu::Device,
        lattice: &Lattice,
        quantity: Derived,
        buffer: &wgpu::Buffer,
    ) -> Result<Dispatch> {
        let (file, axis) = match quantity {
            Derived::QCriterion => ("quantity_q_criterion", None),
            Derived::EddyViscosity => ("quantity_eddy_viscosity", None),
            Derived::Vorticity(axis) => ("quantity_vorticity", Some(axis)),
        };
        let mut buffers = vec![("derived", buffer)];
        buffers.extend(VELOCITY_IN.into_iter().zip(&self.velocity));
        let program = lattice.cell_program("derive").slot("quantity", file);
        let axis = axis.map(|axis| ("AXIS", f64::from(axis)));
        let dispatch = CellDispatch {
            program: &program,
            entry: "derive",
            pass: CellPass::default(),
            buffers: &buffers,
            constants: axis.as_slice(),
            invocations: lattice.grid.cell_count() as u32,
        };
        lattice.cell_dispatch(device, &dispatch)
    }

    /// Reads the sums over the contents of the fluid cells. In cells with solid the momentum includes half of the body force,
    /// which does not correspond to a flow.
    ///
    /// # Errors
    /// If the device is lost.
    pub async fn sums(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        lattice: &mut Lattice,
    ) -> Result<Sums> {
        self.check(lattice)?;
        let turns = lattice.grid.cell_count().div_ceil(64);
        let (buffer, dispatch) = match self.sums.take() {
            Some(made) => made,
            None => {
                let buffer = zeroed(device, "partial sums", 32 * turns as u64);
                let mut buffers = vec![("partial_sums", &buffer), ("density", &self.density)];
                buffers.extend(VELOCITY_IN.into_iter().zip(&self.velocity));
                let program = lattice.cell_program("sums");
                let dispatch = CellDispatch {
                    program: &program,
                    entry: "sum_cells",
                    pass: CellPass::default(),
                    buffers: &buffers,
                    constants: &[],
                    invocations: turns as u32,
                };
                let dispatch = lattice.cell_dispatch(device, &dispatch)?;
                (buffer, dispatch)
            }
        };
        submit_pass(device, queue, |pass| -> Result<()> {
            // The ledger of blocks and fluid uses the contents of the cells.
            self.hold(lattice, pass, false)?;
            dispatch.record(pass);
            Ok(())
        })?;
        let partial: Vec<[f32; 8]> = self.readback.read(device, queue, &buffer, turns).await?;
        self.sums = Some((buffer, dispatch));
        let solid = lattice.setup.surface.iter();
        let mut sums = Sums {
            cells: -solid.map(|of| f64::from(of.fraction)).sum::<f64>(),
            ..Sums::default()
        };
        for part in partial {
            let part = part.map(f64::from);
            sums.excess += part[0];
            for a in 0..3 {
                sums.momentum[a] += part[1 + a];
            }
            sums.kinetic_energy += part[4];
            sums.enstrophy += part[5];
            // A maximum ignores NaN; the kinetic energy does not.
            let lost = part[4].is_nan() || sums.max_speed.is_nan();
            sums.max_speed = match lost {
                true => f64::NAN,
                false => sums.max_speed.max(part[6].sqrt()),
            };
            sums.cells += part[7];
        }
        Ok(sums)
    }

    /// Reads the fault that the guard has found so far, if any.
    ///
    /// # Errors
    /// If the device is lost.
    pub async fn fault(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        lattice: &Lattice,
    ) -> Result<Option<Fault>> {
        let Some(guard) = &lattice.buffers.guard else {
            return Ok(None);
        };
        let found: Vec<u32> = self.readback.read(device, queue, guard, 4).await?;
        // Both counts are numbers of steps: the later one is larger, or both stopped at the same number.
        const STOPPED: u32 = 1 << 31;
        let done = (found[0] & !STOPPED).max(found[1] & !STOPPED);
        let Some(step) = done.checked_sub(1) else {
            return Ok(None);
        };
        let cell = found[2 + (step % 2) as usize];
        if cell == u32::MAX {
            return Ok(None);
        }
        Ok(Some(Fault {
            step: step.into(),
            cell: lattice.grid.padded_cell(cell),
        }))
    }
}
