//! Blocks whose friction a law of the wall gives: on faces along the grid.

use super::{Lattice, boundary::cell_pass, cell_kernels::CellDispatch, fluid::Dispatch};
use crate::{
    Error, Result,
    gpu::{buffers::zeroed, kernel::largest_binding, readback::Readback},
};
use bytemuck::{Pod, Zeroable};

/// A face of a block under which a cell is full, and what the law of the wall says of it, as
/// `kernels/lattice/block_friction.wgsl` writes it; lattice units.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct BlockFace {
    /// Index of that cell in the padded grid.
    pub cell: u32,
    /// The face of the cell: x−, x+, y−, y+, z−, z+.
    pub face: u32,
    /// Friction velocity.
    pub friction: f32,
    /// The part of the stress that is the law's: 0 for a face without slip, 1 for all of it.
    pub share: f32,
    /// Stress on the face over the density, along x, y, z.
    pub stress: [f32; 3],
    /// How far it lies beyond the cell: the part of the next cell that the block fills.
    pub fraction: f32,
}

/// The faces of blocks that a law of the wall is for.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BlockFaces {
    /// Those where it acts, in the order of the cells.
    pub faces: Vec<BlockFace>,
    /// All faces of full cells of blocks before which there is fluid.
    pub area: u64,
}

impl Lattice {
    /// The bricks that blocks reach, where these have a wall model, and how many cells they have.
    fn bricks_of_model(&self) -> Option<(&wgpu::Buffer, u32)> {
        let (list, slots) = self
            .psm_bricks()
            .filter(|_| self.setup.has_block_friction())?;
        let cells = self.grid.brick.iter().product::<u32>() * self.grid.lanes;
        Some((list, slots * cells))
    }

    /// A pass over these cells; `more` are buffers of its own.
    fn pass_of_model(
        &self,
        device: &wgpu::Device,
        entry: &'static str,
        odd: u32,
        (list, invocations): (&wgpu::Buffer, u32),
        more: &[(&str, &wgpu::Buffer)],
    ) -> Result<Dispatch> {
        let mut buffers = vec![("bricks", list)];
        buffers.extend(self.psm_planes());
        buffers.extend(more);
        let dispatch = CellDispatch {
            program: &self.cell_program("block_friction"),
            entry,
            pass: cell_pass(odd, 0, &(0..0)),
            buffers: &buffers,
            constants: &[],
            invocations,
        };
        self.cell_dispatch(device, &dispatch)
    }

    /// The dispatches of what depends on the place of blocks: their friction in the coming step of this parity, and the walls with
    /// blocks near them, which the next step reads.
    pub(super) fn block_passes(&self, device: &wgpu::Device, odd: u32) -> Result<Vec<Dispatch>> {
        let mut passes = self.mark_passes(device)?;
        if let Some(bricks) = self.bricks_of_model() {
            passes.push(self.pass_of_model(device, "block_friction", odd, bricks, &[])?);
        }
        Ok(passes)
    }

    /// Clears the eddy viscosity beside walls and blocks before a step, where blocks may move.
    pub(super) fn clear_near_wall(&self, device: &wgpu::Device) -> Result<Option<Dispatch>> {
        if !self.setup.has_block_friction() {
            return Ok(None);
        }
        let dispatch = CellDispatch {
            program: &self.cell_program("block_friction"),
            entry: "clear_near_wall",
            pass: cell_pass(0, 0, &(0..0)),
            buffers: &[],
            constants: &[],
            invocations: self.grid.scalar_count(),
        };
        Ok(Some(self.cell_dispatch(device, &dispatch)?))
    }

    /// The faces of blocks where the wall model acts in the coming step; none without it.
    ///
    /// # Errors
    /// [`Error::Limit`] if the device cannot hold them, or if it fails.
    pub async fn block_faces(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
    ) -> Result<BlockFaces> {
        let Some(bricks) = self.bricks_of_model() else {
            return Ok(BlockFaces::default());
        };
        let each = size_of::<BlockFace>() as u64;
        let has = largest_binding(&device.limits()) / each;
        let most = u64::from(bricks.1).min(has);
        let counts = zeroed(device, "counts of faces", 8);
        let list = zeroed(device, "faces of blocks", each * most);
        let more = [("face_counts", &counts), ("found_faces", &list)];
        let odd = self.parity() as u32;
        let dispatch = self.pass_of_model(device, "list_block_faces", odd, bricks, &more)?;
        let mut encoder = device.create_command_encoder(&Default::default());
        dispatch.record(&mut encoder.begin_compute_pass(&Default::default()));
        queue.submit([encoder.finish()]);
        let mut readback = Readback::default();
        let counts: Vec<u32> = readback.read(device, queue, &counts, 2).await?;
        let [area, found] = [counts[0], counts[1]].map(u64::from);
        if found > most {
            return Err(Error::Limit {
                name: "bytes of one storage binding (faces of blocks)".into(),
                wants: found * each,
                has: has * each,
                remedy: "use a larger cell, or another adapter".into(),
            });
        }
        let mut faces: Vec<BlockFace> = readback.read(device, queue, &list, found as usize).await?;
        faces.sort_unstable_by_key(|face| face.cell);
        Ok(BlockFaces { faces, area })
    }
}
