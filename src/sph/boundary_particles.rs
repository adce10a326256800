//! Boundary (dummy) particles inside walls and blocks.

use super::{
    Side,
    layer_polygon::{LayerBounds, LayerEdge, LayerPoint, LayerPolygon},
    particle_lattice::{ParticleLattice, SpatialHash},
    solid::{ConvexPart, Faces, Solid, solids},
};
use crate::{
    Error, Result,
    geometry::{Form, HalfSpace},
    rock::{Block, Motion},
};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_4, PI, TAU};

/// Distance to all other points from which a point fills a gap, in spacings: above half a diagonal of a square, so
/// that a regular layer has no gaps.
const GAP_DISTANCE: f64 = 0.72;

/// Radius of the search for the best position in a gap around a rejected point, in spacings.
const GAP_SEARCH_RADIUS: f64 = 1.0;

/// How much deeper a gap point may be in another block than in its own, in spacings. Deeper points coincide with
/// layers of the other block.
const GAP_DEPTH_TOLERANCE: f64 = 0.25;

/// The golden angle between successive points of a Fibonacci spiral.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// Boundary particles of `blocks`, one list per block: positions relative to the centroid of the block in its own frame, m.
/// The blocks from the index `walls` on are the walls of the domain.
///
/// Each layer (k + ½) Δx below the surface of a convex part is filled face by face with rows of points. The points
/// belong to the lattice of the fluid where the part spans the domain. Rows continue across the internal face between two
/// parts of a block. Points keep a distance of 0.6 Δx within a block and among all fixed blocks. Where fixed blocks
/// overlap, a point belongs to the block in which it is deepest, and further points fill the gaps that this leaves in the
/// layers. Walls of the domain have lattice points outside of it, corners included. Points of fixed blocks extend no
/// farther beyond the domain than those of its walls.
///
/// # Errors
/// [`Error::Argument`] if a block is thinner than Δx, or a block of a planar lattice is not a prism across the domain.
pub fn boundary_particles(
    lattice: &ParticleLattice,
    blocks: &[Block],
    walls: usize,
) -> Result<Vec<Vec<DVec3>>> {
    let faces: Vec<(usize, bool)> = lattice.faces_of(Side::Wall).collect();
    for block in &blocks[..walls.min(blocks.len())] {
        check(block, &ConvexPart::of_block(block), lattice)?;
    }
    let solids = solids(blocks, lattice);
    let fixed: Vec<usize> = (0..blocks.len())
        .filter(|index| blocks[*index].motion == Motion::Fixed)
        .collect();
    let deepest = |index: usize, point: DVec3| {
        let depths = solids[index].iter().map(|solid| solid.depth(point));
        depths.fold(f64::NEG_INFINITY, f64::max)
    };
    let depths = |own: usize, point: DVec3| {
        let depths = fixed.iter().map(|block| (deepest(*block, point), *block));
        let own = (deepest(own, point) + lattice.tolerance(), own);
        // At equal depths a point belongs to its own block.
        let (deepest, block) = depths.fold(own, |a, b| if b.0 > a.0 { b } else { a });
        Depths {
            own: own.0,
            deepest,
            block,
        }
    };
    let mut occupied = SpatialHash::new(lattice);
    let mut rejected = Vec::new();
    let mut particles = Vec::with_capacity(blocks.len());
    for (index, block) in blocks.iter().enumerate() {
        let points = match faces.get(index.wrapping_sub(walls)) {
            Some(face) => wall(lattice, *face),
            None => layers(block, &solids[index], lattice),
        };
        let positions = points.iter().map(|point| point.at);
        if block.motion == Motion::Fixed {
            let mut kept = Vec::with_capacity(points.len());
            for point in points {
                let is_own = depths(index, point.at).block == index;
                if is_own && occupied.insert(lattice.wrapped(point.at)) {
                    kept.push(point.at);
                } else {
                    rejected.push((index, point));
                }
            }
            particles.push(kept);
        } else {
            let mut own = SpatialHash::new(lattice);
            particles.push(positions.filter(|point| own.insert(*point)).collect());
        }
    }
    for (index, point) in rejected {
        let depths = |x: DVec3| lattice.is_within(x).then(|| depths(index, x));
        if let Some((position, block)) = gap(point, depths, &occupied, lattice)
            && occupied.insert(position)
        {
            particles[block].push(position);
        }
    }
    for (block, points) in blocks.iter().zip(&mut particles) {
        let to_body = block.rotation.inverse();
        for point in points {
            *point = to_body * (*point - block.centre);
        }
    }
    Ok(particles)
}

/// Lattice points outside the domain behind one of its faces, corners included.
fn wall(lattice: &ParticleLattice, (normal, is_upper): (usize, bool)) -> Vec<LayerPoint> {
    if lattice.plane && normal == 1 {
        return Vec::new();
    }
    let (plane, outward) = if is_upper {
        (lattice.high, 1.0)
    } else {
        (lattice.low, -1.0)
    };
    let rows: [Vec<f64>; 3] = std::array::from_fn(|axis| {
        if axis == normal {
            (0..lattice.layers)
                .map(|layer| plane[axis] + outward * lattice.depth(layer))
                .collect()
        } else {
            lattice.row(axis, lattice.extent_with_layers(axis))
        }
    });
    let [x, y, z] = &rows;
    let mut points = Vec::with_capacity(x.len() * y.len() * z.len());
    for z in z {
        for y in y {
            points.extend(x.iter().map(|x| LayerPoint {
                at: DVec3::new(*x, *y, *z),
                normal: DVec3::AXES[normal],
            }));
        }
    }
    points
}

/// Points of the layers of a block, the outermost layer of all faces first, and the continuations behind re-entrant edges
/// last.
fn layers(block: &Block, solids: &[Solid], lattice: &ParticleLattice) -> Vec<LayerPoint> {
    let fixed = block.motion == Motion::Fixed;
    let (mut points, mut behind) = (Vec::new(), Vec::new());
    let deepest = |x: DVec3| {
        let depths = solids.iter().map(|solid| solid.depth(x));
        depths.fold(f64::NEG_INFINITY, f64::max)
    };
    for layer in 0..lattice.layers {
        let depth = lattice.depth(layer);
        for (index, solid) in solids.iter().enumerate() {
            match solid {
                Solid::Faces(faces) => {
                    let others = solids.iter().enumerate().filter(|(i, _)| *i != index);
                    let others: Vec<&Solid> = others.map(|(_, other)| other).collect();
                    let part = Part {
                        block,
                        faces,
                        others: &others,
                        fixed,
                    };
                    for polygon in part.layer_polygons(depth, lattice) {
                        let (own, rest): (Vec<LayerPoint>, Vec<LayerPoint>) =
                            polygon.points(lattice).into_iter().partition(|x| {
                                let mut internal = faces.internal.iter();
                                internal.all(|face| face.height(x.at) <= lattice.tolerance())
                            });
                        points.extend(own);
                        let least = lattice.depth(0) - lattice.tolerance();
                        behind.extend(rest.into_iter().filter(|x| deepest(x.at) >= least));
                    }
                }
                Solid::Sphere { centre, radius } if *radius >= depth - lattice.tolerance() => {
                    let sphere = fibonacci_sphere((radius - depth).max(0.0), lattice.spacing);
                    points.extend(sphere.map(|point| LayerPoint {
                        at: *centre + point,
                        normal: point.normalize_or(DVec3::Z),
                    }));
                }
                Solid::Sphere { .. } => {}
            }
        }
    }
    points.extend(behind);
    points.retain(|x| !fixed || lattice.is_within(lattice.wrapped(x.at)));
    points
}

/// A convex part of a block with its surroundings.
struct Part<'a> {
    block: &'a Block,
    faces: &'a Faces,
    /// The other parts of the block.
    others: &'a [&'a Solid],
    /// Whether the domain and the periodic images bound the layers.
    fixed: bool,
}

impl Part<'_> {
    /// The polygons of the layer at `depth` (m) below the exposed faces.
    fn layer_polygons(&self, depth: f64, lattice: &ParticleLattice) -> Vec<LayerPolygon> {
        let Self {
            block,
            faces,
            others: solids,
            fixed,
        } = *self;
        let moved = |plane: &HalfSpace, by: f64| HalfSpace {
            distance: plane.distance - by,
            ..*plane
        };
        // A layer that degenerates to a line or a point still carries particles.
        let slack = 0.1 * lattice.tolerance();
        // A moving block keeps all its particles. So does a block across the end of a period, unless it spans the period.
        let ends = (0..3).filter(|axis| {
            if lattice.is_unbounded(*axis) {
                spans(faces, *axis) || fixed && !lattice.crosses_period(block, *axis)
            } else {
                fixed
            }
        });
        let ends: Vec<HalfSpace> = ends.flat_map(|axis| lattice.half_spaces(axis)).collect();
        let middle = 0.5 * (lattice.low + lattice.high);
        let size = (lattice.high - lattice.low).length()
            + 2.0 * f64::from(lattice.layers) * lattice.spacing;
        let square = if fixed {
            (middle, 2.0 * size)
        } else {
            (block.centre, 2.0 * block.shape.radius() + size)
        };
        let polygon = |(index, plane): (usize, &HalfSpace)| {
            let exposed = faces.exposed.iter().enumerate();
            let others = exposed.filter(|(i, _)| *i != index);
            let others = others.map(|(_, other)| moved(other, depth - slack));
            let others: Vec<HalfSpace> = others.chain(ends.iter().copied()).collect();
            let internal = faces.internal.iter();
            let whole = others.iter().copied();
            let whole = whole.chain(internal.clone().map(|face| moved(face, -slack)));
            let plane = moved(plane, depth);
            let whole = LayerPolygon::new(plane, whole, square.0, square.1)?;
            let insets = internal.map(|face| {
                let edge = LayerEdge {
                    points: whole.edge(face, lattice.tolerance()),
                    depth,
                };
                (*face, edge.inset(&plane, face, solids, lattice))
            });
            let bounds = LayerBounds {
                half_spaces: &others,
                insets: &insets.collect::<Vec<_>>(),
                slack,
                square,
            };
            LayerPolygon::inset(plane, &bounds)
        };
        faces
            .exposed
            .iter()
            .enumerate()
            .filter_map(polygon)
            .collect()
    }
}

/// Whether no face bounds the part along an axis.
fn spans(faces: &Faces, axis: usize) -> bool {
    let mut planes = faces.exposed.iter().chain(&faces.internal);
    planes.all(|plane| plane.normal[axis].abs() < 1e-9)
}

/// Checks that a block can carry boundary particles.
fn check(block: &Block, parts: &[ConvexPart<'_>], lattice: &ParticleLattice) -> Result<()> {
    let refuse = |message: String| Err(Error::argument(format!("block {}", block.name), message));
    if lattice.plane {
        for part in parts {
            let Form::Convex(_) = part.form else {
                return refuse(
                    "is a sphere, and the scene is planar (particles.plane); give a prism along y, or remove plane"
                        .into(),
                );
            };
            let is_prismatic = |plane: &HalfSpace| {
                let along = plane.normal.y.abs();
                !(1e-9..=1.0 - 1e-9).contains(&along)
            };
            if !part.planes().iter().all(is_prismatic) {
                return refuse(
                    "has a face oblique to y, and the scene is planar (particles.plane); rotate the block (give a terrain \
                     the same heights in all its rows along y), or remove plane"
                        .into(),
                );
            }
            let tolerance = 1e-6 * (lattice.high.y - lattice.low.y);
            let (low, high) = (part.low.y - lattice.low.y, part.high.y - lattice.high.y);
            let fits = low <= tolerance && high >= -tolerance;
            let exact = low.abs() <= tolerance && high.abs() <= tolerance;
            if !(exact || fits && block.motion != Motion::Free) {
                return refuse(format!(
                    "extends from y = {} to {} m, and a planar scene (particles.plane) represents the whole domain, from \
                     {} to {} m; give it that width (a terrain: two rows of heights along y)",
                    part.low.y, part.high.y, lattice.low.y, lattice.high.y
                ));
            }
        }
    }
    let depth = lattice.depth(0);
    let thick = |part: &ConvexPart<'_>| match part.form {
        Form::Sphere { radius } => *radius >= depth - lattice.tolerance(),
        Form::Convex(_) => {
            let Solid::Faces(faces) = Solid::of(part, lattice, false) else {
                return true;
            };
            let part = Part {
                block,
                faces: &faces,
                others: &[],
                fixed: false,
            };
            !part.layer_polygons(depth, lattice).is_empty()
        }
    };
    if parts.iter().any(thick) {
        return Ok(());
    }
    refuse(format!(
        "is thinner than the spacing of {} m, so that no boundary particle fits into it; use a smaller particles.spacing, or \
         a thicker block",
        lattice.spacing
    ))
}

/// Depths of a point in fixed blocks.
struct Depths {
    /// Below the surface of the block whose layer contains the point, m; negative outside.
    own: f64,
    /// In the block in which the point is deepest, m.
    deepest: f64,
    /// Index of that block.
    block: usize,
}

/// The position near a rejected point, in its layer, that is farthest from all `occupied` points, and the block that it
/// belongs to; `None` if there is no gap.
///
/// The rows of two blocks that meet have different phases. Where the last point of one is too close to the first of the
/// other it is rejected, which leaves a gap of up to 1.6 spacings, through which water leaks.
fn gap(
    rejected: LayerPoint,
    depths: impl Fn(DVec3) -> Option<Depths>,
    occupied: &SpatialHash<'_>,
    lattice: &ParticleLattice,
) -> Option<(DVec3, usize)> {
    let spacing = lattice.spacing;
    let distance = |x: DVec3| {
        let depths = depths(x)?;
        let least = lattice.depth(0) - 1e3 * lattice.tolerance();
        let fits =
            depths.own >= least && depths.deepest <= depths.own + GAP_DEPTH_TOLERANCE * spacing;
        fits.then(|| (occupied.nearest(x), depths.block))
    };
    let u = rejected.normal.any_orthonormal_vector();
    let v = rejected.normal.cross(u);
    let (mut best, mut position) = (distance(rejected.at), rejected.at);
    let mut step = 0.5 * spacing;
    while step > 0.05 * spacing {
        let from = position;
        for direction in 0..8 {
            let (sin, cos) = (f64::from(direction) * FRAC_PI_4).sin_cos();
            let x = from + (u * cos + v * sin) * step;
            if x.distance(rejected.at) > GAP_SEARCH_RADIUS * spacing {
                continue;
            }
            let found = distance(x);
            let is_farther = |(distance, _): (f64, usize)| {
                best.is_none_or(|(most, _)| distance > most + lattice.tolerance())
            };
            if found.is_some_and(is_farther) {
                (best, position) = (found, x);
            }
        }
        if position == from {
            step *= 0.5;
        }
    }
    best.filter(|(distance, _)| *distance >= GAP_DISTANCE * spacing)
        .map(|(_, block)| (position, block))
}

/// Points on the sphere of `radius` (m) about the origin, as many as there are cubes of edge `spacing` (m) in the layer
/// of that thickness: a Fibonacci spiral (Swinbank & Purser 2006, Q. J. R. Meteorol. Soc. 132:1769).
fn fibonacci_sphere(radius: f64, spacing: f64) -> impl Iterator<Item = DVec3> {
    let layer = 2.0 * TAU * (radius * radius + spacing * spacing / 12.0) / (spacing * spacing);
    // The innermost layer is a ball.
    let inner = radius < 0.5 * spacing;
    let core = 4.0 / 3.0 * PI * ((radius + 0.5 * spacing) / spacing).powi(3);
    let count = if inner { core } else { layer }.round().max(1.0);
    (0..count as u64).map(move |i| {
        let z = 1.0 - (2.0 * i as f64 + 1.0) / count;
        let (sin, cos) = (GOLDEN_ANGLE * i as f64).sin_cos();
        let across = (1.0 - z * z).sqrt();
        radius * DVec3::new(across * cos, across * sin, z)
    })
}
