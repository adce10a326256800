//! Safety against uplift.

use super::factor;
use glam::DVec3;

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
