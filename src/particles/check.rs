//! What particles of water can be computed with.

use super::{Body, Scheme, Setup, Solid};
use crate::{Error, Result, bodies::Pose};
use glam::DVec3;

/// Largest Courant number: water in tanks stays calm up to it, whatever its smoothing.
const MOST_COURANT: f64 = 1.4;

impl Setup {
    /// Whether water can be made of it.
    ///
    /// # Errors
    /// [`Error::Scene`] naming the first number that cannot be used.
    pub(super) fn check(&self) -> Result<()> {
        let positive = [
            ("spacing", self.spacing),
            ("smoothing", self.smoothing),
            ("sound_speed", self.sound_speed),
            ("density", self.density),
            ("courant", self.courant),
            ("size.x", self.size.x),
            ("size.y", self.size.y),
            ("size.z", self.size.z),
        ];
        for (name, value) in positive {
            if !(value > 0.0 && value.is_finite()) {
                let message = format!("is {value}; give a positive number");
                return Err(Error::scene(format!("particles.{name}"), message));
            }
        }
        if self.courant > MOST_COURANT {
            let message = format!(
                "is {}, and water may blow up beyond {MOST_COURANT}; give less, such as 0.7",
                self.courant
            );
            return Err(Error::scene("particles.courant", message));
        }
        let mueller = match self.scheme {
            Scheme::Delta => 0.0,
            Scheme::Mueller { viscosity } => viscosity,
        };
        let not_negative = [
            ("fluid.viscosity", self.laminar_viscosity),
            ("particles.scheme.viscosity", mueller),
            ("particles.artificial_viscosity", self.artificial_viscosity),
            ("particles.density_diffusion", self.density_diffusion),
        ];
        for (place, value) in not_negative {
            if !(value >= 0.0 && (value as f32).is_finite()) {
                let message = format!("is {value}; give a number from 0");
                return Err(Error::scene(place, message));
            }
        }
        if !(self.gravity.is_finite() && self.origin.is_finite()) {
            return Err(Error::scene(
                "particles",
                "gravity and origin must be finite",
            ));
        }
        if self.plane && self.gravity.y != 0.0 {
            let message =
                "gravity has a part along y, and with particles.plane nothing moves there";
            return Err(Error::scene("fluid.acceleration", message));
        }
        let mut bodies = self.bodies.iter().enumerate();
        bodies.try_for_each(|(index, body)| body.check(&format!("bodies[{index}]"), self.spacing))
    }

    /// Whether a particle (m, m/s, Pa) can be water.
    ///
    /// # Errors
    /// [`Error::Scene`] if not.
    pub(super) fn check_pressure(&self, id: usize, pressure: f64) -> Result<()> {
        let excess = self.excess(pressure) as f32;
        if excess.is_finite() && excess > -1.0 {
            return Ok(());
        }
        let least = self.pressure(-1.0);
        let message = format!(
            "particle {id} has {pressure} Pa, at which it has no density; give more than {least:.3e} Pa, the pressure of \
             nothing"
        );
        Err(Error::scene("water", message))
    }
}

impl Body {
    fn check(&self, place: &str, spacing: f64) -> Result<()> {
        let refuse = |list: &str, index: usize| {
            let message = "is not finite; give places and lengths in m";
            Err(Error::scene(format!("{place}.{list}[{index}]"), message))
        };
        let held = |x: DVec3| (x / spacing).as_vec3().is_finite();
        if let Some(bad) = self.shell.iter().position(|x| !held(*x)) {
            return refuse("shell", bad);
        }
        let finite = |solid: &Solid| match solid {
            Solid::Sphere { centre, radius } => held(*centre) && held(DVec3::X * *radius),
            Solid::Faces(faces) => {
                let mut planes = faces.bare.iter().chain(&faces.seams);
                held(faces.centre)
                    && held(DVec3::X * faces.radius)
                    && planes.all(|face| face.normal.is_finite() && held(DVec3::X * face.distance))
            }
        };
        match self.solids.iter().position(|solid| !finite(solid)) {
            Some(bad) => refuse("solids", bad),
            None => Ok(()),
        }
    }
}

/// Whether there is a pose for each of `bodies` bodies in which it can be, and a `time` (s) to go on for.
///
/// # Errors
/// [`Error::Scene`] naming the first that cannot be used.
pub(super) fn check_exchange(poses: &[Pose], bodies: usize, time: f64) -> Result<()> {
    if poses.len() != bodies {
        let message = format!("{} poses for {bodies} bodies; give one each", poses.len());
        return Err(Error::scene("poses", message));
    }
    for (body, pose) in poses.iter().enumerate() {
        let place = || format!("poses[{body}]");
        if !pose.is_finite() {
            let message = "is not finite; look at what moves this body";
            return Err(Error::scene(place(), message));
        }
        pose.check_volume(place)?;
    }
    if time > 0.0 && time.is_finite() {
        return Ok(());
    }
    let message = format!("is {time} s; give a number greater than 0");
    Err(Error::scene("time", message))
}
