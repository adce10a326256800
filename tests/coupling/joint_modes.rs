//! Oscillations of blocks in closed joints, in a one-dimensional f64 model: two blocks in a periodic row, between joints of one
//! cell, in fluid with τ = 1/2. Checks the growth rates in docs/src/theory/solids.md, and that the weights of closed joints damp
//! the modes.

/// Density of the blocks over that of the fluid.
const DENSITY: f64 = 2.65;
/// Weights of the populations with velocities 0, 1 and −1 across the joints, summed over the other directions.
const W: [f64; 3] = [2.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0];
/// Number of rows of full cells at each face that reflect; deeper rows are at equilibrium with the block.
const REFLECT: usize = 2;

/// Direction of the modelled momentum.
#[derive(Clone, Copy, PartialEq)]
enum Along {
    /// Across the joints, with the density.
    Normal,
    /// Along the joints: the sums of the populations times their velocity there.
    Tangent,
}

/// Parameters of a joint.
#[derive(Clone, Copy)]
struct Joint {
    /// B of the momentum and of the other moments.
    weights: [f64; 2],
    /// Delay of the load, in steps, that the correction assumes.
    delay: f64,
}

const CLOSED: Joint = Joint {
    weights: [0.25, 1.0 / 16.0],
    delay: 1.5,
};

struct Row {
    along: Along,
    joint: Joint,
    /// Number of full cells of a block, without its halves of two joints.
    full: usize,
    populations: Vec<[f64; 3]>,
    velocity: [f64; 2],
    before: [f64; 2],
    loads: [f64; 2],
    /// Mean velocity over 16 steps.
    mean: [f64; 2],
}

impl Row {
    fn new(along: Along, joint: Joint, full: usize) -> Self {
        // Any start that contains all modes.
        let start = |n: usize, q: usize| ((3 * n + q) as f64 * 1.7).sin();
        let populations = (0..2 * (full + 1)).map(|n| [0, 1, 2].map(|q| start(n, q)));
        Self {
            along,
            joint,
            full,
            populations: populations.collect(),
            velocity: [0.3, -0.2],
            before: [0.3, -0.2],
            loads: [0.0; 2],
            mean: [0.0; 2],
        }
    }

    fn step(&mut self) {
        let (length, cells) = (self.full + 1, self.populations.len());
        let mut loads = [0.0; 2];
        let mut collided = vec![[0.0; 3]; cells];
        for (n, f) in self.populations.iter().enumerate() {
            let block = n / length;
            let depth = (n % length).min(length - n % length);
            if depth == 0 {
                let both = [(block + 1) % 2, block];
                let (after, force) = self.in_joint(f, 0.5 * (self.velocity[0] + self.velocity[1]));
                both.iter().for_each(|&block| loads[block] += 0.5 * force);
                collided[n] = after;
            } else {
                let u = self.velocity[block];
                collided[n] = self.in_block(f, u, depth > REFLECT);
                loads[block] += self.momentum(f) - self.momentum(&collided[n]);
            }
        }
        for n in 0..cells {
            let from = [n, (n + cells - 1) % cells, (n + 1) % cells];
            self.populations[n] = [0, 1, 2].map(|q| collided[from[q]][q]);
        }
        let mass = DENSITY * length as f64;
        let old = self.velocity;
        for block in 0..2 {
            // The mean of two loads, and the inertia of the fluid inside.
            let load = 0.5 * (loads[block] + self.loads[block]);
            let inside = length as f64 * (old[block] - self.before[block]);
            self.velocity[block] += (load + inside) / mass;
        }
        self.complete_load(mass);
        (self.before, self.loads) = (old, loads);
    }

    /// Corrects the loads implicitly for their delay t: two joints between the blocks, each with ρ c² t/Δx.
    fn complete_load(&mut self, mass: f64) {
        if self.along == Along::Normal && self.joint.delay > 0.0 {
            let resistance = 2.0 * self.joint.delay / 3.0;
            let changed = self.velocity[1] - self.velocity[0] - (self.mean[1] - self.mean[0]);
            let impulse = resistance * changed / (1.0 + 2.0 * resistance / mass);
            self.velocity[0] += impulse / mass;
            self.velocity[1] -= impulse / mass;
        }
        for (mean, now) in self.mean.iter_mut().zip(self.velocity) {
            *mean += (now - *mean) / 17.0;
        }
    }

    /// Populations after collision with a solid of velocity `u`; at equilibrium with it if `deep`.
    fn in_block(&self, f: &[f64; 3], u: f64, deep: bool) -> [f64; 3] {
        let [rest, up, down] = *f;
        match (self.along, deep) {
            (Along::Normal, true) => {
                let rho: f64 = f.iter().sum();
                [W[0] * rho, W[1] * (rho + 3.0 * u), W[2] * (rho - 3.0 * u)]
            }
            (Along::Normal, false) => [rest, down + 6.0 * W[1] * u, up - 6.0 * W[2] * u],
            (Along::Tangent, true) => W.map(|w| w * u),
            (Along::Tangent, false) => [
                2.0 * W[0] * u - rest,
                2.0 * W[1] * u - down,
                2.0 * W[2] * u - up,
            ],
        }
    }

    /// Populations after collision in a joint whose solid has the velocity `u`, and the force on the solid.
    fn in_joint(&self, f: &[f64; 3], u: f64) -> ([f64; 3], f64) {
        let [momentum, others] = self.joint.weights;
        let change = 2.0 * momentum * (u - self.momentum(f));
        let [rest, up, down] = *f;
        let after = match self.along {
            Along::Normal => {
                // A third of the normal stress belongs to the trace, which relaxes at 1.54; the rest changes its sign.
                let (rho, j) = (rest + up + down, up - down + change);
                let rate = (1.0 - others) * (1.54 + 2.0 * 2.0) / 3.0;
                let stress = up + down + rate * (rho / 3.0 - up - down);
                [rho - stress, 0.5 * (stress + j), 0.5 * (stress - j)]
            }
            Along::Tangent => {
                // Third moments vanish; the shear stress changes its sign.
                let j = rest + up + down + change;
                let stress = (1.0 - 2.0 * (1.0 - others)) * (up - down);
                [W[0] * j, W[1] * j + 0.5 * stress, W[2] * j - 0.5 * stress]
            }
        };
        (after, -change)
    }

    fn momentum(&self, f: &[f64; 3]) -> f64 {
        match self.along {
            Along::Normal => f[1] - f[2],
            Along::Tangent => f.iter().sum(),
        }
    }

    /// Growth per step of the fastest mode, and half its period in steps if the velocity of a block oscillates.
    fn growth(&mut self) -> (f64, f64) {
        let mut rates = Vec::new();
        let mut turns = 0;
        for n in 0..6000 {
            let old = self.velocity[1] - self.before[1];
            self.step();
            let new = self.velocity[1] - self.before[1];
            turns += usize::from(n >= 4000 && old * new < 0.0);
            let size = self
                .populations
                .iter()
                .flatten()
                .map(|f| f * f)
                .sum::<f64>()
                .sqrt();
            rates.push(size.ln());
            let scale = 1.0 / size;
            self.populations
                .iter_mut()
                .flatten()
                .for_each(|f| *f *= scale);
            let others = [
                &mut self.velocity,
                &mut self.before,
                &mut self.loads,
                &mut self.mean,
            ];
            others.into_iter().flatten().for_each(|x| *x *= scale);
        }
        let late = &rates[4000..];
        let mean = late.iter().sum::<f64>() / late.len() as f64;
        (mean.exp(), late.len() as f64 / turns.max(1) as f64)
    }
}

fn growth(along: Along, joint: Joint, full: usize) -> (f64, f64) {
    let found = Row::new(along, joint, full).growth();
    println!(
        "{} {} {:?}: {found:?}",
        along == Along::Normal,
        full,
        joint.weights
    );
    found
}

/// The table in docs/src/theory/solids.md: blocks of seven cells.
#[test]
fn what_nothing_stops_grows() {
    let without = |weights: [f64; 2]| Joint {
        weights,
        delay: 0.0,
    };
    for (along, joint, [rate, period]) in [
        (Along::Normal, without([0.0, 0.0]), [1.056, 4.0]),
        (Along::Tangent, without([0.25, 0.0]), [1.019, 4.0]),
        (Along::Normal, without([0.25, 0.0]), [1.026, 27.0]),
    ] {
        let (found, half) = growth(along, joint, 6);
        assert!((found - rate).abs() < 0.0006, "{found} for {rate}");
        assert!((2.0 * half / period - 1.0).abs() < 0.03, "{half}");
    }
}

#[test]
fn closed_joints_stop_it() {
    // Up to the B of the narrowest aperture.
    for weight in [CLOSED.weights[0], 0.5, 0.75, 0.95] {
        let joint = Joint {
            weights: [weight, CLOSED.weights[1]],
            ..CLOSED
        };
        for full in [3, 6, 12] {
            for along in [Along::Normal, Along::Tangent] {
                let (found, _) = growth(along, joint, full);
                assert!(found < 1.0 + 1e-6, "{found}");
            }
        }
    }
}
