//! Statistics over time, compared with sums in f64.

use kit::{Random, Rig, twin::statistics::moments};
use riprap::{
    gpu::kernel::submit_pass,
    lattice::{
        Face, Force, Grid, Lattice, Observer, Setup, State, Statistic, Statistics, StatisticsState,
        Storage, SurfaceCell,
    },
    wgpu,
};

/// The sampled signal: the buffers of an observer, filled by the test.
struct Signal {
    rig: Rig,
    lattice: Lattice,
    observer: Observer,
    cells: usize,
}

impl Signal {
    fn new(cells: [u32; 3], limits: Option<wgpu::Limits>) -> Self {
        let rig = limits.map_or_else(Rig::new, Rig::with_limits);
        let count = cells.iter().product::<u32>() as usize;
        let lattice = rig.start(Setup::periodic(cells, 0.02), &State::rest(count), true);
        let observer = Observer::new(&rig.device, &lattice).unwrap();
        Self {
            rig,
            lattice,
            observer,
            cells: count,
        }
    }

    fn statistics(&self) -> Statistics {
        Statistics::of_observer(&self.rig.device, &self.lattice, &self.observer).unwrap()
    }

    /// Adds a sample of each cell.
    fn add(&mut self, statistics: &mut Statistics, sample: &[[f32; 4]]) {
        let [x, y, z] = self.observer.velocity();
        for (k, buffer) in [self.observer.density(), x, y, z].into_iter().enumerate() {
            let values: Vec<f32> = sample.iter().map(|values| values[k]).collect();
            let bytes = bytemuck::cast_slice(&values);
            self.rig.queue.write_buffer(buffer, 0, bytes);
        }
        let (device, queue) = (&self.rig.device, &self.rig.queue);
        let recorded = submit_pass(device, queue, |pass| {
            statistics.record(device, &mut self.lattice, pass)
        });
        recorded.unwrap();
    }

    fn read(&self, statistics: &mut Statistics, of: Statistic, on: Option<&[u32]>) -> Vec<f32> {
        let (device, queue) = (&self.rig.device, &self.rig.queue);
        let read = statistics.read(device, queue, &self.lattice, of, on);
        self.rig.wait(read).unwrap()
    }

    fn state(&self, statistics: &mut Statistics) -> StatisticsState {
        let state = statistics.state(&self.rig.device, &self.rig.queue, &self.lattice);
        self.rig.wait(state).unwrap()
    }
}

const ALL: [Statistic; 11] = [
    Statistic::Excess,
    Statistic::Velocity(0),
    Statistic::Velocity(1),
    Statistic::Velocity(2),
    Statistic::ExcessVariance,
    Statistic::ReynoldsStress(0),
    Statistic::ReynoldsStress(1),
    Statistic::ReynoldsStress(2),
    Statistic::ReynoldsStress(3),
    Statistic::ReynoldsStress(4),
    Statistic::ReynoldsStress(5),
];

/// Correlated fluctuations around means that are ten times as large.
fn sample(random: &mut Random, cells: usize) -> Vec<[f32; 4]> {
    let mut one = || {
        let [a, b, c, d] = [(); 4].map(|()| random.between(-1.0, 1.0));
        let values = [
            1e-3 + 1e-4 * a,
            0.05 + 5e-3 * (b + 0.3 * a),
            2e-3 * (c + b),
            0.01 + 1e-3 * (d - c),
        ];
        values.map(|value| value as f32)
    };
    (0..cells).map(|_| one()).collect()
}

#[test]
fn means_and_covariances_are_those_of_all_samples() {
    // Odd sizes, one cell; before, at and after the end of a sampling block; one buffer and several.
    let small = {
        let all = kit::gpu::selected().unwrap().limits();
        let grid = Grid::new(&Setup::periodic([7, 5, 3], 0.02)).unwrap();
        let plane = 4 * u64::from(grid.scalar_count());
        wgpu::Limits {
            max_storage_buffer_binding_size: 4 * plane,
            ..all
        }
    };
    for (cells, limits) in [
        ([7, 5, 3], None),
        ([1, 1, 1], None),
        ([7, 5, 3], Some(small)),
    ] {
        let mut signal = Signal::new(cells, limits);
        let mut statistics = signal.statistics();
        let first = signal.read(&mut statistics, Statistic::Excess, None);
        assert!(
            first.iter().all(|value| value.is_nan()),
            "before any sample"
        );
        let mut random = Random(7);
        let mut samples = Vec::new();
        for count in 1..=600 {
            let sample = sample(&mut random, signal.cells);
            signal.add(&mut statistics, &sample);
            samples.push(sample);
            if ![1, 2, 255, 256, 257, 600].contains(&count) {
                continue;
            }
            assert_eq!(statistics.samples(), count);
            let found = ALL.map(|of| signal.read(&mut statistics, of, None));
            for cell in 0..signal.cells {
                let own: Vec<[f32; 4]> = samples.iter().map(|sample| sample[cell]).collect();
                let (mean, product) = moments(&own);
                for k in 0..4 {
                    let error = (f64::from(found[k][cell]) - mean[k]).abs();
                    let scale = mean[k].abs() + product[k].sqrt();
                    assert!(
                        error < 2e-6 * scale,
                        "{cells:?} {count} {k}: {error} of {scale}"
                    );
                }
                // Errors of stresses relative to the scale of their components.
                let scale = |k: usize| match k {
                    0..=3 => product[k],
                    _ => (product[k - 3] * product[k % 3 + 1]).sqrt(),
                };
                for k in 0..7 {
                    let error = (f64::from(found[4 + k][cell]) - product[k]).abs();
                    assert!(
                        error <= 1e-5 * scale(k),
                        "{cells:?} {count} {k}: {error} of {}",
                        product[k]
                    );
                }
            }
            let some: Vec<u32> = (0..signal.cells as u32).rev().step_by(2).collect();
            let listed = signal.read(&mut statistics, ALL[6], Some(&some));
            let expected: Vec<f32> = some.iter().map(|cell| found[6][*cell as usize]).collect();
            assert_eq!(listed, expected);
        }
    }
}

/// A stream between walls, driven by a force, with a solid cell and some that are filled in part, in all layouts; sums in one
/// binding and in several.
#[test]
fn samples_that_steps_add_are_those_of_an_observer() {
    let all = Rig::new();
    let can_be_wide = all.device.features().contains(wgpu::Features::SHADER_INT64);
    let cells = [6, 7, 4];
    let count = cells.iter().product::<u32>() as usize;
    for (storage, lanes, wide, wale) in [
        (Storage::F32, 1, false, Some(1)),
        (Storage::F16, 2, false, None),
        (Storage::F32, 4, false, Some(2)),
        (Storage::F32, 4, true, Some(2)),
        (Storage::F16, 4, true, None),
    ] {
        if wide && !can_be_wide {
            continue;
        }
        let mut setup = Setup::periodic(cells, 0.02);
        (setup.storage, setup.lanes, setup.wide) = (storage, lanes, wide);
        setup.faces[1] = [Face::Wall([0.0; 3]), Face::Wall([0.05, 0.0, 0.0])];
        setup.force = Force::Constant([1e-4, 0.0, 2e-5]);
        if let Some(interval) = wale {
            (setup.wale, setup.wale_interval) = (Some(0.4), interval);
        }
        setup.solid = (0..count).map(|n| n == 100).collect();
        setup.surface = vec![SurfaceCell {
            cell: 63,
            fraction: 0.4,
        }];
        let plane = 4 * u64::from(Grid::new(&setup).unwrap().scalar_count());
        let few = wgpu::Limits {
            max_storage_buffer_binding_size: 5 * plane,
            ..all.device.limits()
        };
        let spread = all.device.limits().max_storage_buffers_per_shader_stage >= 32;
        for limits in std::iter::once(None).chain(spread.then_some(Some(few))) {
            let rig = limits.map_or_else(Rig::new, Rig::with_limits);
            let mut lattice = rig.start(setup.clone(), &State::rest(count), true);
            let mut observer = Observer::new(&rig.device, &lattice).unwrap();
            let mut observed = Statistics::of_observer(&rig.device, &lattice, &observer).unwrap();
            let mut summed = Statistics::new(&rig.device, &mut lattice).unwrap();
            assert!(Statistics::new(&rig.device, &mut lattice).is_err(), "twice");
            // Over the end of a block in one of them.
            let samples = if lanes == 1 { 300 } else { 20 };
            for sample in 1..=samples {
                submit_pass(&rig.device, &rig.queue, |pass| {
                    observer.record(&mut lattice, pass).unwrap();
                    for statistics in [&mut observed, &mut summed] {
                        let recorded = statistics.record(&rig.device, &mut lattice, pass);
                        recorded.unwrap();
                    }
                });
                assert_eq!(summed.samples(), sample);
                let early = summed.state(&rig.device, &rig.queue, &lattice);
                assert!(rig.wait(early).is_err(), "before the step");
                rig.run(&mut lattice, 1 + 2 * (sample as usize % 2));
                if sample != 7 && sample != samples {
                    continue;
                }
                let found = ALL.map(|of| {
                    [&mut observed, &mut summed].map(|statistics| {
                        let read = statistics.read(&rig.device, &rig.queue, &lattice, of, None);
                        rig.wait(read).unwrap()
                    })
                });
                let most = found.each_ref().map(|[one, _]| {
                    let sizes = one.iter().map(|value| value.abs());
                    sizes.fold(0.0, f32::max)
                });
                // After few samples: the two sum the 27 populations of a cell, whose scale is the speed of the wall, in different
                // orders.
                let rounding = 27.0_f32.sqrt() * f32::EPSILON * 0.05;
                for (k, [one, other]) in found.iter().enumerate() {
                    let fluctuation = match k {
                        0..4 => 0.5,
                        4 => most[4].sqrt(),
                        _ => most[5..8].iter().fold(0.0, |a: f32, b| a.max(*b)).sqrt(),
                    };
                    let bound = match sample {
                        7 => 1e-6 * most[k] + 2.0 * rounding * fluctuation,
                        // The rounding of sums of so many samples.
                        _ => 1e-5 * most[k],
                    };
                    assert!(most[k] > 0.0, "{:?}", ALL[k]);
                    for (one, other) in one.iter().zip(other) {
                        assert!(
                            (one - other).abs() <= bound,
                            "{storage:?} {lanes} {wide} {sample} {:?}: {one} {other}",
                            ALL[k]
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn a_restored_state_goes_on_with_the_same_bits() {
    let mut signal = Signal::new([3, 4, 5], None);
    let cells = signal.cells;
    let mut random = Random(3);
    let mut whole = signal.statistics();
    for cut in [0, 3, 300] {
        while whole.samples() < cut {
            let sample = sample(&mut random, cells);
            signal.add(&mut whole, &sample);
        }
        let state = signal.state(&mut whole);
        let mut fresh = signal.statistics();
        fresh
            .restore(&signal.rig.queue, &mut signal.lattice, &state)
            .unwrap();
        assert_eq!(signal.state(&mut fresh), state);
        let next = sample(&mut random, cells);
        signal.add(&mut whole, &next);
        signal.add(&mut fresh, &next);
        let [one, other] = [&mut whole, &mut fresh].map(|of| signal.state(of));
        assert_eq!(one, other, "cut at {cut}");
    }
    let mut state = signal.state(&mut whole);
    state.values.pop();
    let restored = whole.restore(&signal.rig.queue, &mut signal.lattice, &state);
    assert!(restored.is_err());
    let bad = whole.read(
        &signal.rig.device,
        &signal.rig.queue,
        &signal.lattice,
        Statistic::Velocity(3),
        None,
    );
    assert!(signal.rig.wait(bad).is_err());
}
