//! The flow that a scene prescribes, sampled on cells and faces, in SI.

use super::{Boundary, Face, InitialPressure, Scene};
use crate::error::{Error, Result};
use crate::formula::Formula;

/// Velocity and pressure at the time 0 on all cells, x fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct InitialFields {
    /// Velocity components, m/s.
    pub velocity: [Vec<f32>; 3],
    /// Pressure above the reference pressure, Pa.
    pub pressure: Vec<f32>,
}

/// Pressure above the reference pressure at the time 0.
#[derive(Clone, Debug, PartialEq)]
pub enum StartPressure {
    /// A formula of the position, Pa.
    Given(Formula),
    /// p = zero + gradient·x.
    Linear {
        /// Pressure at the origin of the coordinates, Pa.
        zero: f64,
        /// Gradient, Pa/m.
        gradient: [f64; 3],
    },
}

impl StartPressure {
    /// Pressure at the point `x` (m), Pa.
    pub fn at(&self, x: [f64; 3]) -> f64 {
        match self {
            Self::Given(formula) => formula.eval_at(x, 0.0),
            Self::Linear { zero, gradient } => {
                zero + (0..3).map(|axis| gradient[axis] * x[axis]).sum::<f64>()
            }
        }
    }
}

/// Body force per mass.
#[derive(Clone, Debug, PartialEq)]
pub enum BodyForce {
    /// There is none.
    None,
    /// The same everywhere, m/s².
    Uniform([f64; 3]),
    /// Components on all cells, x fastest, m/s².
    Field([Vec<f32>; 3]),
}

impl Scene {
    /// Velocity and pressure at the time 0 on all cells.
    ///
    /// # Errors
    /// If a formula is not finite somewhere.
    pub fn initial_fields(&self) -> Result<InitialFields> {
        let pressure = match &self.initial.pressure {
            InitialPressure::Given(formula) => self.on_cells("initial.pressure", formula)?,
            InitialPressure::Hydrostatic => {
                let start = self.start_pressure();
                let centres = self.domain.centres();
                centres.map(|x| start.at(x) as f32).collect()
            }
        };
        Ok(InitialFields {
            velocity: self.vector_on_cells("initial.velocity", &self.initial.velocity)?,
            pressure,
        })
    }

    /// The pressure at the time 0.
    pub fn start_pressure(&self) -> StartPressure {
        match &self.initial.pressure {
            InitialPressure::Given(formula) => StartPressure::Given(formula.clone()),
            InitialPressure::Hydrostatic => {
                let (zero, gradient) = self.hydrostatic();
                StartPressure::Linear { zero, gradient }
            }
        }
    }

    /// Pressure `p = a + g·x` of the fluid at rest: `a` in Pa, `g` in Pa/m.
    ///
    /// Only a constant acceleration along an axis that is not periodic has a pressure that
    /// balances it.
    pub fn hydrostatic(&self) -> (f64, [f64; 3]) {
        let constant = self.fluid.acceleration.each_ref().map(Formula::constant);
        let [Some(ax), Some(ay), Some(az)] = constant else {
            return (0.0, [0.0; 3]);
        };
        let gradient: [f64; 3] = std::array::from_fn(|axis| {
            if *self.boundaries.face(Face::ALL[2 * axis]) == Boundary::Periodic {
                0.0
            } else {
                self.fluid.density * [ax, ay, az][axis]
            }
        });
        let end = self.domain.end();
        let mut known = 0.0;
        let mut at: [f64; 3] = std::array::from_fn(|axis| {
            if gradient[axis] < 0.0 {
                end[axis]
            } else {
                self.domain.origin[axis]
            }
        });
        for (face, boundary) in self.boundaries.iter() {
            if let Boundary::Pressure { pressure, .. } = boundary {
                known = pressure.eval(0.0, 0.0, 0.0, 0.0);
                at = self.domain.middle();
                at[face.axis().index()] = self.domain.face_position(face);
                break;
            }
        }
        let zero = known - (0..3).map(|a| gradient[a] * at[a]).sum::<f64>();
        (zero, gradient)
    }

    /// Smallest and largest pressure prescribed on faces during the run, including the reference pressure, 0, Pa. A formula is
    /// sampled at some times.
    pub(super) fn face_pressures(&self) -> [f64; 2] {
        let held = |(_, boundary): (Face, &Boundary)| match boundary {
            Boundary::Pressure { pressure, .. } => {
                let times = self.times_of(pressure.uses_time());
                let pressure = pressure.clone();
                Some(times.map(move |t| pressure.eval(0.0, 0.0, 0.0, t)))
            }
            _ => None,
        };
        range([0.0; 2], self.boundaries.iter().filter_map(held).flatten())
    }

    /// Times from 0 to the duration of the run at which a formula is sampled, s; 0 alone if it does not use the time, or if the run has a
    /// number of steps instead of a duration.
    fn times_of(&self, uses_time: bool) -> impl Iterator<Item = f64> + use<> {
        const TIMES: u32 = 100;
        let end = self.run.duration.filter(|_| uses_time);
        let last = end.map_or(0, |_| TIMES);
        (0..=last).map(move |n| end.unwrap_or(0.0) * f64::from(n) / f64::from(TIMES))
    }

    /// Pressure prescribed on `face` at the time `t` in s, Pa; `None` if the face prescribes none.
    ///
    /// # Errors
    /// If its formula is not finite at this time.
    pub fn face_pressure(&self, face: Face, t: f64) -> Result<Option<f64>> {
        let Boundary::Pressure { pressure, .. } = self.boundaries.face(face) else {
            return Ok(None);
        };
        let key = format!("boundaries.{}.pressure", face.name());
        let value = pressure.eval(0.0, 0.0, 0.0, t);
        finite(&key, pressure, value, [0.0; 3], t).map(Some)
    }

    /// Smallest and largest pressure on faces during the run and in the fluid at the time 0, Pa.
    ///
    /// # Errors
    /// If a formula is not finite somewhere.
    pub(super) fn pressure_range(&self) -> Result<[f64; 2]> {
        let faces = self.face_pressures();
        match self.start_pressure() {
            StartPressure::Given(formula) => {
                // One point is enough for a constant formula.
                let places = match formula.is_constant() {
                    true => 1,
                    false => usize::MAX,
                };
                self.domain
                    .centres()
                    .take(places)
                    .try_fold(faces, |found, x| {
                        let value = formula.eval_at(x, 0.0);
                        let value = finite("initial.pressure", &formula, value, x, 0.0)?;
                        Ok(range(found, [value]))
                    })
            }
            // A linear pressure is smallest and largest at two corners, which its gradient selects.
            start @ StartPressure::Linear { gradient, .. } => {
                let (low, high) = (self.domain.origin, self.domain.end());
                let corner = |up: bool| -> [f64; 3] {
                    std::array::from_fn(|axis| match (gradient[axis] > 0.0) == up {
                        true => high[axis],
                        false => low[axis],
                    })
                };
                Ok(range(faces, [false, true].map(|up| start.at(corner(up)))))
            }
        }
    }

    /// Velocity on `face` at the time `t` in s, at the centres of the outer cell faces, the lower of the two in-plane
    /// axes fastest, m/s. Zero if the face prescribes no velocity.
    ///
    /// # Errors
    /// If a formula is not finite somewhere.
    pub fn face_velocity(&self, face: Face, t: f64) -> Result<Vec<[f64; 3]>> {
        let points = self.domain.face_points(face);
        match self.boundaries.face(face) {
            Boundary::Velocity { velocity, .. } => {
                let key = format!("boundaries.{}.velocity", face.name());
                points.map(|x| vector_at(&key, velocity, x, t)).collect()
            }
            Boundary::Wall { velocity, .. } => Ok(points.map(|_| *velocity).collect()),
            _ => Ok(points.map(|_| [0.0; 3]).collect()),
        }
    }

    /// The body force per mass.
    ///
    /// # Errors
    /// If a formula is not finite somewhere.
    pub fn force_field(&self) -> Result<BodyForce> {
        let formulas = &self.fluid.acceleration;
        Ok(match formulas.each_ref().map(Formula::constant) {
            [Some(0.0), Some(0.0), Some(0.0)] => BodyForce::None,
            [Some(x), Some(y), Some(z)] => BodyForce::Uniform([x, y, z]),
            _ => BodyForce::Field(self.vector_on_cells("fluid.acceleration", formulas)?),
        })
    }

    /// Largest speed on the boundaries during the run, in the fluid at the time 0 and due to a bulk velocity, m/s. A formula is sampled
    /// at some times.
    ///
    /// # Errors
    /// If a formula is not finite somewhere.
    pub fn sampled_speed(&self) -> Result<f64> {
        // The maximum of a laminar flow between plates is 1.5 times its mean.
        let kept = self.fluid.kept_velocity().map(|(_, velocity)| velocity);
        let mut largest = 1.5 * kept.unwrap_or_default().abs();
        for (face, boundary) in self.boundaries.iter() {
            match boundary {
                Boundary::Wall { velocity, .. } => largest = largest.max(length(*velocity)),
                Boundary::Velocity {
                    velocity,
                    turbulence,
                    ..
                } => {
                    // Three standard deviations.
                    let eddies = turbulence.map_or(0.0, |t| 3.0 * t.intensity);
                    for t in self.times_of(velocity.iter().any(Formula::uses_time)) {
                        let velocities = self.face_velocity(face, t)?;
                        let fastest = velocities.iter().copied().map(length).fold(0.0, f64::max);
                        let mean = mean_normal_velocity(face, &velocities).abs();
                        largest = largest.max(fastest + eddies * mean);
                    }
                }
                _ => {}
            }
        }
        let velocity = &self.initial.velocity;
        if velocity.iter().all(Formula::is_constant) {
            let everywhere = vector_at("initial.velocity", velocity, self.domain.middle(), 0.0)?;
            return Ok(largest.max(length(everywhere)));
        }
        for x in self.domain.centres() {
            largest = largest.max(length(vector_at("initial.velocity", velocity, x, 0.0)?));
        }
        Ok(largest)
    }

    /// Speed from which the time step follows, m/s: `numerics.velocity_scale`, else
    /// [`Self::sampled_speed`].
    ///
    /// # Errors
    /// If the scene gives neither.
    pub fn velocity_scale(&self) -> Result<f64> {
        if let Some(speed) = self.numerics.velocity_scale {
            return Ok(speed);
        }
        let speed = self.sampled_speed()?;
        if speed > 0.0 {
            return Ok(speed);
        }
        Err(Error::scene(
            "numerics",
            "no time step follows from this scene: nothing moves on its boundaries or in its initial \
             state; give `velocity_scale` (the largest speed expected, m/s) or \
             `time_step` (s)",
        ))
    }

    fn on_cells(&self, key: &str, formula: &Formula) -> Result<Vec<f32>> {
        if let Some(value) = formula.constant() {
            finite(key, formula, value, self.domain.middle(), 0.0)?;
            return Ok(vec![value as f32; self.domain.cell_count()]);
        }
        let value = |x| finite(key, formula, formula.eval_at(x, 0.0), x, 0.0);
        self.domain
            .centres()
            .map(|x| Ok(value(x)? as f32))
            .collect()
    }

    fn vector_on_cells(&self, key: &str, formulas: &[Formula; 3]) -> Result<[Vec<f32>; 3]> {
        let [x, y, z] = formulas;
        Ok([
            self.on_cells(&format!("{key}[0]"), x)?,
            self.on_cells(&format!("{key}[1]"), y)?,
            self.on_cells(&format!("{key}[2]"), z)?,
        ])
    }
}

/// The range `known` extended to include all `values`.
fn range(known: [f64; 2], values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    values.into_iter().fold(known, |[low, high], value| {
        [low.min(value), high.max(value)]
    })
}

/// Euclidean length.
fn length(v: [f64; 3]) -> f64 {
    v.iter().map(|c| c * c).sum::<f64>().sqrt()
}

/// The mean of the normal components of the velocities on a face.
pub(super) fn mean_normal_velocity(face: Face, velocities: &[[f64; 3]]) -> f64 {
    let sum: f64 = velocities.iter().map(|u| u[face.axis().index()]).sum();
    sum / velocities.len().max(1) as f64
}

/// The vector of `formulas` at the point `x` in m and the time `t` in s.
fn vector_at(key: &str, formulas: &[Formula; 3], x: [f64; 3], t: f64) -> Result<[f64; 3]> {
    let mut vector = [0.0; 3];
    for (axis, formula) in formulas.iter().enumerate() {
        let value = formula.eval_at(x, t);
        vector[axis] = finite(&format_args!("{key}[{axis}]"), formula, value, x, t)?;
    }
    Ok(vector)
}

/// `value`, if it is finite in f32.
fn finite(
    key: &(impl std::fmt::Display + ?Sized),
    formula: &Formula,
    value: f64,
    [x, y, z]: [f64; 3],
    t: f64,
) -> Result<f64> {
    // Populations and fields are f32 on the device.
    if value.abs() <= f64::from(f32::MAX) {
        return Ok(value);
    }
    Err(Error::scene(
        key.to_string(),
        format!(
            "`{formula}` is {value:e} at ({x}, {y}, {z}) m, t = {t} s; it must be finite, at most 3e38, on the \
             whole domain: guard divisions, roots and logarithms with max(…)"
        ),
    ))
}
