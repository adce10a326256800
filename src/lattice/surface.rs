//! Cells that solids at rest fill in part, as the device has them.

use super::{C, Grid, Setup, buffers::storage};

/// In a fluid cell next to one that is filled in part.
const NEAR: f32 = -1.0;

/// What `kernels/lattice/surface_fraction.wgsl` reads.
#[derive(Debug)]
pub(super) struct Surface {
    /// Of each brick its place among those with such cells or their neighbours, from 1.
    pub slots: wgpu::Buffer,
    /// The fractions in these bricks.
    pub fractions: wgpu::Buffer,
}

/// The bricks that hold cells which solids fill in part, or neighbours of such cells, in ascending order.
pub(super) fn bricks(setup: &Setup, grid: &Grid) -> Vec<u32> {
    let mut found: Vec<u32> = marked(setup, grid)
        .map(|(cell, _)| grid.place_in_bricks(cell).0)
        .collect();
    found.sort_unstable();
    found.dedup();
    found
}

/// All such cells of the grid, with what stands in them: neighbours first.
fn marked<'a>(setup: &'a Setup, grid: &'a Grid) -> impl Iterator<Item = ([u32; 3], f32)> + 'a {
    let [nx, ny, _] = grid.cells;
    let at = move |n: u32| [n % nx, n / nx % ny, n / (nx * ny)];
    let solid = move |cell: [u32; 3]| setup.solid.get(grid.index(cell)) == Some(&true);
    let periodic = setup.periodic_axes();
    let neighbour = move |cell: [u32; 3], c: [i32; 3]| {
        let mut to = [0; 3];
        for a in 0..3 {
            let n = i64::from(grid.cells[a]);
            let i = i64::from(cell[a]) + i64::from(c[a]);
            if !periodic[a] && !(0..n).contains(&i) {
                return None;
            }
            to[a] = i.rem_euclid(n) as u32;
        }
        (!solid(to)).then_some(to)
    };
    let own = setup.surface.iter();
    let near = own.clone().flat_map(move |surface| {
        C[1..7]
            .iter()
            .filter_map(move |c| neighbour(at(surface.cell), *c))
    });
    near.map(|cell| (cell, NEAR))
        .chain(own.map(move |surface| (at(surface.cell), surface.fraction)))
}

/// Bytes of what [`Surface`] has on a device: of the slots, and of the fractions.
pub(super) fn bytes(setup: &Setup, grid: &Grid) -> [u64; 2] {
    if setup.surface.is_empty() {
        return [0; 2];
    }
    let product = |of: [u32; 3]| of.iter().map(|&n| u64::from(n)).product::<u64>();
    let cells = product(grid.brick) * u64::from(grid.lanes);
    let count = bricks(setup, grid).len() as u64;
    [4 * product(grid.bricks()), 4 * count * cells]
}

impl Surface {
    /// Those of a setup; none without such cells.
    pub fn new(device: &wgpu::Device, setup: &Setup, grid: &Grid) -> Option<Self> {
        if setup.surface.is_empty() {
            return None;
        }
        let bricks = bricks(setup, grid);
        let mut slots = vec![0u32; grid.bricks().iter().product::<u32>() as usize];
        for (slot, brick) in (1..).zip(&bricks) {
            slots[*brick as usize] = slot;
        }
        let elements = grid.brick.iter().product::<u32>() as usize;
        let lanes = grid.lanes as usize;
        let mut fractions = vec![0f32; bricks.len() * elements * lanes];
        for (cell, value) in marked(setup, grid) {
            let (brick, place) = grid.place_in_bricks(cell);
            let slot = slots[brick as usize] as usize - 1;
            fractions[slot * elements * lanes + place as usize] = value;
        }
        Some(Self {
            slots: storage(device, "slots of surfaces", bytemuck::cast_slice(&slots)),
            fractions: storage(
                device,
                "surface fractions",
                bytemuck::cast_slice(&fractions),
            ),
        })
    }

    /// Bytes of its buffers.
    pub fn bytes(&self) -> u64 {
        self.slots.size() + self.fractions.size()
    }
}
