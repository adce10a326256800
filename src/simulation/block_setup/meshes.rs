//! Blocks and regions from files of triangles.

use crate::{
    Error, Result,
    block::{Polyhedron, Shape},
    solid::{TriangleMesh, WindingTree},
};
use glam::DVec3;
use std::path::Path;

/// The shape of the mesh at `path`, or its hull, and its centroid, m.
pub(super) fn shape(
    path: &Path,
    scale: f64,
    translate: DVec3,
    hull: bool,
) -> Result<(Shape, DVec3)> {
    let mesh = closed(path, scale, translate)?;
    let (made, centroid) = Polyhedron::from_vertices(&mesh.vertices).map_err(of_file(path))?;
    Ok((made.into(), centroid))
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

pub(super) fn closed(path: &Path, scale: f64, translate: DVec3) -> Result<TriangleMesh> {
    let mesh = TriangleMesh::read(path, scale, translate.to_array())?;
    mesh.closed()
        .map_err(|message| Error::file(path, message))?;
    Ok(mesh)
}

/// What a shape says of its faces or vertices, said of the file.
fn of_file(path: &Path) -> impl Fn(Error) -> Error + '_ {
    move |error| match error {
        Error::Scene { place, message } => Error::file(path, format!("{place}: {message}")),
        other => other,
    }
}
