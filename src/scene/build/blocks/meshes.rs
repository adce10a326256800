//! Blocks and regions from files of triangles.

use crate::{
    Error, Result,
    geometry::{Polyhedron, Shape, TriangleMesh, WindingTree},
};
use glam::DVec3;
use std::path::Path;

/// The shape of the mesh at `path`, or its hull, and its centroid, m.
pub(super) fn shape(path: &Path, scale: f64, hull: bool) -> Result<(Shape, DVec3)> {
    if !hull {
        return Shape::read(path, scale);
    }
    let mesh = closed(path, scale, DVec3::ZERO)?;
    match Polyhedron::from_vertices(&mesh.vertices) {
        Ok((made, centroid)) => Ok((made.into(), centroid)),
        Err(error) => Err(Error::file(path, error)),
    }
}

/// Whether a point is inside the mesh at `path`.
pub(super) fn inside(
    path: &Path,
    scale: f64,
    translate: DVec3,
) -> Result<Box<dyn Fn(DVec3) -> bool>> {
    let tree = WindingTree::new(&closed(path, scale, translate)?);
    // Half-way between outside and inside, whichever way the triangles turn.
    Ok(Box::new(move |x| tree.at(x).abs() > 0.5))
}

/// The closed mesh at `path`.
pub(super) fn closed(path: &Path, scale: f64, translate: DVec3) -> Result<TriangleMesh> {
    let mesh = TriangleMesh::read(path, scale, translate.to_array())?;
    mesh.closed()
        .map_err(|message| Error::file(path, message))?;
    Ok(mesh)
}
