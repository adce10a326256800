//! The solid fractions of the cells of a block add up to its volume.

use crate::validate::{
    Outcome, Stand,
    tank::{self, Tank, block, turn},
};
use riprap::scene::{BlockShape, Motion};

/// Largest extent of each block, cells.
const ACROSS: f64 = 16.0;
/// From a block to the next one: the diagonal of the cube and a cell on each side.
const SPACING: u32 = 30;
/// Turns of each shape.
const TURNS: u32 = 4;
const FULL_TURNS: u32 = 16;

/// Cubes, tetrahedra and icosahedra, turned and shifted against the grid.
pub fn run(stand: &Stand) -> Outcome {
    let tetrahedron = ACROSS;
    // Twice the radius of the sphere around it.
    let icosahedron = ACROSS / (10.0 + 2.0 * 5f64.sqrt()).sqrt() * 2.0;
    let shapes = [
        (
            "cubes",
            BlockShape::Box { size: [ACROSS; 3] },
            ACROSS.powi(3),
        ),
        (
            "tetrahedra",
            BlockShape::Tetrahedron { edge: tetrahedron },
            tetrahedron.powi(3) / (6.0 * 2f64.sqrt()),
        ),
        (
            "icosahedra",
            BlockShape::Icosahedron { edge: icosahedron },
            icosahedron.powi(3) * 5.0 / 12.0 * (3.0 + 5f64.sqrt()),
        ),
    ];
    let turns = if stand.full { FULL_TURNS } else { TURNS };
    let mut scene = tank::scene(
        [shapes.len() as u32 * SPACING, turns * SPACING, SPACING],
        1.0,
    )?;
    for row in 0..turns {
        for (column, (_, shape, _)) in (0..).zip(&shapes) {
            let number = f64::from(shapes.len() as u32 * row + column);
            let place = |n: u32, step: f64| {
                f64::from(n * SPACING) + 0.5 * f64::from(SPACING) + (step * number).fract()
            };
            let at = [place(column, 0.819), place(row, 0.671), place(0, 0.55)];
            let mut made = block(shape.clone(), at, Motion::Driven);
            made.rotation = turn(row);
            scene.blocks.push(made);
        }
    }
    let mut tank = Tank::fill(stand, &scene)?;
    tank.advance(1)?;
    let trial = tank.trial(&format!("{turns} turns"));
    let mut records = Vec::new();
    for (column, (name, _, volume)) in shapes.iter().enumerate() {
        let error = |row: usize| {
            let load = tank.load(shapes.len() * row + column).flow;
            ((load.entrained + load.missing) / volume - 1.0).abs()
        };
        let worst = (0..turns as usize).map(error).fold(0.0, largest);
        records.push(trial.at_most(format!("Σε / volume − 1, {name}"), worst, 1e-4));
    }
    Ok(records)
}

/// The larger one; what is not a number stays.
fn largest(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}
