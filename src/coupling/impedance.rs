//! How long blocks may go without news of the water around them.

use super::Rock;
use crate::{
    block::{Form, Shape},
    bodies::{Motion, Pose},
    immersed::{area_of, corners},
    integrate::Principal,
};
use glam::{DMat3, DQuat, DVec3};
use std::f64::consts::PI;

/// Share of its speed that the pressure of a plane wave of sound may take from a block from one exchange to the next: it
/// would come to rest at 1, and swing ever more above 2.
const SHARE: f64 = 1.0;
/// A block that deforms yields more easily: 3 ρ c A/m for two opposite faces A of a box that move apart.
const YIELDING: f64 = 3.0;

/// Σ A n⊗n over the surface of a shape, that of all its parts, m².
fn section(shape: &Shape) -> DMat3 {
    let pose = Pose::rigid(DVec3::ZERO, DQuat::IDENTITY, DVec3::ZERO, DVec3::ZERO);
    let faces = shape.parts().iter().map(|part| match &part.form {
        Form::Sphere { radius } => {
            DMat3::from_diagonal(DVec3::splat(4.0 * PI / 3.0 * radius * radius))
        }
        Form::Convex(of) => (0..of.faces().len())
            .map(|face| {
                let (_, area) = area_of(&corners(of, face, part.offset, &pose));
                let normal = area.normalize_or_zero();
                DMat3::from_cols(area * normal.x, area * normal.y, area * normal.z)
            })
            .fold(DMat3::ZERO, |sum, face| sum + face),
    });
    faces.fold(DMat3::ZERO, |sum, part| sum + part)
}

/// Longest time between two exchanges of free blocks with water whose acoustic impedance ρc is `impedance` (kg/m²s), s;
/// infinite without such blocks. Water takes the speed of a block as it was for that long, so that a light one would be
/// thrown to and fro by the sound that it makes.
pub fn longest_exchange(rock: &Rock, impedance: f64) -> f64 {
    let blocks = rock.setup().setup.blocks.iter().enumerate();
    let free = blocks.filter(|(_, block)| block.motion == Motion::Free);
    free.map(|(number, block)| {
        let across = Principal::of(section(&block.shape)).moments.max_element();
        let ease = if block.deformable.is_some() {
            YIELDING
        } else {
            1.0
        };
        SHARE * rock.blocks().mass(number) / (ease * impedance * across)
    })
    .fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::Polyhedron;

    #[test]
    fn a_box_offers_its_sides_and_a_sphere_a_third_of_its_surface_each_way() {
        let sides = DVec3::new(1.0, 2.0, 3.0);
        let box_ = Shape::from(Polyhedron::cuboid(sides).expect("a box"));
        let moments = section(&box_).to_cols_array();
        for (found, exact) in moments
            .iter()
            .zip([12.0, 0.0, 0.0, 0.0, 6.0, 0.0, 0.0, 0.0, 4.0])
        {
            assert!((found - exact).abs() < 1e-12, "{moments:?}");
        }
        let ball = section(&Shape::sphere(0.5).expect("a sphere"));
        assert!((ball.x_axis.x - PI / 3.0).abs() < 1e-12);
    }
}
