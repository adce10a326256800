//! GPU timestamps of compute passes.

use riprap::{
    gpu::timer::{self, Phases, Timer, begin_pass},
    lattice::{Lattice, Setup, State},
    wgpu,
};
use std::time::Duration;

/// A device with timestamps, if the adapter has them.
fn timed() -> Option<(wgpu::Device, wgpu::Queue)> {
    let adapter = kit::gpu::selected().unwrap();
    let wanted = wgpu::Features::TIMESTAMP_QUERY;
    adapter
        .features()
        .contains(wanted)
        .then(|| kit::gpu::open(&adapter, wanted, adapter.limits()).unwrap())
}

#[test]
fn every_timed_pass_takes_a_positive_time() {
    let Some((device, queue)) = timed() else {
        return;
    };
    let setup = Setup::periodic([32; 3], 0.01);
    let mut lattice = Lattice::new(&device, setup).unwrap();
    let state = State::rest(32 * 32 * 32);
    lattice.start(&device, &queue, &state, true).unwrap();
    let mut timer = Timer::new(&device, &queue, 2).unwrap();
    for _round in 0..2 {
        let mut encoder = device.create_command_encoder(&Default::default());
        for label in ["first", "second", "beyond the capacity"] {
            let mut pass = encoder.begin_compute_pass(&timer.pass(label));
            for _ in 0..4 {
                lattice.record(&mut pass);
            }
        }
        timer.resolve(&mut encoder);
        queue.submit([encoder.finish()]);
        let read = timer.read(&device, &queue);
        let times = kit::gpu::drive(&device, Duration::from_secs(60), "the timer", read)
            .unwrap()
            .unwrap();
        let labels: Vec<_> = times.iter().map(|(label, _)| label.as_str()).collect();
        assert_eq!(labels, ["first", "second"]);
        // Four steps of 32768 cells move 28 MB: between 1 µs (28 TB/s) and a minute.
        assert!(
            times.iter().all(|&(_, t)| t > 1e-6 && t < 60.0),
            "{times:?}"
        );
    }
}

#[test]
fn without_the_feature_there_is_no_timer() {
    let rig = kit::Rig::new();
    assert!(Timer::new(&rig.device, &rig.queue, 1).is_none());
    assert!(timer::pass(None, "plain").timestamp_writes.is_none());
}

/// A phase with several passes per round counts each of them.
#[test]
fn phases_add_up_the_times_of_their_passes() {
    let Some((device, queue)) = timed() else {
        return;
    };
    let setup = Setup::periodic([16; 3], 0.01);
    let mut lattice = Lattice::new(&device, setup).unwrap();
    let mut phases = Some(Phases::new(&device, &queue));
    for _round in 0..2 {
        let mut encoder = device.create_command_encoder(&Default::default());
        for name in ["bulk", "bulk", "reduce"] {
            lattice.record(&mut begin_pass(&mut phases, &mut encoder, name));
        }
        let phases = phases.as_mut().unwrap();
        phases.resolve(&mut encoder);
        queue.submit([encoder.finish()]);
        let collect = phases.collect(&device, &queue);
        kit::gpu::drive(&device, Duration::from_secs(60), "the phases", collect)
            .unwrap()
            .unwrap();
    }
    let phases = phases.unwrap();
    let [bulk, reduce] = phases.times() else {
        panic!("{phases:?}");
    };
    assert_eq!((bulk.name.as_str(), bulk.count), ("bulk", 4));
    assert_eq!((reduce.name.as_str(), reduce.count), ("reduce", 2));
    assert!(bulk.seconds > 0.0 && reduce.seconds > 0.0, "{phases:?}");
}
