//! A bar that hangs by a point of its upper face: V P = mg ⊗ X, which is the mean stress ρgL/2 and the elongation
//! ρgL²/2E of the exact solution.

use super::{
    super::rock::{DENSITY, G, Rock, cuboid, joint},
    ROCK, elastic,
};
use crate::validate::{Outcome, Stand};
use glam::DVec3;
use riprap::rock::{Block, Deformable, FixedPoint};

const LENGTH: f64 = 10.0;

/// Stress, elongation, support and energies at rest.
pub fn run(_: &Stand) -> Outcome {
    let top = DVec3::Z * (0.5 * LENGTH);
    let mut bar = Block::new("bar", cuboid(1.0, 0.8, LENGTH)?, DVec3::ZERO);
    bar.deformable = Some(Deformable {
        fixed_points: vec![FixedPoint {
            point: top,
            axes: [true; 3],
        }],
        ..Deformable::default()
    });
    let mut setup = elastic(vec![bar], joint(1e9, 30.0), ROCK);
    // Critical for the axial mode of a bar held at one end, ω = ½√(12E/ρ)/L.
    setup.damping = (12.0 * ROCK.youngs_modulus / DENSITY).sqrt() / LENGTH;
    let mut rock = Rock::new(setup, format!("{LENGTH} m, E = 1 GPa"))?;
    let start = rock.blocks.ledger();
    rock.run(0.3)?;
    let ledger = rock.blocks.ledger();
    let pose = rock.blocks.poses()[0];
    let stress = rock
        .blocks
        .stress(0)
        .map_or(f64::NAN, |stress| stress.z_axis.z);
    let support = rock.blocks.support(0).map_or(f64::NAN, |force| force.z);
    let mean = 0.5 * DENSITY * G * LENGTH;
    let longer = (pose.point(top) - pose.point(-top)).length() - LENGTH;
    let error = (ledger.balance() - start.balance()).abs() / ledger.taken();
    let trial = rock.trial();
    // Strains of 1.2e-4 set the stresses by area and by length apart.
    Ok(vec![
        trial.relative("mean stress, Pa", stress, mean, 5e-4),
        trial.relative(
            "elongation, m",
            longer,
            mean * LENGTH / ROCK.youngs_modulus,
            5e-4,
        ),
        trial.relative("support, N", support, rock.blocks.mass(0) * G, 1e-6),
        trial.at_most(
            "way of the fixed point, m",
            (pose.point(top) - top).length(),
            1e-12,
        ),
        trial.at_most("error of the energy / energy taken", error, 0.01),
    ])
}
