//! A plane face.

use glam::DVec3;

/// A plane face: the points x of the block have `normal` · x ≤ `distance`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    /// Outward unit normal.
    pub normal: DVec3,
    /// Distance of the plane from the origin, m.
    pub distance: f64,
}

impl HalfSpace {
    /// The half-space whose outward `normal` (of any length) stands on a plane through `point` (m).
    pub fn through(point: DVec3, normal: DVec3) -> Self {
        let normal = normal.normalize_or_zero();
        Self {
            normal,
            distance: normal.dot(point),
        }
    }

    /// How far `point` is outside, m; negative inside.
    pub fn height(&self, point: DVec3) -> f64 {
        self.normal.dot(point) - self.distance
    }

    /// The other side of the same plane: exactly opposite numbers.
    pub fn opposite(&self) -> Self {
        Self {
            normal: -self.normal,
            distance: -self.distance,
        }
    }

    /// The same points when the origin moves to `origin` (m).
    pub fn seen_from(&self, origin: DVec3) -> Self {
        Self {
            normal: self.normal,
            distance: self.distance - self.normal.dot(origin),
        }
    }
}
