//! Initial fluid particles, and the hydrostatic pressures of water that rests on solids or on other water.

use super::{
    Side,
    particle_lattice::{MIN_DISTANCE, ParticleLattice},
    solid::ConvexPart,
};
use crate::{
    Error, Result,
    geometry::{Shape, bounding_box},
    rock::Block,
};
use glam::{DQuat, DVec3};
use rayon::prelude::*;

/// Largest number of particles in a body of water, far more than a device holds: a larger number is an input error.
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

impl Start {
    /// Moves particles along the axis of the `weight` (N/m³) towards the solids below them until each has the volume of its density:
    /// `excess` gives the density excess ρ/ρ₀ − 1 at a pressure (Pa). The pressures, those of the water above, remain.
    ///
    /// If particles had the volume of the reference density, the sum over V (p_i + p_j) ∇W would balance their weight only at a
    /// pressure that is higher by the fraction 2gh/c² at the depth h.
    pub fn compress(
        &mut self,
        lattice: &ParticleLattice,
        weight: DVec3,
        excess: impl Fn(f64) -> f64,
    ) {
        let axis = weight.abs().max_position();
        let up = -weight[axis].signum();
        let (aside, across) = ((axis + 1) % 3, (axis + 2) % 3);
        let place = |x: &DVec3| {
            let x = ((*x - lattice.low) / lattice.spacing).floor();
            (x[aside] as i64, x[across] as i64, (up * x[axis]) as i64)
        };
        let places: Vec<_> = self.positions.iter().map(place).collect();
        let mut order: Vec<usize> = (0..places.len()).collect();
        order.par_sort_unstable_by_key(|&index| places[index]);
        let mut below = None;
        let mut sunk = 0.0;
        for index in order {
            let (first, second, height) = places[index];
            if below != Some((first, second, height - 1)) {
                sunk = 0.0;
            }
            below = Some(places[index]);
            let part = excess(self.pressures[index]);
            let half = 0.5 * lattice.spacing * part / (1.0 + part);
            self.positions[index][axis] -= up * (sunk + half);
            sunk += 2.0 * half;
        }
    }

    /// Displaces particles under pressure by at most `disorder` spacings along each axis, because a regular lattice under
    /// pressure resists shear, and adapts their pressures with the specific `weight` (N/m³).
    pub fn add_disorder(&mut self, disorder: f64, lattice: &ParticleLattice, weight: DVec3) {
        let pressures = self.pressures.iter_mut().enumerate();
        for (index, pressure) in pressures.filter(|(_, pressure)| **pressure > 0.0) {
            let displacement = disorder * lattice.jitter(index);
            self.positions[index] += displacement;
            *pressure += weight.dot(displacement);
        }
    }
}

/// A body of water at the time 0.
#[derive(Clone, Debug)]
pub struct WaterBody {
    /// Shape, about its centroid.
    pub shape: Shape,
    /// Centroid, m.
    pub centre: DVec3,
    /// From the frame of the shape to the world.
    pub rotation: DQuat,
    /// Velocity, m/s.
    pub velocity: DVec3,
}

/// The fluid particles at the time 0: the points of `lattice` inside a body of water and at least Δx/10 away from all
/// `blocks`. A planar lattice has one row in the middle. The pressure is hydrostatic for a fluid of `density` (kg/m³)
/// in `gravity` (m/s², 0 along periodic axes).
///
/// # Errors
/// [`Error::Argument`] naming `water[index]` if a body is outside the domain, overlaps another one, touches an open face
/// through which it would fall, or has no space for a particle.
pub fn fill(
    lattice: &ParticleLattice,
    bodies: &[WaterBody],
    blocks: &[Block],
    density: f64,
    gravity: DVec3,
) -> Result<Start> {
    let parts = blocks
        .iter()
        .flat_map(|block| ConvexPart::with_images(block, lattice));
    let solids: Vec<ConvexPart<'_>> = parts.collect();
    let waters: Vec<Vec<ConvexPart<'_>>> = bodies
        .iter()
        .map(|body| ConvexPart::of_shape(&body.shape, body.centre, body.rotation))
        .collect();
    let mut start = Start::default();
    let mut filled = Vec::with_capacity(waters.len());
    for (index, water) in waters.iter().enumerate() {
        let key = format!("water[{index}]");
        check_inside(&key, water, lattice)?;
        let mut points = points(&key, water, &solids, lattice)?;
        if points.is_empty() {
            return Err(Error::argument(
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
            return Err(Error::argument(
                key,
                format!("it overlaps other water at {point} m; move one of them, or cut it"),
            ));
        }
        // A point on the face between two bodies belongs to the first.
        points.retain(|x| deepest(x) < 0.0);
        check_open(&key, &points, lattice, gravity)?;
        let velocity = bodies[index].velocity;
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
        weight: density * gravity,
    };
    start.pressures = hydrostatic.pressures();
    start.positions = filled.concat();
    Ok(start)
}

/// Sample points for the volume of a body of water that blocks displace. The error is about 1e-3 of the body, a tenth of
/// the threshold of the warning (an oblique plane cuts N points with an error of N^(−2/3), 4e-4).
const SAMPLES: u32 = 1 << 17;

/// Volume of all bodies of water without the volume that `blocks` displace, m³. It is exact for a body whose
/// bounding box meets no block, and sampled otherwise.
pub fn water_volume(lattice: &ParticleLattice, bodies: &[WaterBody], blocks: &[Block]) -> f64 {
    let blocks = blocks.iter();
    let solids = blocks.flat_map(|block| ConvexPart::with_images(block, lattice));
    let solids: Vec<ConvexPart<'_>> = solids.collect();
    let slack = lattice.tolerance();
    let mut volume = 0.0;
    for body in bodies {
        let parts = ConvexPart::of_shape(&body.shape, body.centre, body.rotation);
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
        volume += fraction * body.shape.volume();
    }
    volume
}

/// Fraction of a body of water outside all solids, sampled in its bounding box with the low-discrepancy sequence of the
/// generalised golden ratio (Roberts 2018, R₃).
fn free_fraction(water: &[ConvexPart<'_>], solids: &[&ConvexPart<'_>]) -> f64 {
    let [low, high] = bounding_box(water.iter().flat_map(|part| [part.low, part.high]));
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

/// The lattice points of a body of water, z slowest.
fn points(
    key: &str,
    water: &[ConvexPart<'_>],
    solids: &[ConvexPart<'_>],
    lattice: &ParticleLattice,
) -> Result<Vec<DVec3>> {
    let low = water
        .iter()
        .fold(DVec3::INFINITY, |low, part| low.min(part.low));
    let high = water
        .iter()
        .fold(DVec3::NEG_INFINITY, |high, part| high.max(part.high));
    let size = ((high - low) / lattice.spacing).max(DVec3::ONE);
    if size.x * size.y * size.z > MAX_PARTICLES {
        return Err(Error::argument(
            "spacing",
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
fn check_inside(key: &str, water: &[ConvexPart<'_>], lattice: &ParticleLattice) -> Result<()> {
    let slack = lattice.tolerance();
    for part in water {
        let outside = part.low.cmplt(lattice.low - slack) | part.high.cmpgt(lattice.high + slack);
        if outside.any() {
            return Err(Error::argument(
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
    key: &str,
    points: &[DVec3],
    lattice: &ParticleLattice,
    gravity: DVec3,
) -> Result<()> {
    for (axis, is_upper) in lattice.faces_of(Side::Open) {
        let (at, outward, end) = match is_upper {
            true => (lattice.high[axis], 1.0, "max"),
            false => (lattice.low[axis], -1.0, "min"),
        };
        if outward * gravity[axis] < 0.0 {
            continue;
        }
        let touches = |x: &DVec3| (x[axis] - at).abs() < lattice.spacing;
        if points.iter().any(touches) {
            return Err(Error::argument(
                key,
                format!(
                    "it touches the open face {}_{end}, through which it would leave at once; give that face kind = \
                     \"wall\", or end the water before it",
                    ["x", "y", "z"][axis]
                ),
            ));
        }
    }
    Ok(())
}

/// Bodies of water and the solids that support them.
struct HydrostaticStart<'a> {
    /// Particles of each body, m.
    pub points: &'a [Vec<DVec3>],
    /// Convex parts of each body.
    pub waters: &'a [Vec<ConvexPart<'a>>],
    pub solids: &'a [ConvexPart<'a>],
    /// Δx, m.
    pub spacing: f64,
    /// Weight of the water, N/m³.
    pub weight: DVec3,
}

impl HydrostaticStart<'_> {
    /// Pressures of all particles, Pa: hydrostatic below the top of their body, or of the bodies that rest on it there;
    /// 0 in free fall.
    pub fn pressures(&self) -> Vec<f64> {
        let down = self.weight.normalize_or_zero();
        let step = self.spacing * down;
        let bodies = 0..self.points.len();
        // The bodies on which each body rests.
        let under = |body: usize| {
            let is_under = |other: &usize| {
                let on = |x: &DVec3| {
                    let foot = *x + step;
                    is_in(&self.waters[*other], foot) && !is_in(self.solids, foot)
                };
                *other != body && self.points[body].par_iter().any(on)
            };
            bodies.clone().filter(is_under).collect()
        };
        let under: Vec<Vec<usize>> = bodies.clone().map(under).collect();
        let on_solids = |points: &Vec<DVec3>| {
            let points = points.par_iter();
            down != DVec3::ZERO && points.any(|x| is_in(self.solids, *x + step))
        };
        let mut supported: Vec<bool> = self.points.iter().map(on_solids).collect();
        let top = |points: &Vec<DVec3>| {
            let heights = points.iter().map(|x| -down.dot(*x));
            heights.fold(f64::NEG_INFINITY, f64::max) + 0.5 * self.spacing
        };
        let tops: Vec<f64> = self.points.iter().map(top).collect();
        let highest = tops.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        // The highest top of each body and the bodies that rest on it.
        let mut levels = tops.clone();
        for _ in bodies.clone() {
            for body in bodies.clone() {
                for &other in &under[body] {
                    supported[body] |= supported[other];
                    levels[other] = levels[other].max(levels[body]);
                }
            }
        }
        // Follows the column above x, through water and solids, to the highest top of the bodies in it.
        let level = |body: usize, x: DVec3| {
            if levels[body] == tops[body] {
                return tops[body];
            }
            let (mut top, mut above) = (tops[body], x);
            loop {
                above -= step;
                let other = self.waters.iter().position(|water| is_in(water, above));
                match other {
                    Some(other) => top = top.max(tops[other]),
                    None if is_in(self.solids, above) && -down.dot(above) < highest => {}
                    None => return top,
                }
            }
        };
        let pressure = |body: usize, x: DVec3| {
            if supported[body] {
                self.weight.length() * (level(body, x) + down.dot(x))
            } else {
                0.0
            }
        };
        let of = |body: usize| self.points[body].par_iter().map(move |x| (body, *x));
        let all = bodies.into_par_iter().flat_map(of);
        all.map(|(body, x)| pressure(body, x)).collect()
    }
}

/// Whether `point` (m) lies in one of the `parts`.
fn is_in(parts: &[ConvexPart<'_>], point: DVec3) -> bool {
    parts.iter().any(|part| {
        let near = point.cmpge(part.low).all() && point.cmple(part.high).all();
        near && part.depth(point) >= 0.0
    })
}
