//! Bytes and operations that are counted from the code, against those that follow from the setup.

use crate::specialise::LAYOUTS;
use riprap::{
    gpu::work::Work,
    lattice::{BrickKind, Collision, Force, Setup, Storage, bytes_a_cell, collide_stream},
};

fn work(setup: &Setup, kind: BrickKind) -> Work {
    let linked = collide_stream(setup, 1, kind).link().unwrap();
    Work::of(&linked, "collide_stream").unwrap()
}

fn setup((storage, lanes, wide): (Storage, u32, bool)) -> Setup {
    let mut setup = Setup::periodic([8; 3], 0.1);
    (setup.storage, setup.lanes, setup.wide) = (storage, lanes, wide);
    setup.max_speed = 0.0;
    setup
}

#[test]
fn the_plain_step_moves_its_populations_and_nothing_else() {
    for layout in LAYOUTS {
        let setup = setup(layout);
        let found = work(&setup, BrickKind::All);
        let cells = u64::from(setup.lanes);
        assert_eq!(found.loops, 0, "{layout:?}");
        assert_eq!(found.read, found.written, "{layout:?}");
        assert_eq!(found.bytes(), cells * bytes_a_cell(&setup), "{layout:?}");
    }
}

/// The arithmetic of a cell is the same in every lane.
#[test]
fn a_cell_takes_as_many_operations_in_any_number_of_lanes() {
    for collision in [Collision::Bgk, Collision::Hermite, Collision::Suga] {
        let flops = |lanes| {
            let mut setup = setup((Storage::F32, lanes, false));
            setup.collision = collision;
            work(&setup, BrickKind::All).flops as f64 / f64::from(lanes)
        };
        // What does not depend on the cell is computed once an invocation.
        let (one, four) = (flops(1), flops(4));
        assert!(
            (one - four).abs() < 0.02 * one,
            "{collision:?}: {one}, {four}"
        );
    }
}

#[test]
fn what_a_setup_adds_costs_operations_or_bytes() {
    let plain = setup((Storage::F32, 1, false));
    let more = |change: fn(&mut Setup)| {
        let mut setup = plain.clone();
        change(&mut setup);
        let [with, without] = [&setup, &plain].map(|setup| work(setup, BrickKind::All));
        let flops = with.flops as i64 - without.flops as i64;
        [flops, with.bytes() as i64 - without.bytes() as i64]
    };
    let [flops, bytes] = more(|s| s.force = Force::Constant([1e-6, 0.0, 0.0]));
    assert!(flops > 0 && bytes == 0, "{flops} {bytes}");
    let [flops, bytes] = more(|s| s.force = Force::Field(vec![[0.0; 3]; 512]));
    // As often as the code asks for it.
    assert!(
        flops > 0 && bytes >= 12 && bytes % 12 == 0,
        "{flops} {bytes}"
    );
    // Its own velocity out, and those of six neighbours in, of which each is counted.
    let [flops, bytes] = more(|s| s.wale = Some(0.5));
    assert!(flops > 20 && bytes >= 24, "{flops} {bytes}");
    let [flops, bytes] = more(|s| s.collision = Collision::Bgk);
    assert!(flops < 0 && bytes == 0, "{flops} {bytes}");
}
