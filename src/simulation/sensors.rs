//! Pressure sensors on walls in free water.

use crate::{
    scene::{ProbePlace, Scene},
    sph::{Setup, Side},
};
use glam::DVec3;

/// Measurement of a sensor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct Reading {
    /// Mean pressure on its patch over the last time step, Pa.
    pub pressure: f64,
    /// Time integral of the mean pressure since the start, Pa s.
    pub impulse: f64,
}

/// The sensors of a scene.
#[derive(Debug, Default)]
pub(super) struct Sensors {
    names: Vec<String>,
    /// Probe positions (m) by sensor, each with the fraction of the kernel that water in front of the wall can cover.
    probes: Vec<(DVec3, f64)>,
    /// Index of the first probe of each sensor, and the number of probes as the last entry.
    first: Vec<usize>,
    pub readings: Vec<Reading>,
    /// Impulse of each sensor since the beginning of the step, Pa s.
    step_impulses: Vec<f64>,
    /// Time since the beginning of the step, s.
    step_time: f64,
}

impl Sensors {
    pub fn of(scene: &Scene, setup: &Setup) -> Self {
        let mut sensors = Self {
            first: vec![0],
            ..Self::default()
        };
        for probe in &scene.probes {
            let ProbePlace::Sensor { at, normal, size } = &probe.place else {
                continue;
            };
            let size = size.unwrap_or(setup.spacing);
            let count = (size / setup.spacing).ceil().max(1.0);
            let normal = normal.axis().index();
            let patch = patch_centres(DVec3::from(*at), normal, size, count, setup.plane);
            let [low, high] = [scene.domain.origin, scene.domain.end()].map(DVec3::from);
            sensors.names.push(probe.name.clone());
            let patch = patch.into_iter().map(|position| {
                let position = position.clamp(low, high);
                (position, free_fraction(setup, position, normal))
            });
            sensors.probes.extend(patch);
            sensors.first.push(sensors.probes.len());
        }
        sensors.readings = vec![Reading::default(); sensors.names.len()];
        sensors.begin();
        sensors
    }

    pub fn probes(&self) -> &[(DVec3, f64)] {
        &self.probes
    }

    /// Begins a step.
    pub fn begin(&mut self) {
        self.step_impulses = vec![0.0; self.names.len()];
        self.step_time = 0.0;
    }

    /// Records the mean pressures (Pa) at the probes over an exchange of `time` (s).
    pub fn record(&mut self, pressures: &[f64], time: f64) {
        self.step_time += time;
        for (n, reading) in self.readings.iter_mut().enumerate() {
            let own = &pressures[self.first[n]..self.first[n + 1]];
            let impulse = own.iter().sum::<f64>() / own.len() as f64 * time;
            reading.impulse += impulse;
            self.step_impulses[n] += impulse;
            reading.pressure = self.step_impulses[n] / self.step_time;
        }
    }

    pub fn reading(&self, name: &str) -> Option<Reading> {
        let number = self.names.iter().position(|own| own == name)?;
        Some(self.readings[number])
    }
}

/// Fraction of the kernel that water can cover around a position on a wall with the axis `normal`: one half, reduced near
/// other walls of the domain, each of which counts separately.
fn free_fraction(setup: &Setup, position: DVec3, normal: usize) -> f64 {
    let low = position - setup.origin;
    let high = setup.origin + setup.size - position;
    let others = (0..3).filter(|&axis| axis != normal && !(setup.plane && axis == 1));
    let free = |axis: usize| {
        let ends = setup.faces[axis].iter().zip([low[axis], high[axis]]);
        let behind = ends.filter(|(side, _)| matches!(side, Side::Wall));
        let lost = behind.map(|(_, distance)| {
            fraction_beyond(distance / (setup.smoothing * setup.spacing), setup.plane)
        });
        1.0 - lost.sum::<f64>()
    };
    0.5 * others.map(free).product::<f64>()
}

/// Fraction of Wendland's C2 kernel beyond a plane at the `distance` from its centre, in h: the cap (1 − distance/q)/2 of a
/// sphere of radius q, in a `plane` the arc of a circle.
fn fraction_beyond(distance: f64, plane: bool) -> f64 {
    const RINGS: u32 = 256;
    let rings = (0..RINGS).map(|n| (f64::from(n) + 0.5) * 2.0 / f64::from(RINGS));
    let (mut whole, mut part) = (0.0, 0.0);
    for q in rings {
        let w = (1.0 - 0.5 * q).powi(4) * (2.0 * q + 1.0);
        let (ring, cap) = if plane {
            (w * q, (distance / q).min(1.0).acos() / std::f64::consts::PI)
        } else {
            (w * q * q, 0.5 * (1.0 - distance / q).max(0.0))
        };
        whole += ring;
        part += ring * cap;
    }
    part / whole
}

/// Centres of the `count` × `count` squares of a square patch; a planar patch has one square along y.
fn patch_centres(middle: DVec3, normal: usize, size: f64, count: f64, plane: bool) -> Vec<DVec3> {
    let along = |axis: usize| -> Vec<DVec3> {
        let is_planar_axis = plane && axis == 1;
        let count = if is_planar_axis { 1 } else { count as u32 };
        let offset = |n: u32| ((f64::from(n) + 0.5) / f64::from(count) - 0.5) * size;
        (0..count).map(|n| DVec3::AXES[axis] * offset(n)).collect()
    };
    let [first, second] = [1, 2].map(|n| along((normal + n) % 3));
    let row = |a: &DVec3| second.iter().map(|b| middle + *a + *b).collect::<Vec<_>>();
    first.iter().flat_map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::{fraction_beyond, patch_centres};
    use glam::DVec3;

    #[test]
    fn half_of_the_kernel_is_beyond_its_centre_and_none_beyond_its_end() {
        for plane in [false, true] {
            assert!((fraction_beyond(0.0, plane) - 0.5).abs() < 1e-12);
            assert_eq!(fraction_beyond(2.0, plane), 0.0);
            assert!((0.01..0.2).contains(&fraction_beyond(0.6, plane)));
        }
    }

    #[test]
    fn a_patch_has_its_centre_and_its_squares() {
        let middle = DVec3::new(1.0, 2.0, 3.0);
        for (normal, plane, count) in [(0, false, 9), (1, false, 9), (0, true, 3), (2, true, 3)] {
            let centres = patch_centres(middle, normal, 0.3, 3.0, plane);
            assert_eq!(centres.len(), count);
            let mean = centres.iter().sum::<DVec3>() / count as f64;
            assert!((mean - middle).length() < 1e-12, "{mean}");
            for centre in centres {
                assert_eq!(centre[normal], middle[normal]);
                assert!((centre - middle).abs().max_element() < 0.1 + 1e-12);
            }
        }
    }
}
