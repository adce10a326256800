//! Pressure sensors on walls beside free water.

use crate::{
    particles::{Setup, Side},
    scene::{ProbePlace, Scene},
};
use glam::DVec3;

/// What a sensor has felt.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reading {
    /// Mean pressure on its patch over the last time step, Pa.
    pub pressure: f64,
    /// Integral of that over time since the start, Pa s.
    pub impulse: f64,
}

/// The sensors of a scene.
#[derive(Debug, Default)]
pub(super) struct Sensors {
    names: Vec<String>,
    /// Places that ask for pressures, those of a sensor one after the other, m, each with the share of the kernel that
    /// water in front of it covers.
    places: Vec<(DVec3, f64)>,
    /// Before those of each sensor, and all.
    first: Vec<usize>,
    pub readings: Vec<Reading>,
    /// Since the beginning of the step: impulse of each, Pa s, and time, s.
    step: (Vec<f64>, f64),
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
            let patch = lattice(DVec3::from(*at), normal, size, count, setup.plane);
            let [low, high] = [scene.domain.origin, scene.domain.end()].map(DVec3::from);
            sensors.names.push(probe.name.clone());
            let patch = patch.into_iter().map(|place| {
                let place = place.clamp(low, high);
                (place, covered(setup, place, normal))
            });
            sensors.places.extend(patch);
            sensors.first.push(sensors.places.len());
        }
        sensors.readings = vec![Reading::default(); sensors.names.len()];
        sensors.begin();
        sensors
    }

    pub fn places(&self) -> &[(DVec3, f64)] {
        &self.places
    }

    /// A step begins.
    pub fn begin(&mut self) {
        self.step = (vec![0.0; self.names.len()], 0.0);
    }

    /// Mean pressures (Pa) at the places over an exchange of `time` (s).
    pub fn feel(&mut self, pressures: &[f64], time: f64) {
        let (impulses, elapsed) = &mut self.step;
        *elapsed += time;
        for (n, reading) in self.readings.iter_mut().enumerate() {
            let own = &pressures[self.first[n]..self.first[n + 1]];
            let impulse = own.iter().sum::<f64>() / own.len() as f64 * time;
            reading.impulse += impulse;
            impulses[n] += impulse;
            reading.pressure = impulses[n] / *elapsed;
        }
    }

    pub fn reading(&self, name: &str) -> Option<Reading> {
        let number = self.names.iter().position(|own| own == name)?;
        Some(self.readings[number])
    }
}

/// Share of the kernel around a place on a wall with that normal that water covers: half of it, and less beside the walls
/// of the domain, each taken for itself.
fn covered(setup: &Setup, place: DVec3, normal: usize) -> f64 {
    let low = place - setup.origin;
    let high = setup.origin + setup.size - place;
    let others = (0..3).filter(|&axis| axis != normal && !(setup.plane && axis == 1));
    let free = |axis: usize| {
        let ends = setup.faces[axis].iter().zip([low[axis], high[axis]]);
        let behind = ends.filter(|(side, _)| matches!(side, Side::Wall));
        let lost =
            behind.map(|(_, far)| beyond(far / (setup.smoothing * setup.spacing), setup.plane));
        1.0 - lost.sum::<f64>()
    };
    0.5 * others.map(free).product::<f64>()
}

/// Share of the kernel, Wendland's C2, beyond a plane at the distance `far` from its centre, in h: of a shell of radius q
/// the cap (1 − far/q)/2, in a `plane` of a circle the arc.
fn beyond(far: f64, plane: bool) -> f64 {
    const RINGS: u32 = 256;
    let rings = (0..RINGS).map(|n| (f64::from(n) + 0.5) * 2.0 / f64::from(RINGS));
    let (mut whole, mut part) = (0.0, 0.0);
    for q in rings {
        let w = (1.0 - 0.5 * q).powi(4) * (2.0 * q + 1.0);
        let (ring, cap) = match plane {
            true => (w * q, (far / q).min(1.0).acos() / std::f64::consts::PI),
            false => (w * q * q, 0.5 * (1.0 - far / q).max(0.0)),
        };
        whole += ring;
        part += ring * cap;
    }
    part / whole
}

/// Centres of the `count` × `count` squares of a patch; in a `plane` of x and z nothing varies along y.
fn lattice(middle: DVec3, normal: usize, size: f64, count: f64, plane: bool) -> Vec<DVec3> {
    let along = |axis: usize| -> Vec<DVec3> {
        let alone = plane && axis == 1;
        let count = if alone { 1 } else { count as u32 };
        let offset = |n: u32| ((f64::from(n) + 0.5) / f64::from(count) - 0.5) * size;
        (0..count).map(|n| DVec3::AXES[axis] * offset(n)).collect()
    };
    let [first, second] = [1, 2].map(|n| along((normal + n) % 3));
    let row = |a: &DVec3| second.iter().map(|b| middle + *a + *b).collect::<Vec<_>>();
    first.iter().flat_map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::{beyond, lattice};
    use glam::DVec3;

    #[test]
    fn half_of_the_kernel_is_beyond_its_centre_and_none_beyond_its_end() {
        for plane in [false, true] {
            assert!((beyond(0.0, plane) - 0.5).abs() < 1e-12);
            assert_eq!(beyond(2.0, plane), 0.0);
            assert!((0.01..0.2).contains(&beyond(0.6, plane)));
        }
    }

    #[test]
    fn a_patch_has_its_centre_and_its_squares() {
        let middle = DVec3::new(1.0, 2.0, 3.0);
        for (normal, plane, count) in [(0, false, 9), (1, false, 9), (0, true, 3), (2, true, 3)] {
            let places = lattice(middle, normal, 0.3, 3.0, plane);
            assert_eq!(places.len(), count);
            let mean = places.iter().sum::<DVec3>() / count as f64;
            assert!((mean - middle).length() < 1e-12, "{mean}");
            for place in places {
                assert_eq!(place[normal], middle[normal]);
                assert!((place - middle).abs().max_element() < 0.1 + 1e-12);
            }
        }
    }
}
