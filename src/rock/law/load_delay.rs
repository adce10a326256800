//! Correction of the delay of a fluid's loads in the film between two faces.
//!
//! A fluid that is advanced alternately with its blocks returns the loads of a step at its end. Water in a joint is stiff:
//! a gap that closes by dh raises its pressure by ρ c² dh/H, H being the thickness of the water that is compressed. A
//! spring k whose force lags by t_d has a part in the direction of the motion, F = −k x(t − t_d) ≈ −k x + k t_d dx/dt,
//! and the blocks on its sides oscillate with a growth rate of k t_d/2m, about as fast as the waves in it for blocks a
//! few cells thick. The damping k t_d cancels this. It is correct only while the pressure follows the gap; if water
//! leaves a gap as fast as it closes, the pressure is constant and its delay has no effect. The damping therefore acts
//! on the velocity less a mean over the last steps.

use crate::{
    Result,
    rock::{
        check::positive,
        contact::{GapShape, ThinGap},
    },
};

/// The delay of the loads of a fluid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadDelay {
    /// Missing pressure over the velocity at which a gap closes, Pa s/m: ρ c² t_d/H.
    pub impedance: f64,
    /// Gap above which no correction is needed, m. From half of it on the correction decreases.
    pub range: f64,
    /// Time over which velocities are averaged, s.
    pub memory: f64,
}

impl LoadDelay {
    /// Checks the numbers.
    ///
    /// # Errors
    /// [`crate::Error::Argument`] naming the number and its range.
    pub fn check(&self) -> Result<()> {
        positive("film.delay.impedance", self.impedance, "Pa s/m")?;
        positive("film.delay.range", self.range, "m")?;
        positive("film.delay.memory", self.memory, "s")
    }

    /// Normal force over the closing velocity of the gap, N s/m, and moment over its tilt rate about each axis, N m s; zero
    /// if one side is a sphere.
    pub fn resistance(&self, thin_gap: &ThinGap) -> (f64, [f64; 2]) {
        let GapShape::Flat {
            area,
            moments,
            flatness,
            ..
        } = &thin_gap.shape
        else {
            return (0.0, [0.0; 2]);
        };
        let share = (2.0 - 2.0 * thin_gap.gap / self.range).clamp(0.0, 1.0);
        let pressure = self.impedance * flatness * share;
        (pressure * area, moments.map(|moment| pressure * moment))
    }
}
