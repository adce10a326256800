//! The load of a fluid on a block.

use crate::{
    formula::Formula,
    geometry::{Load, outer},
    rock::Period,
};
use glam::DVec3;

/// Load of the fluid on a block, the mean since the previous exchange.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct FluidLoad {
    /// Load of the flow; zero at rest where buoyancy is separate.
    pub flow: Load,
    /// Buoyancy, −ρ g Σε, of a fluid whose pressure is counted from the hydrostatic one.
    pub buoyancy: Load,
}

/// The fields that act on fluid and rock everywhere.
///
/// The exchange in a partially saturated cell is weighted by B, and the body force b on the fluid by 1 − B, so
/// that ρ b ΣB is missing from the load. Where the rock's gravity g is not all in b, pressure is counted from the
/// hydrostatic one, which adds the buoyancy −ρ g Σε (Archimedes). Together: ρ b ΣB − ρ g Σε. With b = g this is
/// −ρ g Σ(ε − B), and the total load at rest is the buoyancy. With g = 0 the body force stands for a
/// pressure gradient. With b = 0 the water is weightless and contributes only its buoyancy.
#[derive(Clone, Debug, PartialEq)]
pub struct Ambient {
    /// Density of the fluid ρ, kg/m³.
    pub density: f64,
    /// Body force on the fluid per mass b, m/s², a formula of the place.
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

    /// The body force on the fluid at a place, ρ b, N/m³.
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

/// The sum of two loads on a block; the volumes are those of the first.
pub fn add_loads(a: Load, b: Load) -> Load {
    Load {
        force: a.force + b.force,
        moment: a.moment + b.moment,
        ..a
    }
}
