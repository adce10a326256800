//! Drag of simple cubic arrays of bodies with edges: cubes aligned with the grid and rotated, and a polyhedron of 80 faces.

use super::{
    array::{Array, USUAL},
    periodic_flow::{Body, PeriodicFlow, static_solids},
};
use crate::validate::{CaseContext, Method, Outcome, tank};
use glam::DVec3;
use riprap::{
    geometry::Polyhedron,
    scene::{BlockShape, Rotation, Solid},
};

/// Offsets of the middle of a cube from the corner of a cell, cells.
const OFFSETS: [[f64; 3]; 4] = [
    [0.0; 3],
    [0.25, 0.25, 0.25],
    [0.5, 0.5, 0.5],
    [0.3, 0.1, 0.7],
];
/// F/μUD of cubes along the grid with half the edge of the array's cell: by bounce-back on 32, 48 and 64 cells at τ = 1, 58.25,
/// 59.17 and 59.61, extrapolated by the power 1.1 of the cell.
const CUBES: f64 = 60.8;
/// Orientations, by [`tank::turn`].
const TURNS: [u32; 3] = [1, 2, 3];

/// Cubes of 8 cells and a polyhedron of 10, with either weight; with `--full` also of 16 and 20.
pub fn run(context: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    let edges: &[u32] = if context.full { &[16, 32] } else { &[16] };
    let taus: &[f64] = match context.full {
        true => &[0.52, 0.6, 1.0, 1.5],
        false => &[0.6, 1.0],
    };
    for &edge in edges {
        for &tau in taus {
            if edge > 16 && context.software && tau < 1.0 {
                continue;
            }
            for method in [Method::DEFAULT, Method::STANDARD_WEIGHT] {
                records.extend(of(context, edge, tau, method)?);
            }
        }
    }
    Ok(records)
}

fn of(context: &CaseContext, edge: u32, tau: f64, method: Method) -> Outcome {
    let mut records = Vec::new();
    let size = 0.5 * f64::from(edge);
    let flow = |body| PeriodicFlow {
        body,
        size,
        edge,
        tau,
        method,
        expected: CUBES * size,
    };
    let name = |what: &str| format!("{what}, D = {size}, τ = {tau}, {}", method.name);
    let cells = flow(Body::Cells(cells(edge)?)).measure(context, "solid cells")?;
    let default = method.name == Method::DEFAULT.name;
    if default {
        let quantity = format!("F / F(grid → 0), solid cells, D = {size}, τ = {tau}");
        let ratio = cells.resistance / size / CUBES;
        records.push(cells.trial.relative(quantity, ratio, 1.0, None));
    }
    let cube = BlockShape::Box { size: [size; 3] };
    let (mut least, mut most) = (f64::INFINITY, 0f64);
    for offset in OFFSETS {
        let body = Body::Block(cube.clone(), offset, Rotation::default());
        let drag = flow(body).measure(context, "cubes along the grid")?;
        (least, most) = (least.min(drag.resistance), most.max(drag.resistance));
        let quantity = name(&format!("F / F(solid cells), off by {offset:?}"));
        let ratio = drag.resistance / cells.resistance;
        records.push(drag.trial.relative(quantity, ratio, 1.0, None));
    }
    let quantity = name("largest F / smallest F − 1 of these places");
    let scatter = most / least - 1.0;
    records.push(match default {
        true => cells.trial.at_most(quantity, scatter, 2e-2),
        false => cells.trial.report(quantity, scatter),
    });
    for turn in TURNS {
        let body = Body::Block(cube.clone(), OFFSETS[3], tank::turn(turn));
        let drag = flow(body).measure(context, "turned cubes")?;
        let quantity = name(&format!("F/μUD, turn {turn}"));
        records.push(drag.trial.report(quantity, drag.resistance / size));
    }
    let polyhedron = flow(Body::Block(polyhedron(edge)?, OFFSETS[3], tank::turn(2)));
    let sphere = Array::new(USUAL, edge, tau).resistance();
    let drag = polyhedron.measure(context, "polyhedra of 80 faces")?;
    let quantity = name("F / F of a sphere of the same volume, 80 faces");
    let ratio = drag.resistance / sphere;
    records.push(drag.trial.relative(quantity, ratio, 1.0, None));
    Ok(records)
}

/// Solid cells in the shape of a cube whose edge is half of `edge`.
fn cells(edge: u32) -> anyhow::Result<Vec<Solid>> {
    let [low, high] = [0.25, 0.75].map(|part| part * f64::from(edge));
    static_solids(
        edge,
        &format!("kind = \"box\"\nmin = [{low}, {low}, {low}]\nmax = [{high}, {high}, {high}]"),
    )
}

/// An icosahedron whose faces are divided in four, with an eighth of the volume of the cube of `edge` cells.
fn polyhedron(edge: u32) -> anyhow::Result<BlockShape> {
    let golden = 0.5 * (1.0 + 5f64.sqrt());
    let mut points = Vec::new();
    for a in [-1.0, 1.0] {
        for b in [-golden, golden] {
            points.extend([[0.0, a, b], [a, b, 0.0], [b, 0.0, a]].map(DVec3::from));
        }
    }
    // Middles of the edges, whose length is 2.
    for i in 0..points.len() {
        for j in 0..i {
            if points[i].distance(points[j]) < 2.1 {
                points.push(points[i] + points[j]);
            }
        }
    }
    for point in &mut points {
        *point = point.normalize();
    }
    let (hull, _) = Polyhedron::from_vertices(&points)?;
    let scale = (USUAL * f64::from(edge).powi(3) / hull.volume()).cbrt();
    let vertices = points.iter().map(|p| (*p * scale).to_array()).collect();
    Ok(BlockShape::Vertices { vertices })
}
