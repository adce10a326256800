//! Checks whether the lattice can represent a scene: what is refused, and what is only worth a warning.

use std::fmt;

use super::{Collision, EddyViscosity, InitialPressure, Numerics, Scene, Storage, WallModel};
use crate::error::{Error, Result};
use crate::units::Units;

/// Above this Mach number the error of compressibility, about Ma², exceeds 10 %, and no collision
/// operator here is stable at low viscosity.
const MOST_MACH: f64 = 0.3;
/// Above this Mach number the error of compressibility exceeds 2 %.
pub const HIGH_MACH: f64 = 0.15;
/// Above this relative change of density the fluid's weight affects the flow: drag and inertia change by as much.
const HIGH_COMPRESSION: f64 = 0.05;
/// Range of τ − ½ in which the rates of Suga et al. (2015) are linearly stable at rest.
pub const SUGA_EXCESS: std::ops::RangeInclusive<f64> = 4e-4..=0.059;
/// Below this τ − ½ flows with one magic parameter everywhere, without lower bounds of the odd rates, may become unsteady.
const LAMBDA_EXCESS: f64 = 0.02;
/// Below this τ − ½ the viscosity is lost in the rounding of f32.
const LEAST_TAU: f64 = 1e-6;
/// Above this τ half-way walls and the discretisation lose accuracy quickly.
const HIGH_TAU: f64 = 1.5;
/// Above this τ the error of the lattice, which grows with τ², exceeds any flow: populations hardly relax.
const MOST_TAU: f64 = 1e3;
/// Above this Reynolds number of a cell the grid does not resolve the smallest eddies.
const HIGH_CELL_REYNOLDS: f64 = 30.0;
/// Below this τ − ½ the operator with one relaxation time oscillates at walls and solids.
const LOW_BGK_TAU: f64 = 0.01;

/// A setting that works but may give poor results.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// The key concerned.
    pub place: String,
    /// The problem and a remedy, with numbers.
    pub message: String,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.message)
    }
}

/// Warnings about a scene, such as those of [`Scene::advise`].
pub type Advice = Vec<Warning>;

impl Scene {
    /// Refuses what the lattice cannot compute at these `units`, and returns warnings about what it computes poorly.
    ///
    /// # Errors
    /// A Mach number above 0.3; a relaxation time for which the collision operator is unstable or too inaccurate.
    pub fn advise(&self, units: &Units) -> Result<Advice> {
        let sampled = self.sampled_speed()?;
        let mut adviser = Adviser {
            scene: self,
            units,
            speed: self.numerics.velocity_scale.unwrap_or(0.0).max(sampled),
            // Not computed as the difference of τ and ½, which would lose small values to rounding.
            excess: 3.0 * self.fluid.viscosity * units.time_step / units.cell.powi(2),
            step_key: if self.numerics.time_step.is_some() {
                "numerics.time_step"
            } else {
                "numerics.mach"
            },
            advice: Vec::new(),
        };
        adviser.mach()?;
        adviser.low_tau()?;
        adviser.suga()?;
        adviser.lambda();
        adviser.high_tau()?;
        adviser.bgk();
        adviser.cell_reynolds();
        adviser.weight();
        adviser.friction_of_surfaces();
        adviser.pressures()?;
        Ok(adviser.advice)
    }

    /// Largest relative difference of density in the fluid that follows from the pressures of faces and of the initial state:
    /// Δp/(ρ c²), c being the speed of sound of the lattice.
    ///
    /// # Errors
    /// If the formula of the pressure is not finite somewhere.
    pub fn compression(&self, units: &Units) -> Result<f64> {
        let [low, high] = self.pressure_range()?;
        Ok(units.pressure_to_lattice(high - low) - 1.0)
    }
}

struct Adviser<'a> {
    scene: &'a Scene,
    units: &'a Units,
    /// Largest known speed, m/s.
    speed: f64,
    /// τ − ½: grows with the time step, and at a fixed Mach number with 1/cell.
    excess: f64,
    /// The key that fixes the time step.
    step_key: &'static str,
    advice: Advice,
}

impl Adviser<'_> {
    fn warn(&mut self, place: &str, message: String) {
        self.advice.push(Warning {
            place: place.into(),
            message,
        });
    }

    /// Warns of the odd rates of one magic parameter at low viscosities.
    fn lambda(&mut self) {
        if self.scene.numerics.lambda.is_some() && self.excess < LAMBDA_EXCESS {
            let message = format!(
                "sets the odd rates without a lower bound, and τ − ½ is {:.2e}, below {LAMBDA_EXCESS}: laminar flows may become \
                 unsteady; remove it, or use viscosity ≥ {:.3e} m²/s at the same time step",
                self.excess,
                self.scene.fluid.viscosity * LAMBDA_EXCESS / self.excess
            );
            self.warn("numerics.lambda", message);
        }
    }

    /// Time step, s, for which τ − ½ is `wanted`.
    fn step_for(&self, wanted: f64) -> f64 {
        self.units.time_step * wanted / self.excess
    }

    /// Cell, m, for which τ − ½ is `wanted` at the same Mach number.
    fn cell_for(&self, wanted: f64) -> f64 {
        self.units.cell * self.excess / wanted
    }

    fn mach(&mut self) -> Result<()> {
        let (mach, speed) = (self.units.mach(self.speed), self.speed);
        let usual = Numerics::DEFAULT_MACH;
        let remedy = format!(
            "use time_step ≤ {:.3e} s (mach = {usual})",
            self.units.time_step * usual / mach
        );
        // Tolerates rounding: a scene may set exactly 0.3.
        if mach > MOST_MACH * (1.0 + 1e-9) {
            return Err(Error::scene(
                self.step_key,
                format!(
                    "the Mach number of the lattice is {mach:.3} at {speed} m/s, above {MOST_MACH}, \
                     where the flow is compressible and unstable; {remedy}"
                ),
            ));
        }
        if mach > HIGH_MACH {
            self.warn(
                self.step_key,
                format!(
                    "the Mach number of the lattice is {mach:.3} at {speed} m/s: errors of \
                     compressibility near {:.1} %; {remedy}",
                    100.0 * mach * mach
                ),
            );
        }
        Ok(())
    }

    fn low_tau(&self) -> Result<()> {
        if self.excess >= LEAST_TAU {
            return Ok(());
        }
        // A longer step is a remedy as long as the Mach number of the lattice stays low.
        let longer =
            self.units.mach(self.speed) * LEAST_TAU <= Numerics::DEFAULT_MACH * self.excess;
        let longer = match longer && self.scene.numerics.time_step.is_some() {
            true => format!("time_step ≥ {:.3e} s, or ", self.step_for(LEAST_TAU)),
            false => String::new(),
        };
        Err(Error::scene(
            "fluid.viscosity",
            format!(
                "τ − ½ is {:.3e}, below {LEAST_TAU:e}: the viscosity drowns in rounding; use \
                 {longer}viscosity ≥ {:.3e} m²/s, or cell ≤ {:.3e} m at the same Mach number",
                self.excess,
                self.scene.fluid.viscosity * LEAST_TAU / self.excess,
                self.cell_for(LEAST_TAU)
            ),
        ))
    }

    fn suga(&self) -> Result<()> {
        let suga = self.scene.numerics.collision == Collision::Suga;
        if !suga || SUGA_EXCESS.contains(&self.excess) {
            return Ok(());
        }
        let (low, high) = (*SUGA_EXCESS.start(), *SUGA_EXCESS.end());
        let remedy = if self.excess > high {
            format!("time_step ≤ {:.3e} s", self.step_for(high))
        } else {
            format!(
                "time_step ≥ {:.3e} s, or cell ≤ {:.3e} m at the same Mach number",
                self.step_for(low),
                self.cell_for(low)
            )
        };
        Err(Error::scene(
            "numerics.collision",
            format!(
                "suga is linearly unstable at the relaxation time {:.6}: τ − ½ must lie between \
                 {low:e} and {high}; use collision = \"hermite\", or {remedy}",
                0.5 + self.excess
            ),
        ))
    }

    fn high_tau(&mut self) -> Result<()> {
        if self.excess > MOST_TAU {
            return Err(Error::scene(
                self.step_key,
                format!(
                    "the relaxation time is {:.3e}, above {MOST_TAU}, where the lattice computes no flow of this \
                     viscosity, {:e} m²/s: check it; at most use time_step ≤ {:.3e} s, and ≤ {:.3e} s to be accurate",
                    0.5 + self.excess,
                    self.scene.fluid.viscosity,
                    self.step_for(MOST_TAU - 0.5),
                    self.step_for(HIGH_TAU - 0.5)
                ),
            ));
        }
        if self.excess > HIGH_TAU - 0.5 {
            self.warn(
                self.step_key,
                format!(
                    "the relaxation time is {:.3}, above {HIGH_TAU}, where accuracy falls off; use \
                     time_step ≤ {:.3e} s",
                    0.5 + self.excess,
                    self.step_for(HIGH_TAU - 0.5)
                ),
            );
        }
        Ok(())
    }

    fn bgk(&mut self) {
        if self.scene.numerics.collision == Collision::Bgk && self.excess < LOW_BGK_TAU {
            self.warn(
                "numerics.collision",
                format!(
                    "bgk oscillates at a relaxation time of {:.5}, below {}; use collision = \
                     \"hermite\", or cell ≤ {:.3e} m at the same Mach number",
                    0.5 + self.excess,
                    0.5 + LOW_BGK_TAU,
                    self.cell_for(LOW_BGK_TAU)
                ),
            );
        }
    }

    fn cell_reynolds(&mut self) {
        let nu = self.scene.fluid.viscosity;
        let reynolds = self.speed * self.units.cell / nu;
        let modelled = self.scene.numerics.eddy_viscosity != EddyViscosity::None;
        if reynolds > HIGH_CELL_REYNOLDS && !modelled {
            self.warn(
                "domain.cell",
                format!(
                    "the Reynolds number of a cell is {reynolds:.1} at {} m/s, above \
                     {HIGH_CELL_REYNOLDS}: eddies are not resolved and the run may diverge; use \
                     cell ≤ {:.3e} m, or eddy_viscosity = \"wale\"",
                    self.speed,
                    HIGH_CELL_REYNOLDS * nu / self.speed
                ),
            );
        }
    }

    /// Warns of exact surfaces with 16-bit storage, where the wall model acts only on walls along the sides of cells.
    fn friction_of_surfaces(&mut self) {
        let scene = self.scene;
        let numerics = &scene.numerics;
        if numerics.wall_model == WallModel::None || numerics.storage == Storage::F32 {
            return;
        }
        let mut solids = scene.solids.iter();
        if let Some(index) = solids.position(|solid| solid.is_exact()) {
            self.warn(
                &format!("solids[{index}].surface"),
                "is exact, and with numerics.storage = \"f16\" the wall model does not act on surfaces that cut cells: their friction is \
                 that of the grid, whatever their roughness; use storage = \"f32\""
                    .into(),
            );
        }
    }

    /// Warns if the weight of the fluid compresses it: on the lattice its density increases with pressure.
    fn weight(&mut self) {
        let (_, gradient) = self.scene.hydrostatic();
        let size = self.scene.domain.size;
        let rise: f64 = (0..3).map(|axis| gradient[axis].abs() * size[axis]).sum();
        let compression = self.units.pressure_to_lattice(rise) - 1.0;
        if compression > HIGH_COMPRESSION {
            let step = self.units.time_step * (HIGH_COMPRESSION / compression).sqrt();
            self.warn(
                "fluid.acceleration",
                format!(
                    "the weight of the fluid makes it denser by {:.1} % from top to bottom, which no \
                     liquid does; use time_step ≤ {step:.3e} s, or, where it drives no flow and blocks \
                     alone shall feel gravity, acceleration = [0, 0, 0]: [rock] gravity includes their \
                     buoyancy",
                    100.0 * compression
                ),
            );
        }
    }

    /// Warns if the pressures of faces or of the initial state compress the fluid.
    fn pressures(&mut self) -> Result<()> {
        let scene = self.scene;
        let faces = ("boundaries", scene.face_pressures());
        let start = match scene.initial.pressure {
            InitialPressure::Given(_) => Some(("initial.pressure", scene.pressure_range()?)),
            InitialPressure::Hydrostatic => None,
        };
        for (place, [low, high]) in [faces].into_iter().chain(start) {
            let compression = self.units.pressure_to_lattice(high - low) - 1.0;
            if compression > HIGH_COMPRESSION {
                let part = (HIGH_COMPRESSION / compression).sqrt();
                let step = self.units.time_step * part;
                self.warn(
                    place,
                    format!(
                        "pressures from {low:.3e} to {high:.3e} Pa, the reference being 0, make the fluid denser by \
                         {:.1} %, which no liquid does: flows and forces are off by about half of that; use \
                         time_step ≤ {step:.3e} s{}",
                        100.0 * compression,
                        match self.units.mach(self.speed) * part {
                            mach if mach > 0.0 => format!(" (mach = {mach:.3})"),
                            _ => String::new(),
                        }
                    ),
                );
                break;
            }
        }
        Ok(())
    }
}
