//! The flow in which speed is measured.

use riprap::{
    Error,
    lattice::{Grid, Setup, State},
};

/// A flow that moves in every cell: waves along each axis and noise. At rest, or where symmetry
/// keeps a component at 0, denormal numbers would slow a CPU down.
///
/// # Errors
/// If the setup has no grid.
pub fn sheared_noise(setup: &Setup) -> Result<State, Error> {
    let grid = Grid::new(setup)?;
    let mut state = State::rest(grid.cell_count());
    for (n, cell) in grid.domain().enumerate() {
        let wave = |axis: usize| {
            let turns = (f64::from(cell[axis]) + 0.5) / f64::from(grid.cells[axis]);
            (std::f64::consts::TAU * turns).sin()
        };
        let noise = |k: usize| f64::from(hash(4 * n + k)) / f64::from(u32::MAX) - 0.5;
        state.excess[n] = (1e-3 * noise(3)) as f32;
        for a in 0..3 {
            // 0.04 is a Mach number of 0.07.
            state.velocity[a][n] = (0.04 * wave((a + 1) % 3) + 0.01 * noise(a)) as f32;
        }
    }
    Ok(state)
}

/// A number that looks random: the finaliser of MurmurHash3 (Appleby 2011).
fn hash(n: usize) -> u32 {
    let mut n = n as u32;
    n = (n ^ (n >> 16)).wrapping_mul(0x85eb_ca6b);
    n = (n ^ (n >> 13)).wrapping_mul(0xc2b2_ae35);
    n ^ (n >> 16)
}
