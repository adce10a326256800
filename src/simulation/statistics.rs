//! Time statistics of the fields of a fluid on a lattice.

use super::lattice_fluid::LatticeFluid;
use crate::{
    Error, Result,
    gpu::kernel::submit_pass,
    lattice::{Lattice, Observer, Statistic, Statistics, StatisticsState},
    scene::{Field, Scene},
};

/// Field statistics and their sampling schedule.
#[derive(Debug)]
pub(super) struct Sampling {
    first: u64,
    stride: u64,
    statistics: Statistics,
}

/// State of the field statistics between two steps, and their sampling schedule.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct SamplingState {
    /// First step that may be a sample.
    pub first: u64,
    /// Steps from one sample to the next.
    pub stride: u64,
    /// The samples so far.
    pub statistics: StatisticsState,
}

impl Sampling {
    /// The statistics that the scene outputs; `None` if it outputs none.
    ///
    /// # Errors
    /// If the device cannot hold them.
    pub fn new(
        device: &wgpu::Device,
        (scene, time_step): (&Scene, f64),
        lattice: &mut Lattice,
        observer: &Observer,
    ) -> Result<Option<Self>> {
        let Some(requested) = scene
            .statistics
            .as_ref()
            .filter(|_| scene.shows_statistics())
        else {
            return Ok(None);
        };
        Ok(Some(Self {
            first: requested.first_step(time_step).max(1),
            stride: requested.stride(time_step),
            statistics: match Statistics::new(device, lattice) {
                // The device has too few bindings for the sums in the kernels of a step.
                Err(Error::Limit { .. }) => Statistics::of_observer(device, lattice, observer)?,
                statistics => statistics?,
            },
        }))
    }

    /// Whether the state after `step` is a sample, which the next step or the observer of the fluid adds.
    fn due(&self, step: u64, by_observer: bool) -> bool {
        let since = step.checked_sub(self.first);
        since.is_some_and(|since| since.is_multiple_of(self.stride))
            && self.statistics.is_of_observer() == by_observer
    }

    pub fn check(&self, lattice: &Lattice, state: &SamplingState) -> Result<()> {
        self.statistics.check(lattice, &state.statistics)
    }

    /// Continues from a state with the same sampling schedule; with another one the statistics start anew.
    pub fn restore(
        &mut self,
        queue: &wgpu::Queue,
        lattice: &mut Lattice,
        state: Option<&SamplingState>,
    ) -> Result<()> {
        let same =
            |state: &&SamplingState| [state.first, state.stride] == [self.first, self.stride];
        let none = StatisticsState::default();
        let state = state.filter(same).map_or(&none, |state| &state.statistics);
        self.statistics.restore(queue, lattice, state)
    }
}

impl LatticeFluid {
    /// Whether the present state is a sample that the observer adds.
    pub(super) fn observed_sample_due(&self) -> bool {
        let sampling = self.sampling.as_ref();
        sampling.is_some_and(|sampling| sampling.due(self.lattice.step(), true))
    }

    /// Adds the present state to the statistics if it is a sample that the observer adds.
    pub(super) fn sample_observed(&mut self) -> Result<()> {
        if !self.observed_sample_due() {
            return Ok(());
        }
        let (device, queue) = (self.device.clone(), self.queue.clone());
        submit_pass(&device, &queue, |pass| {
            self.observer.record(&mut self.lattice, pass)?;
            self.record_sample(pass)
        })
    }

    /// Makes the coming step add the state before it to the statistics if that is a sample.
    pub(super) fn sample_in_step(&mut self, encoder: &mut wgpu::CommandEncoder) -> Result<()> {
        let step = self.lattice.step();
        let sampling = self.sampling.as_ref();
        if sampling.is_some_and(|sampling| sampling.due(step, false)) {
            self.record_sample(&mut encoder.begin_compute_pass(&Default::default()))?;
        }
        Ok(())
    }

    fn record_sample(&mut self, pass: &mut wgpu::ComputePass<'_>) -> Result<()> {
        let Some(sampling) = &mut self.sampling else {
            return Ok(());
        };
        let statistics = &mut sampling.statistics;
        statistics.record(&self.device, &mut self.lattice, pass)
    }

    pub(super) async fn sampling_state(&mut self) -> Result<Option<SamplingState>> {
        let Some(sampling) = &mut self.sampling else {
            return Ok(None);
        };
        Ok(Some(SamplingState {
            first: sampling.first,
            stride: sampling.stride,
            statistics: sampling
                .statistics
                .state(&self.device, &self.queue, &self.lattice)
                .await?,
        }))
    }

    /// Number of samples so far.
    pub(super) fn samples(&self) -> u64 {
        self.sampling
            .as_ref()
            .map_or(0, |sampling| sampling.statistics.samples())
    }

    /// Bytes of the statistics on the device.
    pub(super) fn statistics_bytes(&self) -> u64 {
        let sampling = self.sampling.as_ref();
        sampling.map_or(0, |sampling| sampling.statistics.bytes())
    }

    /// A statistical field on the given cells or on all, component by component, SI; empty for any other field.
    pub(super) async fn statistic(
        &mut self,
        field: Field,
        cells: Option<&[u32]>,
    ) -> Result<Vec<Vec<f32>>> {
        let units = self.units;
        let speed = units.velocity_from_lattice(1.0);
        // p is linear in ρ − 1.
        let pressure = units.pressure_from_lattice(2.0);
        let stress = (0..6).map(Statistic::ReynoldsStress);
        let (components, scale): (Vec<Statistic>, f64) = match field {
            Field::MeanVelocity => ((0..3).map(Statistic::Velocity).collect(), speed),
            Field::MeanPressure => (vec![Statistic::Excess], pressure),
            Field::PressureRms => (vec![Statistic::ExcessVariance], pressure * pressure),
            Field::ReynoldsStress => (stress.collect(), speed * speed),
            Field::TurbulentKineticEnergy => (stress.take(3).collect(), speed * speed),
            _ => return Ok(Vec::new()),
        };
        let Some(sampling) = &mut self.sampling else {
            return Ok(Vec::new());
        };
        let mut values = Vec::with_capacity(components.len());
        for component in components {
            let mut read = sampling
                .statistics
                .read(&self.device, &self.queue, &self.lattice, component, cells)
                .await?;
            read.iter_mut()
                .for_each(|value| *value = (f64::from(*value) * scale) as f32);
            values.push(read);
        }
        if field == Field::PressureRms {
            let variances = values.iter_mut().flatten();
            variances.for_each(|variance| *variance = variance.max(0.0).sqrt());
        }
        if field == Field::TurbulentKineticEnergy {
            let [xx, yy, zz] = [0, 1, 2].map(|k| std::mem::take(&mut values[k]));
            let traces = xx
                .iter()
                .zip(&yy)
                .zip(&zz)
                .map(|((x, y), z)| 0.5 * (x + y + z));
            values = vec![traces.collect()];
        }
        Ok(values)
    }
}
