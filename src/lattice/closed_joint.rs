//! Conductivity of closed joints, as a function of the weight B of the momentum in their cells.
//!
//! The cells of a closed joint remove part of the momentum of their water in each step, and the adjacent full cells reflect their populations. Steady flow
//! along such cells, uniform across the joint but for the rows, follows from three sums over the populations that go along it: those
//! that stay in the row, move up and move down. Their momentum, shear stress and third moment relax with B of the momentum and that of
//! the other moments; a gradient of p/ρ adds its part to those that come from cells of the joint (docs/src/theory/solids.md).

use super::{Collision, Setup, SolidOperator};
use crate::error::{Error, Result};

/// Default B of the momentum without a given aperture: joints of blocks a few cells thick are stable with it at any viscosity.
const WEIGHT: f64 = 0.25;
/// Largest B in joints of one row and of two; 1 would let no water through, and keep the pressure at the time the joint closed.
const LARGEST_WEIGHTS: [f64; 2] = [0.95, 0.98];
/// Tolerance of the bounds for rounding.
const ROUNDING: f64 = 1.0 - 1e-6;
/// B of all other moments, as in `kernels/lattice/psm_cells.wgsl`.
const OTHERS: f64 = 0.0625;

/// Fractions of the moments that the water keeps in a step, without B of the momentum.
struct Kept {
    /// Fraction of the momentum that the operator removes for B = 1.
    momentum: f64,
    shear: f64,
    third: f64,
}

impl Setup {
    /// Hydraulic aperture of closed joints with one row of cells, a shared one or one between block and wall, and of those with two, cells:
    /// a slot of this aperture a has the flow a³/12ν per width and −∇(p/ρ) (cubic law). Within 1 % of the measured flow
    /// (`riprap validate --case joint/pressure`).
    pub fn joint_apertures(&self) -> [f64; 2] {
        let kept = self.kept();
        let [one, two] = self.joint_weights();
        [kept.one_row(one), kept.two_rows(two)].map(|conductance| self.aperture(conductance))
    }

    /// Diffusivity of the pressure in closed joints with one row of cells and with two, lattice units. Full cells next to a row store a sixth of the
    /// water of the row. The first value is that of a shared row; for a row at a wall it is 8/7 times as large.
    pub fn joint_diffusivities(&self) -> [f64; 2] {
        let [one, two] = self.joint_apertures().map(|a| a.powi(3) / (12.0 * self.nu));
        [one / 4.0, two / 7.0]
    }

    /// Least and largest `joint_aperture` that this setup may have with [`SolidOperator::Holdych`], cells.
    pub fn joint_aperture_range(&self) -> [f64; 2] {
        let kept = self.kept();
        let [one, two] = LARGEST_WEIGHTS;
        let least = kept.one_row(one).max(kept.two_rows(two));
        [least, kept.one_row(WEIGHT)].map(|conductance| self.aperture(conductance))
    }

    fn aperture(&self, conductance: f64) -> f64 {
        (12.0 * self.nu * conductance).cbrt()
    }

    /// B of the momentum in joints of one row and of two.
    pub(super) fn joint_weights(&self) -> [f64; 2] {
        let Some(aperture) = self.joint_aperture else {
            return [WEIGHT; 2];
        };
        let kept = self.kept();
        let [one, two] = LARGEST_WEIGHTS;
        let conducts: [(&dyn Fn(f64) -> f64, f64); 2] =
            [(&|b| kept.one_row(b), one), (&|b| kept.two_rows(b), two)];
        conducts.map(|(conductance, largest)| {
            let [mut low, mut high] = [0.0, largest];
            for _ in 0..50 {
                let middle = 0.5 * (low + high);
                match self.aperture(conductance(middle)) > aperture {
                    true => low = middle,
                    false => high = middle,
                }
            }
            low
        })
    }

    pub(super) fn check_joint_aperture(&self) -> Result<()> {
        let of_holdych = matches!(self.solid_operator, None | Some(SolidOperator::Holdych));
        if self.joint_aperture.is_some() && !of_holdych {
            let message = "joints of one row and of two have a common aperture with SolidOperator::Holdych only; leave it out";
            return Err(Error::argument("joint_aperture", message));
        }
        let [least, largest] = self.joint_aperture_range();
        match self.joint_aperture {
            // The bounds may have been converted to metres and back.
            Some(given) if !(least * ROUNDING..=largest / ROUNDING).contains(&given) => {
                let message = format!(
                    "is {given}; closed joints conduct as slots of {least:.4} to {largest:.4} cells"
                );
                Err(Error::argument("joint_aperture", message))
            }
            _ => Ok(()),
        }
    }

    fn kept(&self) -> Kept {
        let rate = 1.0 / self.tau();
        let third = match (self.collision, self.odd_rates()) {
            (Collision::Bgk, _) => rate,
            (_, [_, solids]) => solids.unwrap_or(self.bulk_rates().s10),
        };
        let (momentum, of_shear, of_third) = match self.solid_operator {
            Some(SolidOperator::Noble) => (1.0, 0.0, 2.0),
            Some(SolidOperator::Superposition) => (1.0, rate, rate),
            Some(SolidOperator::Holdych) | None => (2.0, 0.0, 2.0),
        };
        Kept {
            momentum,
            shear: 1.0 - (1.0 - OTHERS) * rate - OTHERS * of_shear,
            third: 1.0 - (1.0 - OTHERS) * third - OTHERS * of_third,
        }
    }
}

impl Kept {
    /// Full cells on both sides reflect.
    fn one_row(&self, weight: f64) -> f64 {
        let a = 1.0 - self.momentum * weight;
        let k = self.third / (1.0 + self.third);
        let momentum = 2.0 / (3.0 - a - 2.0 * k * (1.0 + a));
        (momentum * (2.0 * a + k * (1.0 + a)) + 1.0) / 3.0
    }

    /// Full cells reflect on one side of each, the other row is on the other one.
    fn two_rows(&self, weight: f64) -> f64 {
        let Self { shear, third, .. } = *self;
        let a = 1.0 - self.momentum * weight;
        let both = 1.0 + shear * third;
        let mixed = third * (1.0 + shear) / both;
        let momentum = ((5.0 - shear) / 6.0 - mixed * (1.0 - shear) / 6.0)
            / (1.0 - (2.0 - shear) * a / 3.0 - mixed * (1.0 + shear * a) / 3.0);
        let of_third = ((1.0 - shear) / 6.0 - momentum * (1.0 + shear * a) / 3.0) / both;
        let of_shear = -third * of_third - a * momentum / 3.0 - 1.0 / 6.0;
        let row = 2.0 * a * momentum / 3.0 - third * of_third
            + 0.5 * (third * of_third + a * momentum / 3.0 + shear * of_shear)
            + 5.0 / 12.0;
        2.0 * row
    }
}
