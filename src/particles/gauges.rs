//! Gauges among particles: what a kernel sees at a place.

use super::{Kernel, Setup};
use glam::{DVec2, DVec3};

/// Where the kernel finds this share of what it finds in the water, its surface is: half of it is above a
/// flat one.
const SURFACE: f64 = 0.5;
/// Share that the kernel finds at a particle on a flat surface, halved: less has what flies alone.
const DROP: f64 = 0.25;

/// Particles as gauges see them.
#[derive(Clone, Copy, Debug)]
pub struct Gauges<'a> {
    /// Where they are, m.
    pub positions: &'a [DVec3],
    /// Their kernel.
    pub kernel: Kernel,
    /// Their distance at rest Δx, m.
    pub spacing: f64,
    /// What the domain repeats itself by, m; 0 along axes that are not periodic.
    pub period: DVec3,
    /// Whether nothing varies along y.
    pub plane: bool,
}

impl<'a> Gauges<'a> {
    /// Gauges among particles at `positions` (m).
    pub fn new(setup: &Setup, positions: &'a [DVec3]) -> Self {
        let h = setup.smoothing * setup.spacing;
        let period = |axis: usize| match setup.faces[axis][0] {
            super::Side::Periodic => setup.size[axis],
            _ => 0.0,
        };
        Self {
            positions,
            kernel: if setup.plane {
                Kernel::plane(h)
            } else {
                Kernel::space(h)
            },
            spacing: setup.spacing,
            period: DVec3::new(period(0), period(1), period(2)),
            plane: setup.plane,
        }
    }

    /// The same among others.
    fn among<'b>(&self, positions: &'b [DVec3]) -> Gauges<'b> {
        Gauges {
            positions,
            kernel: self.kernel,
            ..*self
        }
    }

    /// What a particle takes up, m³; in a plane m².
    fn volume(&self) -> f64 {
        self.spacing.powi(if self.plane { 2 } else { 3 })
    }

    /// From `at` to a particle or its nearest image, m.
    fn apart(&self, at: DVec3, position: DVec3) -> DVec3 {
        let mut apart = position - at;
        for axis in 0..3 {
            if self.period[axis] > 0.0 {
                apart[axis] -= self.period[axis] * (apart[axis] / self.period[axis]).round();
            }
        }
        if self.plane {
            apart.y = 0.0;
        }
        apart
    }

    /// Part of the kernel at `at` (m) in which there is water: 1 inside, ½ at a flat surface.
    pub fn share(&self, at: DVec3) -> f64 {
        let weights = self.positions.iter();
        let weights = weights.map(|x| self.kernel.at(self.apart(at, *x).length()));
        self.volume() * weights.sum::<f64>()
    }

    /// Mean at `at` (m) of a value of each particle, by the kernel (Shepard 1968), of a field that grows by
    /// `gradient` a metre: with that of the weight, beside a wall too the pressure is that at `at`. None where
    /// no particle is near.
    pub fn mean(&self, at: DVec3, values: &[f64], gradient: DVec3) -> Option<f64> {
        let mut sum = 0.0;
        let mut weights = 0.0;
        for (x, value) in self.positions.iter().zip(values) {
            let apart = self.apart(at, *x);
            let weight = self.kernel.at(apart.length());
            sum += weight * (value - gradient.dot(apart));
            weights += weight;
        }
        (weights > 0.0).then(|| sum / weights)
    }

    /// Height of the free surface above (x, y), m: where the kernel finds half of the most that it finds below,
    /// drops aside. In water too thin for that, the top of the highest particle. None where there is none
    /// within h.
    pub fn level(&self, [x, y]: [f64; 2]) -> Option<f64> {
        let foot = |z: f64| DVec3::new(x, y, z);
        let aside = |p: &DVec3| {
            let apart = self.apart(foot(p.z), *p);
            DVec2::new(apart.x, apart.y).length()
        };
        let column: Vec<DVec3> = self
            .positions
            .iter()
            .copied()
            .filter(|p| aside(p) < self.kernel.support())
            .collect();
        let near = column
            .iter()
            .filter(|p| aside(p) <= self.kernel.smoothing_length);
        let top = near.map(|p| p.z).reduce(f64::max)?;
        let low = column.iter().map(|p| p.z).fold(top, f64::min);
        let column = self.among(&column);
        // From above, in steps over which the kernel is nearly straight.
        let step = 0.25 * self.spacing;
        let count = ((top - low) / step).ceil() as usize + 1;
        let above = top + self.kernel.support();
        let steps = count + (self.kernel.support() / step).ceil() as usize;
        let shares: Vec<f64> = (0..=steps)
            .map(|i| column.share(foot(above - i as f64 * step)))
            .collect();
        let most = shares.iter().copied().fold(0.0, f64::max);
        if most < SURFACE {
            return Some(top + 0.5 * self.spacing);
        }
        let wanted = SURFACE * most;
        let first = shares.iter().position(|share| *share >= wanted)?;
        let before = shares.get(first.wrapping_sub(1)).copied().unwrap_or(0.0);
        let part = (wanted - before) / (shares[first] - before);
        Some(above - (first as f64 - 1.0 + part) * step)
    }

    /// The particles in the box between two corners (m); where nothing varies along y, whatever it is along that.
    pub fn inside(&self, min: DVec3, max: DVec3) -> impl Iterator<Item = usize> {
        let plane = self.plane;
        let inside = move |x: &DVec3| {
            let mut inside = x.cmpge(min) & x.cmple(max);
            inside.set(1, plane || inside.test(1));
            inside.all()
        };
        let all = self.positions.iter().enumerate();
        all.filter_map(move |(n, x)| inside(x).then_some(n))
    }

    /// The particle in the box between two corners (m) that is farthest along `direction`, drops aside; None if
    /// there is none.
    pub fn farthest(&self, min: DVec3, max: DVec3, direction: DVec3) -> Option<DVec3> {
        let inside = self.inside(min, max);
        let mut there: Vec<DVec3> = inside.map(|n| self.positions[n]).collect();
        there.sort_unstable_by(|a, b| direction.dot(*b).total_cmp(&direction.dot(*a)));
        there.into_iter().find(|p| self.share(*p) >= DROP)
    }
}
