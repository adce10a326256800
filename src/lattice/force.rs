//! The body force of all cells, which may change between two steps.

use super::{Force, Lattice, check::finite};
use crate::{Error, Result};

/// The buffer that the kernels read.
pub(super) fn force_words([x, y, z]: [f64; 3]) -> [f32; 4] {
    [x as f32, y as f32, z as f32, 0.0]
}

impl Lattice {
    /// Sets the body force per volume of all cells, in lattice units; it holds from the next submission on.
    ///
    /// # Errors
    /// If the setup has no [`Force::Constant`], or the force is not finite.
    pub fn set_force(&mut self, queue: &wgpu::Queue, force: [f64; 3]) -> Result<()> {
        let (Force::Constant(old), Some(buffer)) =
            (&mut self.setup.force, &self.buffers.uniform_force)
        else {
            let message = "only a force that is the same in all cells can be changed";
            return Err(Error::argument("force", message));
        };
        let words = force_words(force);
        finite("force", &words)?;
        *old = force;
        self.revision += 1;
        queue.write_buffer(buffer, 0, bytemuck::cast_slice(&words));
        Ok(())
    }
}
