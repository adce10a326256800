//! Factors of safety of a block at rest by limit equilibrium: the ratio of resisting to driving actions.
//!
//! The load consists of the weight W of the block and the force F of its point loads, of its applied acceleration, and of the
//! fluid on it, including buoyancy and all pressure in joints and under its base (in a lattice, closed joints have the
//! pressure of their rim, see [`crate::coupling::Coupled::wrench_with_uplift`]). The block is stable while all factors exceed
//! one. A block that is held or has not moved yet has no contacts; its faces that lie on other blocks replace them. A factor
//! is infinite if the driving action is less than 1e-7 of the whole load, the rounding of sums on a device, and NaN if there
//! is no contact. Contacts act as planes that transmit compression and friction but no tension. The forces by which
//! neighbours push the block are ignored, and so is its inertia: for a block in motion, the factors state what equilibrium
//! would require.
//!
//! With the resultant R = W + F, and planes with unit normals n into the block, areas A, cohesions c and friction
//! angles φ:
//!
//! | factor | definition | source |
//! |---|---|---|
//! | sliding on one plane | (c A + N′ tan φ)/T, N′ = −R·n, T = \|R + N′ n\| | Wyllie & Mah 2004, chapter 6 |
//! | sliding on two planes | Σ (c A + N′ tan φ)/T along their line of intersection s, T = R·s, the N′ from R = T s − Σ N′ n | Wyllie & Mah 2004, chapter 7; Goodman & Shi 1985, chapter 9 |
//! | uplift | W/(F·e), e against gravity | limit equilibrium of a floating body |
//! | toppling | ΣM⁺/ΣM⁻ about an edge of the base: stabilising over overturning moments of the components of W along and across n, of the fluid, and of the point loads and the acceleration | Novak et al. 2007, Hydraulic Structures, §3.2; for W alone Wyllie & Mah 2004, chapter 9, Goodman & Bray 1976 |
//!
//! The moment of the fluid about the edge follows from its true line of action: thrust and uplift are overturning, and uplift,
//! buoyancy included, is not subtracted from W, as in the practice of gravity dams. The factors with and without this
//! subtraction reach one together, when the resultant passes through the edge; USACE (EM 1110-2-2200, 1995) uses only the
//! location of that resultant. The fluid is one load: water that presses down on a slope is netted with its thrust.
//!
//! The planes on which a block slides follow from the direction of R alone: the block must not move into a neighbour that it
//! touches (Goodman & Shi 1985, chapter 9).
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

mod safety_factors;
mod sliding;
mod toppling;

pub use safety_factors::{SafetyFactors, Supports};
pub use sliding::{Mode, Plane, Sliding, sliding};
pub use toppling::{Base, Wrench, toppling};

use glam::DVec3;

/// Fraction of the whole load below which a driving action is zero: rounding of normals, lever arms and sums.
const ROUNDING: f64 = 1e-7;
/// Angle by which an admissible direction may point into a plane, rad: contact normals tilt by 1e-6 to 1e-4, the ratio of
/// overlap to width of their faces.
const TILT: f64 = 1e-3;

/// Resisting over driving action; infinite if the driving action is within the rounding of the `whole` load.
fn factor(resisting: f64, driving: f64, whole: f64) -> f64 {
    if driving > ROUNDING * whole {
        resisting / driving
    } else {
        f64::INFINITY
    }
}

/// The weight (N, a vector) over the opposing force of fluid and loads (N), buoyancy included: infinite if they do not lift
/// the block, NaN without weight.
pub fn uplift(weight: DVec3, lifting: DVec3) -> f64 {
    match weight.try_normalize() {
        Some(down) => factor(weight.length(), -lifting.dot(down), weight.length()),
        None => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The factor of a submerged body is the ratio of the densities.
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
