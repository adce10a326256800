//! The faces of bodies, for walls that are springs.

use super::{Frame, Hull, Setup};
use crate::{Error, Result, block::Form};

/// The convex parts of all bodies in the `order` of the device, and their faces: outward normal, and distance
/// from the body's centroid in spacings.
pub(super) fn hulls(
    setup: &Setup,
    frame: &Frame,
    order: &[usize],
) -> Result<(Vec<Hull>, Vec<[f32; 4]>)> {
    let (mut hulls, mut planes) = (Vec::new(), Vec::new());
    for (number, &body) in order.iter().enumerate() {
        let Some(shape) = &setup.bodies[body].shape else {
            continue;
        };
        for part in shape.parts() {
            let Form::Convex(polyhedron) = &part.form else {
                return Err(Error::scene(
                    "particles.scheme",
                    "`mueller` has walls of plane faces, and a block is a sphere; use `delta`",
                ));
            };
            hulls.push(Hull {
                centre: frame.length(part.offset).as_vec3().to_array(),
                radius: frame.length(glam::DVec3::X * polyhedron.radius()).x as f32,
                body: number as u32,
                first_face: planes.len() as u32,
                faces: polyhedron.faces().len() as u32,
                unused: 0,
            });
            for face in polyhedron.faces() {
                let from_body = face.distance + face.normal.dot(part.offset);
                let distance = frame.length(glam::DVec3::X * from_body).x;
                let normal = face.normal.as_vec3();
                planes.push([normal.x, normal.y, normal.z, distance as f32]);
            }
        }
    }
    Ok((hulls, planes))
}
