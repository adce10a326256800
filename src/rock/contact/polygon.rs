//! A convex polygon in a plane, clipped by lines.

use super::section::Bound;
use glam::{DMat3, DVec2, DVec3};

/// Corners in order. Lengths are in L; the origin is inside.
#[derive(Default)]
pub(super) struct Polygon {
    pub corners: Vec<DVec2>,
    spare: Vec<DVec2>,
}

/// Polygons for the computation of sections, reused to save allocations.
#[derive(Default)]
pub(super) struct Polygons {
    pub section: Polygon,
    pub cell: Polygon,
    pub bounds: Vec<Bound>,
}

/// Integrals over a polygon of a thickness u that is linear between the corners and their mean.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Moments {
    /// ∫ dA.
    pub area: f64,
    /// ∫ u dA.
    pub volume: f64,
    /// ∫ u x dA.
    pub first: DVec2,
}

/// Second moments of an area about its centroid.
#[derive(Clone, Copy, Debug)]
pub(super) struct SecondMoments {
    pub area: f64,
    pub centre: DVec2,
    /// Largest and smallest ∫ x² dA.
    pub principal: [f64; 2],
    /// Axis along which it is the largest.
    pub axis: DVec2,
}

/// Σ s a aᵀ over two principal axes a.
pub(super) fn spread(axes: [DVec3; 2], squares: [f64; 2]) -> DMat3 {
    let outer = |axis: DVec3| DMat3::from_cols(axis * axis.x, axis * axis.y, axis * axis.z);
    outer(axes[0]) * squares[0] + outer(axes[1]) * squares[1]
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

    /// Moments of the thickness `u`, exact if it is linear.
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

    /// Area, centroid and second moments about it; `None` if the area is zero.
    pub fn second_moments(&self) -> Option<SecondMoments> {
        let last = self.corners.last()?;
        let mean = self.corners.iter().sum::<DVec2>() / self.corners.len() as f64;
        let (mut area, mut first) = (0.0, DVec2::ZERO);
        let mut second = [0.0; 3];
        let mut p = *last - mean;
        for corner in &self.corners {
            let q = *corner - mean;
            // ∫ λ_i λ_j dA = A (1 + δ_ij)/12 on each triangle with the mean.
            let part = 0.5 * p.perp_dot(q);
            let sum = p + q;
            area += part;
            first += part / 3.0 * sum;
            let of = |u: f64, v: f64, p2: f64, q2: f64| part / 12.0 * (u * v + p2 + q2);
            second[0] += of(sum.x, sum.x, p.x * p.x, q.x * q.x);
            second[1] += of(sum.x, sum.y, p.x * p.y, q.x * q.y);
            second[2] += of(sum.y, sum.y, p.y * p.y, q.y * q.y);
            p = q;
        }
        if area.is_nan() || area <= 0.0 {
            return None;
        }
        let centre = first / area;
        let xx = second[0] - area * centre.x * centre.x;
        let xy = second[1] - area * centre.x * centre.y;
        let yy = second[2] - area * centre.y * centre.y;
        let (middle, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
        let radius = half.hypot(xy);
        let angle = 0.5 * xy.atan2(half);
        Some(SecondMoments {
            area,
            centre: mean + centre,
            principal: [middle + radius, middle - radius],
            axis: DVec2::from_angle(angle),
        })
    }

    /// Largest distance between two corners.
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
