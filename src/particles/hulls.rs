//! The faces of bodies, behind which no water may be.

use super::{Frame, Hull, Scheme, Setup, Solid};
use crate::{Error, Result};
use glam::DVec3;

/// Turns of loops that an invocation may take in all: software adapters end its loops, without a word, after 65 535, and the
/// neighbours of a particle want some.
pub(super) const TURNS: u32 = 60_000;

/// Turns of loops in the push of `hulls` on a particle: each loop has one more, in which it finds its end.
pub(super) fn turns<'a>(hulls: impl Iterator<Item = &'a Hull>) -> u32 {
    let of = |hull: &Hull| 3_u32.saturating_add(hull.faces);
    hulls.map(of).fold(2, u32::saturating_add)
}

/// Whether an invocation on `device` has turns enough for all of `hulls`.
pub(super) fn check(device: &wgpu::Device, hulls: &[Hull]) -> Result<()> {
    let software = device.adapter_info().device_type == wgpu::DeviceType::Cpu;
    let turns = turns(hulls.iter());
    if !software || turns <= TURNS {
        return Ok(());
    }
    Err(Error::scene(
        "blocks",
        format!(
            "the {} convex parts that push water out would take {turns} turns of loops, and a software adapter has {TURNS}; \
             use a GPU, or fewer and simpler fixed blocks",
            hulls.len()
        ),
    ))
}

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
