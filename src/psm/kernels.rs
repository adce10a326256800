//! The kernels of blocks in the fluid, and their shared buffers.

use super::{CellMapping, Forms, Plan, Tile, WHOLE, WRENCH, program};
use crate::{
    Error, Result,
    gpu::{
        Processor,
        buffers::zeroed,
        kernel::{Kernel, MAX_GROUPS, fold, largest_binding},
        link::Program,
    },
    lattice::Lattice,
};

/// A buffer that is replaced when it must hold more.
#[derive(Debug)]
pub(super) struct Growing {
    pub buffer: wgpu::Buffer,
    pub label: &'static str,
}

impl Growing {
    pub fn new(device: &wgpu::Device, label: &'static str) -> Self {
        Self {
            buffer: zeroed(device, label, 256),
            label,
        }
    }

    /// Makes room, with half as much in reserve when it grows; returns whether the buffer was replaced.
    pub fn hold(&mut self, device: &wgpu::Device, bytes: u64) -> Result<bool> {
        if bytes <= self.buffer.size() {
            return Ok(false);
        }
        let most = largest_binding(&device.limits());
        if bytes > most {
            return Err(Error::Limit {
                name: format!("bytes of one storage binding ({})", self.label),
                wants: bytes,
                has: most,
                remedy:
                    "use fewer or smaller blocks in the fluid, a larger cell, or another adapter"
                        .into(),
            });
        }
        self.buffer = zeroed(device, self.label, (bytes + bytes / 2).min(most) / 4 * 4);
        Ok(true)
    }
}

/// Iterations of the loops of `polyhedron_fraction` for a part of so many faces: three passes through all of them, and one more per
/// column.
fn loop_iterations(faces: u32) -> u64 {
    let faces = u64::from(faces.max(1));
    let columns = (2 * (8192 / faces).isqrt()).clamp(2, 8);
    3 * faces + columns * (1 + columns * (1 + faces))
}

/// Names of the buffers in WGSL.
const NAMES: [&str; 15] = [
    "tiles",
    "parts",
    "faces",
    "motions",
    "solid_fractions",
    "effective_fractions",
    "lane_first",
    "lane_tiles",
    "block_first",
    "partials",
    "wrenches",
    "tile_work",
    "lane_work",
    "edges",
    "segments",
];

/// The kernels in the order in which they run, with the list that some go through.
const KERNELS: [(&str, Option<&str>); 5] = [
    ("voxelise", Some("tile_work")),
    ("voxelise_edges", None),
    ("combine_parts", Some("lane_work")),
    ("reduce_tiles", None),
    ("reduce_blocks", None),
];
/// Cells of tiles per cell at an edge, for blocks of some ten cells: if there are more edge cells, an invocation of
/// `voxelise_edges` computes several.
const CELLS_PER_EDGE: u64 = 16;
/// Number of loop iterations per invocation that every adapter executes: some end loops after 65 535 without an error.
const MAX_LOOP_ITERATIONS: u64 = 60_000;
/// Marks an unused entry of a list.
const NOTHING: u32 = u32::MAX;
/// Largest number of workgroups that folding a dispatch of 2³² adds.
const MAX_FOLD_SURPLUS: usize = (u32::MAX / MAX_GROUPS) as usize;

/// Pads a list for a dispatch of `groups` workgroups with `each` entries per workgroup: a folded dispatch has some additional
/// workgroups, which find unused entries.
fn pad(list: &mut Vec<u32>, groups: u32, each: usize) {
    let [x, y] = fold(groups);
    list.resize(x as usize * y as usize * each, NOTHING);
}

/// Kernels with their buffers.
#[derive(Debug)]
pub(super) struct Kernels {
    kernels: Vec<Kernel>,
    binds: Vec<wgpu::BindGroup>,
    buffers: Vec<Growing>,
    workgroup: u64,
    /// Workgroups of the coming dispatches, in the order of `KERNELS`.
    groups: [u32; 5],
    pub mapping: CellMapping,
    /// Largest number of cells per invocation of `voxelise_edges`.
    at_once: u64,
}

impl Kernels {
    /// Creates the kernels for parts of these forms, with at most `faces` faces.
    pub fn new(device: &wgpu::Device, lattice: &Lattice, forms: Forms, faces: u32) -> Result<Self> {
        let grid = lattice.grid();
        // Barriers are slow on a CPU, which processes the invocations of a workgroup one after the other.
        let processor = lattice.setup().processor;
        let mapping = match processor.unwrap_or_else(|| Processor::of(&device.adapter_info())) {
            Processor::Cpu => CellMapping::Serial,
            Processor::Gpu => CellMapping::Parallel,
        };
        let weight = lattice.setup().weight();
        let programs = [
            program::voxelise(grid, mapping, forms, weight),
            program::voxelise_edges(grid, forms, weight),
            program::spread(program::combine_parts(grid, mapping), lattice),
            program::spread(program::reduce_tiles(grid, mapping), lattice),
            program::reduce_blocks(),
        ];
        let mut constants = program::constants(grid);
        constants.push((
            "SPHERE_GROWTH",
            program::sphere_growth(lattice.setup().weight(), lattice.setup().tau()),
        ));
        let kernel = |((entry, _), program): (&(&str, Option<&str>), Program)| {
            let linked = program.link()?;
            Kernel::new(device, &linked, entry, &linked.constants_of(&constants))
        };
        let kernels = KERNELS.iter().zip(programs).map(kernel);
        let mut kernels = Self {
            kernels: kernels.collect::<Result<_>>()?,
            binds: Vec::new(),
            buffers: NAMES.map(|name| Growing::new(device, name)).into(),
            workgroup: grid.brick.iter().map(|&n| u64::from(n)).product(),
            groups: [0; 5],
            mapping,
            at_once: (MAX_LOOP_ITERATIONS / loop_iterations(faces)).clamp(1, CELLS_PER_EDGE),
        };
        kernels.bind(device, lattice)?;
        Ok(kernels)
    }

    /// Buffers by their names.
    pub fn buffer(&self, name: &str) -> &wgpu::Buffer {
        let at = NAMES
            .iter()
            .position(|known| *known == name)
            .unwrap_or_default();
        &self.buffers[at].buffer
    }

    /// Makes room for a plan of `loaded` blocks with loads.
    pub fn hold(
        &mut self,
        device: &wgpu::Device,
        lattice: &Lattice,
        plan: &Plan,
        [parts, faces, blocks, loaded]: [usize; 4],
    ) -> Result<()> {
        let words = |n: usize| 4 * n as u64;
        let tiles = plan.tiles.len();
        let bytes = [
            (size_of::<Tile>() * tiles) as u64,
            (size_of::<super::Part>() * parts) as u64,
            (16 * faces) as u64,
            (size_of::<super::Motion>() * blocks) as u64,
            words(tiles) * self.workgroup,
            2 * words(tiles) * self.workgroup,
            words(plan.lane_first.len()),
            words(tiles),
            words(loaded + 1),
            words(WRENCH * tiles),
            words(WRENCH * loaded),
            words(tiles + MAX_FOLD_SURPLUS),
            words(plan.lane_count() + MAX_FOLD_SURPLUS),
            words(tiles) * self.workgroup + 4,
            words(tiles.next_multiple_of(self.mapping.segments_per_workgroup()))
                + words(
                    self.mapping.segments_per_workgroup() * tiles.div_ceil(MAX_GROUPS as usize),
                ),
        ];
        for (buffer, bytes) in self.buffers.iter_mut().zip(bytes) {
            buffer.hold(device, bytes)?;
        }
        // The kernel takes the number of blocks from this length.
        let first = &mut self.buffers[8];
        if first.buffer.size() != words(loaded + 1) {
            first.buffer = zeroed(device, first.label, words(loaded + 1));
        }
        self.bind(device, lattice)
    }

    /// Rebinds the planes of the lattice, which may have replaced them.
    fn bind(&mut self, device: &wgpu::Device, lattice: &Lattice) -> Result<()> {
        if lattice.setup().solid_operator.is_none() {
            let message = "the lattice has no solid operator, so that no block may be in it";
            return Err(Error::argument("solid_operator", message));
        }
        let named: Vec<_> = NAMES
            .iter()
            .zip(&self.buffers)
            .map(|(name, growing)| (*name, &growing.buffer))
            .chain(lattice.psm_planes())
            .collect();
        let bind = |(kernel, (_, work)): (&Kernel, &(&str, Option<&str>))| {
            let mut named = named.clone();
            named.extend(work.map(|work| ("work", self.buffer(work))));
            kernel.bind(device, &named)
        };
        self.binds = self
            .kernels
            .iter()
            .zip(&KERNELS)
            .map(bind)
            .collect::<Result<_>>()?;
        Ok(())
    }

    /// Sets the work of the kernels of cells: numbers of tiles, and of lanes of bricks; `anew` if they differ from
    /// those before.
    pub fn set_work(&mut self, queue: &wgpu::Queue, tiles: &[u32], lanes: &[u32], anew: bool) {
        let mark = if anew { WHOLE } else { 0 };
        for (n, list) in [(0, tiles), (2, lanes)] {
            self.groups[n] = list.len() as u32;
            if let (Some(name), false) = (KERNELS[n].1, list.is_empty()) {
                let mut list: Vec<u32> = list.iter().map(|number| number | mark).collect();
                pad(&mut list, self.groups[n], 1);
                queue.write_buffer(self.buffer(name), 0, bytemuck::cast_slice(&list));
            }
        }
        let cells = tiles.len() as u64 * self.workgroup;
        self.groups[1] = cells.div_ceil(64 * self.at_once) as u32;
        self.no_edges(queue);
    }

    /// Clears the list of `voxelise_edges`, before `voxelise` with the same work.
    pub fn no_edges(&self, queue: &wgpu::Queue) {
        queue.write_buffer(self.buffer("edges"), 0, &[0; 4]);
    }

    /// Sets the work of the sums.
    pub fn set_sums(&mut self, queue: &wgpu::Queue, mut segments: Vec<u32>, block_first: &[u32]) {
        self.groups[3] = self.mapping.groups(segments.len() as u32);
        self.groups[4] = block_first.len() as u32 - 1;
        pad(
            &mut segments,
            self.groups[3],
            self.mapping.segments_per_workgroup(),
        );
        for (name, list) in [("segments", &segments[..]), ("block_first", block_first)] {
            queue.write_buffer(self.buffer(name), 0, bytemuck::cast_slice(list));
        }
    }

    /// Records those of the kernels `which` that have work.
    pub fn record(&self, pass: &mut wgpu::ComputePass<'_>, which: std::ops::Range<usize>) {
        for n in which {
            if self.groups[n] > 0 {
                self.kernels[n].record(pass, &self.binds[n], self.groups[n]);
            }
        }
    }

    /// All kernels in their order, each with the workgroups of the coming dispatch.
    pub fn all(&self) -> impl Iterator<Item = (&Kernel, u32)> {
        self.kernels.iter().zip(self.groups)
    }

    /// Bytes on the device.
    pub fn bytes(&self) -> u64 {
        self.buffers
            .iter()
            .map(|growing| growing.buffer.size())
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::{MAX_LOOP_ITERATIONS, loop_iterations};
    use crate::psm::MAX_FACES;

    #[test]
    fn a_cell_of_any_part_takes_fewer_iterations_than_there_are() {
        assert!((1..=MAX_FACES).all(|faces| loop_iterations(faces) <= MAX_LOOP_ITERATIONS));
    }
}
