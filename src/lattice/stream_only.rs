//! Streaming without collision: what a step of a layout costs at the least.

use super::{Lattice, fluid::Dispatch, program};
use crate::{Error, Result, gpu::kernel::Shader};
use std::sync::Arc;

/// A lattice that streams and never collides, for measuring.
#[derive(Debug)]
pub struct StreamOnly {
    lattice: Lattice,
    passes: [Dispatch; 2],
}

impl StreamOnly {
    /// Takes a periodic lattice without solids, with the state that it has.
    ///
    /// # Errors
    /// [`Error::Argument`] if it has walls or solids, whose reflections belong to the collision.
    pub fn new(device: &wgpu::Device, lattice: Lattice) -> Result<Self> {
        if !lattice.setup.is_all_fluid() {
            let message = "streaming alone wants a periodic box without solids";
            return Err(Error::argument("faces", message));
        }
        let linked = program::stream_only(&lattice.setup, lattice.bindings).link()?;
        let shader = Shader::new(device, linked);
        let groups = lattice.grid.bricks().iter().product();
        let pass = |odd| {
            let setup = program::constants(&lattice.setup, &lattice.grid, odd);
            let mut constants = shader.linked().constants_of(&setup);
            constants.push(("BRICKS", f64::from(groups)));
            let kernel = shader.kernel(device, "stream_only", &constants)?;
            let bind = kernel.bind(device, &lattice.buffers.named(odd))?;
            Ok::<_, Error>(Dispatch::new(Arc::new(kernel), bind, groups))
        };
        let passes = [pass(false)?, pass(true)?];
        Ok(Self { lattice, passes })
    }

    /// Records one step into the caller's pass.
    pub fn record(&mut self, pass: &mut wgpu::ComputePass<'_>) {
        self.passes[self.lattice.parity()].record(pass);
        self.lattice.step += 1;
    }

    /// The lattice whose populations move.
    pub fn lattice(&self) -> &Lattice {
        &self.lattice
    }
}
