//! Particles of the fluid at the start.

use super::{crowd::NEAREST, lattice::Lattice, placed::Placed, standing::Standing};
use crate::{
    Error, Result,
    block::Shape,
    scene::{Boundary, Face, Scene},
    simulation::{self, BlockSetup},
};
use glam::DVec3;
use rayon::prelude::*;

/// Most particles that are made: far more than a device holds, so a slip of the pen.
const MOST: f64 = 1e9;

/// Least distance of water from solids, of the spacing: its particles then keep from the first layer of shells,
/// which is half a spacing deep, as shells do from each other. The room beside an oblique face is on average
/// what a particle has elsewhere: at 2° to 30° the kernel finds 0.98 to 1 beside it, and 0.93 if water kept half
/// a spacing off.
const CLEARANCE: f64 = NEAREST - 0.5;

/// Particles of the fluid at the time 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Start {
    /// Where they are, m.
    pub positions: Vec<DVec3>,
    /// Velocities, m/s.
    pub velocities: Vec<DVec3>,
    /// Pressures, Pa: that of their depth below the top of their body of water, or of what stands on it there; 0 in one
    /// that falls freely.
    pub pressures: Vec<f64>,
}

/// The error of a scene without particles.
pub(super) fn none() -> Error {
    Error::scene(
        "particles",
        "the scene has no particles; add [particles] with a spacing",
    )
}

/// A body of water and where it is.
struct Body {
    shape: Shape,
    centre: DVec3,
    rotation: glam::DQuat,
}

/// The particles of `scene` at the time 0: the points of the lattice from the lower corner of the domain that
/// lie in a body of water, and neither in a block nor nearer than Δx/10 to one.
///
/// In a plane, those of the row in the middle of the domain.
///
/// # Errors
/// If the scene has no particles, water lies outside the domain, in other water, at an open face through
/// which it would fall, or has no room at all.
pub fn fill(scene: &Scene, setup: &BlockSetup) -> Result<Start> {
    let Some(particles) = &scene.particles else {
        return Err(none());
    };
    let lattice = Lattice::of(scene, particles);
    let blocks = &setup.setup.blocks;
    let seen = blocks
        .iter()
        .flat_map(|block| Placed::seen(block, &lattice));
    let solids: Vec<Placed<'_>> = seen.collect();
    let mut bodies = Vec::with_capacity(scene.water.len());
    for (index, water) in scene.water.iter().enumerate() {
        let (shape, centroid) = simulation::shape(scene, &format!("water[{index}]"), &water.shape)?;
        let rotation = simulation::rotation(&water.rotation);
        bodies.push(Body {
            shape,
            centre: DVec3::from(water.position) + rotation * centroid,
            rotation,
        });
    }
    let waters: Vec<Vec<Placed<'_>>> = bodies
        .iter()
        .map(|body| Placed::parts(&body.shape, body.centre, body.rotation))
        .collect();
    let gravity = gravity(scene);
    let mut start = Start::default();
    let mut filled = Vec::with_capacity(waters.len());
    for (index, water) in waters.iter().enumerate() {
        let key = format!("water[{index}]");
        check_place(&key, water, &lattice)?;
        let mut points = points(&key, water, &solids, &lattice)?;
        if points.is_empty() {
            return Err(Error::scene(
                key,
                "no particle has room in it beside the blocks; enlarge it, or use a smaller particles.spacing",
            ));
        }
        let deepest = |x: &DVec3| {
            let others = waters[..index].iter().flatten();
            others
                .map(|other| other.depth(*x))
                .fold(f64::NEG_INFINITY, f64::max)
        };
        if let Some(point) = points.iter().find(|x| deepest(x) > lattice.tolerance()) {
            return Err(Error::scene(
                key,
                format!("it overlaps other water at {point} m; move one of them, or cut it"),
            ));
        }
        // What lies on the face between two bodies is in the first.
        points.retain(|x| deepest(x) < 0.0);
        check_open(scene, &key, &points, &lattice, gravity)?;
        let velocity = DVec3::from(scene.water[index].velocity);
        start
            .velocities
            .extend(std::iter::repeat_n(velocity, points.len()));
        filled.push(points);
    }
    let standing = Standing {
        points: &filled,
        waters: &waters,
        solids: &solids,
        spacing: lattice.spacing,
        weight: scene.fluid.density * gravity,
    };
    start.pressures = standing.pressures();
    start.positions = filled.concat();
    Ok(start)
}

/// Volume of all bodies of water of `scene`, m³; none where a block stands in the box around one.
pub(super) fn volume(scene: &Scene, setup: &BlockSetup) -> Result<Option<f64>> {
    let solids = setup.setup.blocks.iter().flat_map(Placed::of);
    let solids: Vec<Placed<'_>> = solids.collect();
    let slack = 1e-6 * scene.particles.as_ref().map_or(0.0, |p| p.spacing);
    let mut volume = 0.0;
    for (index, water) in scene.water.iter().enumerate() {
        let (shape, centroid) = simulation::shape(scene, &format!("water[{index}]"), &water.shape)?;
        let rotation = simulation::rotation(&water.rotation);
        let centre = DVec3::from(water.position) + rotation * centroid;
        let is_met = |part: &Placed<'_>| {
            let meets = |solid: &Placed<'_>| {
                (solid.low + slack).cmplt(part.high).all()
                    && (solid.high - slack).cmpgt(part.low).all()
            };
            solids.iter().any(meets)
        };
        if Placed::parts(&shape, centre, rotation).iter().any(is_met) {
            return Ok(None);
        }
        volume += shape.volume();
    }
    Ok(Some(volume))
}

/// The acceleration that pressure balances, m/s²: along a period, nothing stands against it.
fn gravity(scene: &Scene) -> DVec3 {
    let (_, gradient) = scene.hydrostatic();
    DVec3::from(gradient) / scene.fluid.density
}

/// The lattice points of a body of water, z slowest.
fn points(
    key: &str,
    water: &[Placed<'_>],
    solids: &[Placed<'_>],
    lattice: &Lattice,
) -> Result<Vec<DVec3>> {
    let low = water
        .iter()
        .fold(DVec3::INFINITY, |low, part| low.min(part.low));
    let high = water
        .iter()
        .fold(DVec3::NEG_INFINITY, |high, part| high.max(part.high));
    let room = ((high - low) / lattice.spacing).max(DVec3::ONE);
    if room.x * room.y * room.z > MOST {
        return Err(Error::scene(
            "particles.spacing",
            format!(
                "{key} would be about {:.1e} particles, and at most {MOST:.0e} are made; use a larger spacing",
                room.x * room.y * room.z
            ),
        ));
    }
    let rows = [0, 1, 2].map(|axis| lattice.row(axis, [low[axis], high[axis]]));
    let free = CLEARANCE * lattice.spacing;
    let slab = |z: &f64| {
        let mut points = Vec::new();
        for y in &rows[1] {
            let beside = |part: &&Placed<'_>| {
                let near = |at: f64, axis: usize| {
                    at > part.low[axis] - free && at < part.high[axis] + free
                };
                near(*y, 1) && near(*z, 2)
            };
            let beside: Vec<&Placed<'_>> = solids.iter().filter(beside).collect();
            for x in &rows[0] {
                let point = DVec3::new(*x, *y, *z);
                let wet = water.iter().any(|part| part.depth(point) >= 0.0);
                if wet && !beside.iter().any(|part| part.is_near(point, free)) {
                    points.push(point);
                }
            }
        }
        points
    };
    let slabs: Vec<Vec<DVec3>> = rows[2].par_iter().map(slab).collect();
    Ok(slabs.concat())
}

/// Water is in the domain.
fn check_place(key: &str, water: &[Placed<'_>], lattice: &Lattice) -> Result<()> {
    let slack = lattice.tolerance();
    for part in water {
        let out = part.low.cmplt(lattice.low - slack) | part.high.cmpgt(lattice.high + slack);
        if out.any() {
            return Err(Error::scene(
                key,
                format!(
                    "it reaches from {} to {} m, and the domain from {} to {} m; cut it, or enlarge the domain",
                    part.low, part.high, lattice.low, lattice.high
                ),
            ));
        }
    }
    Ok(())
}

/// No water stands at an open face that is not above it.
fn check_open(
    scene: &Scene,
    key: &str,
    points: &[DVec3],
    lattice: &Lattice,
    gravity: DVec3,
) -> Result<()> {
    for (face, boundary) in scene.boundaries.iter() {
        let axis = face.axis().index();
        if *boundary != Boundary::Open || face.outward() * gravity[axis] < 0.0 {
            continue;
        }
        let at = scene.domain.face_position(face);
        let touches = |x: &DVec3| (x[axis] - at).abs() < lattice.spacing;
        if points.iter().any(touches) {
            return Err(Error::scene(
                key,
                format!(
                    "it touches the open face {}, through which it would leave at once; give that face kind = \
                     \"wall\", or end the water before it",
                    Face::name(face)
                ),
            ));
        }
    }
    Ok(())
}
