//! The particle setup of a scene.

use super::{
    Body, EquationOfState, NeighbourSearch, Scheme, Setup, Side, Start, boundary_particles,
    convex_part::ConvexPart, fill, lattice::Lattice, solid, speed_estimate::SpeedEstimate,
};
use crate::{
    Error, Result,
    rock::{Block, Motion},
    scene::{self, Boundary, Face, Scene, build::BlockSetup},
    simulation::scene_step,
};
use glam::DVec3;

/// Bisection steps for the length of a run: to a millionth of the initial interval.
const BISECTIONS: u32 = 20;

/// The setup and the initial particles of a scene with the walls and blocks of `blocks`.
///
/// # Errors
/// [`Error::Scene`] naming the invalid key or block.
pub fn particle_setup(scene: &Scene, blocks: &BlockSetup) -> Result<(Setup, Start)> {
    let Some(particles) = &scene.particles else {
        return Err(Error::scene(
            "particles",
            "the scene has no particles; add [particles] with a spacing",
        ));
    };
    let mut start = fill(scene, blocks)?;
    let boundary = match particles.scheme {
        scene::Scheme::Delta => boundary_particles(scene, blocks)?,
        // This scheme has penalty walls.
        scene::Scheme::Mueller => vec![Vec::new(); blocks.setup.blocks.len()],
    };
    let free_slip = |(face, boundary): (Face, &Boundary)| {
        matches!(boundary, Boundary::FreeSlip).then(|| format!("wall_{}", face.name()))
    };
    let free_slip: Vec<String> = scene.boundaries.iter().filter_map(free_slip).collect();
    let all = &blocks.setup.blocks;
    let boundary = transfer_interior(all, boundary, |block| scene.probes_block(&block.name));
    let lattice = Lattice::of(scene, particles);
    let mut solids = solid::solids(all, &lattice);
    if particles.scheme == scene::Scheme::Delta {
        solid::mark_covered_faces(all, &mut solids, &lattice);
    }
    let bodies = all.iter().zip(boundary).zip(solids);
    let bodies = bodies.map(|((block, boundary), solids)| Body {
        boundary,
        solids: solids
            .into_iter()
            .map(|solid| solid.in_body_frame(block))
            .collect(),
        moves: block.motion != Motion::Fixed,
        // The energy ledger needs the loads on all moving bodies.
        loaded: block.motion != Motion::Fixed || scene.probes_block(&block.name),
        accelerates: matches!(block.motion, Motion::Driven { .. }),
        free_slip: free_slip.contains(&block.name),
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
    let mut setup = Setup {
        origin: DVec3::from(scene.domain.origin),
        size: DVec3::from(scene.domain.size),
        faces: sides,
        spacing: particles.spacing,
        smoothing: particles.smoothing,
        // Set below.
        sound_speed: 0.0,
        density: scene.fluid.density,
        gravity,
        laminar_viscosity: match particles.scheme {
            scene::Scheme::Delta => scene.fluid.viscosity,
            scene::Scheme::Mueller => 0.0,
        },
        artificial_viscosity: particles.artificial_viscosity,
        density_diffusion: particles.density_diffusion,
        courant: particles.courant,
        equation_of_state: match particles.equation_of_state {
            scene::EquationOfState::Linear => EquationOfState::Linear,
            scene::EquationOfState::Tait => EquationOfState::Tait,
        },
        plane: particles.plane,
        scheme: Scheme::Delta,
        neighbours: NeighbourSearch::Cells,
        bodies: bodies.collect(),
    };
    let speeds = SpeedEstimate::new(&start.positions, particles.spacing, gravity);
    let of_water = speeds.of_start(&start);
    let sound_speed = |length: f64| {
        let fastest = largest_speed(particles, all, of_water, &speeds.over(length));
        match particles.scheme {
            scene::Scheme::Delta => scene::Particles::SOUND * fastest,
            scene::Scheme::Mueller => {
                let default = scene::Particles::STIFFNESS * fastest.powi(2);
                particles.stiffness.unwrap_or(default).sqrt()
            }
        }
    };
    let length = run_length(&scene.run, |length| {
        setup.sound_speed = sound_speed(length);
        scene_step(scene, setup.acoustic_step())
    });
    setup.sound_speed = sound_speed(length);
    check_driven_speeds(all, &speeds.over(length), setup.sound_speed)?;
    if particles.scheme == scene::Scheme::Mueller {
        let viscosity = match scene.fluid.viscosity {
            0.0 => setup.viscosity(),
            given => given,
        };
        setup.scheme = Scheme::Mueller { viscosity };
    }
    add_disorder(
        &mut start,
        particles.disorder,
        &lattice,
        setup.density * gravity,
    );
    Ok((setup, start))
}

/// Displaces particles under pressure by at most `disorder` spacings along each axis, because a regular lattice under
/// pressure resists shear, and adapts their pressures with the specific `weight` (N/m³).
fn add_disorder(start: &mut Start, disorder: f64, lattice: &Lattice, weight: DVec3) {
    let pressures = start.pressures.iter_mut().enumerate();
    for (index, pressure) in pressures.filter(|(_, pressure)| **pressure > 0.0) {
        let displacement = disorder * lattice.jitter(index);
        start.positions[index] += displacement;
        *pressure += weight.dot(displacement);
    }
}

/// Transfers the boundary particles that a fixed block with a load probe (`is_probed`) has inside adjacent walls to a
/// fixed block without one, so that the load on the probed block acts on its own surface only.
fn transfer_interior(
    blocks: &[Block],
    mut boundary: Vec<Vec<DVec3>>,
    is_probed: impl Fn(&Block) -> bool,
) -> Vec<Vec<DVec3>> {
    let is_fixed = |block: &Block| block.motion == Motion::Fixed;
    let takes = |block: &Block| is_fixed(block) && !is_probed(block);
    let Some(target) = blocks.iter().position(takes) else {
        return boundary;
    };
    for (n, block) in blocks.iter().enumerate() {
        if !is_fixed(block) || !is_probed(block) {
            continue;
        }
        let parts = ConvexPart::of_block(block);
        let world = |x: &DVec3| block.centre + block.rotation * *x;
        let is_own = |x: &DVec3| parts.iter().any(|part| part.depth(world(x)) > 0.0);
        let (kept, beyond): (Vec<_>, Vec<_>) = boundary[n].iter().copied().partition(is_own);
        boundary[n] = kept;
        let to = &blocks[target];
        let moved = beyond
            .iter()
            .map(|x| to.rotation.inverse() * (world(x) - to.centre));
        boundary[target].extend(moved);
    }
    boundary
}

/// Length of a run, s. `step` gives the time step (s) for a run of a given length (s): in a longer run driven blocks may
/// become faster, which requires a higher speed of sound and a shorter step.
fn run_length(run: &scene::Run, mut step: impl FnMut(f64) -> f64) -> f64 {
    if let Some(duration) = run.duration {
        return duration;
    }
    let mut length_of = |length| run.length(step(length));
    let (mut low, mut high) = (0.0, length_of(0.0));
    if !high.is_finite() {
        // Nothing moves, so the speed of sound is 0.
        return 0.0;
    }
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if length_of(middle) > middle {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

/// The largest expected speed, m/s: the one that the scene gives, or else that of the water (m/s) and of driven and free
/// blocks.
fn largest_speed(
    particles: &scene::Particles,
    blocks: &[Block],
    of_water: f64,
    speeds: &SpeedEstimate,
) -> f64 {
    let blocks = blocks.iter().map(|block| speeds.of_block(block));
    let expected = || blocks.fold(of_water, f64::max);
    particles.largest_speed.unwrap_or_else(expected)
}

/// Checks that all driven blocks are slower than sound in the water.
fn check_driven_speeds(blocks: &[Block], speeds: &SpeedEstimate, sound_speed: f64) -> Result<()> {
    if sound_speed <= 0.0 {
        return Err(Error::scene(
            "particles.largest_speed",
            "nothing flows, falls or is driven, so the speed of sound is undetermined; give the largest expected \
             speed, m/s",
        ));
    }
    let driven = |block: &&Block| matches!(block.motion, Motion::Driven { .. });
    for block in blocks.iter().filter(driven) {
        let speed = speeds.of_block(block);
        if speed < sound_speed {
            continue;
        }
        let place = format!("block {}", block.name);
        let message = if speed.is_finite() {
            format!(
                "is driven at up to {speed:.3} m/s, faster than sound in the water ({sound_speed:.3} m/s); drive it more \
                 slowly, or set particles.largest_speed to {speed:.3} at least"
            )
        } else {
            format!("is driven at {speed} m/s at some time of the run; correct the formula")
        };
        return Err(Error::scene(place, message));
    }
    Ok(())
}
