//! Field lines of a direction field, their spacing, and the arrow heads on them.

use std::collections::HashMap;

/// A field of unit vectors in `D` dimensions, and the parameters for tracing its lines.
pub struct Field<const D: usize, F> {
    /// The direction at a point (m); `None` where a line ends.
    pub direction: F,
    /// Length of a step, m.
    pub step: f64,
    /// Distance at which a line that approaches itself counts as closed, m.
    pub own: f64,
    /// Largest number of steps of a line, which might otherwise not end.
    pub most: usize,
}

impl<const D: usize, F: Fn([f64; D]) -> Option<[f64; D]>> Field<D, F> {
    /// The line through `seed`, up to points that are `blocked`, in downstream order.
    pub fn line(&self, seed: [f64; D], blocked: impl Fn([f64; D]) -> bool) -> Vec<[f64; D]> {
        let mut line = self.half(seed, -self.step, &[], &blocked);
        line.reverse();
        let downstream = self.half(seed, self.step, &line, &blocked);
        line.push(seed);
        line.extend(downstream);
        line
    }

    /// Points after `seed` at steps of the signed length `step` (m), until the field ends, a point is blocked, or the line
    /// closes; `upstream` is the other half of the same line.
    fn half(
        &self,
        seed: [f64; D],
        step: f64,
        upstream: &[[f64; D]],
        blocked: impl Fn([f64; D]) -> bool,
    ) -> Vec<[f64; D]> {
        // Neighbours along the line are near each other although the line is not closed.
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

/// Points of `D` coordinates, sorted into bins for neighbour searches.
pub struct Taken<const D: usize> {
    bin: f64,
    points: HashMap<[i64; D], Vec<[f64; D]>>,
}

impl<const D: usize> Taken<D> {
    /// Bins for searches up to the distance `bin` (m).
    pub fn new(bin: f64) -> Self {
        Self {
            bin,
            points: HashMap::new(),
        }
    }

    fn place(&self, point: [f64; D]) -> [i64; D] {
        point.map(|coordinate| (coordinate / self.bin).floor() as i64)
    }

    pub fn add(&mut self, point: [f64; D]) {
        self.points
            .entry(self.place(point))
            .or_default()
            .push(point);
    }

    /// Whether a point is nearer than `distance` to `point`.
    pub fn near(&self, point: [f64; D], distance: f64) -> bool {
        let place = self.place(point);
        // The bin and its 3^D − 1 neighbours, counted in base 3.
        (0..3_i64.pow(D as u32)).any(|number| {
            let mut digits = number;
            let neighbour = place.map(|along| {
                let step = digits % 3 - 1;
                digits /= 3;
                along + step
            });
            let points = self.points.get(&neighbour).into_iter().flatten();
            points
                .into_iter()
                .any(|other| square(*other, point) < distance * distance)
        })
    }
}

fn square<const D: usize>(a: [f64; D], b: [f64; D]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum()
}

/// An arrow head.
pub struct Arrow<const D: usize> {
    /// Index of its point on the line.
    pub point: usize,
    /// Direction, a unit vector.
    pub towards: [f64; D],
}

/// Arrow heads on a line in `D` dimensions, about `apart` from each other, at least one.
pub fn arrows<const D: usize>(points: &[[f64; D]], apart: f64) -> Vec<Arrow<D>> {
    let length = |pair: &[[f64; D]]| {
        let square = (0..D).map(|axis| (pair[1][axis] - pair[0][axis]).powi(2));
        square.sum::<f64>().sqrt()
    };
    let whole: f64 = points.windows(2).map(length).sum();
    let count = (whole / apart).round().max(1.0);
    let mut arrows = Vec::new();
    let mut passed = 0.0;
    for (point, pair) in points.windows(2).enumerate() {
        let step = length(pair);
        let next = (arrows.len() as f64 + 0.5) * whole / count;
        if step > 0.0 && passed + step >= next && (arrows.len() as f64) < count {
            let towards = std::array::from_fn(|axis| (pair[1][axis] - pair[0][axis]) / step);
            arrows.push(Arrow { point, towards });
        }
        passed += step;
    }
    arrows
}
