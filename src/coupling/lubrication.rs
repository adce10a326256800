//! Lubrication in gaps narrower than a cell.

use crate::{
    rock::{Block, law::Film},
    scene::{Boundary, Scene},
    units::Units,
};

/// Roughness of faces, cells: that of rock is a thousandth to a hundredth of the size of a block, which spans some
/// tens of cells.
const ROUGHNESS: f64 = 0.1;
/// Gap of curved surfaces, cells, below which the grid does not resolve the force. For a sphere that approaches a wall
/// the lattice yields 0.91 of the force at a gap of one cell, 0.78 at half a cell and 0.55 at a quarter. A limit of 2/3 of
/// a cell (as Nguyen & Ladd 2002 found with other walls) leaves errors of −2, +13 and +11 % at 0.5, 0.25 and 0.12 cells.
const CURVED_GAP: f64 = 2.0 / 3.0;
/// The same between plane faces, where the force grows with the third power of the gap: the lattice yields 0.92 of it at
/// a cell, 0.21 at half a cell, and 0.04 at a quarter.
const PLANE_GAP: f64 = 0.8;

/// The lubrication film in unresolved gaps; `None` without `coupling.lubrication`, and for an inviscid fluid.
pub(super) fn lubrication_film(scene: &Scene, units: &Units, blocks: &[Block]) -> Option<Film> {
    let faces = scene.boundaries.iter();
    let free_slip = faces.filter(|(_, boundary)| matches!(boundary, Boundary::FreeSlip));
    let mut slip: Vec<usize> = free_slip
        .map(|(face, _)| format!("wall_{}", face.name()))
        .filter_map(|name| blocks.iter().position(|block| block.name == name))
        .collect();
    slip.sort_unstable();
    let viscous = scene.fluid.viscosity > 0.0;
    (scene.coupling.lubrication && viscous).then_some(Film {
        viscosity: scene.fluid.density * scene.fluid.viscosity,
        round: CURVED_GAP * units.cell,
        flat: PLANE_GAP * units.cell,
        roughness: ROUGHNESS * units.cell,
        slip,
    })
}
