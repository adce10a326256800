//! The first state of a fluid.

use super::{
    CellPass, Lattice,
    buffers::{self, GUARD_START},
    cell_kernels::CellDispatch,
};
use crate::{Error, Result, gpu::kernel::submit_pass};

/// Density and velocity on the domain cells, lattice units, x fastest.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// Density minus one.
    pub excess: Vec<f32>,
    /// Components of the velocity.
    pub velocity: [Vec<f32>; 3],
}

impl State {
    /// Rest at ρ = 1.
    pub fn rest(cells: usize) -> Self {
        let zero = || vec![0.0; cells];
        Self {
            excess: zero(),
            velocity: [zero(), zero(), zero()],
        }
    }
}

impl Lattice {
    /// Starts from a state at step 0. With `non_equilibrium` the populations carry the viscous
    /// stress of the velocity field from the first step on (Latt & Chopard 2006).
    ///
    /// # Errors
    /// If the state has another number of cells or is not finite.
    pub fn start(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        state: &State,
        non_equilibrium: bool,
    ) -> Result<()> {
        let cells = self.grid.cell_count();
        let names = ["excess", "velocity.x", "velocity.y", "velocity.z"];
        let fields = std::iter::once(&state.excess).chain(&state.velocity);
        for (name, field) in names.into_iter().zip(fields) {
            if field.len() != cells {
                let message = format!("{} values for {cells} cells", field.len());
                return Err(Error::argument(name, message));
            }
            if let Some(at) = field.iter().position(|v| !v.is_finite()) {
                let message = format!("the value of cell {at} is not a finite number");
                return Err(Error::argument(name, message));
            }
        }
        self.step = 0;
        self.closed = true;
        self.revision += 1;
        if let Some(guard) = &self.buffers.guard {
            queue.write_buffer(guard, 0, bytemuck::cast_slice(&GUARD_START));
        }
        self.set_velocity_before(queue, &state.velocity);
        self.write_mean_velocities(queue);
        self.set_travelled(queue, &[]);
        let input =
            |field: &[f32]| buffers::storage(device, "initial state", bytemuck::cast_slice(field));
        let density = input(&state.excess);
        let [x, y, z] = state.velocity.each_ref().map(|field| input(field));
        let buffers = [
            ("density", &density),
            ("velocity_x", &x),
            ("velocity_y", &y),
            ("velocity_z", &z),
        ];
        let program = self.cell_program("initialise");
        let amount = f64::from(u8::from(non_equilibrium));
        for half in self.halves() {
            let dispatch = CellDispatch {
                program: &program,
                entry: "initialise",
                pass: CellPass {
                    half,
                    ..CellPass::default()
                },
                buffers: &buffers,
                constants: &[("NON_EQUILIBRIUM", amount)],
                invocations: cells as u32,
            };
            let dispatch = self.cell_dispatch(device, &dispatch)?;
            submit_pass(device, queue, |pass| dispatch.record(pass));
        }
        self.set_near_wall(device, queue, false)?;
        self.store_outflow_faces(device, queue)
    }

    /// Has outflow faces carry the present state to the next step.
    fn store_outflow_faces(&self, device: &wgpu::Device, queue: &wgpu::Queue) -> Result<()> {
        let outflow_state = &self.buffers.open.outflow_state;
        queue.write_buffer(outflow_state, 0, &vec![0; outflow_state.size() as usize]);
        let Some(store) = self.store_outflow_pass(device, self.parity() as u32)? else {
            return Ok(());
        };
        submit_pass(device, queue, |pass| store.record(pass));
        Ok(())
    }

    /// Sets the velocity that the eddy viscosity of the coming step looks at: zero in static solids, as the step itself stores
    /// it, which leaves out bricks of nothing else.
    pub(super) fn set_velocity_before(&self, queue: &wgpu::Queue, velocity: &[Vec<f32>; 3]) {
        let Some(before) = self.buffers.velocity_before(self.parity() == 1) else {
            return;
        };
        let solid = |n: usize| self.setup.solid.get(n) == Some(&true);
        let of = |n: usize| [0, 1, 2].map(|a: usize| if solid(n) { 0.0 } else { velocity[a][n] });
        let values = buffers::vectors(&self.grid, self.bindings.vectors, of);
        for (buffer, values) in before.iter().zip(values) {
            queue.write_buffer(buffer, 0, bytemuck::cast_slice(&values));
        }
    }
}
