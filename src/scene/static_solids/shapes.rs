//! Cells inside boxes, half spaces and spheres.

use glam::DVec3;

use crate::scene::{Domain, Shape};

/// How near, in cells, a centre counts as lying on a surface: above the rounding of decimal
/// coordinates, below anything that matters.
const ON_SURFACE: f64 = 1e-6;

/// Calls `mark` for each cell whose centre lies inside `shape`. A mesh has none here.
pub(super) fn inside(shape: &Shape, domain: &Domain, mut mark: impl FnMut([u32; 3])) {
    let slack = ON_SURFACE * domain.cell;
    let [nx, ny, nz] = domain.cells();
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                if contains(shape, domain.centre([i, j, k]), slack) {
                    mark([i, j, k]);
                }
            }
        }
    }
}

/// Whether `shape` contains the point `x` in m; a point within `slack` m of a surface belongs to
/// the side of larger coordinates.
fn contains(shape: &Shape, x: [f64; 3], slack: f64) -> bool {
    match shape {
        Shape::Box { min, max } => (0..3).all(|a| min[a] - slack <= x[a] && x[a] < max[a] - slack),
        Shape::HalfSpace { point, normal } => {
            let normal = DVec3::from(*normal).normalize();
            (DVec3::from(x) - DVec3::from(*point)).dot(normal) < -slack
        }
        Shape::Sphere { center, radius } => {
            DVec3::from(x).distance(DVec3::from(*center)) < radius - slack
        }
        Shape::Mesh { .. } => false,
    }
}
