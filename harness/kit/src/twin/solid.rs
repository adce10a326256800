//! Partially saturated cells: the fluid of a cell and the solid that fills a part of it (Noble & Torczynski 1998).

use super::equilibrium::equilibrium;
use super::lattice::{C, OPPOSITE, Q, macroscopic};
use super::rates::{Config, OddClass, Operator, moment_rates};

/// Ω^s, the change of populations by the solid alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SolidOperator {
    /// f_ī − f_ī^eq(ρ, u_s) − f_i + f_i^eq(ρ, u_s) (Holdych 2003).
    Holdych,
    /// f_ī − f_ī^eq(ρ, u) − f_i + f_i^eq(ρ, u_s) (Noble & Torczynski 1998).
    Noble,
    /// f_i^eq(ρ, u_s) − f_i + (1 − 1/τ)(f_i − f_i^eq(ρ, u)) (Noble & Torczynski 1998).
    Superposition,
}

/// B of an open cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SolidWeight {
    /// That of Noble & Torczynski (1998).
    Standard,
    /// The weight with which planes act at their exact positions.
    Exact,
}

/// The solid in a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Solid {
    /// Solid fraction for the weight, up to 1.
    pub fraction: f64,
    /// Sum of the effective fractions of all blocks, by which the force is divided among them; more than 1 where they overlap.
    pub shares: f64,
    /// Mean velocity of the blocks, weighted by their effective fractions.
    pub velocity: [f64; 3],
    /// Whether a direct neighbour holds solid while the cell itself holds no block.
    pub beside: bool,
    /// Whether the cell and all within two layers of it are full of one block.
    pub deep: bool,
    /// How closely blocks that meet in the cell, or a block and a wall, fill it: [`tightness`]; 0 if they do not.
    pub tight: f64,
    /// Whether several blocks meet in it.
    pub shared: bool,
    /// Whether the cell belongs to a joint of two rows: one block fills it, and another one the next cell.
    pub facing: bool,
}

/// Lower bound of B of the momentum in a cell that several blocks share, and in a nearly full cell.
const LEAST: f64 = 0.25;
/// B of all moments except mass and momentum in a cell of a closed joint, and their lower bound in these cells.
pub(super) const DAMPS: f64 = 1.0 / 16.0;

/// Tightness of a cell with the solid `share`: 1 for a closed joint, up to 0.002 of a cell wide, 0 from a tenth of a cell on.
pub fn tightness(share: f64) -> f64 {
    ((share - 0.9) / 0.098).clamp(0.0, 1.0)
}

impl Solid {
    /// Whether the odd moments relax as next to the surface of a block.
    pub fn is_near(&self) -> bool {
        self.beside || self.shares > 0.0
    }

    /// B of the momentum at the relaxation time `tau`: 1 deep inside, that of the configuration in closed joints, and at least a
    /// quarter in a cell that several blocks fill by half or that is almost full. Elsewhere ε (τ − ½) / ((1 − ε) + (τ − ½)), or that
    /// of docs/src/theory/solids.md.
    pub fn weight(&self, config: &Config, tau: f64) -> f64 {
        let [one, two] = config.joint_weights;
        let closed = if self.facing { two } else { one };
        self.in_joint(config, tau, [LEAST, closed])
    }

    /// The same for all moments except mass and momentum.
    pub fn higher_weight(&self, config: &Config, tau: f64) -> f64 {
        self.in_joint(config, tau, [DAMPS; 2])
    }

    fn in_joint(&self, config: &Config, tau: f64, [least, closed]: [f64; 2]) -> f64 {
        if self.deep {
            return 1.0;
        }
        let shared = if self.shared {
            (2.0 * self.fraction).min(1.0)
        } else {
            0.0
        };
        let least = shared.max(tightness(self.fraction)) * least;
        (1.0 - self.tight) * self.open_weight(config, tau).max(least) + self.tight * closed
    }

    fn open_weight(&self, config: &Config, tau: f64) -> f64 {
        let (e, excess) = (self.fraction, tau - 0.5);
        match config.solid_weight {
            SolidWeight::Standard => e * excess / ((1.0 - e) + excess),
            SolidWeight::Exact => {
                let s = third_order_rate(config, tau);
                let x = (1.0 - e) / excess;
                let b = s * (1.0 + 2.0 * x) - 3.0 * (2.0 - s) * e;
                2.0 * s * e / (b + (b * b + 12.0 * (2.0 - s) * (1.0 + x) * s * e).sqrt())
            }
        }
    }

    /// Part of Ω^s that the equilibrium replaces: all deep inside, and with Holdych's operator |u_x| + |u_y| + |u_z| in full cells.
    pub fn damping(&self, operator: SolidOperator) -> f64 {
        if self.deep {
            return 1.0;
        }
        if operator != SolidOperator::Holdych {
            return 0.0;
        }
        let speed: f64 = self.velocity.iter().map(|u| u.abs()).sum();
        speed.min(1.0) * tightness(self.fraction)
    }

    /// Velocity from which the eddy viscosity is computed: the mean of fluid and solid, by the solid fraction.
    pub fn mean_velocity(&self, u: [f64; 3]) -> [f64; 3] {
        let e = self.fraction;
        [0, 1, 2].map(|a| (1.0 - e) * u[a] + e * self.velocity[a])
    }
}

/// Rate of 120 + 102 in cells with a block.
pub(super) fn third_order_rate(config: &Config, tau: f64) -> f64 {
    match config.operator {
        Operator::Bgk => 1.0 / tau,
        _ => moment_rates(config, 0.0, OddClass::Block)[10],
    }
}

/// Ω^s of a solid that moves with `u_s`, in a cell with the relaxation time `tau`; the equilibrium of the solid replaces the part
/// `damping` of all populations.
pub fn solid_change(
    config: &Config,
    (operator, damping): (SolidOperator, f64),
    f: &[f64; Q],
    force: [f64; 3],
    tau: f64,
    u_s: [f64; 3],
) -> [f64; Q] {
    let (rho, u) = macroscopic(f, force);
    let fluid = equilibrium(config.equilibrium, rho, u);
    let solid = equilibrium(config.equilibrium, rho, u_s);
    std::array::from_fn(|i| {
        let r = OPPOSITE[i];
        let change = match operator {
            SolidOperator::Holdych => f[r] - solid[r] - f[i] + solid[i],
            SolidOperator::Noble => f[r] - fluid[r] - f[i] + solid[i],
            SolidOperator::Superposition => solid[i] - f[i] + (1.0 - 1.0 / tau) * (f[i] - fluid[i]),
        };
        (1.0 - damping) * change + damping * (solid[i] - f[i])
    })
}

/// Force on one of the blocks in a cell, −B_p Σ_i c_i Ω^s_i, of which the cell has the share `part` and
/// which moves there with `u_p` (Gardner & Sitar 2018, eq. 11, with the sign of their text).
pub fn force_on(weight: f64, solid: &Solid, part: f64, change: &[f64; Q]) -> [f64; 3] {
    let own = weight * part / solid.shares;
    [0, 1, 2].map(|a| -own * (0..Q).map(|i| f64::from(C[i][a]) * change[i]).sum::<f64>())
}
