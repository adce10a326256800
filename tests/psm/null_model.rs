//! Changes of a setup that must leave results bitwise equal, or equal up to rounding.

use crate::fixture::Subject;
use kit::{
    twin::Solid,
    twin::lattice::W,
    twin::of_setup::{limit, noise, walled},
};
use riprap::{
    gpu::kernel::submit_pass,
    lattice::{Force, Lattice, Observer, Setup, SolidOperator, State, Storage},
};

fn bits(subject: &mut Subject) -> Vec<u32> {
    let end = subject.rig.populations(&mut subject.lattice);
    let solid = subject.twin.domain.solid.iter().cycle();
    let cells = end.values.iter().zip(solid);
    // The content of solid cells is undefined.
    cells
        .filter(|(_, solid)| !**solid)
        .map(|(f, _)| f.to_bits())
        .collect()
}

/// Walls, WALE and a force per cell.
fn busy(storage: Storage, lanes: u32) -> Setup {
    let mut setup = walled(lanes, storage);
    setup.brick = [4, 4, 2];
    setup.wale = Some(0.5);
    setup.force = Force::Field(
        (0..6 * 5 * 7)
            .map(|n| [0, 1, 2].map(|a| 1e-3 * noise(3 * n + a) as f32))
            .collect(),
    );
    setup
}

/// The results agree up to the rounding of one step. The bits differ because compilers may fold constants only in the plain
/// kernel; in the other one the solid fraction prevents it.
#[test]
fn bricks_that_hold_no_block_give_what_the_plain_kernel_gives() {
    let mut periodic = Setup::periodic([5, 7, 4], 0.01);
    periodic.brick = [4, 4, 2];
    for plain in [periodic, busy(Storage::F32, 4), busy(Storage::F16, 2)] {
        let mut alone = Subject::new(&plain);
        alone.rig.run(&mut alone.lattice, 7);
        let expected = alone.rig.populations(&mut alone.lattice).values;
        let mut plain = plain;
        plain.solid_operator = Some(SolidOperator::Holdych);
        let mut with = Subject::new(&plain);
        let listed = with.some_bricks();
        // First no bricks listed, then some, then none again.
        for (bricks, steps) in [(&[][..], 2), (&listed[..], 3), (&[], 2)] {
            let (device, queue) = (&with.rig.device, &with.rig.queue);
            with.lattice.set_psm_bricks(device, queue, bricks).unwrap();
            with.rig.run(&mut with.lattice, steps);
        }
        let found = with.rig.populations(&mut with.lattice).values;
        let n = with.twin.domain.cell_count();
        let fluid = (0..found.len()).filter(|&k| !with.twin.domain.solid[k % n]);
        let worst = fluid
            .map(|k| f64::from((found[k] - expected[k]).abs()) / W[k / n])
            .fold(0.0, f64::max);
        println!("{:?}: {worst:e}", with.setup.storage);
        assert!(
            worst < limit(&with.setup),
            "{:?}: {worst:e}",
            with.setup.storage
        );
    }
}

#[test]
fn neither_the_order_of_bricks_nor_a_step_in_two_submissions_changes_a_bit() {
    let mut setup = busy(Storage::F32, 4);
    setup.solid_operator = Some(SolidOperator::Noble);
    let mut whole = Subject::new(&setup);
    let mut bricks = whole.some_bricks();
    whole.fill(&bricks);
    whole.rig.run(&mut whole.lattice, 5);
    let expected = bits(&mut whole);

    let mut split = Subject::new(&setup);
    bricks.sort_unstable();
    split.fill(&bricks);
    for _ in 0..5 {
        for rest in [false, true] {
            submit_pass(&split.rig.device, &split.rig.queue, |pass| match rest {
                false => split.lattice.record_psm(pass),
                true => split.lattice.record_rest(pass),
            });
        }
    }
    assert!(bits(&mut split) == expected);
}

#[test]
fn lists_of_bricks_that_cannot_be_are_refused() {
    let mut subject = Subject::new(&busy(Storage::F32, 1));
    let list = subject.some_bricks();
    let refusal = |subject: &mut Subject, bricks: &[u32]| {
        let (device, queue) = (&subject.rig.device, &subject.rig.queue);
        let refused = subject.lattice.set_psm_bricks(device, queue, bricks);
        refused.unwrap_err().to_string()
    };
    let error = refusal(&mut subject, &list);
    assert!(error.contains("solid operator"), "{error}");

    let mut setup = busy(Storage::F32, 1);
    setup.solid_operator = Some(SolidOperator::Holdych);
    let mut subject = Subject::new(&setup);
    let error = refusal(&mut subject, &[list[0], 1000]);
    assert!(error.contains("brick 1000"), "{error}");
    let error = refusal(&mut subject, &[list[0], list[1], list[0]]);
    assert!(error.contains("twice"), "{error}");
}

/// An observer that has read a state reads it again as a new one does, also after sums, which leave out the action of solids, and
/// after every change of the state.
#[test]
fn an_observer_sees_every_change_of_the_state() {
    let mut setup = Setup::periodic([8, 6, 4], 0.02);
    setup.brick = [4, 4, 2];
    setup.solid_operator = Some(SolidOperator::Holdych);
    setup.force = Force::Constant([1e-3, 0.0, 0.0]);
    let mut subject = Subject::new(&setup);
    let bricks = subject.some_bricks();
    subject.fill(&bricks);
    let (device, queue) = (subject.rig.device.clone(), subject.rig.queue.clone());
    let make = |lattice: &Lattice| Observer::new(&device, lattice).unwrap();
    let mut kept = [(); 3].map(|()| make(&subject.lattice));
    let saved = subject.rig.populations(&mut subject.lattice);
    let mut seen = Vec::new();
    for change in 0..6 {
        match change {
            0 | 1 => subject.rig.run(&mut subject.lattice, 1),
            2 => {
                let set = subject.lattice.set_force(&queue, [0.0, 2e-3, 0.0]);
                set.unwrap();
            }
            3 => {
                subject.fill_with(&bricks, |_| Solid::default());
                subject.lattice.blocks_have_moved();
            }
            4 => {
                let set = subject.lattice.set_populations(&device, &queue, &saved);
                set.unwrap();
            }
            _ => {
                let rest = State::rest(8 * 6 * 4);
                let started = subject.lattice.start(&device, &queue, &rest, true);
                started.unwrap();
            }
        }
        let (rig, lattice) = (&subject.rig, &mut subject.lattice);
        let state = |observer: &mut Observer, lattice: &mut Lattice| {
            let read = observer.state(&device, &queue, lattice);
            rig.wait(read).unwrap()
        };
        let sums = |observer: &mut Observer, lattice: &mut Lattice| {
            let read = observer.sums(&device, &queue, lattice);
            rig.wait(read).unwrap()
        };
        let expected = state(&mut make(lattice), lattice);
        let expected_sums = sums(&mut make(lattice), lattice);
        let [of_state, of_sums, of_both] = &mut kept;
        for _ in 0..2 {
            assert_eq!(state(of_state, lattice), expected, "change {change}");
            assert_eq!(sums(of_sums, lattice), expected_sums, "change {change}");
            assert_eq!(sums(of_both, lattice), expected_sums, "change {change}");
            assert_eq!(state(of_both, lattice), expected, "change {change}");
        }
        seen.push(expected);
    }
    assert!(seen.windows(2).all(|pair| pair[0] != pair[1]));
}
