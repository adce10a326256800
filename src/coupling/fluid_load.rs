//! The load of a fluid on a block, and its average between two exchanges.

use crate::{
    formula::Formula,
    geometry::{Load, outer},
    rock::Period,
};
use glam::DVec3;

/// Mean load of the fluid on a block since the previous exchange.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct FluidLoad {
    /// Load of the flow; zero at rest if buoyancy is separate.
    pub flow: Load,
    /// Buoyancy, −ρ g Σε, of a fluid whose pressure is relative to the hydrostatic pressure.
    pub buoyancy: Load,
}

/// The fields that act on fluid and rock everywhere.
///
/// The exchange in a partially saturated cell is weighted by B, and the body force b on the fluid by 1 − B, so
/// that ρ b ΣB is missing from the load. If b does not contain all of the rock's gravity g, pressure is relative to the
/// hydrostatic pressure, which adds the buoyancy −ρ g Σε (Archimedes). Together: ρ b ΣB − ρ g Σε. With b = g this is
/// −ρ g Σ(ε − B), and the total load at rest is the buoyancy. With g = 0 the body force stands for a
/// pressure gradient. With b = 0 the water is weightless and contributes only its buoyancy.
#[derive(Clone, Debug, PartialEq)]
pub struct Ambient {
    /// Density of the fluid ρ, kg/m³.
    pub density: f64,
    /// Body force per mass on the fluid b, m/s², a formula of the position.
    pub acceleration: [Formula; 3],
    /// Gravity of the rock g, m/s².
    pub gravity: DVec3,
    /// The period of the domain. Positions of blocks are not wrapped.
    pub period: Option<Period>,
}

impl Ambient {
    /// Force and moment of the body force on the entrained fluid: ρ b ΣB.
    pub fn entrained_weight(&self, load: &Load, centre: DVec3) -> Load {
        load_of_density(
            self.body_force(centre),
            load.entrained,
            load.entrained_moment,
        )
    }

    /// The body force on the fluid at a position, ρ b, N/m³.
    pub fn body_force(&self, place: DVec3) -> DVec3 {
        let place = self
            .period
            .map_or(place, |period| period.wrapped(place))
            .to_array();
        let b = [0, 1, 2].map(|k| self.acceleration[k].eval_at(place, 0.0));
        self.density * DVec3::from_array(b)
    }

    /// Buoyancy: −ρ g Σε.
    pub fn buoyancy(&self, load: &Load) -> Load {
        load_of_density(
            -self.density * self.gravity,
            load.entrained + load.missing,
            load.entrained_moment + load.missing_moment,
        )
    }
}

/// Load of a uniform force density (N/m³) on a volume (m³) with the first moment `moment` (m⁴).
fn load_of_density(force: DVec3, volume: f64, moment: DVec3) -> Load {
    Load {
        force: force * volume,
        moment: outer(force, moment),
        ..Load::default()
    }
}

/// The sum of two loads on a block, with the volumes of the first.
pub fn add_loads(a: Load, b: Load) -> Load {
    Load {
        force: a.force + b.force,
        moment: a.moment + b.moment,
        ..a
    }
}

/// Mean of the loads since the last exchange. It conserves momentum: the blocks receive the impulse that the fluid loses
/// in these steps.
///
/// Full cells may reflect their populations in each step, so that loads oscillate with a period of two
/// steps. The mean of each load and the previous one removes the oscillation (Owen, Leonardi & Feng 2011); over many
/// steps it is the trapezoidal rule.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct LoadAverage {
    /// The last loads and their step.
    pub(super) last: Option<(u64, Vec<Load>)>,
    /// Sum of forces and moments, with the volumes of the last step.
    pub(super) sum: Vec<Load>,
    /// Number of steps in the sum.
    pub(super) steps: u64,
}

impl LoadAverage {
    /// Adds the loads of a step, counted from 1. With `average` it adds their mean with the loads of the previous step, which
    /// are zero before the first step; if the previous loads are unknown, it only stores the loads for the next step.
    pub fn add(&mut self, step: u64, loads: Vec<Load>, average: bool) {
        let before = match self.last.take() {
            _ if !average => Some(loads.clone()),
            Some((known, old)) if known + 1 == step => Some(old),
            _ => (step == 1).then(|| vec![Load::default(); loads.len()]),
        };
        if let Some(before) = before {
            if self.steps == 0 {
                self.sum = vec![Load::default(); loads.len()];
            }
            for ((sum, old), new) in self.sum.iter_mut().zip(&before).zip(&loads) {
                *sum = Load {
                    force: sum.force + 0.5 * (old.force + new.force),
                    moment: sum.moment + 0.5 * (old.moment + new.moment),
                    ..*new
                };
            }
            self.steps += 1;
        }
        self.last = Some((step, loads));
    }

    /// Stores the loads of a step for the mean with the loads of the next step.
    pub fn store(&mut self, step: u64, loads: Vec<Load>) {
        self.last = Some((step, loads));
    }

    /// Returns the mean since the last call and starts a new one; returns the last loads if no mean has been added.
    pub fn take(&mut self) -> Option<Vec<Load>> {
        if self.steps == 0 {
            return self.last.as_ref().map(|(_, loads)| loads.clone());
        }
        let weight = 1.0 / self.steps as f64;
        self.steps = 0;
        let mean = |sum: Load| Load {
            force: weight * sum.force,
            moment: weight * sum.moment,
            ..sum
        };
        Some(
            std::mem::take(&mut self.sum)
                .into_iter()
                .map(mean)
                .collect(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn load(x: f64) -> Vec<Load> {
        vec![Load {
            entrained: x,
            ..Load::at(DVec3::X * x, DVec3::Y)
        }]
    }

    fn mean(average: &mut LoadAverage) -> f64 {
        let taken = average.take().unwrap();
        assert_eq!(taken[0].moment.y_axis.x, taken[0].force.x);
        taken[0].force.x
    }

    #[test]
    fn an_oscillation_of_two_steps_cancels_and_impulse_is_conserved() {
        let mut average = LoadAverage::default();
        assert_eq!(average.take(), None);
        // Half of each load counts in the next step.
        average.add(1, load(6.0), true);
        assert_eq!(mean(&mut average), 3.0);
        for (step, x) in [(2, -4.0), (3, 6.0), (4, -4.0)] {
            average.add(step, load(x), true);
        }
        assert_eq!(mean(&mut average), 1.0);
        average.add(5, load(2.0), true);
        assert_eq!(mean(&mut average), -1.0);
    }

    #[test]
    fn loads_without_averaging_are_summed_unchanged() {
        let mut average = LoadAverage::default();
        for (step, x) in [(1, 1.0), (2, 6.0), (9, 2.0)] {
            average.add(step, load(x), false);
        }
        assert_eq!(mean(&mut average), 3.0);
    }

    #[test]
    fn after_a_gap_the_first_load_is_only_stored() {
        let mut average = LoadAverage::default();
        average.add(1, load(1.0), true);
        average.take();
        average.add(15, load(4.0), true);
        average.add(16, load(2.0), true);
        assert_eq!(mean(&mut average), 3.0);
        average.add(20, load(7.0), true);
        assert_eq!(mean(&mut average), 7.0);
    }
}
