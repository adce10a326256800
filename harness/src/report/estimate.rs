//! Estimated duration of a report, updated as it proceeds.

use super::class::Class;
use crate::print::duration;
use std::fmt;

/// Recorded times of the classes on two cores, from which the time here is estimated.
#[derive(Debug)]
pub struct Estimate {
    /// All classes, s; `None` in the full form, which has not been timed.
    planned: Option<f64>,
    /// Finished classes, s.
    done: f64,
    points: usize,
}

impl Estimate {
    /// Estimate for the classes to run.
    pub fn of(classes: &[Class]) -> Self {
        Self {
            planned: classes.iter().map(|class| class.seconds).sum(),
            done: 0.0,
            points: classes.iter().map(|class| class.points.len()).sum(),
        }
    }

    /// Time left after another class, `spent` seconds from the start, in proportion to the finished classes.
    pub fn after(&mut self, class: &Class, spent: f64) -> Option<String> {
        self.done += class.seconds?;
        let left = self.planned? - self.done;
        let here = spent * left / self.done;
        (left > 0.0).then(|| format!("about {} left", duration(here)))
    }
}

impl fmt::Display for Estimate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} points; ", self.points)?;
        match self.planned {
            Some(seconds) => write!(
                f,
                "about {} on two quiet cores with lavapipe",
                duration(seconds)
            ),
            None => f.write_str("the full form has no estimate: it is for a GPU"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{super::class::classes, *};

    #[test]
    fn the_short_form_is_to_take_less_than_five_minutes() {
        let short = classes(false);
        let mut estimate = Estimate::of(&short);
        assert!(estimate.planned.is_some_and(|s| s <= 300.0), "{estimate}");
        // Twice as slow as planned.
        let first = short[0].seconds.unwrap();
        let rest = estimate.planned.unwrap() - first;
        let told = estimate.after(&short[0], 2.0 * first);
        assert_eq!(told, Some(format!("about {} left", duration(2.0 * rest))));
        assert!(Estimate::of(&classes(true)).planned.is_none());
    }

    #[test]
    fn the_short_form_has_every_class_and_setting_of_the_full_one_on_three_grids() {
        for (short, full) in classes(false).iter().zip(classes(true)) {
            assert_eq!(short.name, full.name);
            let mut grids: Vec<f64> = short.points.iter().map(|p| p.resolution).collect();
            grids.sort_by(f64::total_cmp);
            grids.dedup();
            assert!(grids.len() >= 3, "{}: {grids:?}", short.name);
            for point in &full.points {
                let has = short.points.iter().any(|p| p.setting == point.setting);
                assert!(has, "{}: {}", short.name, point.setting);
            }
            for (n, point) in short.points.iter().enumerate() {
                let same = |p: &&super::super::class::Point| {
                    p.setting == point.setting && p.resolution == point.resolution
                };
                let count = short.points.iter().filter(same).count();
                assert_eq!(count, 1, "{}: {n} {}", short.name, point.setting);
            }
        }
    }
}
