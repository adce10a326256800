//! Blocks that sleep do what they would have done awake.

use crate::fixture::{blocks, cuboid, joint, run, setup};
use glam::DVec3;
use riprap::{
    geometry::Load,
    rock::{Block, Setup, Sleep},
};

/// A stack of three beside a block on its own.
fn scene() -> Setup {
    let floor = Block::new("floor", cuboid(20.0, 20.0, 1.0), DVec3::Z * -0.5).fixed();
    let mut list = vec![floor];
    for i in 0..3 {
        let at = DVec3::new(0.02 * f64::from(i), 0.0, 0.5 + f64::from(i));
        list.push(Block::new(format!("stack {i}"), cuboid(1.0, 1.0, 1.0), at));
    }
    list.push(Block::new(
        "alone",
        cuboid(1.0, 1.0, 1.0),
        DVec3::new(5.0, 0.0, 0.5),
    ));
    Setup {
        damping: 8.0,
        ..setup(list, joint(1e7, 30.0))
    }
}

#[test]
fn pushed_blocks_wake_and_go_where_they_would_have_gone() {
    let (rest, push, end) = (4.0, 4.1, 4.5);
    let run_with = |sleep: Option<Sleep>| {
        let mut blocks = blocks(Setup { sleep, ..scene() });
        run(&mut blocks, rest);
        let asleep = blocks.asleep().filter(|&a| a).count();
        let calls = blocks.counts().pairs;
        run(&mut blocks, push);
        let idle = blocks.counts().pairs - calls;
        let mut loads = [Load::default(); 5];
        // The middle of the stack, harder than friction with both neighbours holds.
        loads[2].force = DVec3::X * 6e4;
        blocks.load(&loads).expect("one load a block");
        run(&mut blocks, end);
        let still = blocks.asleep().filter(|&a| a).count();
        (blocks.poses(), asleep, idle, still)
    };
    let (awake, none, calls, _) = run_with(None);
    let (slept, all, no_calls, one) = run_with(Some(Sleep {
        speed: 1e-7,
        ..Sleep::default()
    }));
    assert_eq!((none, all), (0, 4));
    assert!(calls > 100, "{calls}");
    assert_eq!(no_calls, 0, "nothing is computed while all sleep");
    assert_eq!(one, 1, "the block on its own sleeps on");
    for (a, b) in awake.iter().zip(&slept) {
        // Speed at which they slept over the rate at which it fell, 1e-7 m/s / 3 s⁻¹, before the top one
        // falls: then nothing is continuous any more.
        let error = a.centre.distance(b.centre);
        assert!(error < 1e-7, "{error} m");
    }
    let moved = awake[2].centre.x - scene().blocks[2].centre.x;
    assert!(moved > 0.1, "{moved} m");
}
