//! From what the fluid did to the solid in its cells to the load on a block.

use crate::{
    bodies::{Load, Period, outer},
    formula::Formula,
};
use glam::DVec3;

/// What acts on fluid and rock everywhere.
///
/// The exchange in a partially saturated cell is weighted by B, and the body force b on the fluid by 1 − B, so
/// that ρ b ΣB is missing from it; and where the rock's gravity g is not all in b, pressure is counted from the
/// hydrostatic one, whose push is −ρ g Σε (Archimedes). Together: ρ b ΣB − ρ g Σε. With b = g this is
/// −ρ g Σ(ε − B), which at rest makes the whole load the buoyancy; with g = 0 the body force stands for a
/// pressure gradient; with b = 0 the water is weightless and only its buoyancy is felt.
#[derive(Clone, Debug, PartialEq)]
pub struct Ambient {
    /// Density of the fluid ρ, kg/m³.
    pub density: f64,
    /// Body force on the fluid per mass b, m/s², a formula of the place.
    pub acceleration: [Formula; 3],
    /// Gravity of the rock g, m/s².
    pub gravity: DVec3,
    /// Where the fluid repeats; blocks go on in the coordinates of the world.
    pub period: Option<Period>,
}

impl Ambient {
    /// Force and moment of the body force on what the block entrains: ρ b ΣB.
    pub fn push(&self, load: &Load, centre: DVec3) -> Load {
        spread(self.weight(centre), load.entrained, load.entrained_moment)
    }

    /// The body force on the fluid at a place, ρ b, N/m³.
    pub fn weight(&self, place: DVec3) -> DVec3 {
        let place = self
            .period
            .map_or(place, |period| period.within(place))
            .to_array();
        let b = [0, 1, 2].map(|k| self.acceleration[k].eval_at(place, 0.0));
        self.density * DVec3::from_array(b)
    }

    /// Buoyancy: −ρ g Σε.
    pub fn buoyancy(&self, load: &Load) -> Load {
        spread(
            -self.density * self.gravity,
            load.entrained + load.missing,
            load.entrained_moment + load.missing_moment,
        )
    }
}

/// A force per volume over a volume with a first moment.
fn spread(force: DVec3, volume: f64, moment: DVec3) -> Load {
    Load {
        force: force * volume,
        moment: outer(force, moment),
        ..Load::default()
    }
}

/// The sum of two loads on a block; the volumes are those of the first.
pub fn sum(a: Load, b: Load) -> Load {
    Load {
        force: a.force + b.force,
        moment: a.moment + b.moment,
        ..a
    }
}
