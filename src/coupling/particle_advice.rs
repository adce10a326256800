//! Warnings about water that particles resolve poorly.

use super::{Gap, gaps::gaps};
use crate::{
    Result,
    geometry::{Form, Placed, min_max},
    rock::{Block, Blocks, Motion, broadphase::HostBroadphase, formula_values},
    scene::{
        Advice, Probe, ProbePlace, Scene, Shape, Warning,
        build::{BlockSetup, particle_lattice, scene_step, water_bodies},
    },
    sph::{ConvexPart, Scheme, Setup, Side, SpeedEstimate, is_reached, water_volume},
};
use glam::DVec3;

/// Least number of particles over the depth that resolves waves and pressure: at 25 a standing wave loses a few percent of
/// its height per period.
const MIN_DEPTH_PARTICLES: f64 = 10.0;

/// Tolerated relative difference between the mass of the particles and that of the bodies of water.
const MASS_TOLERANCE: f64 = 0.01;

/// Ratio of the long-wave speed to the largest expected speed above which still water is 4 % denser at its bottom.
const MAX_WAVE_SPEED_RATIO: f64 = 2.0;

/// Tolerated ratio of the fall speed of a block to the largest expected speed. The fall speed is an upper bound, which
/// friction and water reduce.
const FALL_SPEED_RATIO: f64 = 1.5;

/// Young's modulus over ρ₀c₀² of the water, and density over that of the water, below which a deformable block is excited by the
/// water: cubes were at 5 and 1.2, and not at 17 or 1.5.
const SOFT: f64 = 10.0;
const LIGHT: f64 = 1.5;

/// Difference of the size of a tank, or of the position of a face, from a whole number of spacings from which the water starts too
/// far from the wall, or too near.
const WALL_TOLERANCE: f64 = 0.05;

/// Warnings about the water of `scene` with the particle setup `setup`: `positions` (m) are the initial positions of the
/// particles, `state` the initial state of `blocks`.
///
/// # Errors
/// [`crate::Error::Scene`] if a body of water has an invalid shape; errors of the search for gaps.
pub async fn particle_advice(
    scene: &Scene,
    blocks: &BlockSetup,
    state: &Blocks,
    setup: &Setup,
    positions: &[DVec3],
) -> Result<Advice> {
    let mut advice = Advice::new();
    let mut warn = |place: String, message: String| advice.push(Warning { place, message });
    let spacing = setup.spacing;
    if let Some(up) = (-setup.gravity).try_normalize() {
        let [low, high] = min_max(positions.iter().map(|x| up.dot(*x)));
        // At the start the water is compressed by its weight.
        let particles = ((high - low) / spacing).round() + 1.0;
        if particles < MIN_DEPTH_PARTICLES {
            warn(
                "particles.spacing".into(),
                format!(
                    "the water is {particles:.0} particles deep, and waves need {MIN_DEPTH_PARTICLES} at least; use a spacing of \
                     {:.2e} m",
                    spacing * particles / MIN_DEPTH_PARTICLES
                ),
            );
        }
    }
    check_mass(scene, blocks, setup, positions.len(), &mut warn)?;
    check_walls(setup, positions, &mut warn);
    check_faces(scene, blocks, state, setup, positions, &mut warn);
    check_support(scene, blocks, setup, &mut warn);
    check_soft_blocks(blocks, setup, &mut warn);
    check_speeds(scene, blocks, setup, positions, &mut warn);
    check_probes(scene, blocks, setup, positions, &mut warn);
    let free = || {
        let all = blocks.setup.blocks.iter();
        all.filter(|block| block.motion == Motion::Free)
    };
    let gravity = DVec3::from(scene.rock.gravity);
    if free().next().is_some() && gravity.distance(setup.gravity) > 1e-6 * gravity.length() {
        warn(
            "fluid.acceleration".into(),
            format!(
                "is {} m/s² for the water, and rock.gravity is {gravity} m/s² for the blocks; buoyancy is wrong unless \
                 they are equal",
                setup.gravity
            ),
        );
    }
    check_thin_blocks(scene, blocks, setup, &mut warn);
    let mut broadphase = HostBroadphase;
    let width = 2.0 * spacing;
    let mut narrow = gaps(
        &blocks.setup,
        state,
        blocks.in_fluid,
        width,
        &mut broadphase,
    )
    .await?;
    narrow.retain(|gap| !gap.is_closed(spacing));
    let least = |a: &&Gap, b: &&Gap| a.width.total_cmp(&b.width);
    if let Some(narrowest) = narrow.iter().min_by(least) {
        let [first, second] = narrowest
            .blocks
            .map(|block| blocks.setup.blocks[block].name.as_str());
        warn(
            "particles.spacing".into(),
            format!(
                "gaps between blocks narrower than two spacings: {}, the narrowest of {:.2e} m between `{first}` and \
                 `{second}`: they hold one layer of particles at most, and none below half a spacing; close them, or use \
                 a smaller spacing",
                narrow.len(),
                narrowest.width
            ),
        );
    }
    Ok(advice)
}

/// Warns if the mass of the particles differs from that of the bodies of water.
fn check_mass(
    scene: &Scene,
    blocks: &BlockSetup,
    setup: &Setup,
    particles: usize,
    warn: &mut impl FnMut(String, String),
) -> Result<()> {
    let volume = water_volume(
        &particle_lattice(scene)?,
        &water_bodies(scene)?,
        &blocks.setup.blocks,
    );
    let expected = setup.density * volume;
    let mass = setup.particle_mass() * particles as f64;
    if (mass / expected - 1.0).abs() > MASS_TOLERANCE {
        warn(
            "particles.spacing".into(),
            format!(
                "the particles are {mass:.4} kg of water, and its bodies hold {expected:.4} kg outside the blocks; place the \
                 sides of water and blocks at whole numbers of spacings from the lower corner of the domain, or use \
                 a smaller spacing"
            ),
        );
    }
    Ok(())
}

/// Warns if the last particles before a wall are not half a spacing from it.
fn check_walls(setup: &Setup, positions: &[DVec3], warn: &mut impl FnMut(String, String)) {
    for axis in (0..3).filter(|&axis| !(setup.plane && axis == 1)) {
        if setup.faces[axis][0] == Side::Periodic {
            continue;
        }
        let (size, spacing) = (setup.size[axis], setup.spacing);
        let end = setup.origin[axis] + size;
        let last = min_max(positions.iter().map(|x| x[axis]))[1];
        let count = size / spacing;
        let apart = (count - count.round()).abs();
        if apart > WALL_TOLERANCE
            && end - last < 1.5 * spacing
            && setup.faces[axis][1] != Side::Open
        {
            warn(
                format!("domain.size[{axis}]"),
                format!(
                    "{size} m are {count:.2} particles: the water starts {:.2} of a spacing from the upper wall instead of half of \
                     one, and sloshes; use {:.4} or {:.4} m, or a spacing that divides the size",
                    (end - last) / spacing,
                    count.floor() * spacing,
                    count.ceil() * spacing
                ),
            );
        }
    }
}

/// Warns of deformable blocks that are so soft and light that the pressures of successive exchanges excite their strain.
fn check_soft_blocks(blocks: &BlockSetup, setup: &Setup, warn: &mut impl FnMut(String, String)) {
    let modulus = SOFT * setup.density * setup.sound_speed.powi(2);
    let is_unstable = |block: &&Block| {
        let material = &blocks.setup.materials[block.material];
        let elastic = material.elastic.filter(|_| block.deformable.is_some());
        elastic.is_some_and(|elastic| elastic.youngs_modulus < modulus)
            && material.density < LIGHT * setup.density
    };
    if let Some(block) = blocks.setup.blocks.iter().find(is_unstable) {
        warn(
            "particles".into(),
            format!(
                "`{}` deforms, is soft, and is not much denser than the water: its strain and the pressure of the water excite each \
                 other; take a Young's modulus of {modulus:.1e} Pa at least, or a density of {:.0} kg/m³, or make it rigid",
                block.name,
                LIGHT * setup.density
            ),
        );
    }
}

/// Warns of blocks and solids thinner than the support of the kernel function, across which water interacts.
fn check_thin_blocks(
    scene: &Scene,
    blocks: &BlockSetup,
    setup: &Setup,
    warn: &mut impl FnMut(String, String),
) {
    let support = f64::from(setup.layers()) * setup.spacing;
    let least = support - 1e-6 * setup.spacing;
    let all = &blocks.setup.blocks;
    let obstacles = all.iter().filter(|block| block.motion != Motion::Free);
    let obstacles: Vec<_> = obstacles.flat_map(ConvexPart::of_block).collect();
    let is_reached = |at: DVec3, outward: DVec3| {
        let front = at + 0.25 * setup.spacing * outward;
        let near = |part: &&ConvexPart<'_>| part.is_near(front, 0.0);
        is_reached(setup, &[], front, DVec3::ZERO) && obstacles.iter().find(near).is_none()
    };
    // Half of the thickness in the direction of a face, if the part is thin there.
    let thin_faces = |part: &ConvexPart<'_>| -> Vec<(DVec3, f64)> {
        let planes = part.planes().into_iter().filter_map(|plane| {
            let half = -plane.height(part.centre);
            // The ends of a prism in a planar scene do not touch water.
            let is_end = setup.plane && plane.normal.y.abs() > 0.5;
            (2.0 * half < least && !is_end).then_some((plane.normal, half))
        });
        match part.form {
            Form::Sphere { radius } if 2.0 * radius < least => vec![(DVec3::Z, *radius)],
            _ => planes.collect(),
        }
    };
    // Floors and walls have water on one side.
    let is_between = |part: &ConvexPart<'_>| {
        thin_faces(part).into_iter().any(|(normal, half)| {
            [normal, -normal]
                .into_iter()
                .all(|outward| is_reached(part.centre + half * outward, outward))
        })
    };
    // Pieces of terrain reach down to its lower face; only their sides are close to each other.
    let is_terrain = |index: usize| {
        let solid = scene.solids.get(index.wrapping_sub(blocks.in_fluid));
        solid.is_some_and(|solid| matches!(solid.shape, Shape::Terrain { .. }))
    };
    let is_thin = |index: usize| {
        let mut parts = ConvexPart::of_block(&all[index]).into_iter();
        match all[index].motion {
            Motion::Free => parts.all(|part| !thin_faces(&part).is_empty()),
            _ => !is_terrain(index) && parts.any(|part| is_between(&part)),
        }
    };
    // The walls of the domain follow the solids.
    let found = (0..blocks.in_fluid + scene.solids.len()).filter(|index| is_thin(*index));
    let names: Vec<&str> = found.map(|index| all[index].name.as_str()).collect();
    if let Some(first) = names.first() {
        warn(
            "particles.spacing".into(),
            format!(
                "{} blocks, `{first}` the first, are thinner than the {support:.2e} m of the kernel support, so water interacts \
                 across them, and leaks through moving ones; use a smaller spacing",
                names.len()
            ),
        );
    }
}

/// Warns of a face of a block that is not free, among those along the axes: the one farthest from a whole number of spacings.
fn check_faces(
    scene: &Scene,
    blocks: &BlockSetup,
    state: &Blocks,
    setup: &Setup,
    positions: &[DVec3],
    warn: &mut impl FnMut(String, String),
) {
    let spacing = setup.spacing;
    let (mut farthest, mut message) = (WALL_TOLERANCE, None);
    let all = blocks.setup.blocks.iter().zip(state.poses());
    let all = all.take(blocks.in_fluid + scene.solids.len());
    for (block, pose) in all.filter(|(block, _)| block.motion != Motion::Free) {
        for part in block.shape.parts() {
            let placed = Placed::of(part, &pose);
            let corners = |axis: usize| {
                min_max(
                    placed
                        .vertices
                        .iter()
                        .map(|v| placed.centre[axis] + v[axis]),
                )
            };
            let bounds = [0, 1, 2].map(corners);
            for face in &placed.faces {
                let along = |axis: &usize| face.normal[*axis].abs() > 1.0 - 1e-9;
                let Some(axis) = (0..3).find(along).filter(|&a| !(setup.plane && a == 1)) else {
                    continue;
                };
                let side = face.normal[axis].signum();
                let at = placed.centre[axis] + side * face.distance;
                let count = (at - setup.origin[axis]) / spacing;
                let off = (count - count.round()).abs();
                if off <= farthest {
                    continue;
                }
                let before = positions.iter().filter(|x| {
                    let within = |a: usize| bounds[a][0] < x[a] && x[a] < bounds[a][1];
                    (0..3).all(|a| a == axis || within(a))
                });
                let gaps = before
                    .map(|x| side * (x[axis] - at))
                    .filter(|gap| *gap > 0.0);
                let [gap, _] = min_max(gaps);
                if gap < 1.5 * spacing {
                    let lower = setup.origin[axis] + count.floor() * spacing;
                    farthest = off;
                    message = Some(format!(
                        "`{}` has a face at {} = {at:.4} m, {count:.2} spacings from the lower corner of the domain: the water starts \
                         {:.2} of a spacing from it instead of half of one, and circulates there for some time; {lower:.4} or {:.4} m \
                         are whole numbers of spacings",
                        block.name,
                        ["x", "y", "z"][axis],
                        gap / spacing,
                        lower + spacing
                    ));
                }
            }
        }
    }
    if let Some(message) = message {
        warn("particles.spacing".into(), message);
    }
}

/// Warns if nothing supports the water against gravity.
fn check_support(
    scene: &Scene,
    blocks: &BlockSetup,
    setup: &Setup,
    warn: &mut impl FnMut(String, String),
) {
    // Walls brake a viscous flow.
    let brakes = setup.laminar_viscosity > 0.0 && setup.faces.as_flattened().contains(&Side::Wall);
    let falls = |axis: usize| setup.faces[axis][0] == Side::Periodic || setup.gravity[axis] == 0.0;
    // Walls follow the blocks and solids in the list.
    let supports = blocks
        .setup
        .blocks
        .iter()
        .take(blocks.in_fluid + scene.solids.len());
    let mut supports = supports.filter(|block| block.motion != Motion::Free);
    if !brakes && setup.gravity != DVec3::ZERO && (0..3).all(falls) && supports.next().is_none() {
        warn(
            "boundaries".into(),
            format!(
                "gravity, {} m/s², acts along periodic axes, and no block opposes it: the water falls for ever; give the \
                 lower face kind = \"wall\", or add a bed below the water",
                formula_values(&scene.fluid.acceleration, 0.0)
            ),
        );
    }
}

/// Warns if the water or a block is too fast, or the water too deep, for the speed of sound.
fn check_speeds(
    scene: &Scene,
    blocks: &BlockSetup,
    setup: &Setup,
    positions: &[DVec3],
    warn: &mut impl FnMut(String, String),
) {
    let expected = setup.largest_speed();
    let length = scene.run.length(scene_step(scene, setup.acoustic_step()));
    let speeds = SpeedEstimate::new(positions, setup.spacing, setup.gravity).over(length);
    let wave_speed = speeds.of_water() / std::f64::consts::SQRT_2;
    if setup.scheme == Scheme::Delta && wave_speed > MAX_WAVE_SPEED_RATIO * expected {
        let compression = (wave_speed / setup.sound_speed).powi(2);
        warn(
            "particles.largest_speed".into(),
            format!(
                "is {expected:.3} m/s for the speed of sound, and the water is so deep that at rest it would be {:.0} % \
                 denser at its bottom; give {:.3} m/s",
                100.0 * compression,
                speeds.of_water()
            ),
        );
    }
    let fastest = |free: bool| {
        let all = blocks.setup.blocks.iter();
        let all = all.filter(|block| (block.motion == Motion::Free) == free);
        let all = all.map(|block| (speeds.of_block(block), block.name.as_str()));
        all.max_by(|a, b| a.0.total_cmp(&b.0))
    };
    for (free, ratio, verb) in [
        (false, 1.0, "is driven at"),
        (true, FALL_SPEED_RATIO, "may fall at"),
    ] {
        let too_fast = fastest(free).filter(|(speed, _)| *speed > 1.001 * ratio * expected);
        if let Some((speed, name)) = too_fast {
            warn(
                "particles.largest_speed".into(),
                format!(
                    "is {expected:.3} m/s for the speed of sound, and block `{name}` {verb} up to {speed:.3} m/s, Mach \
                     {:.2}: its impact compresses the water; give {speed:.3} m/s",
                    speed / setup.sound_speed
                ),
            );
        }
    }
}

/// Warns about probes that water cannot reach.
fn check_probes(
    scene: &Scene,
    blocks: &BlockSetup,
    setup: &Setup,
    positions: &[DVec3],
    warn: &mut impl FnMut(String, String),
) {
    let fixed = blocks.setup.blocks.iter();
    let fixed = fixed.filter(|block| block.motion == Motion::Fixed);
    let fixed: Vec<(&str, ConvexPart<'_>)> = fixed
        .flat_map(|block| {
            ConvexPart::of_block(block)
                .into_iter()
                .map(|part| (block.name.as_str(), part))
        })
        .collect();
    let inside = |x: DVec3| {
        let found = fixed.iter().find(|(_, part)| part.depth(x) > 0.0);
        found.map(|(name, _)| *name)
    };
    let solids: Vec<_> = fixed.iter().map(|(_, part)| part.clone()).collect();
    let [low, high] = min_max(positions.iter().map(|x| x.z));
    for (index, probe) in scene.probes.iter().enumerate() {
        let block = match &probe.place {
            ProbePlace::Point { at } => inside(DVec3::from(*at)),
            // Half a spacing in front of its wall.
            ProbePlace::Sensor { at, normal, .. } => {
                inside(DVec3::from(*at) + 0.5 * setup.spacing * normal.vector())
            }
            // The whole column up to the top of the water.
            ProbePlace::Gauge { at: [x, y] } => {
                let count = ((high - low) / setup.spacing).ceil() as u32;
                let column = (0..=count).map(|n| {
                    let z = low + f64::from(n) * setup.spacing;
                    inside(DVec3::new(*x, *y, z.min(high)))
                });
                let column: Option<Vec<&str>> = column.collect();
                column.and_then(|names| names.first().copied())
            }
            _ => None,
        };
        let fault = match block {
            Some(block) => Some(format!(
                "`{}` is inside block `{block}`, which water cannot reach; move the probe",
                probe.name
            )),
            None => sensor_fault(probe, &solids, setup),
        };
        if let Some(message) = fault {
            warn(format!("probes[{index}].at"), message);
        }
    }
}

/// What is wrong with the place of a sensor, if anything. `solids`: the fixed blocks.
fn sensor_fault(probe: &Probe, solids: &[ConvexPart<'_>], setup: &Setup) -> Option<String> {
    let ProbePlace::Sensor { at, normal, .. } = &probe.place else {
        return None;
    };
    let (name, outward) = (&probe.name, normal.vector());
    let behind = DVec3::from(*at) - 0.5 * setup.spacing * outward;
    let tolerance = 1e-6 * setup.spacing;
    let on_wall = !is_reached(setup, &[], behind, DVec3::ZERO)
        || solids.iter().any(|part| part.depth(behind) > -tolerance);
    if !on_wall {
        return Some(format!(
            "sensor `{name}` is not on a wall of the domain or a fixed block, and shows the pressure of the water around \
             it in part; move it, or use a point probe, or the probe of a free block"
        ));
    }
    let patch = probe.place.patch(setup.spacing, setup.plane);
    let reached = patch
        .iter()
        .filter(|position| is_reached(setup, solids, **position, outward));
    let left_out = patch.len() - reached.count();
    (left_out > 0 && left_out < patch.len()).then(|| {
        format!(
            "{:.0} % of the patch of sensor `{name}` is inside fixed blocks or outside the domain, and is left out of its \
             mean; if the face is oblique to the patch, the rest is in front of it: give a smaller `size`",
            100.0 * left_out as f64 / patch.len() as f64
        )
    })
}
