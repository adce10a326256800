//! Pressure sensors on walls in free water.

use crate::{
    rock::{Block, Motion},
    scene::{Direction, ProbePlace, Scene},
    sph::{ConvexPart, Setup, Side, is_reached},
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
    /// `blocks`: at the start.
    pub fn of(scene: &Scene, setup: &Setup, blocks: &[Block]) -> Self {
        let mut sensors = Self {
            first: vec![0],
            ..Self::default()
        };
        let fixed = blocks.iter().filter(|block| block.motion == Motion::Fixed);
        let solids: Vec<_> = fixed.flat_map(ConvexPart::of_block).collect();
        for probe in &scene.probes {
            let ProbePlace::Sensor { at, normal, .. } = &probe.place else {
                continue;
            };
            let mut patch = probe.place.patch(setup.spacing, setup.plane);
            patch.retain(|position| is_reached(setup, &solids, *position, normal.vector()));
            if patch.is_empty() {
                patch.push((*at).into());
            }
            sensors.names.push(probe.name.clone());
            let patch = patch.into_iter().map(|position| {
                let free = free_fraction(setup, &solids, position, *normal);
                (position, free)
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

/// Points of the kernel per radius in [`free_fraction`].
const POINTS: i32 = 8;
/// Least fraction: the inverse has to be finite.
const LEAST_FRACTION: f64 = 1e-3;

/// Fraction of the kernel that water in front of a wall can cover at a position: one half, reduced by other walls of the domain
/// and by fixed blocks.
fn free_fraction(
    setup: &Setup,
    solids: &[ConvexPart<'_>],
    position: DVec3,
    normal: Direction,
) -> f64 {
    let kernel = setup.kernel();
    let step = kernel.support() / f64::from(POINTS);
    let [low, high] = [position - kernel.support(), position + kernel.support()];
    let overlaps =
        |part: &&ConvexPart<'_>| part.low.cmplt(high).all() && part.high.cmpgt(low).all();
    let solids: Vec<_> = solids.iter().filter(overlaps).collect();
    let range = |axis: usize| match setup.plane && axis == 1 {
        true => vec![0.0],
        false => (-POINTS..POINTS)
            .map(|n| (f64::from(n) + 0.5) * step)
            .collect::<Vec<_>>(),
    };
    let [x, y, z] = [0, 1, 2].map(range);
    let row = |x: f64| y.iter().map(move |y| (x, *y));
    let columns = x.iter().flat_map(|x| row(*x));
    let offsets = columns.flat_map(|(x, y)| z.iter().map(move |z| DVec3::new(x, y, *z)));
    let (mut front, mut free) = (0.0, 0.0);
    for offset in offsets.filter(|offset| offset.dot(normal.vector()) > 0.0) {
        let (weight, at) = (kernel.at(offset.length()), position + offset);
        let depths = solids.iter().map(|part| part.depth(at));
        let depth = depths.fold(depth_behind_walls(setup, at), f64::max);
        front += weight;
        free += weight * (0.5 - depth / step).clamp(0.0, 1.0);
    }
    (0.5 * free / front).max(LEAST_FRACTION)
}

/// Distance of a point (m) behind the nearest wall of the domain; negative in front of it.
fn depth_behind_walls(setup: &Setup, at: DVec3) -> f64 {
    let (low, high) = (setup.origin - at, at - setup.origin - setup.size);
    let sides = (0..3).flat_map(|axis| [0, 1].map(|side| (axis, side)));
    sides
        .filter(|(axis, side)| matches!(setup.faces[*axis][*side], Side::Wall))
        .map(|(axis, side)| [low, high][side][axis])
        .fold(f64::NEG_INFINITY, f64::max)
}
