//! The kernels of loads on faces, with their own buffers.

use super::{
    CellMapping, FACE_LAYERS, FACE_LOAD, FaceJob, Plan, Tile,
    kernels::{Growing, Kernels},
    program,
    tiles::{Outline, SKIN},
};
use crate::{
    Result,
    gpu::{buffers::zeroed, kernel::Kernel},
    lattice::Lattice,
};
use glam::DVec3;

/// Names of the buffers in WGSL.
const NAMES: [&str; 4] = ["jobs", "face_first", "face_partials", "face_loads"];
/// Buffers of blocks that the first kernel reads.
const SHARED: [&str; 5] = ["tiles", "parts", "faces", "motions", "solid_fractions"];
/// Largest distance of the centre of a cell in the first layer from the plane of a face, cells: half the diagonal of a
/// cell plus the thickness of the layer.
const REACH: f64 = 1.9;

/// Sums over the layers of cells along the faces of the blocks that request them.
#[derive(Debug)]
pub(super) struct FaceSums {
    /// Blocks that request them, in the order of the device, ascending.
    pub requested: Vec<usize>,
    mapping: CellMapping,
    reduce: Kernel,
    sum: Kernel,
    binds: Option<[wgpu::BindGroup; 2]>,
    buffers: [Growing; 4],
    jobs: Vec<FaceJob>,
    face_first: Vec<u32>,
}

impl FaceSums {
    pub fn new(
        device: &wgpu::Device,
        lattice: &Lattice,
        mapping: CellMapping,
        requested: Vec<usize>,
    ) -> Result<Self> {
        let grid = lattice.grid();
        let linked = program::spread(program::reduce_faces(grid, mapping), lattice).link()?;
        let mut constants = linked.constants_of(&program::constants(grid));
        constants.push(("VISCOSITY", lattice.setup().nu));
        Ok(Self {
            requested,
            mapping,
            reduce: Kernel::new(device, &linked, "reduce_faces", &constants)?,
            sum: Kernel::new(device, &program::sum_faces().link()?, "sum_faces", &[])?,
            binds: None,
            buffers: NAMES.map(|name| Growing::new(device, name)),
            jobs: Vec::new(),
            face_first: Vec::new(),
        })
    }

    /// Lists the tiles of each face, grows the buffers and uploads the lists; `outlines` are those of the
    /// parts of all blocks.
    pub fn lay(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        (lattice, kernels): (&Lattice, &Kernels),
        (plan, first_part): (&Plan, &[u32]),
        outlines: &[Vec<Outline>],
    ) -> Result<()> {
        self.jobs.clear();
        self.face_first.clear();
        self.face_first.push(0);
        let grid = lattice.grid();
        let brick = grid.brick.map(f64::from);
        for &block in &self.requested {
            let tiles = plan.tiles_of(block);
            for (part, outline) in (first_part[block]..).zip(&outlines[block]) {
                for (face, plane) in (0..).zip(&outline.faces) {
                    for layer in 0..FACE_LAYERS as u32 {
                        let heights = [0.0, REACH].map(|height| height + f64::from(layer));
                        let sees = |tile: &u32| {
                            let tile = &plan.tiles[*tile as usize];
                            tile.part == part
                                && reaches(tile, brick, outline.centre, plane, heights)
                        };
                        let job = |tile| FaceJob { tile, face, layer };
                        self.jobs.extend(tiles.clone().filter(sees).map(job));
                        self.face_first.push(self.jobs.len() as u32);
                    }
                }
            }
        }
        let words = |n: usize| 4 * n as u64;
        let layers = self.face_first.len() - 1;
        let bytes = [
            (size_of::<FaceJob>() * self.jobs.len()) as u64,
            words(self.face_first.len()),
            words(FACE_LOAD * self.jobs.len()),
            words(FACE_LOAD * layers),
        ];
        for (buffer, bytes) in self.buffers.iter_mut().zip(bytes) {
            buffer.hold(device, bytes)?;
        }
        // The kernels take the numbers of jobs and faces from these lengths.
        for (buffer, bytes) in self.buffers.iter_mut().zip(bytes).take(2) {
            if buffer.buffer.size() != bytes && bytes > 0 {
                buffer.buffer = zeroed(device, buffer.label, bytes);
            }
        }
        let own = || {
            NAMES
                .iter()
                .zip(&self.buffers)
                .map(|(name, b)| (*name, &b.buffer))
        };
        let shared = SHARED.iter().map(|name| (*name, kernels.buffer(name)));
        let named: Vec<_> = own().chain(shared).chain(lattice.psm_planes()).collect();
        self.binds = Some([
            self.reduce.bind(device, &named)?,
            self.sum.bind(device, &own().collect::<Vec<_>>())?,
        ]);
        queue.write_buffer(&self.buffers[0].buffer, 0, bytemuck::cast_slice(&self.jobs));
        let first = bytemuck::cast_slice(&self.face_first);
        queue.write_buffer(&self.buffers[1].buffer, 0, first);
        Ok(())
    }

    /// The kernels in the order in which they run.
    pub fn kernels(&self) -> [&Kernel; 2] {
        [&self.reduce, &self.sum]
    }

    /// Records the sums.
    pub fn record(&self, pass: &mut wgpu::ComputePass<'_>) {
        let Some([reduce, sum]) = &self.binds else {
            return;
        };
        if !self.jobs.is_empty() {
            let groups = self.mapping.groups(self.jobs.len() as u32);
            self.reduce.record(pass, reduce, groups);
        }
        let numbers = self.count() as u32;
        if numbers > 0 {
            self.sum.record(pass, sum, numbers.div_ceil(64));
        }
    }

    /// The sums, [`FACE_LOAD`] numbers per layer of each face.
    pub fn loads(&self) -> &wgpu::Buffer {
        &self.buffers[3].buffer
    }

    /// Number of sums.
    pub fn count(&self) -> usize {
        FACE_LOAD * self.face_first.len().saturating_sub(1)
    }

    /// Bytes on the device.
    pub fn bytes(&self) -> u64 {
        self.buffers
            .iter()
            .map(|growing| growing.buffer.size())
            .sum()
    }
}

/// Whether the centre of a cell of a tile may be between two heights over a face of the part about `centre` until the next search
/// for tiles: the part may move by the skin before and after.
fn reaches(
    tile: &Tile,
    brick: [f64; 3],
    centre: DVec3,
    (normal, distance): &(DVec3, f64),
    [low, high]: [f64; 2],
) -> bool {
    let half = 0.5 * DVec3::from_array(brick);
    let middle = DVec3::from_array(tile.cell.map(f64::from)) + half - centre;
    let height = normal.dot(middle) - distance;
    let extent = normal.abs().dot(half) + 2.0 * SKIN;
    height + extent >= low && height - extent <= high
}
