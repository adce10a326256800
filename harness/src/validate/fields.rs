//! Fields on cell centres: made from formulas, compared with them, interpolated.

use kit::twin::noise::hash32;
use riprap::lattice::{Setup, State};
use std::f64::consts::{PI, TAU};

/// A copy of a setup with `change` applied.
pub fn changed(setup: &Setup, change: impl FnOnce(&mut Setup)) -> Setup {
    let mut setup = setup.clone();
    change(&mut setup);
    setup
}

/// Centres of the cells, lattice units, x fastest.
pub fn centres(cells: [u32; 3]) -> impl Iterator<Item = [f64; 3]> {
    let [nx, ny, nz] = cells;
    (0..nz).flat_map(move |z| {
        (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z].map(|n| f64::from(n) + 0.5)))
    })
}

/// The state with density minus one and velocity given at each cell centre.
pub fn state(cells: [u32; 3], field: impl Fn([f64; 3]) -> (f64, [f64; 3])) -> State {
    let mut state = State::default();
    for at in centres(cells) {
        let (excess, velocity) = field(at);
        state.excess.push(excess as f32);
        for a in 0..3 {
            state.velocity[a].push(velocity[a] as f32);
        }
    }
    state
}

/// L2 norm of the velocity's error over the L2 norm of the exact velocity.
pub fn l2_error(cells: [u32; 3], found: &State, exact: impl Fn([f64; 3]) -> [f64; 3]) -> f64 {
    let (mut error, mut norm) = (0.0, 0.0);
    for (n, at) in centres(cells).enumerate() {
        let exact = exact(at);
        for a in 0..3 {
            error += (f64::from(found.velocity[a][n]) - exact[a]).powi(2);
            norm += exact[a].powi(2);
        }
    }
    (error / norm).sqrt()
}

/// How much of the velocity field `mode` the velocity contains: ⟨u, mode⟩/⟨mode, mode⟩.
pub fn amplitude(cells: [u32; 3], found: &State, mode: impl Fn([f64; 3]) -> [f64; 3]) -> f64 {
    let (mut product, mut norm) = (0.0, 0.0);
    for (n, at) in centres(cells).enumerate() {
        let mode = mode(at);
        for a in 0..3 {
            product += f64::from(found.velocity[a][n]) * mode[a];
            norm += mode[a] * mode[a];
        }
    }
    product / norm
}

/// Largest difference of a component of the velocity between two states.
pub fn largest_change(a: &State, b: &State) -> f64 {
    let pairs = |c: usize| a.velocity[c].iter().zip(&b.velocity[c]);
    (0..3)
        .flat_map(pairs)
        .map(|(a, b)| f64::from((a - b).abs()))
        .fold(0.0, f64::max)
}

/// A pseudo-random number in [−1, 1), from an integer hash.
pub fn noise(n: u32) -> f64 {
    f64::from(hash32(n)) / f64::from(1u32 << 31) - 1.0
}

/// Value at `x` of the cubic through the four nodes around it (Lagrange); nodes ascend.
pub fn cubic(nodes: &[f64], values: &[f64], x: f64) -> f64 {
    let above = nodes.partition_point(|&node| node < x);
    let first = above.saturating_sub(2).min(nodes.len().saturating_sub(4));
    let last = nodes.len().min(first + 4);
    (first..last)
        .map(|i| {
            let others = (first..last).filter(|&j| j != i);
            let base: f64 = others
                .map(|j| (x - nodes[j]) / (nodes[i] - nodes[j]))
                .product();
            base * values[i]
        })
        .sum()
}

/// Slope of the least-squares line through (x, y).
pub fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let mean_x = points.iter().map(|p| p.0).sum::<f64>() / n;
    let mean_y = points.iter().map(|p| p.1).sum::<f64>() / n;
    let above: f64 = points.iter().map(|p| (p.0 - mean_x) * (p.1 - mean_y)).sum();
    let below: f64 = points.iter().map(|p| (p.0 - mean_x).powi(2)).sum();
    above / below
}

/// Initial state of a turbulent channel along x, of depth `h` from the wall at y = 0, for a friction velocity and Re_τ: the mean
/// profile of Reichardt 1951 with streamwise rolls and spanwise waves, strong enough to break up.
pub fn turbulent_channel(cells: [u32; 3], h: f64, friction: f64, reynolds: f64) -> State {
    let [nx, _, nz] = cells.map(f64::from);
    state(cells, |[x, y, z]| {
        let wall = (h - (y - h).abs()) / h * reynolds;
        let mean = (1.0 + 0.4 * wall).ln() / 0.4
            + 7.8 * (1.0 - (-wall / 11.0).exp() - wall / 11.0 * (-wall / 3.0).exp());
        // ψ = (1 + cos πη)² sin kz with η from the centre: no slip and no flow through the walls.
        let eta = PI * (y - h) / h;
        let (shape, steep) = (
            (1.0 + eta.cos()).powi(2),
            -2.0 * (1.0 + eta.cos()) * eta.sin() * PI / h,
        );
        let mut u = [friction * mean, 0.0, 0.0];
        for mode in 1..6u32 {
            let k = TAU * f64::from(mode) / nz;
            let l = TAU * f64::from(mode % 3 + 1) / nx;
            let phase = l * x + PI * noise(mode);
            let size = 0.6 * friction / k.max(2.0 * PI / h);
            u[1] += size * k * shape * (k * z + phase.sin()).cos();
            u[2] -= size * steep * (k * z + phase.sin()).sin();
            u[0] += 0.5 * friction * shape * (k * z + phase).sin();
        }
        (0.0, u)
    })
}
