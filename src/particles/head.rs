//! The pressure of the water around a body, continued to where none of it is.

use crate::bodies::outer;
use glam::{DMat3, DVec3};

/// Pressure of the water around a body: a linear field, by least squares over the particles of its shell that feel
/// water. Where these do not tell, across a shell that is wet on one side only, it is that of water at rest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Head {
    /// Where its pressure is given: the middle of those particles, m.
    pub place: DVec3,
    /// Pa.
    pub pressure: f64,
    /// Pa/m.
    pub gradient: DVec3,
}

impl Head {
    /// At `x` (m), Pa; water does not pull.
    pub fn at(&self, x: DVec3) -> f64 {
        (self.pressure + self.gradient.dot(x - self.place)).max(0.0)
    }

    /// From the sums over the particles that feel water: their number, Σ r, Σ r r by xx, yy, zz, xy, yz, zx, Σ q
    /// and Σ q r, with q the pressure less that of water at rest under `gravity`. Layers of particles are `reach`
    /// thick. All in the same units, from the same point.
    pub(super) fn fit(sums: &[f32], reach: f64, gravity: DVec3) -> Option<Self> {
        let [wet, sums @ ..] = sums else {
            return None;
        };
        if *wet <= 0.0 {
            return None;
        }
        let mean = |n: usize| f64::from(sums[n]) / f64::from(*wet);
        let vector = |n: usize| DVec3::new(mean(n), mean(n + 1), mean(n + 2));
        let (place, squares, products) = (vector(0), vector(3), vector(6));
        let (rest, with_place) = (mean(9), vector(10));
        let about = DMat3::from_cols(
            DVec3::new(squares.x, products.x, products.z),
            DVec3::new(products.x, squares.y, products.y),
            DVec3::new(products.z, products.y, squares.z),
        );
        // The variance of places across one layer teaches nothing.
        let ridge = DMat3::from_diagonal(DVec3::splat(reach.powi(2) / 12.0));
        let spread = about - outer(place, place) + ridge;
        let slope = spread.inverse() * (with_place - rest * place);
        Some(Self {
            place,
            pressure: rest + gravity.dot(place),
            gradient: slope + gravity,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sums(points: &[DVec3], pressure: impl Fn(DVec3) -> f64, gravity: DVec3) -> Vec<f32> {
        let mut all = [0.0; 14];
        for &r in points {
            let q = pressure(r) - gravity.dot(r);
            let of = [
                1.0,
                r.x,
                r.y,
                r.z,
                r.x * r.x,
                r.y * r.y,
                r.z * r.z,
                r.x * r.y,
                r.y * r.z,
                r.z * r.x,
                q,
                q * r.x,
                q * r.y,
                q * r.z,
            ];
            for (sum, number) in all.iter_mut().zip(of) {
                *sum += number;
            }
        }
        all.map(|sum| sum as f32).to_vec()
    }

    #[test]
    fn still_water_is_found_exactly_whatever_is_wet() {
        let gravity = DVec3::new(1.0, 0.0, -10.0);
        let still = |x: DVec3| 100.0 + gravity.dot(x);
        // On one side only, and two points.
        for points in [
            vec![
                DVec3::X,
                DVec3::new(1.0, 0.0, 3.0),
                DVec3::new(1.0, 2.0, -1.0),
            ],
            vec![DVec3::new(2.0, 1.0, 5.0), DVec3::ZERO],
        ] {
            let head = Head::fit(&sums(&points, still, gravity), 4.0, gravity).unwrap();
            for x in [DVec3::new(-3.0, 1.0, -2.0), DVec3::Z * 4.0] {
                assert!((head.at(x) - still(x)).abs() < 1e-3, "{}", head.at(x));
            }
        }
    }

    #[test]
    fn between_two_levels_it_falls_linearly() {
        // A dam, 60 across, with 30 more on its left.
        let mut points = Vec::new();
        for z in 0..20 {
            for layer in 0..4 {
                for side in [-1.0, 1.0] {
                    let x = side * (30.0 - f64::from(layer));
                    points.push(DVec3::new(x, 0.0, f64::from(z)));
                }
            }
        }
        let gravity = DVec3::NEG_Z;
        let level = |x: DVec3| 50.0 - x.z - 15.0 * x.x.signum();
        let head = Head::fit(&sums(&points, level, gravity), 4.0, gravity).unwrap();
        for (x, expected) in [(-28.5, 65.0), (0.0, 50.0), (28.5, 35.0)] {
            let found = head.at(DVec3::X * x);
            assert!((found - expected).abs() < 0.1, "{found} at {x}");
        }
        assert_eq!(head.at(DVec3::Z * 1e3), 0.0);
        assert_eq!(Head::fit(&[0.0; 14], 4.0, gravity), None);
    }
}
