//! The particle setup of a scene.

use super::{BlockSetup, rotation, shape};
use crate::{
    Error, Result,
    rock::{Block, Motion},
    scene::{self, Boundary, Face, Scene, build::keys::particle_key},
    sph::{
        self, EquationOfState, NeighbourSearch, ParticleLattice, Scheme, Setup, Side,
        SpeedEstimate, Start, WaterBody,
    },
};
use glam::DVec3;

/// Bisection steps for the length of a run: to a millionth of the initial interval.
const BISECTIONS: u32 = 20;

/// Largest number of acoustic steps in a step of the scene. The water takes a whole number of equal steps, so rounding wastes
/// at most a tenth of them unless outputs require shorter steps of the scene.
const ACOUSTIC_STEPS: f64 = 10.0;
/// Deviation of the number of steps of a run from a whole number that counts as rounding, relative.
const ROUNDING: f64 = 1e-6;

/// The setup and the initial particles of a scene with the walls and blocks of `blocks`.
///
/// # Errors
/// [`Error::Scene`] naming the invalid key or block.
pub fn particle_setup(scene: &Scene, blocks: &BlockSetup) -> Result<(Setup, Start)> {
    let particles = particles(scene)?;
    let lattice = particle_lattice(scene)?;
    let mut start = fill(scene, blocks)?;
    let scheme = match particles.scheme {
        scene::Scheme::Delta => Scheme::Delta,
        // Set below.
        scene::Scheme::Mueller => Scheme::Mueller { viscosity: 0.0 },
    };
    let boundary = match scheme {
        Scheme::Delta => boundary_particles(scene, blocks)?,
        // This scheme has penalty walls.
        Scheme::Mueller { .. } => vec![Vec::new(); blocks.setup.blocks.len()],
    };
    let free_slip = |(face, boundary): (Face, &Boundary)| {
        matches!(boundary, Boundary::FreeSlip).then(|| format!("wall_{}", face.name()))
    };
    let free_slip: Vec<String> = scene.boundaries.iter().filter_map(free_slip).collect();
    let all = &blocks.setup.blocks;
    let is_probed = |block: &Block| scene.probes_block(&block.name);
    let mut bodies = sph::bodies(all, boundary, &lattice, scheme, is_probed);
    for (body, block) in bodies.iter_mut().zip(all) {
        body.free_slip = free_slip.contains(&block.name);
    }
    let gravity = DVec3::from_array(
        [0, 1, 2].map(|axis| scene.fluid.acceleration[axis].eval_at([0.0; 3], 0.0)),
    );
    let mut setup = Setup {
        origin: DVec3::from(scene.domain.origin),
        size: DVec3::from(scene.domain.size),
        faces: lattice.faces,
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
        scheme,
        neighbours: NeighbourSearch::Cells,
        batched_neighbours: false,
        bodies,
    };
    let speeds = SpeedEstimate::new(&start.positions, particles.spacing, gravity);
    let of_water = speeds.of_start(&start);
    let sound_speed = |length: f64| {
        let fastest = largest_speed(particles, all, of_water, &speeds.over(length));
        match particles.scheme {
            scene::Scheme::Delta => Setup::SOUND_RATIO * fastest,
            scene::Scheme::Mueller => {
                let default = Setup::STIFFNESS_RATIO * fastest.powi(2);
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
    if particles.scheme == scene::Scheme::Delta {
        // Along periodic axes there is no floor.
        let (_, weight) = scene.hydrostatic();
        start.compress(&lattice, weight.into(), |p| setup.excess(p));
    }
    start.add_disorder(particles.disorder, &lattice, setup.density * gravity);
    Ok((setup, start))
}

/// The particle settings of a scene.
fn particles(scene: &Scene) -> Result<&scene::Particles> {
    scene.particles.as_ref().ok_or_else(|| {
        Error::scene(
            "particles",
            "the scene has no particles; add [particles] with a spacing",
        )
    })
}

/// The initial lattice of the particles of a scene.
///
/// # Errors
/// [`Error::Scene`] if the scene has no particles.
pub fn particle_lattice(scene: &Scene) -> Result<ParticleLattice> {
    let particles = particles(scene)?;
    let side = |boundary: &Boundary| match boundary {
        Boundary::Periodic => Side::Periodic,
        Boundary::Open => Side::Open,
        _ => Side::Wall,
    };
    let faces = &scene.boundaries;
    Ok(ParticleLattice {
        low: DVec3::from(scene.domain.origin),
        high: DVec3::from(scene.domain.end()),
        spacing: particles.spacing,
        layers: particles.layers(),
        faces: [
            [side(&faces.x_min), side(&faces.x_max)],
            [side(&faces.y_min), side(&faces.y_max)],
            [side(&faces.z_min), side(&faces.z_max)],
        ],
        plane: particles.plane,
    })
}

/// The bodies of water of a scene.
///
/// # Errors
/// [`Error::Scene`] naming the body whose shape is invalid.
pub fn water_bodies(scene: &Scene) -> Result<Vec<WaterBody>> {
    let bodies = scene.water.iter().enumerate();
    let bodies = bodies.map(|(index, water)| {
        let (shape, centroid) = shape(scene, &format!("water[{index}]"), &water.shape)?;
        let rotation = rotation(&water.rotation);
        Ok(WaterBody {
            shape,
            centre: DVec3::from(water.position) + rotation * centroid,
            rotation,
            velocity: DVec3::from(water.velocity),
        })
    });
    bodies.collect()
}

/// The fluid particles of a scene at the time 0 ([`sph::fill`]).
///
/// # Errors
/// [`Error::Scene`] if the scene has no particles, or a body of water has an invalid shape or place.
pub fn fill(scene: &Scene, blocks: &BlockSetup) -> Result<Start> {
    let (_, gradient) = scene.hydrostatic();
    let density = scene.fluid.density;
    sph::fill(
        &particle_lattice(scene)?,
        &water_bodies(scene)?,
        &blocks.setup.blocks,
        density,
        DVec3::from(gradient) / density,
    )
    .map_err(|error| error.at_key(particle_key))
}

/// The boundary particles of the blocks of a scene ([`sph::boundary_particles`]).
///
/// # Errors
/// [`Error::Scene`] if the scene has no particles, or naming the block that cannot carry boundary particles.
pub fn boundary_particles(scene: &Scene, blocks: &BlockSetup) -> Result<Vec<Vec<DVec3>>> {
    let walls = blocks.in_fluid + scene.solids.len();
    sph::boundary_particles(&particle_lattice(scene)?, &blocks.setup.blocks, walls)
        .map_err(|error| error.at_key(particle_key))
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

/// The largest expected speed, m/s: the one that the scene gives, otherwise that of the water (`of_water`, m/s) and of driven
/// and free blocks.
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

/// Length of a step of `scene`, s: at most ten acoustic steps of `acoustic` s. The duration of the run is a whole number of
/// steps, and so is the shortest interval of its outputs if the duration allows it.
pub(crate) fn scene_step(scene: &Scene, acoustic: f64) -> f64 {
    let longest = ACOUSTIC_STEPS * acoustic;
    let step = match scene.shortest_interval() {
        // Several intervals per step: no step is shorter than the speed of sound requires.
        Some(every) if every < acoustic => every * (acoustic / every).floor(),
        Some(every) => every / (every / longest).ceil(),
        None => longest,
    };
    let Some(duration) = scene.run.duration else {
        return step;
    };
    let steps = duration / step;
    let whole = steps.round().max(1.0);
    match (steps - whole).abs() < ROUNDING * whole {
        true => duration / whole,
        // The run ends exactly at its duration.
        false => duration / steps.ceil(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step(duration: f64, every: &str) -> f64 {
        let text = format!(
            r#"domain.size = [2, 2, 2]
            fluid.acceleration = [0, 0, -9.81]
            particles.spacing = 0.1
            water = [{{ kind = "box", size = [1, 1, 0.5], position = [0.5, 0.5, 0.25] }}]
            run.duration = {duration}
            {every}"#
        );
        let scene = Scene::from_toml(&text, ".".as_ref(), "scene.toml").expect("a scene");
        scene_step(&scene, 1e-3)
    }

    #[test]
    fn outputs_come_when_they_are_asked_for() {
        let close = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
        // No outputs at intervals.
        assert!(close(step(1.0, ""), 0.01));
        assert!(close(step(1.005, ""), 1.005 / 101.0));
        // Every 25 ms in three steps, every 3 ms in one step, every 0.4 ms as often as the speed of sound allows.
        assert!(close(step(1.0, "output.every = 0.025"), 0.025 / 3.0));
        assert!(close(step(3.0, "output.every = 0.003"), 0.003));
        assert!(close(step(1.0, "output.every = 0.0004"), 0.0008));
        // The run ends exactly at its duration.
        assert!(close(step(1.0, "output.every = 0.003"), 1.0 / 334.0));
    }
}
