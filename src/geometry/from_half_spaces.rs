//! Polyhedra from their faces.

use super::cell::{Cell, Clip, ON, START};
use super::{HalfSpace, Polyhedron};
use crate::{Error, Result};
use glam::DVec3;

/// Size of the box around the unit sphere's tangent planes beyond which a block counts as unbounded:
/// one so long would be a sliver by far.
const FAR: f64 = 1e6;

impl Polyhedron {
    /// The points inside all of `faces`, and their centroid (m), which becomes the origin. Faces without
    /// a vertex go, coplanar ones become one, the others keep their order. Normals need not have unit
    /// length: both sides of n · x ≤ d are divided by |n|.
    ///
    /// # Errors
    /// If a face is not finite or has no normal, or if what the faces bound is unbounded, empty, or a
    /// sliver (a face nearer to the centroid than 1e-4 of the diameter, twice the radius). Says which face.
    pub fn from_half_spaces(faces: &[HalfSpace]) -> Result<(Self, DVec3)> {
        Self::from_cell(cell_of(&unit(faces)?)?)
    }
}

/// The faces with unit normals.
pub(super) fn unit(faces: &[HalfSpace]) -> Result<Vec<HalfSpace>> {
    let scaled = faces.iter().enumerate().map(|(index, face)| {
        let length = face.normal.length();
        let distance = face.distance / length;
        if !(length > 0.0 && length.is_finite() && distance.is_finite()) {
            let (n, d) = (face.normal, face.distance);
            return Err(Error::argument(
                format!("faces[{index}]"),
                format!("normal {n} and distance {d} m are no plane; give finite numbers and a normal that is not zero"),
            ));
        }
        // A unit normal keeps its bits.
        if (length - 1.0).abs() <= 2.0 * f64::EPSILON {
            return Ok(*face);
        }
        Ok(HalfSpace {
            normal: face.normal / length,
            distance,
        })
    });
    scaled.collect()
}

/// What `faces` (unit normals) bound. Facets carry the index of their face and its very numbers.
pub(super) fn cell_of(faces: &[HalfSpace]) -> Result<Cell> {
    let reach = reach(faces)?;
    let largest = faces.iter().map(|f| f.distance.abs()).fold(0.0, f64::max);
    // n · x ≤ d ≤ largest: all points lie in the polyhedron of the tangent planes, scaled.
    let (mut centre, mut half) = (DVec3::ZERO, 1.01 * reach * largest);
    loop {
        let mut cell = clip_box(faces, centre, half)?;
        let (min, max) = cell.bounds();
        let size = (max - min).max_element() / 2.0;
        // Again from a box of its size, or the rounding of the large box would remain.
        if size < half / 8.0 {
            (centre, half) = ((min + max) / 2.0, 2.0 * size);
            continue;
        }
        cell.vertices.iter_mut().for_each(|v| *v += centre);
        for facet in &mut cell.facets {
            facet.plane = faces[facet.source as usize];
        }
        return Ok(cell);
    }
}

/// What `faces` leave of the box of half-width `half` about `centre`, seen from there.
fn clip_box(faces: &[HalfSpace], centre: DVec3, half: f64) -> Result<Cell> {
    let mut cell = Cell::cuboid(DVec3::splat(-half), DVec3::splat(half));
    for (index, face) in faces.iter().enumerate() {
        if cell.clip(face.seen_from(centre), index as u32, ON * half) == Clip::Nothing {
            return Err(Error::argument(
                format!("faces[{index}]"),
                "nothing is left inside it of what the faces before it bound; check the signs of its \
                 normal (outwards) and its distance",
            ));
        }
    }
    if cell.facets.iter().any(|f| f.source == START) {
        return Err(Error::argument(
            "faces",
            "they meet in a point and enclose no volume; check the distances",
        ));
    }
    Ok(cell)
}

/// Largest distance from the origin in the polyhedron of all tangent planes n · x ≤ 1. That is bounded
/// if and only if every nonempty polyhedron with these normals is.
fn reach(faces: &[HalfSpace]) -> Result<f64> {
    let mut cell = Cell::cuboid(DVec3::splat(-FAR), DVec3::splat(FAR));
    for face in faces {
        let tangent = HalfSpace {
            normal: face.normal,
            distance: 1.0,
        };
        cell.clip(tangent, 0, ON * FAR);
    }
    let longest = |a: DVec3, b: DVec3| if b.length() > a.length() { b } else { a };
    let far = cell.live().fold(DVec3::ZERO, longest);
    if cell.facets.iter().any(|f| f.source == START) {
        let d = far.normalize();
        return Err(Error::argument(
            "faces",
            format!(
                "{} faces leave the block unbounded towards ({:.3}, {:.3}, {:.3}); add a face there",
                faces.len(),
                d.x,
                d.y,
                d.z
            ),
        ));
    }
    Ok(far.length())
}
