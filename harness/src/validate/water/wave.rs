//! A standing wave of small amplitude: ω² = g k tanh kH.

use crate::validate::{
    CaseContext, Outcome, Trial,
    tank::{self, GRAVITY},
};
use glam::DVec3;
use kit::clock::{Spent, Stopwatch};
use riprap::{
    geometry::Pose,
    scene::{
        Scheme,
        build::{block_setup, particle_setup},
    },
    sph::{NeighbourSearch, SphSolver},
};
use std::{f64::consts::PI, time::Instant};

const DEPTH: f64 = 1.0;
/// Lengths of the tank, which is half a wave long, m.
pub const LENGTHS: [f64; 2] = [2.0, 1.0];
/// Amplitude of the surface over the depth.
const STEEPNESS: f64 = 0.02;
/// Readings per period.
const LOOKS: f64 = 40.0;
const PERIODS: f64 = 4.0;

/// Velocity under the wave at the moment when the surface is flat, for an amplitude of 1 m, m/s.
fn flow(x: DVec3, k: f64, omega: f64) -> DVec3 {
    let scale = omega / (k * DEPTH).sinh();
    let [across, along] = [(k * x.z).sinh(), (k * x.z).cosh()];
    DVec3::new(
        scale * along * (k * x.x).sin(),
        0.0,
        -scale * across * (k * x.x).cos(),
    )
}

/// Period and damping of the first mode of a tank.
pub fn run(context: &CaseContext) -> Outcome {
    let layers: &[u32] = if context.full { &[25, 50] } else { &[25] };
    let mut records = Vec::new();
    for (layers, length) in layers
        .iter()
        .flat_map(|n| LENGTHS.map(|length| (*n, length)))
    {
        let found = measure(context, layers, length, Scheme::Delta)?;
        let trial = found.trial;
        let name = |what: &str| format!("{what}, H/Δx = {layers}");
        records.push(trial.relative(name("period / exact"), found.period, 1.0, 0.01));
        records.push(trial.at_most(name("amplitude lost a period"), found.loss, 0.05));
    }
    Ok(records)
}

/// Result for a standing wave.
pub struct Wave {
    /// Setup and cost of the run.
    pub trial: Trial,
    /// Period over the exact one.
    pub period: f64,
    /// Part of the amplitude that is lost in a period.
    pub loss: f64,
}

/// Runs a tank `layers` spacings deep and `length` (m) long.
pub fn measure(
    context: &CaseContext,
    layers: u32,
    length: f64,
    scheme: Scheme,
) -> anyhow::Result<Wave> {
    let k = PI / length;
    let omega = (GRAVITY * k * (k * DEPTH).tanh()).sqrt();
    let period = 2.0 * PI / omega;
    let spacing = DEPTH / f64::from(layers);
    let mut scene = tank::pool([length, 1.4 * DEPTH], spacing, [length, DEPTH], "")?;
    tank::choose(&mut scene, scheme);
    let blocks = block_setup(&scene)?;
    let (mut setup, start) = particle_setup(&scene, &blocks)?;
    if context.software {
        setup.neighbours = NeighbourSearch::Lists;
    }
    let amplitude = STEEPNESS * DEPTH;
    let velocities: Vec<DVec3> = start
        .positions
        .iter()
        .map(|x| amplitude * flow(*x, k, omega))
        .collect();
    let (device, queue) = (&context.device, &context.queue);
    let positions = &start.positions;
    let mut water = SphSolver::new(
        device,
        queue,
        setup,
        positions,
        &velocities,
        &start.pressures,
    )?;
    let poses: Vec<Pose> = blocks
        .setup
        .blocks
        .iter()
        .map(|b| Pose::at_rest(b.centre, b.rotation))
        .collect();
    let begin = Instant::now();
    let mut stepping = Spent::default();
    // Share of the wave's flow in the velocities, over time.
    let mut shares = vec![1.0];
    let (mut steps, mut timed) = (0, 0);
    for look in 0..(PERIODS * LOOKS) as usize {
        let watch = Stopwatch::start();
        let done = water.advance(device, queue, &poses, period / LOOKS);
        context.drive("a wave", done)??;
        let now = context.drive("reading particles", water.water(device, queue))??;
        // Drivers compile during the first part.
        if look > 0 {
            stepping += watch.spent();
            timed += water.steps() - steps;
        }
        steps = water.steps();
        let (mut with, mut of) = (0.0, 0.0);
        for n in 0..now.len() {
            let mode = flow(now.positions[n], k, omega);
            with += now.velocities[n].as_dvec3().dot(mode);
            of += mode.length_squared();
        }
        shares.push(with / of / amplitude);
    }
    let trial = Trial {
        setup: format!("standing wave, kH = {:.2}, H/Δx = {layers}", k * DEPTH),
        cells: water.counts().fluid.into(),
        steps,
        seconds: begin.elapsed().as_secs_f64(),
        stepping: stepping.scaled(steps as f64 / timed.max(1) as f64),
    };
    let crossings = crossings(&shares);
    anyhow::ensure!(
        crossings.len() > 2,
        "there is no wave: the velocity changes its sign {} times in {PERIODS} periods",
        crossings.len()
    );
    let (first, last) = (crossings[0], crossings[crossings.len() - 1]);
    let found = 2.0 * (last - first) / (crossings.len() - 1) as f64 / LOOKS;
    // Peaks half a period apart, from the first whole one.
    let peak = |from: f64, to: f64| {
        let some = &shares[from as usize..=(to as usize).min(shares.len() - 1)];
        some.iter()
            .fold(0.0, |most: f64, share| most.max(share.abs()))
    };
    let early = peak(first, crossings[1]);
    let late = peak(crossings[crossings.len() - 2], last);
    let periods = 0.5 * (crossings.len() - 2) as f64;
    Ok(Wave {
        trial,
        period: found,
        loss: 1.0 - (late / early).powf(1.0 / periods),
    })
}

/// Zero crossings of a sequence, interpolated between its values.
fn crossings(values: &[f64]) -> Vec<f64> {
    let pairs = values.windows(2).enumerate();
    pairs
        .filter(|(_, pair)| pair[0] * pair[1] < 0.0)
        .map(|(n, pair)| n as f64 + pair[0] / (pair[0] - pair[1]))
        .collect()
}
