//! The fluid between blocks that are less than a cell apart.

use crate::{
    bodies::Block,
    law::Film,
    scene::{Boundary, Scene},
    units::Units,
};

/// Roughness of faces, cells: that of rock is of the size of a thousandth to a hundredth of a block, which is some
/// tens of cells.
const ROUGHNESS: f64 = 0.1;
/// Gaps, cells, below which the grid falls short. Of a sphere that nears a wall it gives 0.91 of the force at a cell,
/// 0.78 at half a cell and 0.55 at a quarter, so that 2/3 of a cell, as Nguyen & Ladd 2002 found with other walls, too,
/// leaves −2, +13 and +11 % at 0.5, 0.25 and 0.12 cells.
const ROUND: f64 = 2.0 / 3.0;
/// Between faces the force goes with the third power, and the grid loses it at once: 0.92 of it at a cell, 0.21 at half
/// a cell, 0.04 at a quarter.
const FLAT: f64 = 0.8;

/// The film in the gaps of a scene that the grid does not resolve, if the scene wants it and the fluid is viscous.
pub(super) fn film(scene: &Scene, units: &Units, blocks: &[Block]) -> Option<Film> {
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
        round: ROUND * units.cell,
        flat: FLAT * units.cell,
        roughness: ROUGHNESS * units.cell,
        slip,
    })
}
