//! Blocks that deform as a whole (Mikola & Sitar 2014, §2), against exact solutions of affine bodies.

pub mod bar;
pub mod contact;
pub mod critical_step;
pub mod rigid_limit;
pub mod spin;
pub mod vibration;

use super::rock::{DENSITY, setup};
use glam::{DMat3, DVec3};
use riprap::rock::{
    Block, Setup,
    integrate::{Affine, Wrench},
    law::{Elastic, Joint},
};

/// Rock as soft as tuff.
pub const ROCK: Elastic = Elastic {
    youngs_modulus: 1e9,
    poissons_ratio: 0.25,
};

/// Blocks of one material with this elasticity.
pub fn elastic(blocks: Vec<Block>, joint: Joint, elastic: Elastic) -> Setup {
    let mut setup = setup(blocks, joint);
    setup.materials[0].elastic = Some(elastic);
    setup
}

/// A box of these edges (m) alone.
pub fn alone(edges: DVec3) -> Affine {
    let volume = edges.x * edges.y * edges.z;
    let squares = edges * edges;
    let inertia = DVec3::splat(squares.element_sum()) - squares;
    let inertia = DMat3::from_diagonal(inertia * (volume / 12.0));
    Affine::new(volume, inertia, DENSITY, ROCK, DMat3::ZERO)
}

/// A free step of `dt` (s) by the central difference.
pub fn step(body: &Affine, f: &mut DMat3, rate: &mut DMat3, dt: f64) {
    let free = Wrench {
        force: DVec3::ZERO,
        moment: DMat3::ZERO,
    };
    *rate += body.accelerations(*f, &free).1 * (0.5 * dt);
    *f += *rate * dt;
    *rate += body.accelerations(*f, &free).1 * (0.5 * dt);
}

/// Frobenius norm.
pub fn norm(a: DMat3) -> f64 {
    let squares = a.to_cols_array().map(|x| x * x);
    squares.iter().sum::<f64>().sqrt()
}
