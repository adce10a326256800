//! How safely the blocks stand that a probe asks about.

use riprap::safety::Standing;
use serde::Serialize;
use std::fmt;

/// Factors of safety of a block in a run. In JSON an infinite one and one that is not known are both null.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Safety {
    /// The block.
    pub block: String,
    /// When it was looked at last, s.
    pub time: f64,
    /// Then.
    pub last: Factors,
    /// The least that each was.
    pub least: Factors,
}

/// Factors of safety: infinite where nothing drives, NaN where the block touches nothing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Factors {
    /// Against sliding.
    pub sliding: f64,
    /// Against uplift.
    pub uplift: f64,
    /// Against toppling.
    pub toppling: f64,
}

impl Default for Factors {
    fn default() -> Self {
        Self::of([f64::NAN; 3])
    }
}

impl Factors {
    fn of([sliding, uplift, toppling]: [f64; 3]) -> Self {
        Self {
            sliding,
            uplift,
            toppling,
        }
    }

    fn all(&self) -> [f64; 3] {
        [self.sliding, self.uplift, self.toppling]
    }
}

impl Safety {
    /// RunLog how `block` stands at `time` (s).
    pub fn note(all: &mut Vec<Self>, block: &str, time: f64, now: &Standing) {
        let now = [now.sliding.factor, now.uplift, now.toppling];
        let least = match all.iter().find(|known| known.block == block) {
            // A number is less than none.
            Some(known) => std::array::from_fn(|k| known.least.all()[k].min(now[k])),
            None => now,
        };
        all.retain(|known| known.block != block);
        all.push(Self {
            block: block.into(),
            time,
            last: Factors::of(now),
            least: Factors::of(least),
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
        let names = ["sliding", "uplift", "toppling"];
        for (k, (name, factor)) in names.iter().zip(self.all()).enumerate() {
            let comma = if k == 0 { "" } else { ", " };
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

    fn standing(sliding: f64, uplift: f64, toppling: f64) -> Standing {
        let sliding = Sliding {
            factor: sliding,
            mode: Mode::Held,
            direction: Default::default(),
            driving: 0.0,
        };
        Standing {
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
