//! Polyhedra for tests, in cells.

use crate::tiling::rotation;
use glam::{DQuat, DVec3, Vec3Swizzles};
use kit::Random;
use riprap::geometry::{HalfSpace, Polyhedron};

fn of(normals: impl IntoIterator<Item = DVec3>, distance: f64) -> Polyhedron {
    let face = |n: DVec3| HalfSpace {
        normal: n.normalize(),
        distance,
    };
    let faces: Vec<_> = normals.into_iter().map(face).collect();
    Polyhedron::from_half_spaces(&faces).unwrap().0
}

pub fn cuboid(x: f64, y: f64, z: f64) -> Polyhedron {
    Polyhedron::cuboid(DVec3::new(x, y, z)).unwrap()
}

/// A regular tetrahedron with the given edge.
pub fn tetrahedron(edge: f64) -> Polyhedron {
    let signs = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]];
    let normals = signs.map(|s| -DVec3::from_array(s.map(f64::from)));
    of(normals, edge / 24f64.sqrt())
}

/// A regular icosahedron with the given distance between opposite faces.
pub fn icosahedron(across: f64) -> Polyhedron {
    let golden = (1.0 + 5f64.sqrt()) / 2.0;
    let signs = [-1.0, 1.0];
    let mut normals = Vec::new();
    for a in signs {
        for b in signs {
            normals.extend(signs.map(|c| DVec3::new(a, b, c)));
            let pair = DVec3::new(0.0, a / golden, b * golden);
            normals.extend([pair, pair.yzx(), pair.zxy()]);
        }
    }
    of(normals, across / 2.0)
}

/// A polyhedron of tangent planes of a ball in `faces` evenly distributed directions.
pub fn pebble(faces: usize, radius: f64) -> Polyhedron {
    // Points on a spiral with the golden angle.
    let turn = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let normals = (0..faces).map(|k| {
        let z = 1.0 - (2 * k + 1) as f64 / faces as f64;
        let (s, c) = (turn * k as f64).sin_cos();
        let rho = (1.0 - z * z).sqrt();
        DVec3::new(rho * c, rho * s, z)
    });
    of(normals, radius)
}

/// Random rotations, and those in which planes lie along the grid or through its edges.
pub fn rotations(random: usize, noise: &mut Random) -> Vec<DQuat> {
    let eighth = std::f64::consts::FRAC_PI_4;
    let mut all = vec![
        DQuat::IDENTITY,
        DQuat::from_rotation_x(eighth),
        DQuat::from_rotation_y(eighth),
        DQuat::from_rotation_z(eighth),
        // Almost along the grid.
        DQuat::from_rotation_z(1e-3),
        DQuat::from_rotation_x(2e-4) * DQuat::from_rotation_y(1e-5),
    ];
    all.extend((0..random).map(|_| rotation(noise)));
    all
}
