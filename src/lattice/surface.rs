//! Cells that solids at rest fill in part, as the device has them.

use super::{C, Grid, Setup, buffers::storage, surface_faces::SurfaceFaces};

/// In a fluid cell next to one that is filled in part.
const NEAR: f32 = -1.0;

/// What `kernels/lattice/surface_fraction.wgsl` reads.
#[derive(Debug)]
pub(super) struct Surface {
    /// Of each brick its place among those with such cells or their neighbours, from 1.
    pub slots: wgpu::Buffer,
    /// [`Setup::surface_planes`] planes in each of these bricks.
    pub fractions: wgpu::Buffer,
    /// The slots, as the buffer has them.
    places: Vec<u32>,
    planes: u32,
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
    let neighbour = move |cell, c| {
        let to = grid.neighbour_in_domain(cell, c, periodic)?;
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
    let count = bricks(setup, grid).len() as u64 * u64::from(setup.surface_planes());
    [4 * product(grid.bricks()), 4 * count * cells]
}

/// Index of a cell among the scalars of a plane of its brick.
fn scalar_of(grid: &Grid, slots: &[u32], planes: u32, cell: [u32; 3], plane: u32) -> usize {
    let each = (grid.brick.iter().product::<u32>() * grid.lanes) as usize;
    let (brick, place) = grid.place_in_bricks(cell);
    let slot = slots[brick as usize] as usize - 1;
    (slot * planes as usize + plane as usize) * each + place as usize
}

impl Surface {
    /// Those of a setup; none without such cells.
    pub fn new(
        device: &wgpu::Device,
        setup: &Setup,
        grid: &Grid,
        faces: &SurfaceFaces,
    ) -> Option<Self> {
        if setup.surface.is_empty() {
            return None;
        }
        let bricks = bricks(setup, grid);
        let mut slots = vec![0u32; grid.bricks().iter().product::<u32>() as usize];
        for (slot, brick) in (1..).zip(&bricks) {
            slots[*brick as usize] = slot;
        }
        let planes = setup.surface_planes();
        let each = (grid.brick.iter().product::<u32>() * grid.lanes) as usize;
        let mut values = vec![0f32; bricks.len() * planes as usize * each];
        let place = |cell, plane| scalar_of(grid, &slots, planes, cell, plane);
        for (cell, value) in marked(setup, grid) {
            values[place(cell, 0)] = value;
        }
        for (_, cell, normal) in faces.cut() {
            for (n, component) in (2..).zip(normal) {
                values[place(grid.padded_cell(cell), n)] = component;
            }
        }
        let fractions = bytemuck::cast_slice(&values);
        Some(Self {
            slots: storage(device, "slots of surfaces", bytemuck::cast_slice(&slots)),
            fractions: storage(device, "surface fractions", fractions),
            places: slots,
            planes,
        })
    }

    /// Index of a cell of these bricks among the scalars of a plane.
    pub fn plane(&self, grid: &Grid, cell: [u32; 3], plane: u32) -> usize {
        scalar_of(grid, &self.places, self.planes, cell, plane)
    }

    /// Bytes of its buffers.
    pub fn bytes(&self) -> u64 {
        self.slots.size() + self.fractions.size()
    }
}
