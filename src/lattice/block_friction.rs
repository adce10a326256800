//! Wall model on faces of blocks.

use super::{
    Lattice, boundary::cell_pass, cell_kernels::CellDispatch, fluid::Dispatch,
    surface_faces::SlopingCell,
};
use crate::{
    Error, Result,
    gpu::{
        buffers::zeroed,
        kernel::{largest_binding, submit_pass},
        readback::Readback,
    },
};
use bytemuck::{Pod, Zeroable};

/// A face of a block, or of an exact surface at rest, above a full cell, or the part of a sloping face in a column of cells, with the
/// result of the law of the wall, in the layout of `kernels/lattice/block_friction.wgsl`; lattice units.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct BlockFace {
    /// Index of that cell in the padded grid.
    pub cell: u32,
    /// The face of the cell, the nearest to a sloping one: x−, x+, y−, y+, z−, z+.
    pub face: u32,
    /// Friction velocity.
    pub friction: f32,
    /// Fraction of the stress that comes from the law: 0 for a no-slip face, 1 for the law alone.
    pub share: f32,
    /// Stress on the face over the density, along x, y, z.
    pub stress: [f32; 3],
    /// Distance of the face beyond the cell along that axis, cells.
    pub fraction: f32,
    /// Outward normal.
    pub normal: [f32; 3],
    /// Its area, in faces of a cell. At edges it includes what lies beyond the columns with full cells.
    pub area: f32,
}

/// The faces of blocks for the wall model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BlockFaces {
    /// Those where it acts, in the order of the cells.
    pub faces: Vec<BlockFace>,
    /// Number of all faces of full block cells in contact with fluid.
    pub area: u64,
}

/// Number of cells of the bricks that blocks reach per invocation over the list of cells under faces: if the list is longer,
/// an invocation processes several entries.
const CELLS_OF_BRICKS: u32 = 16;

/// The dispatches that depend on the positions of blocks.
#[derive(Debug, Default)]
pub(super) struct BlockPasses {
    /// After blocks have moved: find the walls with blocks nearby, and the faces where the law of the wall acts.
    pub faces: Vec<Dispatch>,
    /// Friction of these faces, in even and odd steps.
    pub friction: [Vec<Dispatch>; 2],
    /// Friction of sloping faces, after the collision in even and odd steps.
    pub sloping: [Vec<Dispatch>; 2],
    /// Removal of the eddy viscosity at the end of a step.
    pub end: Vec<Dispatch>,
    /// List of the cells that may be under such a face, and the sloping faces there.
    pub lists: Vec<wgpu::Buffer>,
}

/// Room for the sloping faces at so many cells.
fn slopes(device: &wgpu::Device, cells: u32) -> Result<wgpu::Buffer> {
    let (wants, has) = (
        size_of::<SlopingCell>() as u64 * u64::from(cells.max(1)),
        largest_binding(&device.limits()),
    );
    if wants > has {
        return Err(Error::Limit {
            name: "bytes of one storage binding (sloping faces of blocks)".into(),
            wants,
            has,
            remedy: "use a larger cell, no sloping faces, or another adapter".into(),
        });
    }
    Ok(zeroed(device, "sloping faces of blocks", wants))
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

    /// A pass over these cells; `more`: additional buffers.
    fn pass_of_model(
        &self,
        device: &wgpu::Device,
        (file, entry): (&str, &'static str),
        odd: u32,
        (list, invocations): (&wgpu::Buffer, u32),
        more: &[(&str, &wgpu::Buffer)],
    ) -> Result<Dispatch> {
        let mut buffers = vec![("bricks", list)];
        buffers.extend(self.psm_planes());
        buffers.extend(more);
        let dispatch = CellDispatch {
            program: &self.cell_program(file),
            entry,
            pass: cell_pass(odd, 0, &(0..0)),
            buffers: &buffers,
            constants: &[],
            invocations,
        };
        self.cell_dispatch(device, &dispatch)
    }

    /// The dispatches that depend on the positions of blocks.
    pub(super) fn block_passes(&self, device: &wgpu::Device) -> Result<BlockPasses> {
        let mut passes = BlockPasses {
            faces: self.mark_passes(device)?,
            ..BlockPasses::default()
        };
        passes.faces.extend(self.mark_surface(device)?);
        for friction in &mut passes.friction {
            friction.extend(self.surface_shares(device)?);
        }
        let of_model = self.bricks_of_model().zip(self.streams.face_codes());
        if let Some(((list, cells), codes)) = of_model {
            let outer = zeroed(device, "outer cells of blocks", 24 + 4 * u64::from(cells));
            let buffers = [("face_codes", codes), ("outer_cells", &outer)];
            let pass = |entry, odd, invocations| {
                let kernel = ("block_friction", entry);
                self.pass_of_model(device, kernel, odd, (list, invocations), &buffers)
            };
            let listed = cells.div_ceil(CELLS_OF_BRICKS);
            passes.faces.extend([
                pass("forget_outer_cells", 0, 1)?,
                pass("list_outer_cells", 0, cells)?,
                pass("find_faces", 0, listed)?,
            ]);
            for (odd, friction) in (0..).zip(&mut passes.friction) {
                friction.push(pass("block_friction", odd, listed)?);
            }
            passes.end.push(pass("clear_viscosity", 0, listed)?);
            if self.setup.has_sloping_friction() {
                let slopes = slopes(device, cells)?;
                let [codes, outer] = buffers;
                let buffers = [codes, outer, ("slopes", &slopes)];
                let pass = |entry, odd| {
                    let kernel = ("sloping_friction", entry);
                    self.pass_of_model(device, kernel, odd, (list, listed), &buffers)
                };
                passes.faces.push(pass("find_slopes", 0)?);
                for (odd, friction) in (0..).zip(&mut passes.friction) {
                    friction.push(pass("slope_law", odd)?);
                }
                for (next, friction) in [1, 0].into_iter().zip(&mut passes.sloping) {
                    for entry in ["sloping_slip", "sloping_friction"] {
                        friction.push(pass(entry, next)?);
                    }
                }
                passes.end.push(pass("clear_above_slopes", 0)?);
                passes.lists.push(slopes);
            }
            passes.lists.push(outer);
        }
        Ok(passes)
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
        let kernel = ("block_friction", "list_block_faces");
        let dispatch = self.pass_of_model(device, kernel, odd, bricks, &more)?;
        submit_pass(device, queue, |pass| dispatch.record(pass));
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
