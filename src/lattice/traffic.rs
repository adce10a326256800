//! What a step reads and writes, counted from the setup: the measure of how well a kernel uses memory.
//!
//! Each word counts once, however often neighbours fetch it again: a cache that holds a few slices
//! of the grid gives them for nothing.

use super::{
    Force, Geometry, Grid, Setup, WallCell, WallStress, bytes_per_population,
    geometry::{FaceCell, Link, MovingCell},
    populations::Q,
};

/// A vector of three f32.
const VECTOR: u64 = 12;

/// Bytes that a step moves for a fluid cell away from walls: its populations in and out (216 in
/// f32, 108 in 16 bits), the velocity and, if it is kept, the eddy viscosity for WALE (24 or 16), the force field in (12), and
/// the least eddy viscosity of a wall model in (4).
pub fn bytes_per_cell(setup: &Setup) -> u64 {
    let populations = 2 * u64::from(Q) * bytes_per_population(setup.storage);
    let force = match setup.force {
        Force::Field(_) => VECTOR,
        Force::None | Force::Constant(_) => 0,
    };
    populations + bytes_of_wale(setup) + force + setup.wall_model.map_or(0, |_| 4)
}

/// Bytes that WALE keeps per cell between two steps, and moves in each of them: two velocities, or a velocity and the eddy
/// viscosity, one of which a step reads while it writes the other.
pub(super) fn bytes_of_wale(setup: &Setup) -> u64 {
    match (setup.wale, setup.wale_interval) {
        (None, _) => 0,
        (Some(_), 1) => 2 * VECTOR,
        (Some(_), _) => VECTOR + 4,
    }
}

/// Bytes that a step moves over the whole grid: those of its fluid cells, the flags and the list of
/// the bricks, and the passes over walls and open faces.
pub fn bytes_per_step(setup: &Setup, grid: &Grid, geometry: &Geometry) -> u64 {
    let word = bytes_per_population(setup.storage);
    let count = |n: usize| n as u64;
    let brick: u64 = grid.brick.iter().map(|&n| u64::from(n)).product();
    // One u32 holds the flags of the cells of an element.
    let flags = 4 * brick * count(geometry.mixed.len() + geometry.surface.len());
    let lists = 4 * count(geometry.mixed.len() + geometry.plain.len() + geometry.surface.len());
    let surface = 4 * brick * u64::from(grid.lanes) * count(geometry.surface.len());
    let links = count((geometry.link_rows.len() + geometry.links.len()) * size_of::<Link>())
        + count(geometry.link_count()) * 2 * word;
    // The velocity that the law reads, what the wall received, and the eddy viscosity of four cells.
    let wall = 9 * (count(size_of::<Link>()) + 2 * word)
        + count(size_of::<WallCell>() + size_of::<WallStress>())
        + VECTOR
        + 16;
    let walls = count(geometry.walls.cells.len()) * wall;
    let moving = |cell: &MovingCell| {
        let reflected: u32 = cell.through.iter().map(|bits| bits.count_ones()).sum();
        // All populations give the density; those through the faces are written.
        u64::from(Q + reflected) * word + count(size_of::<MovingCell>()) + 3 * VECTOR
    };
    let moving: u64 = geometry.moving.iter().map(moving).sum();
    let open = |cell: &FaceCell| {
        u64::from(Q + cell.entering.count_ones()) * word + count(size_of::<FaceCell>())
    };
    let open: u64 = [&geometry.pressure, &geometry.outflow]
        .into_iter()
        .flatten()
        .map(open)
        .sum();
    geometry.fluid_cells * bytes_per_cell(setup)
        + flags
        + lists
        + surface
        + links
        + walls
        + moving
        + open
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::{Face, Storage};

    fn step(setup: &Setup) -> u64 {
        let grid = Grid::new(setup).unwrap();
        bytes_per_step(setup, &grid, &Geometry::new(setup, &grid))
    }

    #[test]
    fn a_plain_cell_moves_its_populations_in_and_out() {
        let mut setup = Setup::periodic([8; 3], 0.01);
        assert_eq!(bytes_per_cell(&setup), 216);
        assert_eq!(step(&setup), 512 * 216);
        (setup.storage, setup.lanes) = (Storage::F16, 4);
        assert_eq!(bytes_per_cell(&setup), 108);
        assert_eq!(step(&setup), 512 * 108);
    }

    #[test]
    fn what_a_setup_adds_is_counted() {
        let mut setup = Setup::periodic([8; 3], 0.01);
        setup.force = Force::Constant([1e-6, 0.0, 0.0]);
        assert_eq!(bytes_per_cell(&setup), 216);
        setup.wale = Some(0.5);
        assert_eq!(bytes_per_cell(&setup), 232);
        setup.wale_interval = 1;
        assert_eq!(bytes_per_cell(&setup), 240);
        setup.force = Force::Field(vec![[0.0; 3]; 512]);
        assert_eq!(bytes_per_cell(&setup), 252);
    }

    #[test]
    fn a_wall_costs_its_links_its_flags_and_its_list() {
        let mut setup = Setup::periodic([8; 3], 0.01);
        setup.faces[2] = [Face::Wall([0.0; 3]), Face::Wall([0.0; 3])];
        setup.brick = [8, 8, 1];
        // 2 × 64 cells with 9 directions into a wall, 8 bytes of populations each, and 16 bytes of list for each row of 8;
        // 2 of 8 bricks hold them, the layer behind the walls has none that runs.
        let links = 2 * 64 * 9 * (8 + 16 / 8);
        assert_eq!(step(&setup), 512 * 216 + links + 2 * 64 * 4 + 8 * 4);
    }
}
