//! Shell particles: the dummy particles inside walls and blocks.

use super::{
    crowd::Crowd,
    edge::Edge,
    facet::Facet,
    lattice::Lattice,
    placed::{Faces, Placed, Solid},
    sphere::spiral,
};
use crate::{
    Error, Result,
    block::{Form, HalfSpace},
    bodies::{Block, Motion},
    scene::{Boundary, Face, Scene},
    simulation::BlockSetup,
};
use glam::DVec3;

/// Shell particles of each block of `setup`, one list a block: from its centroid in its own frame, the turn at
/// the start undone, m.
///
/// Facet by facet and layer by layer, the facet of what is left of a convex part when all its faces move in
/// by (k + ½) Δx is filled with rows of points; they belong to the lattice of the fluid where the part spans
/// the domain. Where a part stands on another, the rows of both follow each other as if they were of one. No two
/// points of a block are nearer than 0.6 Δx, nor two of fixed blocks, which share what they have in common by
/// depth: who of them is deeper there. The faces of the domain give lattice points outside of it, in corners too.
/// Fixed blocks have none farther beyond the domain than its walls.
///
/// # Errors
/// If the scene has no particles, a block is thinner than Δx, or, in a plane, is no prism across the domain.
pub fn shells(scene: &Scene, setup: &BlockSetup) -> Result<Vec<Vec<DVec3>>> {
    let Some(particles) = &scene.particles else {
        return Err(super::fill::none());
    };
    let lattice = Lattice::of(scene, particles);
    let blocks = &setup.setup.blocks;
    let walls = setup.in_fluid + scene.solids.len();
    let faces: Vec<Face> = scene
        .boundaries
        .iter()
        .filter(|(_, boundary)| matches!(boundary, Boundary::Wall { .. } | Boundary::FreeSlip))
        .map(|(face, _)| face)
        .collect();
    let mut solids = Vec::with_capacity(blocks.len());
    for (index, block) in blocks.iter().enumerate() {
        let parts = Placed::of(block);
        if index < walls {
            check(block, &parts, &lattice)?;
        }
        let fixed = block.motion == Motion::Fixed;
        let solid = |(index, part): (usize, &Placed<'_>)| {
            let mut solid = Solid::of(part, &lattice, fixed);
            let others = parts
                .iter()
                .enumerate()
                .filter(|(other, _)| *other != index);
            let others: Vec<&Placed<'_>> = others.map(|(_, other)| other).collect();
            solid.sew(part, &others, &lattice);
            solid
        };
        solids.push(parts.iter().enumerate().map(solid).collect::<Vec<_>>());
    }
    let still: Vec<usize> = (0..blocks.len())
        .filter(|index| blocks[*index].motion == Motion::Fixed)
        .collect();
    let mut crowd = Crowd::new(&lattice);
    let mut shells = Vec::with_capacity(blocks.len());
    for (index, block) in blocks.iter().enumerate() {
        let fixed = block.motion == Motion::Fixed;
        let points = match faces.get(index.wrapping_sub(walls)) {
            Some(face) => wall(&lattice, *face),
            None => layers(block, &solids[index], &lattice, fixed),
        };
        let mut own = Crowd::new(&lattice);
        let crowd = if fixed { &mut crowd } else { &mut own };
        let deepest = |index: usize, point: DVec3| {
            let depths = solids[index].iter().map(|solid| solid.depth(point));
            depths.fold(f64::NEG_INFINITY, f64::max)
        };
        let mine = |point: DVec3| {
            let depth = deepest(index, point) + lattice.tolerance();
            let others = |other: &usize| *other == index || deepest(*other, point) <= depth;
            still.iter().all(others)
        };
        let kept = points
            .into_iter()
            .filter(|point| (!fixed || mine(*point)) && crowd.admit(*point));
        let back = block.rotation.inverse();
        shells.push(kept.map(|x| back * (x - block.centre)).collect());
    }
    Ok(shells)
}

/// The lattice outside the domain through one of its faces, corners included, m.
fn wall(lattice: &Lattice, face: Face) -> Vec<DVec3> {
    let normal = face.axis().index();
    if lattice.plane && normal == 1 {
        return Vec::new();
    }
    let out = face.outward();
    let plane = if face.is_max() {
        lattice.high
    } else {
        lattice.low
    };
    let rows: [Vec<f64>; 3] = std::array::from_fn(|axis| match axis == normal {
        true => (0..lattice.layers)
            .map(|layer| plane[axis] + out * lattice.depth(layer))
            .collect(),
        false => lattice.row(axis, lattice.reach(axis)),
    });
    let [x, y, z] = &rows;
    let mut points = Vec::with_capacity(x.len() * y.len() * z.len());
    for z in z {
        for y in y {
            points.extend(x.iter().map(|x| DVec3::new(*x, *y, *z)));
        }
    }
    points
}

/// The layers of a block, the outermost of all its facets first, and what goes on behind re-entrant edges last, m.
fn layers(block: &Block, solids: &[Solid], lattice: &Lattice, fixed: bool) -> Vec<DVec3> {
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
                    for facet in facets(block, (faces, &others), depth, lattice, fixed) {
                        let (own, rest): (Vec<DVec3>, Vec<DVec3>) =
                            facet.points(lattice).into_iter().partition(|x| {
                                let mut seams = faces.seams.iter();
                                seams.all(|seam| seam.height(*x) <= lattice.tolerance())
                            });
                        points.extend(own);
                        let least = lattice.depth(0) - lattice.tolerance();
                        behind.extend(rest.into_iter().filter(|x| deepest(*x) >= least));
                    }
                }
                Solid::Sphere { centre, radius } if *radius >= depth - lattice.tolerance() => {
                    let sphere = spiral((radius - depth).max(0.0), lattice.spacing);
                    points.extend(sphere.map(|point| *centre + point));
                }
                Solid::Sphere { .. } => {}
            }
        }
    }
    points.extend(behind);
    let reach = [0, 1, 2].map(|axis| lattice.reach(axis));
    points.retain(|x| {
        let inside = |axis: usize| x[axis] >= reach[axis][0] && x[axis] <= reach[axis][1];
        !fixed || (0..3).all(inside)
    });
    points
}

/// The facets of what is left when the bare ones of `faces` have moved in by `depth` (m), beside `solids`, the other
/// parts of the block.
fn facets(
    block: &Block,
    (faces, solids): (&Faces, &[&Solid]),
    depth: f64,
    lattice: &Lattice,
    fixed: bool,
) -> Vec<Facet> {
    let moved = |plane: &HalfSpace, by: f64| HalfSpace {
        distance: plane.distance - by,
        ..*plane
    };
    // Where nothing is left but a plane or a line, that still carries points.
    let slack = 0.1 * lattice.tolerance();
    // A block that moves takes all its shells along, but for what spans a period.
    let ends = (0..3).filter(|axis| fixed || lattice.endless(*axis) && is_endless(faces, *axis));
    let ends: Vec<HalfSpace> = ends.flat_map(|axis| lattice.sides(axis)).collect();
    let middle = 0.5 * (lattice.low + lattice.high);
    let size =
        (lattice.high - lattice.low).length() + 2.0 * f64::from(lattice.layers) * lattice.spacing;
    let (about, reach) = match fixed {
        true => (middle, 2.0 * size),
        false => (block.centre, 2.0 * block.shape.radius() + size),
    };
    let facet = |(index, plane): (usize, &HalfSpace)| {
        let others = faces.bare.iter().enumerate().filter(|(i, _)| *i != index);
        let others = others.map(|(_, other)| moved(other, depth - slack));
        let others: Vec<HalfSpace> = others.chain(ends.iter().copied()).collect();
        let seams = faces.seams.iter();
        let whole = others.iter().copied();
        let whole = whole.chain(seams.clone().map(|seam| moved(seam, -slack)));
        let plane = moved(plane, depth);
        let whole = Facet::new(plane, whole, about, reach)?;
        let seams = seams.map(|seam| {
            let edge = Edge {
                points: whole.edge(seam, lattice.tolerance()),
                depth,
            };
            (*seam, edge.end(&plane, seam, solids, lattice))
        });
        Facet::beside(
            plane,
            &others,
            (&seams.collect::<Vec<_>>(), slack),
            (about, reach),
        )
    };
    faces.bare.iter().enumerate().filter_map(facet).collect()
}

/// Whether no face bounds these along an axis.
fn is_endless(faces: &Faces, axis: usize) -> bool {
    let mut planes = faces.bare.iter().chain(&faces.seams);
    planes.all(|plane| plane.normal[axis].abs() < 1e-9)
}

/// A block can carry shells.
fn check(block: &Block, parts: &[Placed<'_>], lattice: &Lattice) -> Result<()> {
    let refuse = |message: String| Err(Error::scene(format!("block {}", block.name), message));
    if lattice.plane {
        for part in parts {
            let Form::Convex(_) = part.form else {
                return refuse(
                    "is a sphere, and nothing may vary along y (particles.plane); give a prism along y, or remove \
                     plane"
                        .into(),
                );
            };
            let upright = |plane: &HalfSpace| {
                let along = plane.normal.y.abs();
                !(1e-9..=1.0 - 1e-9).contains(&along)
            };
            if !part.planes().iter().all(upright) {
                return refuse(
                    "has a face oblique to y, and nothing may vary along y (particles.plane); turn it, or remove \
                     plane"
                        .into(),
                );
            }
            let tolerance = 1e-6 * (lattice.high.y - lattice.low.y);
            let (low, high) = (part.low.y - lattice.low.y, part.high.y - lattice.high.y);
            let fits = low <= tolerance && high >= -tolerance;
            let exact = low.abs() <= tolerance && high.abs() <= tolerance;
            if !(exact || fits && block.motion != Motion::Free) {
                return refuse(format!(
                    "reaches from y = {} to {} m, and a plane (particles.plane) stands for all of the domain, from \
                     {} to {} m; give it that width",
                    part.low.y, part.high.y, lattice.low.y, lattice.high.y
                ));
            }
        }
    }
    let depth = lattice.depth(0);
    let thick = |part: &Placed<'_>| match part.form {
        Form::Sphere { radius } => *radius >= depth - lattice.tolerance(),
        Form::Convex(_) => {
            let Solid::Faces(faces) = Solid::of(part, lattice, false) else {
                return true;
            };
            !facets(block, (&faces, &[]), depth, lattice, false).is_empty()
        }
    };
    if parts.iter().any(thick) {
        return Ok(());
    }
    refuse(format!(
        "is thinner than the spacing of {} m, so that no particle fits into it; use a smaller particles.spacing, or a \
         thicker block",
        lattice.spacing
    ))
}
