//! A wedge on two planes (Goodman & Shi 1985): it slides along their line of intersection if its factor
//! of safety, (N₁ tan φ₁ + N₂ tan φ₂)/(W sin ψ), is below one.

use crate::fixture::{blocks, joint, run, settled, setup};
use glam::DVec3;
use riprap::{
    geometry::{HalfSpace, Polyhedron},
    rock::{Block, Material, PairMaterial, Setup},
};
use std::sync::Arc;

const STIFFNESS: f64 = 1e9;
const G: f64 = 9.81;

/// Two planes: dip, dip direction, friction angle, degrees.
pub type Planes = [[f64; 3]; 2];

/// Upward normal of a plane; x east, y north.
fn normal([dip, direction, _]: [f64; 3]) -> DVec3 {
    let (dip, direction) = (dip.to_radians(), direction.to_radians());
    DVec3::new(
        dip.sin() * direction.sin(),
        dip.sin() * direction.cos(),
        dip.cos(),
    )
}

/// Down the line of intersection; the normal forces over the weight; the factor of safety.
fn statics(planes: &Planes) -> (DVec3, [f64; 2], f64) {
    let [n1, n2] = planes.map(normal);
    let mut line = n1.cross(n2).normalize();
    line *= -line.z.signum();
    // Across the line, N₁n₁ + N₂n₂ carries the weight.
    let up = DVec3::Z - line * line.z;
    let cos = n1.dot(n2);
    let det = 1.0 - cos * cos;
    let [a, b] = [up.dot(n1), up.dot(n2)];
    let forces = [(a - cos * b) / det, (b - cos * a) / det];
    let held: f64 = (0..2)
        .map(|k| forces[k] * planes[k][2].to_radians().tan())
        .sum();
    (line, forces, held / -line.z)
}

/// A prism along the line of intersection on two slabs, pressed in as it will be.
pub fn on_planes(planes: &Planes, tan_phi: [f64; 2]) -> Setup {
    let normals = planes.map(normal);
    let (line, forces, _) = statics(planes);
    let up = (normals[0] + normals[1]).normalize();
    let face = |normal: DVec3, distance: f64| HalfSpace { normal, distance };
    let (wedge, at) = Polyhedron::from_half_spaces(&[
        face(-normals[0], 0.0),
        face(-normals[1], 0.0),
        face(up, 1.0),
        face(line, 1.0),
        face(-line, 1.0),
    ])
    .expect("a prism");
    let weight = 2500.0 * G * wedge.volume();
    let area = |face: usize| {
        let corner = |i: usize| wedge.vertices()[wedge.loops()[face][i] as usize];
        let part = |i: usize| (corner(i) - corner(0)).cross(corner(i + 1) - corner(0));
        let parts = (1..wedge.loops()[face].len() - 1).map(part);
        0.5 * parts.sum::<DVec3>().length()
    };
    let pressed = [0, 1].map(|k| {
        let on_plane = |f: &HalfSpace| f.normal.dot(normals[k]) < -1.0 + 1e-9;
        let face = wedge
            .faces()
            .iter()
            .position(on_plane)
            .expect("a face on the plane");
        weight * forces[k] / (STIFFNESS * area(face))
    });
    // n₁·d = −u₁, n₂·d = −u₂.
    let cos = normals[0].dot(normals[1]);
    let det = 1.0 - cos * cos;
    let sink = -normals[0] * ((pressed[0] - cos * pressed[1]) / det)
        - normals[1] * ((pressed[1] - cos * pressed[0]) / det);
    let slab = |k: usize| {
        let n = normals[k];
        let across = line.cross(n);
        let sides = [line, -line, across, -across].map(|side| face(side, 6.0));
        let top = [face(n, 0.0), face(-n, 1.0)];
        let all: Vec<_> = sides.into_iter().chain(top).collect();
        let (slab, at) = Polyhedron::from_half_spaces(&all).expect("a slab");
        let block = Block::new(format!("slab {k}"), Arc::new(slab.into()), at);
        Block {
            material: k + 1,
            ..block.fixed()
        }
    };
    let wedge = Block::new("wedge", Arc::new(wedge.into()), at + sink);
    let joints = tan_phi.map(|t| joint(STIFFNESS, t.atan().to_degrees()));
    let mut setup = setup(vec![slab(0), slab(1), wedge], joints[0]);
    setup.materials = vec![setup.materials[0]; 3];
    setup
        .materials
        .iter_mut()
        .for_each(|m: &mut Material| m.density = 2500.0);
    setup.pairs = (0..2)
        .map(|k| PairMaterial {
            materials: [0, k + 1],
            joint: joints[k],
        })
        .collect();
    setup
}

/// Way down the line in 1 s with a factor of safety of `safety`, m: tan φ of both planes scaled to it.
fn way(planes: &Planes, safety: f64) -> f64 {
    let (line, _, real) = statics(planes);
    let tan_phi = planes.map(|plane| plane[2].to_radians().tan() * safety / real);
    let held = settled(&on_planes(planes, [2.0, 2.0]), 300.0, 0.1);
    let mut blocks = blocks(on_planes(planes, tan_phi));
    blocks.restore(&held).expect("the same blocks");
    let start = blocks.poses()[2].centre;
    run(&mut blocks, held.time() + 1.0);
    (blocks.poses()[2].centre - start).dot(line)
}

fn check(planes: &Planes, safety: f64) {
    let (line, _, real) = statics(planes);
    assert!((real - safety).abs() < 1e-4, "FS = {real}");
    let slips = way(planes, 0.99);
    // ½ g sin ψ (1 − FS) t².
    let exact = 0.5 * G * -line.z * 0.01;
    assert!((slips / exact - 1.0).abs() < 0.02, "{slips} m, {exact} m");
    let holds = way(planes, 1.01);
    assert!(holds.abs() < 1e-5, "{holds} m");
}

#[test]
fn a_symmetric_wedge() {
    check(&[[50.0, 120.0, 30.0], [50.0, 240.0, 30.0]], 1.2949);
}

#[test]
fn a_skew_wedge() {
    let planes = [[45.0, 105.0, 20.0], [70.0, 235.0, 30.0]];
    let (line, ..) = statics(&planes);
    assert!(((-line.z).asin().to_degrees() - 31.1965).abs() < 1e-4);
    check(&planes, 1.10662);
}
