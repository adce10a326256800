//! What the flow does to the blocks in the steps from one exchange to the next.

use crate::bodies::Load;

/// Loads of the steps since the last exchange, of which the blocks feel the mean: what the fluid loses in
/// these steps the blocks gain, however many there are.
///
/// Full cells may reflect what is in them from step to step, so that single loads swing with a period of two
/// steps. The mean of each load and the one before it takes that out (Owen, Leonardi & Feng 2011); over many
/// steps it is the trapezoidal rule.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Gathered {
    /// Step of the last loads that came, and these.
    pub(super) last: Option<(u64, Vec<Load>)>,
    /// Sum of forces and moments, with the volumes of the last step.
    pub(super) sum: Vec<Load>,
    /// Steps in it.
    pub(super) steps: u64,
}

impl Gathered {
    /// Adds the loads of a step, counted from 1, with `average` as the mean of them and those of the step
    /// before: none before the first one. Where those are not known, the step only prepares the next one.
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

    /// The mean since the last time; the last loads alone if no step has come with the one before it.
    pub fn take(&mut self) -> Option<Vec<Load>> {
        if self.steps == 0 {
            return self.last.as_ref().map(|(_, loads)| loads.clone());
        }
        let share = 1.0 / self.steps as f64;
        self.steps = 0;
        let mean = |sum: Load| Load {
            force: share * sum.force,
            moment: share * sum.moment,
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

    fn mean(gathered: &mut Gathered) -> f64 {
        let taken = gathered.take().unwrap();
        assert_eq!(taken[0].moment.y_axis.x, taken[0].force.x);
        taken[0].force.x
    }

    #[test]
    fn a_swing_of_two_steps_goes_and_the_impulse_stays() {
        let mut gathered = Gathered::default();
        assert_eq!(gathered.take(), None);
        // Half of each load comes with the next one.
        gathered.add(1, load(6.0), true);
        assert_eq!(mean(&mut gathered), 3.0);
        for (step, x) in [(2, -4.0), (3, 6.0), (4, -4.0)] {
            gathered.add(step, load(x), true);
        }
        assert_eq!(mean(&mut gathered), 1.0);
        gathered.add(5, load(2.0), true);
        assert_eq!(mean(&mut gathered), -1.0);
    }

    #[test]
    fn single_loads_are_added_as_they_are() {
        let mut gathered = Gathered::default();
        for (step, x) in [(1, 1.0), (2, 6.0), (9, 2.0)] {
            gathered.add(step, load(x), false);
        }
        assert_eq!(mean(&mut gathered), 3.0);
    }

    #[test]
    fn after_a_gap_a_load_waits_for_the_next_one() {
        let mut gathered = Gathered::default();
        gathered.add(1, load(1.0), true);
        gathered.take();
        gathered.add(15, load(4.0), true);
        gathered.add(16, load(2.0), true);
        assert_eq!(mean(&mut gathered), 3.0);
        gathered.add(20, load(7.0), true);
        assert_eq!(mean(&mut gathered), 7.0);
    }
}
