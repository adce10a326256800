//! What full cells at a face at an angle to the grid exchange with the fluid: the populations that leave them gain w c·m.

use super::lattice::{Q, W};
use super::sloping_friction::{Sloping, c, dot};
use super::wall_model::{at_rest, norm};

/// What a solid keeps below which it moves.
const KEPT: f64 = 0.998;

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

/// The sum of what cells give off over that of the amounts of the cells that can balance it.
pub(super) fn balance(given: impl Iterator<Item = (f64, bool)>) -> f64 {
    let [sum, amount] = given.fold([0.0; 2], |[sum, amount], (one, takes)| {
        [sum + one, amount + if takes { one.abs() } else { 0.0 }]
    });
    if amount > 0.0 { sum / amount } else { 0.0 }
}

/// The solution of a symmetric 2 × 2 system by its eigenvectors, with λ/(λ² + 1e-10) for 1/λ.
fn solved([a, b, d]: [f64; 3], wanted: [f64; 2]) -> [f64; 2] {
    let angle = 0.5 * (2.0 * b).atan2(a - d);
    let mut solved = [0.0; 2];
    for [x, y] in [[angle.cos(), angle.sin()], [-angle.sin(), angle.cos()]] {
        let lambda = a * x * x + 2.0 * b * x * y + d * y * y;
        let part = (x * wanted[0] + y * wanted[1]) * lambda / (lambda * lambda + 1e-10);
        solved[0] += part * x;
        solved[1] += part * y;
    }
    solved
}

impl Sloping {
    /// What the populations that leave a full cell gain by its m.
    pub(super) fn gain(&self, m: [f64; 3], balance: f64) -> [f64; Q] {
        let (still, sum) = self.still().unwrap_or(([0.0; 3], f64::INFINITY));
        let leak = balance * self.given(m).abs() / sum;
        let gain = |q: usize| W[q] * (dot(c(q), m) - leak * (1.0 - dot(c(q), still)));
        std::array::from_fn(|q| if self.open.contains(&q) { gain(q) } else { 0.0 })
    }

    /// What a full cell gives off by its m, without the balance.
    pub(super) fn given(&self, m: [f64; 3]) -> f64 {
        self.open.iter().map(|&q| W[q] * dot(c(q), m)).sum()
    }

    /// Mean of the excess densities `of` the last four cells of the column.
    pub(super) fn density(&self, of: impl Fn(usize) -> f64) -> f64 {
        let last = &self.above[self.above.len() - 4..];
        last.iter().map(|&(cell, _)| of(cell)).sum::<f64>() / 4.0
    }

    /// Two directions along the face.
    fn along(&self) -> [[f64; 3]; 2] {
        let n = self.normal;
        let helper = if n[0].abs() > 0.6 {
            [0.0, 1.0, 0.0]
        } else {
            [1.0, 0.0, 0.0]
        };
        let first = cross(n, helper);
        let first = first.map(|v| v / norm(first));
        [first, cross(n, first)]
    }

    /// Σ over the open directions.
    fn over_open(&self, of: &dyn Fn(usize) -> f64) -> f64 {
        self.open.iter().map(|&q| of(q)).sum()
    }

    /// The m for which the part of Σ w c c·m along the face is this.
    fn solution(&self, wanted: [f64; 2]) -> [f64; 3] {
        let along = self.along();
        let over = |q: usize, t: usize| dot(c(q), along[t]);
        let element = |s: usize, t: usize| self.over_open(&|q| W[q] * over(q, s) * over(q, t));
        let found = solved([element(0, 0), element(0, 1), element(1, 1)], wanted);
        [0, 1, 2].map(|i| found[0] * along[0][i] + found[1] * along[1][i])
    }

    /// The vector s along the face for which w (1 − c·s) has no momentum along it, 0 if the solid moves, and the sum of that; none
    /// where it is small.
    pub(super) fn still(&self) -> Option<([f64; 3], f64)> {
        let along = self.along();
        let outward = |t: usize| self.over_open(&|q| W[q] * dot(c(q), along[t]));
        let still = match self.kept > KEPT {
            true => self.solution([outward(0), outward(1)]),
            false => [0.0; 3],
        };
        let all = self.over_open(&|q| W[q]);
        let sum = all - self.over_open(&|q| W[q] * dot(c(q), still));
        (sum > 0.5 * all).then_some((still, sum))
    }

    /// m of a full cell of a solid with this velocity, times the share of the law. `density`: its excess over the
    /// column.
    pub(super) fn slip(&self, velocity: [f64; 3], leaving: &[f64; Q], density: f64) -> [f64; 3] {
        if self.share == 0.0 || self.open.is_empty() {
            return [0.0; 3];
        }
        let along = self.along();
        let area = if self.top { self.area } else { 0.0 };
        let stress = area * self.friction.powi(2) / norm(self.u).max(1e-30);
        let relative =
            |q: usize| leaving[q] - 3.0 * W[q] * dot(c(q), velocity) - at_rest(q, self.force);
        let over = |q: usize, t: usize| dot(c(q), along[t]);
        let excess = if self.kept > KEPT {
            let height = self.above.len() as f64 - 1.5;
            density - 3.0 * f64::from(self.out) * height * self.force[self.axis]
        } else {
            // f = w (excess + c·slip), where the differences to the means over the open directions give the slip.
            let all = self.over_open(&|q| W[q]);
            let mean = [0, 1].map(|t| self.over_open(&|q| W[q] * over(q, t)) / all);
            let apart = |q: usize, t: usize| over(q, t) - mean[t];
            let covariance =
                |s: usize, t: usize| self.over_open(&|q| W[q] * apart(q, s) * apart(q, t));
            let slip = solved(
                [covariance(0, 0), covariance(0, 1), covariance(1, 1)],
                [0, 1].map(|t| self.over_open(&|q| relative(q) * apart(q, t))),
            );
            self.over_open(&relative) / all - mean[0] * slip[0] - mean[1] * slip[1]
        };
        let wanted = [0, 1].map(|t| {
            let arrived = self.over_open(&|q| (relative(q) - W[q] * excess) * over(q, t));
            -(1.0 + 1.0 / self.kept) * arrived - stress * dot(self.u, along[t])
        });
        let m = self.solution(wanted);
        let limit = (12.0 * norm(self.u) / norm(m).max(1e-30)).min(1.0);
        m.map(|m| m * self.share * limit)
    }
}
