//! Factors of safety of a block that stands: limit equilibrium of what it carries against what its contacts hold.
//!
//! A factor is what resists over what drives, from the weight W of the block, the force F of its point loads, of its
//! acceleration, and of the fluid on it with its buoyancy and all pressure in joints and under its base (in a lattice that of the rim where they are closed, see
//! [`crate::coupling::Coupled::wrench_with_uplift`]), and the contacts that it has: it stands while all are
//! above one. A block that is held, or has not moved yet, has no contacts: those faces of it count that lie on others.
//! Where nothing drives, up to a share of 1e-7, the rounding of loads that a device adds up, a factor is infinite; where there is no contact, none is known: NaN. Contacts
//! count as planes that press and rub and do not pull; what neighbours push with is not counted, nor is inertia: of a
//! block in motion the factors say what it would need to stand.
//!
//! With the resultant R = W + F, and planes with unit normals n into the block, areas A, cohesions c and friction
//! angles φ:
//!
//! | factor | definition | source |
//! |---|---|---|
//! | sliding on one plane | (c A + N′ tan φ)/T, N′ = −R·n, T = \|R + N′ n\| | Wyllie & Mah 2004, chapter 6 |
//! | sliding on two planes | Σ (c A + N′ tan φ)/T along their line of intersection s, T = R·s, the N′ from R = T s − Σ N′ n | Wyllie & Mah 2004, chapter 7; Goodman & Shi 1985, chapter 9 |
//! | uplift | W/(F·e), e against gravity | limit equilibrium of a body that floats |
//! | toppling | ΣM⁺/ΣM⁻ about an edge of the base: moments that hold the block over those that turn it over, of the parts of W along and across n, of the fluid, and of the point loads and the acceleration | Novak et al. 2007, Hydraulic Structures, §3.2; of W alone Wyllie & Mah 2004, chapter 9, Goodman & Bray 1976 |
//!
//! The fluid counts with its moment about the edge by its true line of action: thrust and uplift turn the block over, and
//! uplift, buoyancy included, is not taken from W, as in the practice of gravity dams. Both factors reach one together, where
//! the resultant goes through the edge; USACE (EM 1110-2-2200, 1995) judges by the place of that resultant alone. The fluid
//! is one load: water that presses down on a slope is netted with its thrust.
//!
//! Which planes a block slides on follows from the direction of R alone: it may move into no neighbour that it touches (Goodman &
//! Shi 1985, chapter 9).
//!
//! ```
//! use glam::DVec3;
//! use riprap::safety::{Mode, Plane, sliding, uplift};
//!
//! // 100 kN on a joint of 2 m² that dips by 30° along x, with a friction angle of 40° and no cohesion.
//! let weight = DVec3::Z * -1e5;
//! let (sin, cos) = 30f64.to_radians().sin_cos();
//! let joint = Plane {
//!     normal: DVec3::new(sin, 0.0, cos),
//!     area: 2.0,
//!     cohesion: 0.0,
//!     friction_angle: 40f64.to_radians(),
//! };
//! let found = sliding(weight, &[joint]);
//! assert!((found.factor - 40f64.to_radians().tan() / 30f64.to_radians().tan()).abs() < 1e-12);
//! // Water that carries a quarter of the weight.
//! assert_eq!(uplift(weight, -0.25 * weight), 4.0);
//! ```

mod sliding;
mod standing;
mod toppling;

pub use sliding::{Mode, Plane, Sliding, sliding};
pub use standing::{Footing, Standing};
pub use toppling::{Base, Wrench, toppling};

use glam::DVec3;

/// Share of what acts in all by which nothing drives: rounding of normals, arms and sums.
const ROUNDING: f64 = 1e-7;
/// Angle by which an open direction may lead into a plane, rad: normals of contacts tilt by 1e-6 to 1e-4, the overlap of
/// their faces over the width.
const TILT: f64 = 1e-3;

/// What resists over what drives; infinite where nothing drives but rounding of the `whole`.
fn factor(resisting: f64, driving: f64, whole: f64) -> f64 {
    if driving > ROUNDING * whole {
        resisting / driving
    } else {
        f64::INFINITY
    }
}

/// The weight (N, a vector) over the force of fluid and loads against it, buoyancy included (N): infinite where they
/// do not lift, NaN without weight.
pub fn uplift(weight: DVec3, lifting: DVec3) -> f64 {
    match weight.try_normalize() {
        Some(down) => factor(weight.length(), -lifting.dot(down), weight.length()),
        None => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A body under water has the ratio of the densities.
    #[test]
    fn archimedes() {
        let (rock, water, volume) = (2650.0, 1000.0, 0.3);
        let gravity = DVec3::new(0.0, 1.0, -9.8);
        let found = uplift(rock * volume * gravity, -water * volume * gravity);
        assert!((found - 2.65).abs() < 1e-14, "{found}");
    }

    #[test]
    fn what_does_not_lift_leaves_it_infinite() {
        assert_eq!(uplift(-DVec3::Z, DVec3::X), f64::INFINITY);
        assert_eq!(uplift(-DVec3::Z, -DVec3::Z), f64::INFINITY);
        assert!(uplift(DVec3::ZERO, DVec3::Z).is_nan());
    }
}
