//! Convex parts of bodies that repel the particles inside them.

use super::{CellGrid, Hull, Scheme, Setup, Solid};
use crate::{Error, Result};
use glam::DVec3;

/// Most loop iterations of an invocation over hulls. Software adapters silently end the loops of an invocation after
/// 65 535 iterations, some of which the loops over neighbours need.
pub(super) const MAX_LOOP_ITERATIONS: u32 = 60_000;

/// Loop iterations of the penalty force of `hulls` on a particle. Each loop takes one more iteration, the one that
/// ends it.
pub(super) fn loop_iterations<'a>(hulls: impl Iterator<Item = &'a Hull>) -> u32 {
    let of_hull = |hull: &Hull| 3_u32.saturating_add(hull.faces);
    hulls.map(of_hull).fold(2, u32::saturating_add)
}

/// Checks that an invocation on `device` can loop over all of `hulls`.
pub(super) fn check_loop_iterations(device: &wgpu::Device, hulls: &[Hull]) -> Result<()> {
    let software = device.adapter_info().device_type == wgpu::DeviceType::Cpu;
    let iterations = loop_iterations(hulls.iter());
    if !software || iterations <= MAX_LOOP_ITERATIONS {
        return Ok(());
    }
    Err(Error::argument(
        "bodies",
        format!(
            "the penalty force of {} convex parts takes {iterations} loop iterations, and a software adapter has \
             {MAX_LOOP_ITERATIONS}; use a GPU, or fewer and simpler fixed blocks",
            hulls.len()
        ),
    ))
}

/// Hulls of all bodies, and their faces.
pub(super) struct HullSet {
    /// Hulls in the order of the bodies on the device.
    pub hulls: Vec<Hull>,
    /// Outward normal, and distance from the body's centroid in spacings; exposed faces of a hull come first.
    pub planes: Vec<[f32; 4]>,
}

/// The convex parts of the bodies in the `order` of the device. With boundary particles only fixed bodies have hulls:
/// the penalty force has no reaction on the body, and on a moving body it would create energy.
pub(super) fn hulls(setup: &Setup, grid: &CellGrid, order: &[usize]) -> HullSet {
    let (mut hulls, mut planes) = (Vec::new(), Vec::new());
    let length = |length: f64| grid.length(DVec3::X * length).x as f32;
    for (index, &body) in order.iter().enumerate() {
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
                centre: grid.length(centre).as_vec3().to_array(),
                radius: length(radius),
                body: index as u32,
                first_face: planes.len() as u32,
                ..Hull::default()
            };
            if let Solid::Faces(faces) = solid {
                hull.exposed = faces.exposed.len() as u32;
                hull.faces = hull.exposed + faces.internal.len() as u32;
                planes.extend(faces.exposed.iter().chain(&faces.internal).map(|face| {
                    let normal = face.normal.as_vec3();
                    [normal.x, normal.y, normal.z, length(face.distance)]
                }));
            }
            hulls.push(hull);
        }
    }
    HullSet { hulls, planes }
}
