//! Hydrostatic initial pressures of water that rests on solids or on other water.

use super::convex_part::ConvexPart;
use glam::DVec3;
use rayon::prelude::*;

/// Bodies of water and the solids that support them.
pub(super) struct HydrostaticStart<'a> {
    /// Particles of each body, m.
    pub points: &'a [Vec<DVec3>],
    /// Convex parts of each body.
    pub waters: &'a [Vec<ConvexPart<'a>>],
    pub solids: &'a [ConvexPart<'a>],
    /// Δx, m.
    pub spacing: f64,
    /// Weight of the water, N/m³.
    pub weight: DVec3,
}

impl HydrostaticStart<'_> {
    /// Pressures of all particles, Pa: hydrostatic below the top of their body, or of the bodies that rest on it there;
    /// 0 in free fall.
    pub fn pressures(&self) -> Vec<f64> {
        let down = self.weight.normalize_or_zero();
        let step = self.spacing * down;
        let bodies = 0..self.points.len();
        // The bodies on which each body rests.
        let under = |body: usize| {
            let is_under = |other: &usize| {
                let on = |x: &DVec3| {
                    let foot = *x + step;
                    is_in(&self.waters[*other], foot) && !is_in(self.solids, foot)
                };
                *other != body && self.points[body].par_iter().any(on)
            };
            bodies.clone().filter(is_under).collect()
        };
        let under: Vec<Vec<usize>> = bodies.clone().map(under).collect();
        let on_solids = |points: &Vec<DVec3>| {
            let points = points.par_iter();
            down != DVec3::ZERO && points.any(|x| is_in(self.solids, *x + step))
        };
        let mut supported: Vec<bool> = self.points.iter().map(on_solids).collect();
        let top = |points: &Vec<DVec3>| {
            let heights = points.iter().map(|x| -down.dot(*x));
            heights.fold(f64::NEG_INFINITY, f64::max) + 0.5 * self.spacing
        };
        let tops: Vec<f64> = self.points.iter().map(top).collect();
        let highest = tops.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        // The top of each body with the bodies that rest on it.
        let mut levels = tops.clone();
        for _ in bodies.clone() {
            for body in bodies.clone() {
                for &other in &under[body] {
                    supported[body] |= supported[other];
                    levels[other] = levels[other].max(levels[body]);
                }
            }
        }
        // The column above x, through water and solids in it, to the top of the last body.
        let level = |body: usize, x: DVec3| {
            if levels[body] == tops[body] {
                return tops[body];
            }
            let (mut top, mut above) = (tops[body], x);
            loop {
                above -= step;
                let other = self.waters.iter().position(|water| is_in(water, above));
                match other {
                    Some(other) => top = top.max(tops[other]),
                    None if is_in(self.solids, above) && -down.dot(above) < highest => {}
                    None => return top,
                }
            }
        };
        let pressure = |body: usize, x: DVec3| {
            if supported[body] {
                self.weight.length() * (level(body, x) + down.dot(x))
            } else {
                0.0
            }
        };
        let of = |body: usize| self.points[body].par_iter().map(move |x| (body, *x));
        let all = bodies.into_par_iter().flat_map(of);
        all.map(|(body, x)| pressure(body, x)).collect()
    }
}

/// Whether `point` (m) lies in one of the `parts`.
fn is_in(parts: &[ConvexPart<'_>], point: DVec3) -> bool {
    parts.iter().any(|part| {
        let near = point.cmpge(part.low).all() && point.cmple(part.high).all();
        near && part.depth(point) >= 0.0
    })
}
