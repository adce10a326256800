//! From a scene to its water.

use super::{Body, Neighbours, Scheme, Setup, Side, Start, StateEquation, fill, shells};
use crate::{
    Error, Result,
    bodies::{Block, Motion},
    scene::{self, Boundary, ProbePlace, Scene},
    simulation::BlockSetup,
};
use glam::DVec3;

/// The particles of a scene at the time 0, beside the walls and blocks of `blocks`.
///
/// # Errors
/// [`Error::Scene`] naming what is wrong with the scene.
pub fn particle_setup(scene: &Scene, blocks: &BlockSetup) -> Result<(Setup, Start)> {
    let Some(particles) = &scene.particles else {
        return Err(Error::scene("particles", "the scene has none"));
    };
    let start = fill(scene, blocks)?;
    let shells = match particles.scheme {
        scene::Scheme::Delta => shells(scene, blocks)?,
        // Its walls are springs.
        scene::Scheme::Mueller => vec![Vec::new(); blocks.setup.blocks.len()],
    };
    let probed = |name: &str| {
        let of =
            |place: &ProbePlace| matches!(place, ProbePlace::Block { block, .. } if block == name);
        scene.probes.iter().any(|probe| of(&probe.place))
    };
    let bodies = blocks
        .setup
        .blocks
        .iter()
        .zip(shells)
        .map(|(block, shell)| Body {
            shell,
            shape: Some(block.shape.clone()),
            moves: block.motion != Motion::Fixed,
            loaded: block.motion == Motion::Free || probed(&block.name),
            accelerates: matches!(block.motion, Motion::Driven { .. }),
        });
    let side = |boundary: &Boundary| match boundary {
        Boundary::Periodic => Side::Periodic,
        Boundary::Open => Side::Open,
        _ => Side::Wall,
    };
    let faces = &scene.boundaries;
    let sides = [
        [side(&faces.x_min), side(&faces.x_max)],
        [side(&faces.y_min), side(&faces.y_max)],
        [side(&faces.z_min), side(&faces.z_max)],
    ];
    let gravity = DVec3::from_array(
        [0, 1, 2].map(|axis| scene.fluid.acceleration[axis].eval_at([0.0; 3], 0.0)),
    );
    let fastest = largest_speed(scene, blocks, &start, gravity);
    let mut setup = Setup {
        origin: DVec3::from(scene.domain.origin),
        size: DVec3::from(scene.domain.size),
        faces: sides,
        spacing: particles.spacing,
        smoothing: particles.smoothing,
        sound_speed: match particles.scheme {
            scene::Scheme::Delta => scene::Particles::SOUND * fastest,
            scene::Scheme::Mueller => {
                let usual = scene::Particles::STIFFNESS * fastest.powi(2);
                particles.stiffness.unwrap_or(usual).sqrt()
            }
        },
        density: scene.fluid.density,
        gravity,
        artificial_viscosity: particles.artificial_viscosity,
        density_diffusion: particles.density_diffusion,
        courant: particles.courant,
        state: match particles.equation_of_state {
            scene::EquationOfState::Linear => StateEquation::Linear,
            scene::EquationOfState::Tait => StateEquation::Tait,
        },
        plane: particles.plane,
        scheme: Scheme::Delta,
        neighbours: Neighbours::Cells,
        bodies: bodies.collect(),
    };
    if particles.scheme == scene::Scheme::Mueller {
        let viscosity = match scene.fluid.viscosity {
            0.0 => setup.viscosity(),
            given => given,
        };
        setup.scheme = Scheme::Mueller { viscosity };
    }
    Ok((setup, start))
}

/// The largest speed that is expected, m/s: what the scene says, or that of a fall through the height of all
/// water, or of what moves at the start.
fn largest_speed(scene: &Scene, blocks: &BlockSetup, start: &Start, gravity: DVec3) -> f64 {
    if let Some(given) = scene
        .particles
        .as_ref()
        .and_then(|particles| particles.largest_speed)
    {
        return given;
    }
    let heights = start.positions.iter().map(|x| x.dot(gravity));
    let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), height| {
        (low.min(height), high.max(height))
    });
    // Half a spacing of water is above the highest particle and below the lowest.
    let spacing = scene
        .particles
        .as_ref()
        .map_or(0.0, |particles| particles.spacing);
    let fall = (2.0 * ((high - low).max(0.0) + spacing * gravity.length())).sqrt();
    let water = start.velocities.iter().map(|v| v.length());
    let length = scene.run.duration.unwrap_or(0.0);
    let blocks = blocks.setup.blocks.iter().map(|block| speed(block, length));
    water.chain(blocks).fold(fall, f64::max)
}

/// Moments of a run at which the speed of a driven block is looked at.
const MOMENTS: u32 = 1000;

/// The largest speed of a block that nothing pushes, in a run of `length` (s), m/s.
fn speed(block: &Block, length: f64) -> f64 {
    let of =
        |velocity: DVec3, spin: DVec3| velocity.length() + spin.length() * block.shape.radius();
    match &block.motion {
        Motion::Fixed => 0.0,
        Motion::Free => of(block.velocity, block.spin),
        Motion::Driven { velocity, spin } => {
            let moments = (0..=MOMENTS).map(|n| length * f64::from(n) / f64::from(MOMENTS));
            let at = |formulas: &[crate::formula::Formula; 3], time| {
                DVec3::from_array([0, 1, 2].map(|axis| formulas[axis].eval_at([0.0; 3], time)))
            };
            moments
                .map(|time| of(at(velocity, time), at(spin, time)))
                // Where a formula has no value the run ends, and says so.
                .filter(|speed| speed.is_finite())
                .fold(0.0, f64::max)
        }
    }
}
