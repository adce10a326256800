//! The divergence guard reports step and cell whenever it is read and whichever bricks run.

use kit::Rig;
use riprap::lattice::{Fault, Lattice, Observer, Setup, State};

/// A box with a NaN in one population of a cell, set at step `begin`.
fn poisoned(rig: &Rig, setup: &Setup, cell: [u32; 3], begin: u64) -> Lattice {
    let count = setup.cells.iter().product::<u32>() as usize;
    let mut clean = rig.start(setup.clone(), &State::rest(count), false);
    let mut saved = rig.populations(&mut clean);
    saved.step = begin;
    let [nx, ny, _] = setup.cells;
    let at = (cell[0] + nx * (cell[1] + ny * cell[2])) as usize;
    saved.values[at] = f32::NAN;
    let mut lattice = Lattice::new(&rig.device, setup.clone()).unwrap();
    lattice
        .set_populations(&rig.device, &rig.queue, &saved)
        .unwrap();
    lattice
}

/// The fault found `steps` steps after that.
fn fault(rig: &Rig, setup: &Setup, cell: [u32; 3], begin: u64, steps: usize) -> Option<Fault> {
    let mut lattice = poisoned(rig, setup, cell, begin);
    rig.run(&mut lattice, steps);
    let mut observer = Observer::new(&rig.device, &lattice).unwrap();
    rig.wait(observer.fault(&rig.device, &rig.queue, &lattice))
        .unwrap()
}

#[test]
fn a_fault_is_known_after_its_step_and_kept_after_more() {
    let rig = Rig::new();
    let mut setup = Setup::periodic([8; 3], 0.01);
    let cell = [5, 3, 6];
    for lanes in [1, 4] {
        setup.lanes = lanes;
        for begin in [0, 3] {
            assert_eq!(fault(&rig, &setup, cell, begin, 0), None);
            for steps in [1, 2, 3, 8] {
                let found = fault(&rig, &setup, cell, begin, steps);
                assert_eq!(found, Some(Fault { step: begin, cell }), "{steps} steps");
            }
        }
    }
}

#[test]
fn steps_are_counted_where_the_first_brick_is_solid() {
    let rig = Rig::new();
    let mut setup = Setup::periodic([32, 4, 4], 0.01);
    // The first half of the box: half of its bricks of 16 × 2 × 2 are never dispatched.
    setup.solid = (0..32 * 4 * 4).map(|n| n % 32 < 16).collect();
    let cell = [24, 1, 2];
    for begin in [4, 9] {
        let found = fault(&rig, &setup, cell, begin, 3);
        assert_eq!(found, Some(Fault { step: begin, cell }));
    }
}

#[test]
fn sums_of_a_flow_that_is_no_number_have_no_largest_speed() {
    let rig = Rig::new();
    let mut setup = Setup::periodic([8; 3], 0.01);
    // Without a speed limit nothing stops the run.
    setup.max_speed = 0.0;
    let mut lattice = poisoned(&rig, &setup, [5, 3, 6], 0);
    for _ in 0..2 {
        let mut observer = Observer::new(&rig.device, &lattice).unwrap();
        let sums = rig
            .wait(observer.sums(&rig.device, &rig.queue, &mut lattice))
            .unwrap();
        assert!(sums.max_speed.is_nan(), "{sums:?}");
        rig.run(&mut lattice, 8);
    }
}
