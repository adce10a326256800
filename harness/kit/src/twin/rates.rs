//! Collision parameters of a scene, and the relaxation rates that follow from them.

use super::lattice::Q;
use super::solid::SolidWeight;

/// Form of the equilibrium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Equilibrium {
    /// Second order in u.
    Order2,
    /// Full product form.
    Product,
}

/// Collision operator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Operator {
    /// One rate for all moments.
    Bgk,
    /// Suga et al. (2015): moments orthogonal with unit weight.
    Suga,
    /// The same polynomials, orthogonal with the weights w_i.
    Hermite,
}

/// Whether a cell is next to a bounce-back wall or a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OddClass {
    /// No bounce-back link leaves the cell.
    Bulk,
    /// At least one of the 26 neighbours is a wall, a solid or a velocity face.
    Wall,
    /// A block is in the cell or in one of the 26 neighbours; takes precedence over walls.
    Block,
}

/// Rates of the moments that carry neither mass, momentum nor shear (Suga et al. 2015, §2).
/// The shear rate s5 = s7 is 1/τ_eff and depends on the cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rates {
    /// Trace of second order: bulk viscosity.
    pub s4: f64,
    /// 120 + 102 and its permutations.
    pub s10: f64,
    /// 122 and its permutations.
    pub s13: f64,
    /// Trace of fourth order, 220 + 202 + 022.
    pub s16: f64,
    /// 222.
    pub s17: f64,
    /// Deviators of fourth order.
    pub s18: f64,
    /// 112 and its permutations.
    pub s20: f64,
    /// 120 − 102 and its permutations.
    pub s23: f64,
    /// 111.
    pub s26: f64,
}

impl Rates {
    /// The published constants.
    pub const SUGA: Self = Self {
        s4: 1.54,
        s10: 1.5,
        s13: 1.83,
        s16: 1.4,
        s17: 1.61,
        s18: 1.98,
        s20: 1.98,
        s23: 1.74,
        s26: 1.74,
    };

    /// The same rate for every moment.
    pub const fn equal(s: f64) -> Self {
        Self {
            s4: s,
            s10: s,
            s13: s,
            s16: s,
            s17: s,
            s18: s,
            s20: s,
            s23: s,
            s26: s,
        }
    }
}

/// All parameters of the collision of a cell.
#[derive(Clone, Copy, Debug)]
pub struct Config {
    /// Laminar relaxation time, ν = (τ − ½)/3.
    pub tau: f64,
    /// Form of the equilibrium.
    pub equilibrium: Equilibrium,
    /// Collision operator.
    pub operator: Operator,
    /// Rates of the MRT operators away from walls; `None` for the library's defaults.
    pub rates: Option<Rates>,
    /// Λ of cells next to bounce-back walls, `Hermite` only.
    pub lambda_wall: f64,
    /// Λ of cells with a block and of their neighbours, `Hermite` only; `None` keeps the constants.
    pub lambda_solid: Option<f64>,
    /// Λ of every cell, `Hermite` only, instead of the constants and of the two above.
    pub lambda_everywhere: Option<f64>,
    /// Lower bounds of the odd rates from a Λ: next to walls, and in cells with a block and next to them.
    pub floors: [f64; 2],
    /// Weight of the solid in cells that blocks fill partially.
    pub solid_weight: SolidWeight,
    /// B of the momentum in closed joints of one row of cells and of two.
    pub joint_weights: [f64; 2],
    /// WALE's C_w; `None` is laminar.
    pub c_w: Option<f64>,
    /// Steps from one evaluation of the eddy viscosity to the next, 1 or 2.
    pub wale_interval: u64,
}

impl Config {
    /// The library's defaults: `Hermite`, product equilibrium, Λ = 3/16 next to walls and 1/10 in and next to blocks, but no
    /// odd rate below 0.8, nor below 1.6 − 40(τ − ½) next to walls and 1.2 − 20(τ − ½) in and next to blocks.
    pub const fn new(tau: f64) -> Self {
        Self {
            tau,
            equilibrium: Equilibrium::Product,
            operator: Operator::Hermite,
            rates: None,
            lambda_wall: 3.0 / 16.0,
            lambda_solid: Some(0.1),
            lambda_everywhere: None,
            floors: [
                f64::max(0.8, 1.6 - 40.0 * (tau - 0.5)),
                f64::max(0.8, 1.2 - 20.0 * (tau - 0.5)),
            ],
            solid_weight: SolidWeight::Exact,
            joint_weights: [0.25; 2],
            c_w: None,
            wale_interval: 1,
        }
    }

    /// Laminar viscosity.
    pub fn nu(&self) -> f64 {
        (self.tau - 0.5) / 3.0
    }

    /// τ_eff = ½ + 3 (ν + ν_t).
    pub fn tau_eff(&self, nu_t: f64) -> f64 {
        self.tau + 3.0 * nu_t
    }
}

/// s_odd = max(floor, 1/(½ + Λ/(τ − ½))), from (1/s_odd − ½)(τ − ½) = Λ (Ginzburg & d'Humières 2003).
pub fn odd_rate(tau: f64, lambda: f64, floor: f64) -> f64 {
    floor.max(1.0 / (0.5 + lambda / (tau - 0.5)))
}

/// Rate of each of the 27 moments in the order of Suga's matrix.
pub fn moment_rates(config: &Config, nu_t: f64, odd: OddClass) -> [f64; Q] {
    let rates = bulk_rates(config);
    let r = match odd_override(config, odd) {
        None => rates,
        Some(s_odd) => Rates {
            s10: s_odd,
            s13: s_odd,
            s23: s_odd,
            s26: s_odd,
            ..rates
        },
    };
    let s5 = 1.0 / config.tau_eff(nu_t);
    std::array::from_fn(|k| match k {
        0..=3 => 0.0,
        4 => r.s4,
        5..=9 => s5,
        10..=12 => r.s10,
        13..=15 => r.s13,
        16 => r.s16,
        17 => r.s17,
        18 | 19 => r.s18,
        20..=22 => r.s20,
        23..=25 => r.s23,
        _ => r.s26,
    })
}

/// The given rates, or those of Suga et al., of which `Hermite` changes six below τ = 0.52: linearly to 1.9 (odd orders) and 1.6
/// (deviators of fourth order, 112) at τ = ½.
fn bulk_rates(config: &Config) -> Rates {
    let published = Rates::SUGA;
    let low = match config.operator {
        Operator::Hermite => (1.0 - (config.tau - 0.5) / 0.02).max(0.0),
        _ => 0.0,
    };
    let to = |rate: f64, limit: f64| (1.0 - low) * rate + low * limit;
    config.rates.unwrap_or(Rates {
        s10: to(published.s10, 1.9),
        s13: to(published.s13, 1.9),
        s18: to(published.s18, 1.6),
        s20: to(published.s20, 1.6),
        s23: to(published.s23, 1.9),
        s26: to(published.s26, 1.9),
        ..published
    })
}

/// The odd rate that replaces the constants in this cell; `None` for `Suga`, which keeps those of the paper.
fn odd_override(config: &Config, odd: OddClass) -> Option<f64> {
    let [wall, solid] = config.floors;
    let (lambda, floor) = match (config.operator, config.lambda_everywhere, odd) {
        (Operator::Hermite, Some(lambda), _) => (lambda, 0.0),
        (Operator::Hermite, None, OddClass::Wall) => (config.lambda_wall, wall),
        (Operator::Hermite, None, OddClass::Block) => (config.lambda_solid?, solid),
        _ => return None,
    };
    Some(odd_rate(config.tau, lambda, floor))
}
