//! Shell particles: the dummy particles inside walls and blocks.

use super::{
    crowd::Crowd,
    edge::Edge,
    facet::Facet,
    gaps::{Depths, Laid, gap},
    lattice::Lattice,
    placed::Placed,
    solid::{Faces, Solid, solids},
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
/// depth: who of them is deeper there, and points fill what gaps that leaves in their layers. The faces of the domain
/// give lattice points outside of it, in corners too. Fixed blocks have none farther beyond the domain than its walls.
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
    for block in &blocks[..walls.min(blocks.len())] {
        check(block, &Placed::of(block), &lattice)?;
    }
    let solids = solids(blocks, &lattice);
    let still: Vec<usize> = (0..blocks.len())
        .filter(|index| blocks[*index].motion == Motion::Fixed)
        .collect();
    let deepest = |index: usize, point: DVec3| {
        let depths = solids[index].iter().map(|solid| solid.depth(point));
        depths.fold(f64::NEG_INFINITY, f64::max)
    };
    let depths = |own: usize, point: DVec3| {
        let depths = still.iter().map(|block| (deepest(*block, point), *block));
        let mine = (deepest(own, point) + lattice.tolerance(), own);
        // Where some are as deep it is its own.
        let (deepest, block) = depths.fold(mine, |a, b| if b.0 > a.0 { b } else { a });
        Depths {
            own: mine.0,
            deepest,
            block,
        }
    };
    let mut crowd = Crowd::new(&lattice);
    let mut refused = Vec::new();
    let mut shells = Vec::with_capacity(blocks.len());
    for (index, block) in blocks.iter().enumerate() {
        let points = match faces.get(index.wrapping_sub(walls)) {
            Some(face) => wall(&lattice, *face),
            None => layers(block, &solids[index], &lattice),
        };
        let places = points.iter().map(|point| point.at);
        if block.motion == Motion::Fixed {
            let mut kept = Vec::with_capacity(points.len());
            for point in points {
                if depths(index, point.at).block == index && crowd.admit(lattice.wrapped(point.at))
                {
                    kept.push(point.at);
                } else {
                    refused.push((index, point));
                }
            }
            shells.push(kept);
        } else {
            let mut own = Crowd::new(&lattice);
            shells.push(places.filter(|point| own.admit(*point)).collect());
        }
    }
    for (index, point) in refused {
        let there = |x: DVec3| lattice.is_within(x).then(|| depths(index, x));
        if let Some((place, block)) = gap(point, there, &crowd, &lattice)
            && crowd.admit(place)
        {
            shells[block].push(place);
        }
    }
    for (block, shell) in blocks.iter().zip(&mut shells) {
        let back = block.rotation.inverse();
        for point in shell {
            *point = back * (*point - block.centre);
        }
    }
    Ok(shells)
}

/// The lattice outside the domain through one of its faces, corners included, m.
fn wall(lattice: &Lattice, face: Face) -> Vec<Laid> {
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
            points.extend(x.iter().map(|x| Laid {
                at: DVec3::new(*x, *y, *z),
                normal: DVec3::AXES[normal],
            }));
        }
    }
    points
}

/// The layers of a block, the outermost of all its facets first, and what goes on behind re-entrant edges last, m.
fn layers(block: &Block, solids: &[Solid], lattice: &Lattice) -> Vec<Laid> {
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
                    for facet in facets(block, (faces, &others), depth, lattice, fixed) {
                        let (own, rest): (Vec<Laid>, Vec<Laid>) =
                            facet.points(lattice).into_iter().partition(|x| {
                                let mut seams = faces.seams.iter();
                                seams.all(|seam| seam.height(x.at) <= lattice.tolerance())
                            });
                        points.extend(own);
                        let least = lattice.depth(0) - lattice.tolerance();
                        behind.extend(rest.into_iter().filter(|x| deepest(x.at) >= least));
                    }
                }
                Solid::Sphere { centre, radius } if *radius >= depth - lattice.tolerance() => {
                    let sphere = spiral((radius - depth).max(0.0), lattice.spacing);
                    points.extend(sphere.map(|point| Laid {
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
    // A block that moves takes all its shells along, and so does one across the end of a period, but for what spans it.
    let ends = (0..3).filter(|axis| match lattice.endless(*axis) {
        true => is_endless(faces, *axis) || fixed && !lattice.is_across(block, *axis),
        false => fixed,
    });
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
