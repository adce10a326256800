//! Volume, centroid and inertia of what closed triangles enclose, exact up to rounding: the sum over
//! signed tetrahedra from the origin (Tonon 2004, J. Math. Stat. 1:8; the same integrals as Mirtich
//! 1996, J. Graph. Tools 1:31).

use glam::{DMat3, DVec3};

/// ∫dV, ∫x dV and ∫x xᵀ dV.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moments {
    /// m³.
    pub volume: f64,
    first: DVec3,
    second: DMat3,
}

impl Moments {
    /// Of triangles counter-clockwise seen from outside, m from a point near their middle.
    pub fn of(triangles: impl Iterator<Item = [DVec3; 3]>) -> Self {
        let nothing = Self {
            volume: 0.0,
            first: DVec3::ZERO,
            second: DMat3::ZERO,
        };
        triangles.fold(nothing, |sum, [a, b, c]| {
            let det = a.dot(b.cross(c));
            let s = a + b + c;
            let square = outer(s) + outer(a) + outer(b) + outer(c);
            Self {
                volume: sum.volume + det / 6.0,
                first: sum.first + s * (det / 24.0),
                second: sum.second + square * (det / 120.0),
            }
        })
    }

    /// Centroid, m.
    pub fn centroid(&self) -> DVec3 {
        self.first / self.volume
    }

    /// Inertia tensor about the origin for a density of one, m⁵.
    pub fn inertia(&self) -> DMat3 {
        let c = self.second;
        DMat3::IDENTITY * (c.x_axis.x + c.y_axis.y + c.z_axis.z) - c
    }
}

/// v vᵀ.
pub(super) fn outer(v: DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}
