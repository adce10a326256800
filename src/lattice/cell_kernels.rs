//! The kernels for single cells: at walls and faces, at the start, for output.

use super::{Lattice, Storage, fluid::Dispatch, program};
use crate::{
    Result,
    gpu::{
        buffers::filled,
        kernel::{Kernel, Shader},
        link::Program,
    },
};
use bytemuck::{Pod, Zeroable};
use std::{
    collections::HashMap,
    sync::{Arc, Mutex, PoisonError},
};

/// What the dispatches of one kernel differ in, as it lies in `kernels/lattice/scalar_grid.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct CellPass {
    /// Parity of the step that loads, 0 or 1.
    pub odd: u32,
    /// Half of the words that is written where two cells share a word, 0 or 1.
    pub half: u32,
    /// First cell of the kernel's list that is completed.
    pub first: u32,
    /// End of the range of cells.
    pub end: u32,
}

/// An open face of the domain, as it lies in `kernels/lattice/face_cells.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct OpenFace {
    /// Outward unit normal.
    pub normal: [f32; 3],
    /// Density on the face in the first cell of the domain, lattice units.
    pub density: f32,
    /// Share of the difference of density that an outflow face removes each step.
    pub hold: f32,
    /// Share of the sum of that difference over time.
    pub integral: f32,
    /// Not used.
    pub pad: [u32; 2],
    /// Increase of the density on the face from cell to cell.
    pub gradient: [f32; 3],
    /// Not used.
    pub end: u32,
}

/// A kernel for single cells with what one dispatch of it takes.
pub(super) struct CellDispatch<'a> {
    pub program: &'a Program,
    pub entry: &'static str,
    pub pass: CellPass,
    /// Buffers other than those of the fluid.
    pub buffers: &'a [(&'a str, &'a wgpu::Buffer)],
    /// Constants other than those of the setup.
    pub constants: &'a [(&'static str, f64)],
    pub invocations: u32,
}

/// Program, entry point, and the constants that the setup does not give, as bits.
type Key = (Program, &'static str, Vec<(&'static str, u64)>);

/// The shaders and kernels of a lattice, each made when it is first used.
#[derive(Debug, Default)]
pub(super) struct CellKernels(Mutex<Made>);

#[derive(Debug, Default)]
struct Made {
    shaders: HashMap<Program, Arc<Shader>>,
    kernels: HashMap<Key, Arc<Kernel>>,
}

impl Lattice {
    /// A program for single cells, with the slots that the setup decides.
    pub(super) fn cell_program(&self, entry: &str) -> Program {
        program::single_cells(&self.setup, self.bindings, entry)
    }

    /// A kernel for single cells; `extra` adds constants to those of the setup.
    pub(super) fn cell_kernel(
        &self,
        device: &wgpu::Device,
        program: &Program,
        entry: &'static str,
        extra: &[(&'static str, f64)],
    ) -> Result<Arc<Kernel>> {
        let mut made = self.cells.0.lock().unwrap_or_else(PoisonError::into_inner);
        let bits = extra.iter().map(|(name, value)| (*name, value.to_bits()));
        let key = (program.clone(), entry, bits.collect());
        if let Some(kernel) = made.kernels.get(&key) {
            return Ok(kernel.clone());
        }
        let shader = match made.shaders.get(program) {
            Some(shader) => shader.clone(),
            None => {
                let shader = Arc::new(Shader::new(device, program.link()?));
                made.shaders.insert(program.clone(), shader.clone());
                shader
            }
        };
        // Of neither parity: that is in `CellPass`.
        let setup = program::constants(&self.setup, &self.grid, false);
        let mut constants = shader.linked().constants_of(&setup);
        constants.extend(extra);
        let kernel = Arc::new(shader.kernel(device, entry, &constants)?);
        made.kernels.insert(key, kernel.clone());
        Ok(kernel)
    }

    /// The kernels for single cells that have been used, by the names of their files and entry points.
    pub fn single_cell_kernels(&self) -> Vec<Arc<Kernel>> {
        let made = self.cells.0.lock().unwrap_or_else(PoisonError::into_inner);
        let mut kernels: Vec<_> = made.kernels.values().cloned().collect();
        kernels.sort_by(|a, b| (a.file(), a.entry()).cmp(&(b.file(), b.entry())));
        kernels
    }

    /// A dispatch of a kernel for single cells.
    pub(super) fn cell_dispatch(
        &self,
        device: &wgpu::Device,
        dispatch: &CellDispatch<'_>,
    ) -> Result<Dispatch> {
        let CellDispatch {
            program,
            entry,
            pass,
            constants,
            invocations,
            ..
        } = *dispatch;
        let kernel = self.cell_kernel(device, program, entry, constants)?;
        let pass_buffer = uniform(device, "cell pass", &pass);
        let mut buffers = dispatch.buffers.to_vec();
        buffers.push(("cell_pass", &pass_buffer));
        buffers.extend(self.buffers.named(pass.odd == 1));
        let bind = kernel.bind(device, &buffers)?;
        Ok(Dispatch::new(kernel, bind, invocations.div_ceil(64)))
    }

    /// For each half of the words that 16-bit storage shares between cells, or once.
    pub(super) fn halves(&self) -> std::ops::Range<u32> {
        match self.setup.storage {
            Storage::F32 => 0..1,
            Storage::F16 => 0..2,
        }
    }
}

/// A uniform buffer with this content.
pub(super) fn uniform(device: &wgpu::Device, label: &str, content: &impl Pod) -> wgpu::Buffer {
    let usage = wgpu::BufferUsages::UNIFORM;
    filled(device, label, bytemuck::bytes_of(content), usage)
}
