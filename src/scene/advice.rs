//! Whether the lattice can carry the scene: what is refused, and what is only worth a warning.

use std::fmt;

use super::{Collision, EddyViscosity, Numerics, Scene};
use crate::error::{Error, Result};
use crate::units::Units;

/// Above this Mach number the error of compressibility, about Ma², exceeds 10 %, and no collision
/// operator here is stable at low viscosity.
const MOST_MACH: f64 = 0.3;
/// Above this Mach number the error of compressibility exceeds 2 %.
const HIGH_MACH: f64 = 0.15;
/// Range of τ − ½ in which the rates of Suga et al. (2015) are linearly stable at rest.
const SUGA: std::ops::RangeInclusive<f64> = 4e-4..=0.059;
/// Below this τ − ½ the viscosity drowns in the rounding of f32.
const LEAST_TAU: f64 = 1e-6;
/// Above this τ half-way walls and the discretisation lose accuracy quickly.
const HIGH_TAU: f64 = 1.5;
/// Above this Reynolds number of a cell the smallest eddies fall through the grid.
const HIGH_CELL_REYNOLDS: f64 = 30.0;
/// Below this τ − ½ one relaxation time oscillates at walls and solids.
const LOW_BGK_TAU: f64 = 0.01;

/// Something that works but may disappoint.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// The key to look at.
    pub place: String,
    /// What is the matter, and what would help, with numbers.
    pub message: String,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.message)
    }
}

/// What [`Scene::advise`] found that is not refused.
pub type Advice = Vec<Warning>;

impl Scene {
    /// Refuses what the lattice cannot carry at these `units`, and warns of what it carries badly.
    ///
    /// # Errors
    /// A Mach number above 0.3; a relaxation time at which the collision operator is unstable.
    pub fn advise(&self, units: &Units) -> Result<Advice> {
        let speed = match self.numerics.velocity_scale {
            Some(given) => given.max(self.sampled_speed()?),
            None => self.sampled_speed()?,
        };
        let mut advice = Vec::new();
        let mut warn = |place: &str, message: String| {
            advice.push(Warning {
                place: place.into(),
                message,
            });
        };
        let mach = units.mach(speed);
        // The time step for the default Mach number.
        let calm = units.time_step * Numerics::DEFAULT_MACH / mach;
        let key = if self.numerics.time_step.is_some() {
            "time_step"
        } else {
            "mach"
        };
        let slower = format!(
            "use time_step ≤ {calm:.3e} s (mach = {})",
            Numerics::DEFAULT_MACH
        );
        if mach > MOST_MACH {
            return Err(Error::scene(
                format!("numerics.{key}"),
                format!(
                    "the Mach number of the lattice is {mach:.3} at {speed} m/s, above {MOST_MACH}, \
                     where the flow is compressible and unstable; {slower}"
                ),
            ));
        }
        if mach > HIGH_MACH {
            warn(
                &format!("numerics.{key}"),
                format!(
                    "the Mach number of the lattice is {mach:.3} at {speed} m/s: errors of \
                     compressibility near {:.1} %; {slower}",
                    100.0 * mach * mach
                ),
            );
        }
        let nu = self.fluid.viscosity;
        let tau = units.tau(nu);
        self.refuse_tau(tau, units)?;
        if tau > HIGH_TAU {
            let step = units.time_step * (HIGH_TAU - 0.5) / (tau - 0.5);
            warn(
                &format!("numerics.{key}"),
                format!(
                    "the relaxation time is {tau:.3}, above {HIGH_TAU}, where accuracy falls off; \
                     use time_step ≤ {step:.3e} s"
                ),
            );
        }
        if self.numerics.collision == Collision::Bgk && tau - 0.5 < LOW_BGK_TAU {
            warn(
                "numerics.collision",
                format!(
                    "bgk oscillates at a relaxation time of {tau:.5}, below {}; use collision = \
                     \"hermite\", or cell ≤ {:.3e} m at the same Mach number",
                    0.5 + LOW_BGK_TAU,
                    units.cell * (tau - 0.5) / LOW_BGK_TAU
                ),
            );
        }
        let cell_reynolds = speed * units.cell / nu;
        if cell_reynolds > HIGH_CELL_REYNOLDS && self.numerics.eddy_viscosity == EddyViscosity::None
        {
            warn(
                "domain.cell",
                format!(
                    "the Reynolds number of a cell is {cell_reynolds:.1} at {speed} m/s, above \
                     {HIGH_CELL_REYNOLDS}: eddies are not resolved and the run may diverge; use \
                     cell ≤ {:.3e} m, or eddy_viscosity = \"wale\"",
                    HIGH_CELL_REYNOLDS * nu / speed
                ),
            );
        }
        Ok(advice)
    }

    /// Refuses a relaxation time `tau` at which the collision is unstable.
    fn refuse_tau(&self, tau: f64, units: &Units) -> Result<()> {
        let excess = tau - 0.5;
        // τ − ½ grows with the time step, and at a fixed Mach number with 1/cell.
        let step_for = |wanted: f64| units.time_step * wanted / excess;
        let cell_for = |wanted: f64| units.cell * excess / wanted;
        if excess < LEAST_TAU {
            return Err(Error::scene(
                "fluid.viscosity",
                format!(
                    "τ − ½ is {excess:.3e}, below {LEAST_TAU:e}: the viscosity drowns in \
                     rounding; use viscosity ≥ {:.3e} m²/s, or cell ≤ {:.3e} m at the same Mach \
                     number",
                    self.fluid.viscosity * LEAST_TAU / excess,
                    cell_for(LEAST_TAU)
                ),
            ));
        }
        if self.numerics.collision != Collision::Suga || SUGA.contains(&excess) {
            return Ok(());
        }
        let remedy = if excess > *SUGA.end() {
            format!("time_step ≤ {:.3e} s", step_for(*SUGA.end()))
        } else {
            format!(
                "time_step ≥ {:.3e} s, or cell ≤ {:.3e} m at the same Mach number",
                step_for(*SUGA.start()),
                cell_for(*SUGA.start())
            )
        };
        Err(Error::scene(
            "numerics.collision",
            format!(
                "suga is linearly unstable at the relaxation time {tau:.6}: τ − ½ must lie \
                 between {:e} and {}; use collision = \"hermite\", or {remedy}",
                SUGA.start(),
                SUGA.end()
            ),
        ))
    }
}
