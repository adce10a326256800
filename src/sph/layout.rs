//! Memory layout of the structures of the kernels.
//!
//! Device units: lengths in spacings Δx, times in Δx/c₀, velocities in c₀, masses in particle masses m.

use bytemuck::{Pod, Zeroable};
use glam::{DMat3, DVec3};

/// A fluid or boundary particle.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Particle {
    /// Position, quanta. A particle that has left the domain has the first component −1 − x.
    pub at: [i32; 3],
    /// Identity of a fluid particle; index of a boundary particle.
    pub id: u32,
    /// Velocity, in speeds of sound.
    pub velocity: [f32; 3],
    /// ρ/ρ₀ − 1 of a fluid particle; pressure of a boundary particle, in ρ₀ c₀².
    pub excess: f32,
}

/// Sorts the escaped particles by id within the slots that they occupy. The device stores them last, in an order of
/// arrival that differs between devices.
pub fn sort_escaped(particles: &mut [Particle]) {
    let has_escaped = |particle: &Particle| particle.at[0] < 0;
    let mut escaped: Vec<_> = particles.iter().copied().filter(has_escaped).collect();
    escaped.sort_unstable_by_key(|particle| particle.id);
    let slots = particles
        .iter_mut()
        .filter(|particle| has_escaped(particle));
    slots
        .zip(escaped)
        .for_each(|(slot, particle)| *slot = particle);
}

/// Position of a boundary particle in its body.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ReferencePosition {
    /// Position relative to the centroid, in the body's frame, spacings.
    pub position: [f32; 3],
    /// Index of the body.
    pub body: u32,
}

/// Motion of a body.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct BodyMotion {
    /// Centroid, quanta.
    pub centre: [i32; 3],
    /// Index of its first boundary particle.
    pub first: u32,
    /// Velocity, in speeds of sound.
    pub velocity: [f32; 3],
    /// Number of its boundary particles.
    pub count: u32,
    /// Acceleration, in spacings per square of the unit of time.
    pub acceleration: [f32; 3],
    /// 1 for a no-slip surface, 0 for free slip.
    pub no_slip: f32,
    /// Columns of F.
    pub deformation: [[f32; 4]; 3],
    /// Columns of Ḟ.
    pub deformation_rate: [[f32; 4]; 3],
    /// Columns of F̈.
    pub deformation_acceleration: [[f32; 4]; 3],
}

/// The columns of a matrix, padded to 16 bytes each.
pub(super) fn columns(m: DMat3) -> [[f32; 4]; 3] {
    [m.x_axis, m.y_axis, m.z_axis].map(|v: DVec3| v.extend(0.0).as_vec4().to_array())
}

/// Time of the particles within an exchange.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Clock {
    /// Length of the next step; 0 when the exchange is complete.
    pub step: f32,
    /// Upper bound on the length of the next step.
    pub step_limit: f32,
    /// Time since the start of the exchange.
    pub elapsed: f32,
    /// Time to the end of the exchange.
    pub remaining: f32,
    /// Steps since the start of the exchange.
    pub steps: u32,
    /// Highest id of a particle with a non-finite state, plus 1; 0 if there is none.
    pub invalid_particle: u32,
    /// Particles that have left the domain since the start.
    pub escaped: u32,
    /// Length of the longest neighbour list of a fluid particle that exceeds its capacity; 0 if none does.
    pub overflow: u32,
    /// Length of the step that is postponed until the lists have been enlarged.
    pub pending_step: f32,
    /// Length of the longest neighbour list of a boundary particle that exceeds its capacity; 0 if none does.
    pub boundary_overflow: u32,
    /// 1 if the next step sorts the particles and rebuilds the neighbour lists.
    pub stale: u32,
    /// Bound on the approach of any two particles since the lists were built, spacings.
    pub list_displacement: f32,
    /// Largest speed of any boundary particle, in speeds of sound.
    pub max_body_speed: f32,
    /// Escaped particles when the lists were last checked.
    pub escaped_at_sort: u32,
    /// Steps since the start of the exchange that sorted the particles.
    pub sorts: u32,
    /// Largest speed at the end of any step since the start, in speeds of sound.
    pub max_speed: f32,
    /// Work of boundary particles beyond the work of their bodies since the start of the exchange, m c₀².
    pub boundary_work: f32,
    /// Work of the penalty force since the start of the exchange, m c₀².
    pub penalty_work: f32,
    /// Particles that crossed the periodic boundary of each axis upwards since the start of the exchange, less those downwards.
    pub crossings: [i32; 3],
}

/// Work of walls and bodies on a fluid particle in a step.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct WallWork {
    /// 1 if a boundary particle is near.
    pub near_boundary: u32,
    /// Work of boundary particles beyond the work of their bodies, m c₀².
    pub boundary_work: f32,
    /// Work of the penalty force, m c₀².
    pub penalty_work: f32,
}

/// A convex part of a body, bounded by its faces.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Hull {
    /// Centre of the bounding sphere in the body's frame, spacings.
    pub centre: [f32; 3],
    /// Radius of the bounding sphere, spacings. A hull without faces is this sphere.
    pub radius: f32,
    /// Index of the body.
    pub body: u32,
    /// Index of its first face.
    pub first_face: u32,
    /// Number of its faces.
    pub faces: u32,
    /// Number of exposed faces, which come first; the others are internal.
    pub exposed: u32,
}

#[cfg(test)]
mod tests {
    use super::{Particle, sort_escaped};

    #[test]
    fn escaped_particles_are_sorted_by_id() {
        let particle = |x, id| Particle {
            at: [x, 0, 0],
            id,
            ..Particle::default()
        };
        let expected = [(5, 3), (-1, 2), (7, 1), (-9, 4), (-3, 6)].map(|(x, id)| particle(x, id));
        for arrived in [[1, 3, 4], [4, 1, 3], [3, 4, 1]] {
            let mut found = expected;
            for (slot, from) in [1, 3, 4].into_iter().zip(arrived) {
                found[slot] = expected[from];
            }
            sort_escaped(&mut found);
            assert_eq!(found, expected);
        }
    }
}
