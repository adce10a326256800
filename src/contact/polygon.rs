//! A convex polygon in a plane, cut by lines.

use super::envelope::Bound;
use glam::DVec2;

/// Corners in order. Lengths in L, the origin inside.
#[derive(Default)]
pub(super) struct Polygon {
    pub corners: Vec<DVec2>,
    spare: Vec<DVec2>,
}

/// Polygons that a section needs, used again and again.
#[derive(Default)]
pub(super) struct Polygons {
    pub section: Polygon,
    pub cell: Polygon,
    pub bounds: Vec<Bound>,
}

/// Integrals over a polygon of a thickness that is linear between corners and their mean.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Moments {
    /// ∫ dA.
    pub area: f64,
    /// ∫ u dA.
    pub volume: f64,
    /// ∫ u x dA.
    pub first: DVec2,
}

impl Polygon {
    /// A square of half-width `half`.
    pub fn reset(&mut self, half: f64) {
        let corner = |x, y| DVec2::new(x, y) * half;
        self.corners.clear();
        self.corners.extend([
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
        ]);
    }

    /// Keeps the part with `gradient` · x ≤ `slack` (Sutherland & Hodgman 1974).
    pub fn clip(&mut self, gradient: DVec2, slack: f64) {
        let inside = |x: &DVec2| slack - gradient.dot(*x);
        if self.corners.iter().all(|x| inside(x) >= 0.0) {
            return;
        }
        self.spare.clear();
        let Some(mut last) = self.corners.last().copied() else {
            return;
        };
        let mut before = inside(&last);
        for corner in &self.corners {
            let now = inside(corner);
            if (now < 0.0) != (before < 0.0) {
                let s = before / (before - now);
                self.spare.push(last + (*corner - last) * s);
            }
            if now >= 0.0 {
                self.spare.push(*corner);
            }
            (last, before) = (*corner, now);
        }
        std::mem::swap(&mut self.corners, &mut self.spare);
    }

    /// Moments of the thickness `u`, exact where it is linear.
    pub fn moments(&self, u: impl Fn(DVec2) -> f64) -> Moments {
        let mut sums = Moments::default();
        let Some(last) = self.corners.last() else {
            return sums;
        };
        let mean = self.corners.iter().sum::<DVec2>() / self.corners.len() as f64;
        let middle = u(mean);
        let (mut p, mut at_p) = (*last - mean, u(*last));
        for corner in &self.corners {
            let (q, at_q) = (*corner - mean, u(*corner));
            // ∫ λ_i dA = A/3, ∫ λ_i λ_j dA = A (1 + δ_ij)/12.
            let area = 0.5 * p.perp_dot(q);
            let sum = middle + at_p + at_q;
            sums.area += area;
            sums.volume += area / 3.0 * sum;
            sums.first += area / 12.0 * ((sum + at_p) * p + (sum + at_q) * q);
            (p, at_p) = (q, at_q);
        }
        sums.first += sums.volume * mean;
        sums
    }

    /// Largest distance of two corners.
    pub fn width(&self) -> f64 {
        let mut square: f64 = 0.0;
        for (k, p) in self.corners.iter().enumerate() {
            for q in &self.corners[..k] {
                square = square.max(p.distance_squared(*q));
            }
        }
        square.sqrt()
    }
}
