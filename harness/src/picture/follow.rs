//! Lines along a field of directions.

use super::taken::Taken;

/// A field of unit vectors in `D` dimensions, and how lines through it are followed.
pub struct Field<const D: usize, F> {
    /// The direction at a point (m); `None` where a line ends.
    pub direction: F,
    /// Length of a step, m.
    pub step: f64,
    /// A line that comes this near to itself has closed, m.
    pub own: f64,
    /// Most steps of a line, which else might never end.
    pub most: usize,
}

impl<const D: usize, F: Fn([f64; D]) -> Option<[f64; D]>> Field<D, F> {
    /// The line through `seed`, as far as no point of it is `blocked`: points downstream.
    pub fn line(&self, seed: [f64; D], blocked: impl Fn([f64; D]) -> bool) -> Vec<[f64; D]> {
        let mut line = self.half(seed, -self.step, &[], &blocked);
        line.reverse();
        let downstream = self.half(seed, self.step, &line, &blocked);
        line.push(seed);
        line.extend(downstream);
        line
    }

    /// Points after `seed` at steps of the signed length `step` (m), until the field ends, a place is blocked, or the
    /// line closes; `upstream` is the other half of the same line.
    fn half(
        &self,
        seed: [f64; D],
        step: f64,
        upstream: &[[f64; D]],
        blocked: impl Fn([f64; D]) -> bool,
    ) -> Vec<[f64; D]> {
        // Along the line, a point is near to its neighbours without the line closing.
        let skip = (2.0 * self.own / self.step).ceil() as usize + 1;
        let mut whole = upstream.to_vec();
        whole.push(seed);
        let mut mine = Taken::new(self.own);
        let mut known = 0;
        let mut point = seed;
        for _ in 0..self.most {
            let Some(after) = self.runge_kutta(point, step) else {
                break;
            };
            while known + skip < whole.len() {
                mine.add(whole[known]);
                known += 1;
            }
            if blocked(after) || mine.near(after, self.own) {
                break;
            }
            whole.push(after);
            point = after;
        }
        whole.split_off(upstream.len() + 1)
    }

    /// One classical fourth-order step of the signed length `step` (m).
    fn runge_kutta(&self, point: [f64; D], step: f64) -> Option<[f64; D]> {
        let ahead = |slope: [f64; D], part: f64| {
            std::array::from_fn(|axis| point[axis] + part * step * slope[axis])
        };
        let a = (self.direction)(point)?;
        let b = (self.direction)(ahead(a, 0.5))?;
        let c = (self.direction)(ahead(b, 0.5))?;
        let d = (self.direction)(ahead(c, 1.0))?;
        let mean =
            std::array::from_fn(|axis| (a[axis] + 2.0 * (b[axis] + c[axis]) + d[axis]) / 6.0);
        let after = ahead(mean, 1.0);
        (self.direction)(after).map(|_| after)
    }
}
