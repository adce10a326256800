//! Shapes of a scene's blocks, about their centroids.

use crate::{
    Error, Result,
    geometry::{Form, HalfSpace, Part, Polyhedron, Shape, TriangleMesh, WindingTree},
    scene::{BlockShape, PlaneFace, Rotation, Scene},
};
use glam::{DQuat, DVec3};
use std::path::Path;

/// The shape of the table `key`, and its centroid (m) in the block's own frame.
pub(crate) fn shape(scene: &Scene, key: &str, shape: &BlockShape) -> Result<(Shape, DVec3)> {
    let about_centre = |made: Result<Polyhedron>| made.map(|made| (made.into(), DVec3::ZERO));
    match shape {
        BlockShape::Box { size } => about_centre(Polyhedron::cuboid(DVec3::from(*size))),
        BlockShape::Tetrahedron { edge } => about_centre(Polyhedron::tetrahedron(*edge)),
        BlockShape::Octahedron { edge } => about_centre(Polyhedron::octahedron(*edge)),
        BlockShape::Dodecahedron { edge } => about_centre(Polyhedron::dodecahedron(*edge)),
        BlockShape::Icosahedron { edge } => about_centre(Polyhedron::icosahedron(*edge)),
        BlockShape::Vertices { vertices } => hull(vertices),
        BlockShape::HalfSpaces { faces } => {
            Polyhedron::from_half_spaces(&half_spaces(faces)).map(|(made, c)| (made.into(), c))
        }
        BlockShape::Sphere { radius } => Shape::sphere(*radius).map(|made| (made, DVec3::ZERO)),
        BlockShape::Mesh { file, scale, hull } => {
            let path = scene.dir().join(file);
            return mesh_shape(&path, *scale, *hull);
        }
        BlockShape::Compound { parts } => return compound(scene, key, parts),
    }
    .map_err(|error| error.at_key(|what| format!("{key}.{what}")))
}

/// The hull of points.
pub(super) fn hull(points: &[[f64; 3]]) -> Result<(Shape, DVec3)> {
    let points: Vec<DVec3> = points.iter().copied().map(DVec3::from).collect();
    Polyhedron::from_vertices(&points).map(|(made, centroid)| (made.into(), centroid))
}

/// The half-spaces of a table, with unit normals.
pub(super) fn half_spaces(faces: &[PlaneFace]) -> Vec<HalfSpace> {
    let half_space = |face: &PlaneFace| HalfSpace {
        normal: DVec3::from(face.normal).normalize(),
        distance: face.distance,
    };
    faces.iter().map(half_space).collect()
}

fn compound(scene: &Scene, key: &str, parts: &[crate::scene::Part]) -> Result<(Shape, DVec3)> {
    let mut placed = Vec::new();
    for (number, part) in parts.iter().enumerate() {
        let key = format!("{key}.parts[{number}]");
        let (made, centroid) = shape(scene, &key, &part.shape)?;
        let turn = rotation(&part.rotation);
        for piece in made.parts() {
            let (form, shift) = turned(&piece.form, turn)
                .map_err(|error| error.at_key(|what| format!("{key}.{what}")))?;
            placed.push(Part {
                form,
                offset: DVec3::from(part.position) + turn * (centroid + piece.offset) + shift,
            });
        }
    }
    Shape::compound(placed).map_err(|error| error.at_key(|what| format!("{key}.{what}")))
}

/// A form rotated about its centroid, and the shift of the centroid by rounding, m.
fn turned(form: &Form, turn: DQuat) -> Result<(Form, DVec3)> {
    match form {
        Form::Convex(shape) if turn != DQuat::IDENTITY => {
            let corners: Vec<DVec3> = shape.vertices().iter().map(|v| turn * *v).collect();
            let (shape, shift) = Polyhedron::from_vertices(&corners)?;
            Ok((Form::Convex(shape), shift))
        }
        _ => Ok((form.clone(), DVec3::ZERO)),
    }
}

/// The quaternion of a rotation in a scene.
pub(crate) fn rotation(rotation: &Rotation) -> DQuat {
    if rotation.angle == 0.0 {
        return DQuat::IDENTITY;
    }
    let axis = DVec3::from(rotation.axis).normalize();
    DQuat::from_axis_angle(axis, rotation.angle.to_radians())
}

/// The shape of the mesh at `path`, or its hull, and its centroid, m.
pub(super) fn mesh_shape(path: &Path, scale: f64, hull: bool) -> Result<(Shape, DVec3)> {
    if !hull {
        return Shape::read(path, scale);
    }
    let mesh = closed_mesh(path, scale, DVec3::ZERO)?;
    match Polyhedron::from_vertices(&mesh.vertices) {
        Ok((made, centroid)) => Ok((made.into(), centroid)),
        Err(error) => Err(Error::file(path, error)),
    }
}

/// Whether a point is inside the mesh at `path`.
pub(super) fn in_mesh(
    path: &Path,
    scale: f64,
    translate: DVec3,
) -> Result<Box<dyn Fn(DVec3) -> bool>> {
    let tree = WindingTree::new(&closed_mesh(path, scale, translate)?);
    // Half-way between outside and inside, for either orientation of the triangles.
    Ok(Box::new(move |x| tree.at(x).abs() > 0.5))
}

/// The closed mesh at `path`.
pub(super) fn closed_mesh(path: &Path, scale: f64, translate: DVec3) -> Result<TriangleMesh> {
    let mesh = TriangleMesh::read(path, scale, translate.to_array())?;
    mesh.closed()
        .map_err(|message| Error::file(path, message))?;
    Ok(mesh)
}
