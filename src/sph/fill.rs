//! Initial fluid particles.

use super::{
    convex_part::ConvexPart, hydrostatic_start::HydrostaticStart, lattice::Lattice,
    spatial_hash::MIN_DISTANCE,
};
use crate::{
    Error, Result,
    geometry::Shape,
    scene::{
        Boundary, Face, Scene,
        build::{self, BlockSetup},
    },
};
use glam::DVec3;
use rayon::prelude::*;

/// Most particles of a body of water, far more than a device holds: a larger number is an input error.
const MAX_PARTICLES: f64 = 1e9;

/// Least distance of fluid particles from solids, in spacings: their distance from the first layer of boundary particles,
/// half a spacing deep, is then the least distance of boundary particles. Near a face inclined by 2° to 30° the water
/// fraction is 0.98 to 1 on average; with a clearance of half a spacing it would be 0.93.
const CLEARANCE: f64 = MIN_DISTANCE - 0.5;

/// Fluid particles at the time 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Start {
    /// Positions, m.
    pub positions: Vec<DVec3>,
    /// Velocities, m/s.
    pub velocities: Vec<DVec3>,
    /// Pressures, Pa: hydrostatic below the top of their body of water, or of the bodies that rest on it there; 0 in free
    /// fall.
    pub pressures: Vec<f64>,
}

/// The error of a scene without particles.
pub(super) fn no_particles() -> Error {
    Error::scene(
        "particles",
        "the scene has no particles; add [particles] with a spacing",
    )
}

/// A body of water and its pose.
struct WaterBody {
    shape: Shape,
    centre: DVec3,
    rotation: glam::DQuat,
}

/// The fluid particles of `scene` at the time 0: the lattice points inside a body of water, and at least Δx/10 outside of
/// all blocks. The lattice starts at the lower corner of the domain; a planar scene has one row in the middle.
///
/// # Errors
/// [`Error::Scene`] if the scene has no particles, or a body of water is outside the domain, overlaps another one, touches
/// an open face through which it would fall, or has no space for a particle.
pub fn fill(scene: &Scene, setup: &BlockSetup) -> Result<Start> {
    let Some(particles) = &scene.particles else {
        return Err(no_particles());
    };
    let lattice = Lattice::of(scene, particles);
    let blocks = &setup.setup.blocks;
    let parts = blocks
        .iter()
        .flat_map(|block| ConvexPart::with_images(block, &lattice));
    let solids: Vec<ConvexPart<'_>> = parts.collect();
    let mut bodies = Vec::with_capacity(scene.water.len());
    for (index, water) in scene.water.iter().enumerate() {
        let (shape, centroid) = build::shape(scene, &format!("water[{index}]"), &water.shape)?;
        let rotation = build::rotation(&water.rotation);
        bodies.push(WaterBody {
            shape,
            centre: DVec3::from(water.position) + rotation * centroid,
            rotation,
        });
    }
    let waters: Vec<Vec<ConvexPart<'_>>> = bodies
        .iter()
        .map(|body| ConvexPart::of_shape(&body.shape, body.centre, body.rotation))
        .collect();
    let gravity = gravity(scene);
    let mut start = Start::default();
    let mut filled = Vec::with_capacity(waters.len());
    for (index, water) in waters.iter().enumerate() {
        let key = format!("water[{index}]");
        check_inside(&key, water, &lattice)?;
        let mut points = points(&key, water, &solids, &lattice)?;
        if points.is_empty() {
            return Err(Error::scene(
                key,
                "no particle fits into it between the blocks; enlarge it, or use a smaller particles.spacing",
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
        // A point on the face between two bodies belongs to the first.
        points.retain(|x| deepest(x) < 0.0);
        check_open(scene, &key, &points, &lattice, gravity)?;
        let velocity = DVec3::from(scene.water[index].velocity);
        start
            .velocities
            .extend(std::iter::repeat_n(velocity, points.len()));
        filled.push(points);
    }
    let hydrostatic = HydrostaticStart {
        points: &filled,
        waters: &waters,
        solids: &solids,
        spacing: lattice.spacing,
        weight: scene.fluid.density * gravity,
    };
    start.pressures = hydrostatic.pressures();
    start.positions = filled.concat();
    Ok(start)
}

/// Sample points for the volume of a body of water that blocks displace. The error is about 1e-3 of the body, a tenth of
/// the threshold of the warning (an oblique plane cuts N points with an error of N^(−2/3), 4e-4).
const SAMPLES: u32 = 1 << 17;

/// Volume of all bodies of water of `scene` without the volume that blocks displace, m³. It is exact for a body whose
/// bounding box meets no block, and sampled otherwise.
pub(super) fn volume(scene: &Scene, setup: &BlockSetup) -> Result<f64> {
    let Some(particles) = &scene.particles else {
        return Err(no_particles());
    };
    let lattice = Lattice::of(scene, particles);
    let blocks = setup.setup.blocks.iter();
    let solids = blocks.flat_map(|block| ConvexPart::with_images(block, &lattice));
    let solids: Vec<ConvexPart<'_>> = solids.collect();
    let slack = lattice.tolerance();
    let mut volume = 0.0;
    for (index, water) in scene.water.iter().enumerate() {
        let (shape, centroid) = build::shape(scene, &format!("water[{index}]"), &water.shape)?;
        let rotation = build::rotation(&water.rotation);
        let centre = DVec3::from(water.position) + rotation * centroid;
        let parts = ConvexPart::of_shape(&shape, centre, rotation);
        let overlaps = |solid: &&ConvexPart<'_>| {
            let overlap = |part: &ConvexPart<'_>| {
                (solid.low + slack).cmplt(part.high).all()
                    && (solid.high - slack).cmpgt(part.low).all()
            };
            parts.iter().any(overlap)
        };
        let near: Vec<&ConvexPart<'_>> = solids.iter().filter(overlaps).collect();
        let fraction = if near.is_empty() {
            1.0
        } else {
            free_fraction(&parts, &near)
        };
        volume += fraction * shape.volume();
    }
    Ok(volume)
}

/// Fraction of a body of water outside all solids, by the low-discrepancy sequence of the generalised golden ratio
/// (Roberts 2018, R₃) in its bounding box.
fn free_fraction(water: &[ConvexPart<'_>], solids: &[&ConvexPart<'_>]) -> f64 {
    let empty = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = water.iter().fold(empty, |(low, high), part| {
        (low.min(part.low), high.max(part.high))
    });
    // x⁴ = x + 1.
    let golden = 1.220_744_084_605_759_5_f64;
    let steps = DVec3::new(golden.powi(-1), golden.powi(-2), golden.powi(-3));
    let sample = |n: u32| {
        let point = low + (0.5 + f64::from(n) * steps).fract() * (high - low);
        let wet = water.iter().any(|part| part.depth(point) >= 0.0);
        let contains = |solid: &&ConvexPart<'_>| {
            let in_box = point.cmpge(solid.low) & point.cmple(solid.high);
            in_box.all() && solid.depth(point) > 0.0
        };
        let free = wet && !solids.iter().any(contains);
        [u32::from(wet), u32::from(free)]
    };
    let samples = (0..SAMPLES).into_par_iter().map(sample);
    let [wet, free] = samples.reduce(|| [0; 2], |[a, b], [c, d]| [a + c, b + d]);
    f64::from(free) / f64::from(wet.max(1))
}

/// The acceleration that the hydrostatic pressure balances, m/s²; 0 along periodic axes.
fn gravity(scene: &Scene) -> DVec3 {
    let (_, gradient) = scene.hydrostatic();
    DVec3::from(gradient) / scene.fluid.density
}

/// The lattice points of a body of water, z slowest.
fn points(
    key: &str,
    water: &[ConvexPart<'_>],
    solids: &[ConvexPart<'_>],
    lattice: &Lattice,
) -> Result<Vec<DVec3>> {
    let low = water
        .iter()
        .fold(DVec3::INFINITY, |low, part| low.min(part.low));
    let high = water
        .iter()
        .fold(DVec3::NEG_INFINITY, |high, part| high.max(part.high));
    let size = ((high - low) / lattice.spacing).max(DVec3::ONE);
    if size.x * size.y * size.z > MAX_PARTICLES {
        return Err(Error::scene(
            "particles.spacing",
            format!(
                "{key} would have about {:.1e} particles, and at most {MAX_PARTICLES:.0e} are possible; use a larger spacing",
                size.x * size.y * size.z
            ),
        ));
    }
    let rows = [0, 1, 2].map(|axis| lattice.row(axis, [low[axis], high[axis]]));
    let clearance = CLEARANCE * lattice.spacing;
    let slab = |z: &f64| {
        let mut points = Vec::new();
        for y in &rows[1] {
            let is_near_row = |part: &&ConvexPart<'_>| {
                let near = |at: f64, axis: usize| {
                    at > part.low[axis] - clearance && at < part.high[axis] + clearance
                };
                near(*y, 1) && near(*z, 2)
            };
            let nearby: Vec<&ConvexPart<'_>> = solids.iter().filter(is_near_row).collect();
            for x in &rows[0] {
                let point = DVec3::new(*x, *y, *z);
                let wet = water.iter().any(|part| part.depth(point) >= 0.0);
                if wet && !nearby.iter().any(|part| part.is_near(point, clearance)) {
                    points.push(point);
                }
            }
        }
        points
    };
    let slabs: Vec<Vec<DVec3>> = rows[2].par_iter().map(slab).collect();
    Ok(slabs.concat())
}

/// Checks that the water is inside the domain.
fn check_inside(key: &str, water: &[ConvexPart<'_>], lattice: &Lattice) -> Result<()> {
    let slack = lattice.tolerance();
    for part in water {
        let outside = part.low.cmplt(lattice.low - slack) | part.high.cmpgt(lattice.high + slack);
        if outside.any() {
            return Err(Error::scene(
                key,
                format!(
                    "it extends from {} to {} m, and the domain from {} to {} m; cut it, or enlarge the domain",
                    part.low, part.high, lattice.low, lattice.high
                ),
            ));
        }
    }
    Ok(())
}

/// Checks that no water touches an open face that is not above it.
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
