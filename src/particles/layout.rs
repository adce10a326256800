//! Structures of the kernels as they lie in memory.

use bytemuck::{Pod, Zeroable};
use glam::{DMat3, DVec3};

/// A particle of the water or of a shell.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Particle {
    /// Quanta; the first negative, −1 less itself: it has left there.
    pub at: [i32; 3],
    /// What it is called, or the number of a particle of a shell.
    pub id: u32,
    /// In speeds of sound.
    pub velocity: [f32; 3],
    /// Density less the reference density, in parts of it; of a particle of a shell its pressure.
    pub excess: f32,
}

/// Puts those that have left in the order of their ids, in the places of their like: the device sorts them last, as they
/// arrived, and which of two arrives first is left to it.
pub fn order_those_left(particles: &mut [Particle]) {
    let has_left = |particle: &Particle| particle.at[0] < 0;
    let mut left: Vec<_> = particles.iter().copied().filter(has_left).collect();
    left.sort_unstable_by_key(|particle| particle.id);
    let places = particles.iter_mut().filter(|particle| has_left(particle));
    places
        .zip(left)
        .for_each(|(place, particle)| *place = particle);
}

/// The place of a shell's particle in its body.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Home {
    /// From the centroid, in the body's frame, spacings.
    pub place: [f32; 3],
    /// Number of the body.
    pub body: u32,
}

/// How a body moves.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Motion {
    /// Centroid, quanta.
    pub centre: [i32; 3],
    /// Number of the first particle of its shell.
    pub first: u32,
    /// In speeds of sound.
    pub velocity: [f32; 3],
    /// Number of the particles of its shell.
    pub count: u32,
    /// Spacings over the square of the unit of time.
    pub acceleration: [f32; 3],
    /// 1 where water clings to it, 0 where it slides.
    pub clings: f32,
    /// Columns of F.
    pub turn: [[f32; 4]; 3],
    /// Columns of Ḟ.
    pub rate: [[f32; 4]; 3],
    /// Columns of F̈.
    pub change: [[f32; 4]; 3],
}

impl Motion {
    pub(super) fn of(
        centre: [i32; 3],
        shell: [u32; 2],
        [velocity, acceleration]: [DVec3; 2],
        [turn, rate, change]: [DMat3; 3],
        clings: bool,
    ) -> Self {
        Self {
            centre,
            first: shell[0],
            velocity: velocity.as_vec3().to_array(),
            count: shell[1],
            acceleration: acceleration.as_vec3().to_array(),
            clings: if clings { 1.0 } else { 0.0 },
            turn: columns(turn),
            rate: columns(rate),
            change: columns(change),
        }
    }
}

fn columns(m: DMat3) -> [[f32; 4]; 3] {
    [m.x_axis, m.y_axis, m.z_axis].map(|v| v.extend(0.0).as_vec4().to_array())
}

/// The time of the particles within an exchange.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Clock {
    /// Length of the coming step; 0: the exchange is over.
    pub step: f32,
    /// Longest step that the last one allowed.
    pub limit: f32,
    /// From the start of the exchange.
    pub elapsed: f32,
    /// To its end.
    pub left: f32,
    /// Steps since the start of the exchange.
    pub steps: u32,
    /// 1 and the highest id of a particle that is nowhere, or 0.
    pub fault: u32,
    /// Particles that have left since the start.
    pub escaped: u32,
    /// The longest list of neighbours that had no room; 0 if all had.
    pub crowd: u32,
    /// The step that waits for room.
    pub held: f32,
    /// The longest list of a shell's particle that had no room; 0 if all had.
    pub shell_crowd: u32,
    /// 1: the coming step sorts the particles anew and makes the lists of neighbours.
    pub stale: u32,
    /// By how much two particles may have come nearer since the lists were made, spacings.
    pub travel: f32,
    /// The fastest that any body moves, in speeds of sound.
    pub body_speed: f32,
    /// Particles that had left when the lists were looked at last.
    pub missed: u32,
    /// Steps since the start of the exchange that sorted.
    pub sorts: u32,
    /// The highest speed at the end of any step since the start, in speeds of sound.
    pub fastest: f32,
    /// Work since the start of the exchange of particles of shells beyond that of their bodies, in m c₀², m being the mass
    /// of a particle.
    pub pressed: f32,
    /// That of what pushes water out of bodies.
    pub pushed: f32,
}

/// What a particle of water has of bodies beside it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Shelter {
    /// 1 if a particle of a shell is near it.
    pub near: u32,
    /// Work on it in a step of particles of shells, beyond what their bodies did, in m c₀².
    pub pressed: f32,
    /// Work on it in a step of what pushes it out of a body.
    pub pushed: f32,
}

/// A convex part of a body, by its faces.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Hull {
    /// Centre of its circumscribed sphere in the body's frame, spacings.
    pub centre: [f32; 3],
    /// Radius of that, spacings; where it has no faces it is a sphere.
    pub radius: f32,
    /// Number of the body.
    pub body: u32,
    /// Its first face.
    pub first_face: u32,
    /// Number of its faces.
    pub faces: u32,
    /// How many of them, the first ones, water may meet.
    pub bare: u32,
}

#[cfg(test)]
mod tests {
    use super::{Particle, order_those_left};

    #[test]
    fn those_that_have_left_are_in_one_order_however_they_arrived() {
        let particle = |x, id| Particle {
            at: [x, 0, 0],
            id,
            ..Particle::default()
        };
        let expected = [(5, 3), (-1, 2), (7, 1), (-9, 4), (-3, 6)].map(|(x, id)| particle(x, id));
        for arrived in [[1, 3, 4], [4, 1, 3], [3, 4, 1]] {
            let mut found = expected;
            for (place, from) in [1, 3, 4].into_iter().zip(arrived) {
                found[place] = expected[from];
            }
            order_those_left(&mut found);
            assert_eq!(found, expected);
        }
    }
}
