//! Shapes from closed triangle meshes.

use super::convex_parts::{Mesh, PARTS, convex_parts};
use super::moments::Moments;
use super::solids::positive;
use super::{Form, Part, Polyhedron, Shape};
use crate::geometry::TriangleMesh;
use crate::{Error, Result};
use glam::DVec3;
use std::path::Path;

/// Part of a mesh's size that is rounding: STL files and many programs know coordinates to f32 (6e-8).
pub(super) const ROUNDING: f64 = 1e-6;

/// Volume of a mesh that is flat, as part of its size cubed: less than a block of 1 × 3e-5 × 3e-5.
const FLAT: f64 = 1e-9;

/// Relative difference of volumes that [`ROUNDING`] explains: six faces of a box, and some.
const SAME: f64 = 1e-5;

/// By how much convex parts may stand out from a mesh, as part of its size, tried from the left: exact
/// parts where there are few concave edges, near ones where there are many.
const DEVIATIONS: [f64; 7] = [ROUNDING, 0.002, 0.005, 0.01, 0.02, 0.03, 0.05];

/// Most by which the volume of a mesh and the sum of its convex parts may differ.
const UNLIKE: f64 = 0.05;

impl Shape {
    /// Reads a closed mesh from an STL or OBJ file; its unit becomes `scale` m. See [`Shape::from_mesh`].
    ///
    /// # Errors
    /// If the scale is not positive, the file cannot be read, or the mesh is no block.
    pub fn read(path: &Path, scale: f64) -> Result<(Self, DVec3)> {
        positive("scale", scale)?;
        let mesh = TriangleMesh::read(path, scale, [0.0; 3])?;
        Self::from_mesh(&mesh).map_err(|e| match e {
            Error::Argument { message, .. } => Error::file(path, message),
            other => other,
        })
    }

    /// The solid that a closed mesh encloses, and its centroid (m), which becomes the origin. A convex
    /// mesh becomes one polyhedron, faces within 1e-6 of the size on one plane being one. Any other
    /// becomes a compound of at most 64 convex parts that do not overlap: exact ones if it has few concave
    /// edges, else parts that hold all of it and stand out from it by at most 5 % of its size and 5 % of
    /// its volume, by less where 64 suffice for less. Volume, centroid and inertia are those of the mesh
    /// itself, exact, whatever the parts. A mesh of 10⁴ triangles takes seconds, one of 4·10⁴ a minute.
    ///
    /// # Errors
    /// If the mesh is open, inverted, flat, or no solid, or convex parts do not come near enough to it.
    pub fn from_mesh(mesh: &TriangleMesh) -> Result<(Self, DVec3)> {
        let refuse = |message: String| Error::argument("mesh", message);
        let count = mesh.vertices.len();
        let whole = |corners: &[u32; 3]| corners.iter().all(|c| (*c as usize) < count);
        if !mesh.vertices.iter().all(|v| v.is_finite()) || !mesh.triangles.iter().all(whole) {
            let message = "a vertex is not finite or not there; export the mesh again";
            return Err(refuse(message.into()));
        }
        mesh.closed().map_err(refuse)?;
        let (min, max) = mesh.bounds();
        let (min, max) = (DVec3::from(min), DVec3::from(max));
        let size = min.distance(max);
        let moments = |origin: DVec3| {
            let triangles = 0..mesh.triangles.len();
            Moments::of(triangles.map(|t| mesh.corners(t).map(|c| c - origin)))
        };
        let middle = (min + max) / 2.0;
        let first = moments(middle);
        let volume = first.volume;
        // Not true either if there is no triangle, and the size is not a number.
        let thick = volume.abs() > FLAT * size.powi(3);
        if !thick {
            return Err(refuse(format!(
                "the mesh is flat: {volume:.3e} m³ in a box {size:.3e} m across; a block needs a thickness"
            )));
        }
        if volume < 0.0 {
            return Err(refuse(format!(
                "the mesh is inside out (volume {volume:.6e} m³); turn its triangles, counter-clockwise \
                 seen from outside"
            )));
        }
        let centroid = middle + first.centroid();
        let local = Mesh::new(mesh, centroid, ROUNDING * size);
        if !local.hollow() {
            let (hull, shift) = Polyhedron::hull(&local.triangles.vertices, ROUNDING)?;
            if (hull.volume() - volume).abs() <= SAME * volume {
                return Ok((hull.into(), centroid + shift));
            }
        }
        let about = moments(centroid);
        let inertia = about.inertia();
        let [a, b, c] = [inertia.x_axis.x, inertia.y_axis.y, inertia.z_axis.z];
        if !(a > 0.0 && b > 0.0 && c > 0.0 && inertia.determinant() > 0.0) {
            let message = "the mesh crosses itself (its inertia is not positive); repair it";
            return Err(refuse(message.into()));
        }
        let unlike = |parts: &[(Polyhedron, DVec3)]| {
            let sum: f64 = parts.iter().map(|(p, _)| p.volume()).sum();
            (sum - volume) / volume
        };
        let tried = DEVIATIONS.iter().filter_map(|deviation| {
            let parts = convex_parts(&local, deviation * size)?;
            let limit = if *deviation == ROUNDING { SAME } else { UNLIKE };
            (unlike(&parts).abs() <= limit).then_some(parts)
        });
        let Some(parts) = tried.into_iter().next() else {
            return Err(refuse(format!(
                "no compound of at most {PARTS} convex parts comes within {} % of the mesh's volume of \
                 {volume:.6e} m³; simplify or repair it, or give its convex parts",
                100.0 * UNLIKE
            )));
        };
        let parts = parts.into_iter().map(|(polyhedron, offset)| Part {
            form: Form::Convex(polyhedron),
            offset,
        });
        Ok((
            Self::of(parts.collect(), DVec3::ZERO, volume, inertia),
            centroid,
        ))
    }
}
