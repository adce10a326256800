//! The bodies of a setup from its blocks: their hulls, their motion between exchanges, and the loads of the water on them.

use super::{
    Body, CellGrid, Counts, Hull, ParticleLattice, Scheme, Setup, Solid,
    neighbour_lists::Buffers,
    solid::{ConvexPart, mark_covered_faces, solids},
};
use crate::{
    Error, Result,
    geometry::{PlaneFace, Pose, outer, plane_faces},
    gpu::{bins::WORKGROUP, buffers::uniform, kernel::Kernel},
    rock::{Block, Motion},
};
use glam::{DMat3, DQuat, DVec3};

/// The bodies of `blocks` with their `boundary` particles ([`boundary_particles`](super::boundary_particles)), none of
/// them with free slip. `is_probed` selects the blocks whose loads are measured.
pub fn bodies(
    blocks: &[Block],
    boundary: Vec<Vec<DVec3>>,
    lattice: &ParticleLattice,
    scheme: Scheme,
    is_probed: impl Fn(&Block) -> bool,
) -> Vec<Body> {
    let boundary = transfer_interior(blocks, boundary, &is_probed);
    let mut solids = solids(blocks, lattice);
    if scheme == Scheme::Delta {
        mark_covered_faces(blocks, &mut solids, lattice);
    }
    let bodies = blocks.iter().zip(boundary).zip(solids);
    let bodies = bodies.map(|((block, boundary), solids)| Body {
        strain_areas: strain_areas(block, &boundary, lattice.spacing),
        boundary,
        solids: solids
            .into_iter()
            .map(|solid| solid.in_body_frame(block))
            .collect(),
        moves: block.motion != Motion::Fixed,
        // The energy ledger needs the loads on all moving bodies.
        loaded: block.motion != Motion::Fixed || is_probed(block),
        accelerates: matches!(block.motion, Motion::Driven { .. }),
        free_slip: false,
    });
    bodies.collect()
}

/// [`Body::strain_areas`] of a block with these `boundary` particles (m, in its frame). The particles in the first layer of a face and
/// of no other face, if there are any, share its area equally: one face of an edge may be in a joint.
fn strain_areas(block: &Block, boundary: &[DVec3], spacing: f64) -> Vec<DMat3> {
    if block.deformable.is_none() {
        return Vec::new();
    }
    let mut areas = vec![DMat3::ZERO; boundary.len()];
    let rest = Pose::at_rest(DVec3::ZERO, DQuat::IDENTITY);
    let parts = block.shape.parts().iter().enumerate();
    let faces = parts.flat_map(|(number, part)| plane_faces(number, part, &rest));
    let faces: Vec<_> = faces.collect();
    let is_first = |face: &PlaneFace, x: DVec3| face.normal.dot(face.centre - x) < spacing;
    for face in &faces {
        let depth = |x: DVec3| face.normal.dot(face.centre - x);
        let all = boundary.iter().enumerate();
        let mut first: Vec<_> = all.filter(|(_, x)| is_first(face, **x)).collect();
        let alone = |x: DVec3| faces.iter().filter(|f| is_first(f, x)).count() == 1;
        if first.iter().any(|(_, x)| alone(**x)) {
            first.retain(|(_, x)| alone(**x));
        }
        let count = first.len() as f64;
        let foot = |x: DVec3| x + depth(x) * face.normal;
        let mean = first.iter().map(|(_, x)| foot(**x)).sum::<DVec3>() / count;
        for (index, x) in first {
            let dyad = outer(face.normal, foot(*x) - mean + face.centre) * (face.area / count);
            areas[index] += (dyad + dyad.transpose()) * 0.5;
        }
    }
    areas
}

/// Transfers the boundary particles that a fixed block with a load probe (`is_probed`) has inside adjacent walls to a
/// fixed block without one, so that the load on the probed block acts on its own surface only.
fn transfer_interior(
    blocks: &[Block],
    mut boundary: Vec<Vec<DVec3>>,
    is_probed: impl Fn(&Block) -> bool,
) -> Vec<Vec<DVec3>> {
    let is_fixed = |block: &Block| block.motion == Motion::Fixed;
    let takes = |block: &Block| is_fixed(block) && !is_probed(block);
    let Some(target) = blocks.iter().position(takes) else {
        return boundary;
    };
    for (n, block) in blocks.iter().enumerate() {
        if !is_fixed(block) || !is_probed(block) {
            continue;
        }
        let parts = ConvexPart::of_block(block);
        let world = |x: &DVec3| block.centre + block.rotation * *x;
        let is_own = |x: &DVec3| parts.iter().any(|part| part.depth(world(x)) > 0.0);
        let (kept, beyond): (Vec<_>, Vec<_>) = boundary[n].iter().copied().partition(is_own);
        boundary[n] = kept;
        let to = &blocks[target];
        let moved = beyond
            .iter()
            .map(|x| to.rotation.inverse() * (world(x) - to.centre));
        boundary[target].extend(moved);
    }
    boundary
}

/// Largest number of loop iterations over hulls per invocation. Software adapters silently end the loops of an invocation after
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

/// The kernel that sums the loads, with one bind group per range of particles.
#[derive(Debug)]
pub(super) struct BodyLoads {
    kernel: Kernel,
    bind_groups: Vec<wgpu::BindGroup>,
}

impl BodyLoads {
    /// Loads from the forces on boundary particles.
    pub fn of_boundary(
        device: &wgpu::Device,
        kernel: Kernel,
        buffers: &Buffers<'_>,
    ) -> Result<Self> {
        let bind_groups = vec![kernel.bind(device, buffers)?];
        Ok(Self {
            kernel,
            bind_groups,
        })
    }

    /// Loads from the penalty forces of `hulls`. On software adapters a dispatch covers a range of particles, so that
    /// no invocation exceeds [`MAX_LOOP_ITERATIONS`].
    pub fn of_hulls(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        kernel: Kernel,
        counts: Counts,
        hulls: &[Hull],
        buffers: &Buffers<'_>,
    ) -> Result<Self> {
        let of_body = |body| loop_iterations(hulls.iter().filter(|hull| hull.body == body));
        let most = (0..counts.loaded_bodies).map(of_body).max().unwrap_or(1);
        let range = match device.adapter_info().device_type {
            wgpu::DeviceType::Cpu => WORKGROUP * (MAX_LOOP_ITERATIONS / most).max(1),
            _ => counts.fluid.max(1),
        };
        let mut bind_groups = Vec::new();
        for first in (0..counts.fluid).step_by(range as usize) {
            let end = first.saturating_add(range).min(counts.fluid);
            let range = uniform(device, "range of particles", 8);
            queue.write_buffer(&range, 0, bytemuck::cast_slice(&[first, end]));
            let mut all = buffers.to_vec();
            all.push(("range", &range));
            bind_groups.push(kernel.bind(device, &all)?);
        }
        Ok(Self {
            kernel,
            bind_groups,
        })
    }

    /// Records the loads of the first `bodies` bodies.
    pub fn record(&self, pass: &mut wgpu::ComputePass<'_>, bodies: u32) {
        for bind_group in &self.bind_groups {
            self.kernel.record(pass, bind_group, bodies);
        }
    }
}

/// Index of the first hull of each body, and the number of hulls as the last entry.
pub(super) fn hull_starts(hulls: &[Hull], bodies: u32) -> Vec<u32> {
    let first = |body: u32| hulls.partition_point(|hull| hull.body < body) as u32;
    (0..=bodies).map(first).collect()
}

/// The bodies at the start of the last exchange.
#[derive(Clone, Debug, Default)]
pub(super) struct BodyHistory {
    /// Largest distance of a boundary particle from the centroid of its body, m.
    radii: Vec<f64>,
    /// Poses at the start of the last exchange; empty after a restart.
    poses: Vec<Pose>,
    /// Velocity (m/s) and Ḟ (1/s) of each body at the start of the last exchange.
    pub previous_rates: Vec<(DVec3, DMat3)>,
    /// Length of the last exchange, s.
    pub last_duration: f64,
}

impl BodyHistory {
    /// The history before the first exchange.
    pub fn new(bodies: &[Body]) -> Self {
        let radius = |body: &Body| {
            let distances = body.boundary.iter().map(|x| x.length());
            distances.fold(0.0, f64::max)
        };
        Self {
            radii: bodies.iter().map(radius).collect(),
            ..Self::default()
        }
    }

    /// The history after a restart with these rates; the previous poses are unknown.
    pub fn restored(&self, previous_rates: &[(DVec3, DMat3)], last_duration: f64) -> Self {
        Self {
            radii: self.radii.clone(),
            poses: Vec::new(),
            previous_rates: previous_rates.to_vec(),
            last_duration,
        }
    }

    /// Acceleration (m/s²) and F̈ (1/s²) of a body over the last exchange; `None` before the second exchange.
    pub fn acceleration(&self, body: usize, pose: &Pose) -> Option<(DVec3, DMat3)> {
        let (velocity, deformation_rate) = self.previous_rates.get(body)?;
        let acceleration = (pose.velocity - *velocity) / self.last_duration;
        let change = (pose.deformation_rate - *deformation_rate) * (1.0 / self.last_duration);
        (self.last_duration > 0.0).then_some((acceleration, change))
    }

    /// Upper bound on the speed of any boundary particle, m/s.
    pub fn max_speed(&self, poses: &[Pose]) -> f64 {
        let speed = |(pose, radius): (&Pose, &f64)| {
            pose.velocity.length() + frobenius_norm(pose.deformation_rate) * radius
        };
        poses.iter().zip(&self.radii).map(speed).fold(0.0, f64::max)
    }

    /// Upper bound on the distance of any boundary particle from its position extrapolated over the last exchange, m.
    pub fn jump(&self, poses: &[Pose]) -> f64 {
        let jump = |((new, old), radius): ((&Pose, &Pose), &f64)| {
            let centre = old.centre + self.last_duration * old.velocity;
            let shape = old.deformation + old.deformation_rate * self.last_duration;
            (new.centre - centre).length() + frobenius_norm(new.deformation - shape) * radius
        };
        let jumps = poses.iter().zip(&self.poses).zip(&self.radii).map(jump);
        jumps.fold(0.0, f64::max)
    }

    /// Records the poses at the start of an exchange of `duration` (s).
    pub fn record(&mut self, poses: &[Pose], duration: f64) {
        self.poses.clear();
        self.poses.extend_from_slice(poses);
        let rates = poses
            .iter()
            .map(|pose| (pose.velocity, pose.deformation_rate));
        self.previous_rates = rates.collect();
        self.last_duration = duration;
    }
}

/// Frobenius norm, an upper bound on the spectral norm.
fn frobenius_norm(m: DMat3) -> f64 {
    m.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt()
}
