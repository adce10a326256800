//! From a scene to its water.

use super::{
    Body, Neighbours, Scheme, Setup, Side, Start, StateEquation, fill, lattice::Lattice,
    placed::Placed, shells, solid, speeds::Speeds,
};
use crate::{
    Error, Result,
    bodies::{Block, Motion},
    scene::{self, Boundary, Face, Scene},
    simulation::{BlockSetup, scene_step},
};
use glam::DVec3;

/// How often the range is halved in which the length of a run lies: to a millionth of it.
const HALVINGS: u32 = 20;

/// The particles of a scene at the time 0, beside the walls and blocks of `blocks`.
///
/// # Errors
/// [`Error::Scene`] naming what is wrong with the scene.
pub fn particle_setup(scene: &Scene, blocks: &BlockSetup) -> Result<(Setup, Start)> {
    let Some(particles) = &scene.particles else {
        return Err(Error::scene("particles", "the scene has none"));
    };
    let mut start = fill(scene, blocks)?;
    let shells = match particles.scheme {
        scene::Scheme::Delta => shells(scene, blocks)?,
        // Its walls are springs.
        scene::Scheme::Mueller => vec![Vec::new(); blocks.setup.blocks.len()],
    };
    let free_slip = |(face, boundary): (Face, &Boundary)| {
        matches!(boundary, Boundary::FreeSlip).then(|| format!("wall_{}", face.name()))
    };
    let slippery: Vec<String> = scene.boundaries.iter().filter_map(free_slip).collect();
    let all = &blocks.setup.blocks;
    let shells = own(all, shells, |block| scene.probes_block(&block.name));
    let lattice = Lattice::of(scene, particles);
    let mut solids = solid::solids(all, &lattice);
    if particles.scheme == scene::Scheme::Delta {
        solid::join(all, &mut solids, &lattice);
    }
    let bodies = all.iter().zip(shells).zip(solids);
    let bodies = bodies.map(|((block, shell), solids)| Body {
        shell,
        solids: solids.into_iter().map(|s| s.seen_from(block)).collect(),
        moves: block.motion != Motion::Fixed,
        // The work of what moves is booked.
        loaded: block.motion != Motion::Fixed || scene.probes_block(&block.name),
        accelerates: matches!(block.motion, Motion::Driven { .. }),
        slips: slippery.contains(&block.name),
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
        // See below.
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
        state: match particles.equation_of_state {
            scene::EquationOfState::Linear => StateEquation::Linear,
            scene::EquationOfState::Tait => StateEquation::Tait,
        },
        plane: particles.plane,
        scheme: Scheme::Delta,
        neighbours: Neighbours::Cells,
        bodies: bodies.collect(),
    };
    let speeds = Speeds::new(&start.positions, particles.spacing, gravity);
    let of_water = speeds.of_start(&start);
    let sound_speed = |length: f64| {
        let fastest = largest_speed(particles, all, of_water, &speeds.over(length));
        match particles.scheme {
            scene::Scheme::Delta => scene::Particles::SOUND * fastest,
            scene::Scheme::Mueller => {
                let usual = scene::Particles::STIFFNESS * fastest.powi(2);
                particles.stiffness.unwrap_or(usual).sqrt()
            }
        }
    };
    let length = length(&scene.run, |length| {
        setup.sound_speed = sound_speed(length);
        scene_step(scene, setup.acoustic_step())
    });
    setup.sound_speed = sound_speed(length);
    check(all, &speeds.over(length), setup.sound_speed)?;
    if particles.scheme == scene::Scheme::Mueller {
        let viscosity = match scene.fluid.viscosity {
            0.0 => setup.viscosity(),
            given => given,
        };
        setup.scheme = Scheme::Mueller { viscosity };
    }
    disturb(
        &mut start,
        particles.disorder,
        &lattice,
        setup.density * gravity,
    );
    Ok((setup, start))
}

/// Moves what stands by `disorder` spacings at most along each axis from its lattice, which under pressure resists shear, and
/// gives it the pressure there, under so much weight (N/m³).
fn disturb(start: &mut Start, disorder: f64, lattice: &Lattice, weight: DVec3) {
    let pressures = start.pressures.iter_mut().enumerate();
    for (number, pressure) in pressures.filter(|(_, pressure)| **pressure > 0.0) {
        let way = disorder * lattice.aside(number);
        start.positions[number] += way;
        *pressure += weight.dot(way);
    }
}

/// The shells of blocks without what fixed ones have in the walls that they stand at: it counts there, so that the load on a
/// block that is `asked` about is what the water does to its own surface. Fixed blocks that nobody asks about keep it.
fn own(
    blocks: &[Block],
    mut shells: Vec<Vec<DVec3>>,
    asked: impl Fn(&Block) -> bool,
) -> Vec<Vec<DVec3>> {
    let fixed = |block: &Block| block.motion == Motion::Fixed;
    let other = |block: &Block| fixed(block) && !asked(block);
    let Some(heir) = blocks.iter().position(other) else {
        return shells;
    };
    for (n, block) in blocks.iter().enumerate() {
        if !fixed(block) || !asked(block) {
            continue;
        }
        let parts = Placed::of(block);
        let world = |x: &DVec3| block.centre + block.rotation * *x;
        let is_own = |x: &DVec3| parts.iter().any(|part| part.depth(world(x)) > 0.0);
        let (kept, beyond): (Vec<_>, Vec<_>) = shells[n].iter().copied().partition(is_own);
        shells[n] = kept;
        let to = &blocks[heir];
        let moved = beyond
            .iter()
            .map(|x| to.rotation.inverse() * (world(x) - to.centre));
        shells[heir].extend(moved);
    }
    shells
}

/// Length of a run, s, whose steps are as long as `step` has them (s) with the sound of a run so long (s). The longer it is,
/// the faster driven blocks may become by its end, and the shorter are its steps.
fn length(run: &scene::Run, mut step: impl FnMut(f64) -> f64) -> f64 {
    if let Some(duration) = run.duration {
        return duration;
    }
    let mut lasts = |length| run.length(step(length));
    let (mut low, mut high) = (0.0, lasts(0.0));
    if !high.is_finite() {
        // Nothing moves yet, and sound has no speed.
        return 0.0;
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if lasts(middle) > middle {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

/// The largest speed that is expected, m/s: what the scene says, or that of the water (m/s), or of what is driven or falls.
fn largest_speed(
    particles: &scene::Particles,
    blocks: &[Block],
    of_water: f64,
    speeds: &Speeds,
) -> f64 {
    let blocks = blocks.iter().map(|block| speeds.of(block));
    let expected = || blocks.fold(of_water, f64::max);
    particles.largest_speed.unwrap_or_else(expected)
}

/// Water can make way for all that is driven.
fn check(blocks: &[Block], speeds: &Speeds, sound_speed: f64) -> Result<()> {
    if sound_speed <= 0.0 {
        return Err(Error::scene(
            "particles.largest_speed",
            "nothing flows, falls or is driven, from which a speed of sound would follow; give the largest speed that \
             is expected, m/s",
        ));
    }
    let driven = |block: &&Block| matches!(block.motion, Motion::Driven { .. });
    for block in blocks.iter().filter(driven) {
        let speed = speeds.of(block);
        if speed < sound_speed {
            continue;
        }
        let place = format!("block {}", block.name);
        return Err(match speed.is_finite() {
            true => Error::scene(
                place,
                format!(
                    "is driven at up to {speed:.3} m/s, and sound in the water has {sound_speed:.3} m/s: water cannot \
                     make way; drive it more slowly, or give particles.largest_speed {speed:.3} at least"
                ),
            ),
            false => Error::scene(
                place,
                format!("is driven at {speed} m/s at some moment of the run; mend the formula"),
            ),
        });
    }
    Ok(())
}
