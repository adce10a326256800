//! Blocks of one material on a slope.

use glam::DQuat;
use riprap::rock::{Block, Material, Setup, law::Joint};

/// Density of the blocks, kg/m³.
pub const DENSITY: f64 = 2500.0;

/// A rotation about y that tilts x downwards by `degrees`.
pub fn slope(degrees: f64) -> DQuat {
    DQuat::from_rotation_y(degrees.to_radians())
}

/// A joint with the same stiffness in both directions, Pa/m, and the friction angle in degrees.
pub fn joint(stiffness: f64, degrees: f64) -> Joint {
    Joint {
        normal_stiffness: stiffness,
        shear_stiffness: stiffness,
        friction_angle: degrees.to_radians(),
        ..Joint::default()
    }
}

/// Blocks of one material.
pub fn setup(blocks: Vec<Block>, joint: Joint) -> Setup {
    Setup {
        blocks,
        materials: vec![Material {
            density: DENSITY,
            joint,
            elastic: None,
        }],
        ..Setup::default()
    }
}
