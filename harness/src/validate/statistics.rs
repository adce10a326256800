//! Statistics over time on the device, for a signal with known statistics.

use super::{CaseContext, Outcome, record::Trial};
use kit::Random;
use riprap::{
    lattice::{Lattice, Observer, Setup, State, Statistic, Statistics},
    output::Series,
    wgpu::{self, util::DeviceExt},
};
use std::time::Instant;

/// Cells, each with a signal of its own.
const CELLS: usize = 64;
/// Samples, as many as in a long run.
const SAMPLES: usize = 300_000;
/// Samples per submission.
const BATCH: usize = 500;
/// Limit on the errors.
const LIMIT: f64 = 1e-5;
/// Mean and root mean square of density and velocity, as in turbulent water.
const SIGNAL: [(f64, f64); 4] = [(2e-3, 4e-4), (0.05, 5e-3), (0.01, 3e-3), (-0.005, 3e-3)];
/// Correlation of a sample with the previous one.
const MEMORY: f64 = 0.95;

/// Statistics of 3·10⁵ correlated samples in f32 on the device, against sums in f64.
pub fn known_signal(context: &CaseContext) -> Outcome {
    let begin = Instant::now();
    let (device, queue) = (&context.device, &context.queue);
    let mut lattice = Lattice::new(device, Setup::periodic([4, 4, 4], 0.02))?;
    lattice.start(device, queue, &State::rest(CELLS), true)?;
    let observer = Observer::new(device, &lattice)?;
    let mut statistics = Statistics::of_observer(device, &lattice, &observer)?;
    let mut random = Random(5);
    let mut fluctuations = [[0.0; CELLS]; 4];
    let mut exact = vec![Series::default(); 4 * CELLS];
    let mut products = [0.0; CELLS];
    for _ in 0..SAMPLES / BATCH {
        let mut values = Vec::with_capacity(4 * CELLS * BATCH);
        for _ in 0..BATCH {
            for (k, (mean, rms)) in SIGNAL.into_iter().enumerate() {
                for cell in 0..CELLS {
                    // Uniform numbers between −√3 and √3 have unit variance.
                    let new = 3.0_f64.sqrt() * random.between(-1.0, 1.0);
                    let kept = &mut fluctuations[k][cell];
                    *kept = MEMORY * *kept + (1.0 - MEMORY * MEMORY).sqrt() * new;
                    let value = (mean + rms * *kept) as f32;
                    exact[k * CELLS + cell].push(value.into());
                    values.push(value);
                }
            }
            let sample = &values[values.len() - 4 * CELLS..];
            for (cell, sum) in products.iter_mut().enumerate() {
                let of = |k: usize| f64::from(sample[k * CELLS + cell]) - SIGNAL[k].0;
                *sum += of(1) * of(2);
            }
        }
        let staged = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("samples"),
            contents: bytemuck::cast_slice(&values),
            usage: wgpu::BufferUsages::COPY_SRC,
        });
        let mut encoder = device.create_command_encoder(&Default::default());
        let [x, y, z] = observer.velocity();
        for sample in 0..BATCH {
            let bytes = 4 * CELLS as u64;
            for (k, buffer) in (0..).zip([observer.density(), x, y, z]) {
                let from = (4 * sample as u64 + k) * bytes;
                encoder.copy_buffer_to_buffer(&staged, from, buffer, 0, bytes);
            }
            let mut pass = encoder.begin_compute_pass(&Default::default());
            statistics.record(device, &mut lattice, &mut pass)?;
        }
        queue.submit([encoder.finish()]);
        // A read per batch keeps submissions from piling up.
        let read = statistics.read(device, queue, &lattice, Statistic::Excess, Some(&[0]));
        context.drive("statistics", read)??;
    }
    let mut read = |statistic| -> anyhow::Result<Vec<f32>> {
        let read = statistics.read(device, queue, &lattice, statistic, None);
        Ok(context.drive("statistics", read)??)
    };
    let of_velocity = [
        (Statistic::Velocity(0), Statistic::ReynoldsStress(0)),
        (Statistic::Velocity(1), Statistic::ReynoldsStress(1)),
        (Statistic::Velocity(2), Statistic::ReynoldsStress(2)),
    ];
    let (mut mean_error, mut variance_error) = (0.0_f64, 0.0_f64);
    let all = std::iter::once((Statistic::Excess, Statistic::ExcessVariance)).chain(of_velocity);
    for (k, (mean, variance)) in all.enumerate() {
        let (means, variances) = (read(mean)?, read(variance)?);
        for (cell, series) in exact[k * CELLS..][..CELLS].iter().enumerate() {
            let off = |found: f32, exact: f64| (f64::from(found) / exact - 1.0).abs();
            mean_error = mean_error.max(off(means[cell], series.mean()));
            variance_error = variance_error.max(off(variances[cell], series.variance()));
        }
    }
    let covariances = read(Statistic::ReynoldsStress(3))?;
    let mut covariance_error = 0.0_f64;
    for (cell, sum) in products.into_iter().enumerate() {
        let [u, v] = [1, 2].map(|k| &exact[k * CELLS + cell]);
        let shift = (u.mean() - SIGNAL[1].0) * (v.mean() - SIGNAL[2].0);
        let own = sum / SAMPLES as f64 - shift;
        let error = (f64::from(covariances[cell]) - own).abs() / (u.rms() * v.rms());
        covariance_error = covariance_error.max(error);
    }
    let setup = format!("{SAMPLES} samples of {CELLS} signals");
    let trial = Trial::since(begin, setup, CELLS as u64, SAMPLES as u64);
    Ok(vec![
        trial.at_most("largest relative error of a mean", mean_error, LIMIT),
        trial.at_most(
            "largest relative error of a variance",
            variance_error,
            LIMIT,
        ),
        trial.at_most(
            "largest error of a Reynolds stress over the product of the RMS",
            covariance_error,
            LIMIT,
        ),
    ])
}
