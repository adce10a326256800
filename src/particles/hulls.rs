//! The faces of bodies, behind which no water may be.

use super::{Frame, Hull, Scheme, Setup, Solid};
use glam::DVec3;

/// The convex parts of bodies in the `order` of the device, and their faces, bare ones first: outward normal, and
/// distance from the body's centroid in spacings. Where walls are shells, only those of bodies that do not move: the
/// push has no reaction, which would be energy from nowhere beside a moving one.
pub(super) fn hulls(setup: &Setup, frame: &Frame, order: &[usize]) -> (Vec<Hull>, Vec<[f32; 4]>) {
    let (mut hulls, mut planes) = (Vec::new(), Vec::new());
    let length = |length: f64| frame.length(DVec3::X * length).x as f32;
    for (number, &body) in order.iter().enumerate() {
        let body = &setup.bodies[body];
        if setup.scheme == Scheme::Delta && body.moves {
            continue;
        }
        for solid in &body.solids {
            let (centre, radius) = match solid {
                Solid::Sphere { centre, radius } => (*centre, *radius),
                Solid::Faces(faces) => (faces.centre, faces.radius),
            };
            let mut hull = Hull {
                centre: frame.length(centre).as_vec3().to_array(),
                radius: length(radius),
                body: number as u32,
                first_face: planes.len() as u32,
                ..Hull::default()
            };
            if let Solid::Faces(faces) = solid {
                hull.bare = faces.bare.len() as u32;
                hull.faces = hull.bare + faces.seams.len() as u32;
                planes.extend(faces.bare.iter().chain(&faces.seams).map(|face| {
                    let normal = face.normal.as_vec3();
                    [normal.x, normal.y, normal.z, length(face.distance)]
                }));
            }
            hulls.push(hull);
        }
    }
    (hulls, planes)
}
