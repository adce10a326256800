//! Factors of safety of blocks whose probes request them.

use riprap::safety::SafetyFactors;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Factors of safety of a block in a run. In JSON infinite and unknown ones are both null.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Safety {
    /// The block.
    pub block: String,
    /// Time of the last evaluation, s.
    pub time: f64,
    /// Factors at that time.
    pub last: Factors,
    /// Smallest value of each factor.
    pub least: Factors,
}

/// Factors of safety: infinite without a driving load, NaN if the block touches nothing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Factors {
    /// Against sliding.
    pub sliding: f64,
    /// Against uplift.
    pub uplift: f64,
    /// Against toppling.
    pub toppling: f64,
}

impl Safety {
    /// Adds the standing of `block` at `time` (s) to `all`.
    pub fn note(all: &mut Vec<Self>, block: &str, time: f64, now: &SafetyFactors) {
        let last = Factors {
            sliding: now.sliding.factor,
            uplift: now.uplift,
            toppling: now.toppling,
        };
        let least = match all.iter().find(|known| known.block == block) {
            // The minimum of a number and NaN is the number.
            Some(Self { least, .. }) => Factors {
                sliding: least.sliding.min(last.sliding),
                uplift: least.uplift.min(last.uplift),
                toppling: least.toppling.min(last.toppling),
            },
            None => last,
        };
        all.retain(|known| known.block != block);
        all.push(Self {
            block: block.into(),
            time,
            last,
            least,
        });
    }
}

impl fmt::Display for Safety {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{}: factor of safety {} at {:.4} s; least {}",
            self.block, self.last, self.time, self.least
        )
    }
}

impl fmt::Display for Factors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (comma, name, factor) in [
            ("", "sliding", self.sliding),
            (", ", "uplift", self.uplift),
            (", ", "toppling", self.toppling),
        ] {
            match factor.is_nan() {
                true => write!(f, "{comma}{name} none (no contact)")?,
                false => write!(f, "{comma}{name} {factor:.2}")?,
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use riprap::safety::{Mode, Sliding};

    fn standing(sliding: f64, uplift: f64, toppling: f64) -> SafetyFactors {
        let sliding = Sliding {
            factor: sliding,
            mode: Mode::Held,
            direction: Default::default(),
            driving: 0.0,
        };
        SafetyFactors {
            sliding,
            uplift,
            toppling,
        }
    }

    #[test]
    fn the_least_of_each_and_the_last_of_all() {
        let mut all = Vec::new();
        let infinite = f64::INFINITY;
        Safety::note(&mut all, "stone", 0.1, &standing(1.4, infinite, 3.0));
        Safety::note(&mut all, "stone", 0.2, &standing(1.2, infinite, f64::NAN));
        assert_eq!(all.len(), 1);
        assert_eq!(
            all[0].to_string(),
            "stone: factor of safety sliding 1.20, uplift inf, toppling none (no contact) at 0.2000 s; \
             least sliding 1.20, uplift inf, toppling 3.00"
        );
    }
}
