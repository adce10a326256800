//! A pushed stack of three blocks: sleeping blocks behave as if they had been awake, and a small displacement changes
//! the motion only a little, since contacts are continuous.

use crate::fixture::{blocks, cuboid, joint, run, setup};
use glam::DVec3;
use riprap::{
    geometry::Load,
    rock::{Block, Blocks, Setup, Sleep},
};

/// Start of the push, s: the stack is at rest then.
const REST: f64 = 4.0;

/// A stack of three next to a single block, the middle block of the stack displaced by `aside` (m).
fn stack(aside: f64) -> Setup {
    let floor = Block::new("floor", cuboid(20.0, 20.0, 1.0), DVec3::Z * -0.5).fixed();
    let mut list = vec![floor];
    for (i, x) in [0.0, 0.02 + aside, 0.04].into_iter().enumerate() {
        let at = DVec3::new(x, 0.0, 0.5 + i as f64);
        list.push(Block::new(format!("stack {i}"), cuboid(1.0, 1.0, 1.0), at));
    }
    let at = DVec3::new(5.0, 0.0, 0.5);
    list.push(Block::new("alone", cuboid(1.0, 1.0, 1.0), at));
    Setup {
        damping: 8.0,
        ..setup(list, joint(1e7, 30.0))
    }
}

/// Pushes a block sideways, with more than the limit of friction.
fn push(blocks: &mut Blocks, block: usize) {
    let mut loads = [Load::default(); 5];
    loads[block].force = DVec3::X * 6e4;
    blocks.set_loads(&loads).expect("one load a block");
}

#[test]
fn pushed_blocks_wake_and_go_where_they_would_have_gone() {
    let run_with = |sleep: Option<Sleep>| {
        let mut blocks = blocks(Setup {
            sleep,
            ..stack(0.0)
        });
        run(&mut blocks, REST);
        let asleep = blocks.asleep().filter(|&a| a).count();
        let calls = blocks.counts().pairs;
        run(&mut blocks, REST + 0.1);
        let idle = blocks.counts().pairs - calls;
        push(&mut blocks, 2);
        run(&mut blocks, REST + 0.5);
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
        // Sleep speed over the rate at which the speed decayed, 1e-7 m/s / 3 s⁻¹, before the top block
        // falls: after that the motion is no longer continuous.
        let error = a.centre.distance(b.centre);
        assert!(error < 1e-7, "{error} m");
    }
    let moved = awake[2].centre.x - stack(0.0).blocks[2].centre.x;
    assert!(moved > 0.1, "{moved} m");
}

/// The blocks tilt by more than five degrees relative to each other, from lying on faces to standing on edges and
/// back, some faces being upright to the last bit.
#[test]
fn a_pushed_stack_forgets_what_set_it_aside() {
    const ASIDE: f64 = 1e-8;
    for (damping, block) in [(8.0, 3), (0.0, 2)] {
        let [mut one, mut two] = [0.0, ASIDE].map(|aside| {
            let mut blocks = blocks(Setup {
                damping,
                ..stack(aside)
            });
            run(&mut blocks, REST);
            push(&mut blocks, block);
            blocks
        });
        let (mut apart, mut tilt) = (0.0f64, 0.0f64);
        for step in 1..=25 {
            let until = REST + 0.02 * f64::from(step);
            run(&mut one, until);
            run(&mut two, until);
            let both = one.poses().into_iter().zip(two.poses());
            apart = both.fold(apart, |most, (a, b)| most.max(a.centre.distance(b.centre)));
            let up = |i: usize| one.rotation(i) * DVec3::Z;
            tilt = (1..3).fold(tilt, |most, i| most.max(up(i).angle_between(up(i + 1))));
        }
        assert!(tilt > 5f64.to_radians(), "{}°", tilt.to_degrees());
        // The distance between toppling blocks of 1 m grows as cosh(t √(3g/2h)), 3.5 in half a second.
        assert!(apart < 3.5 * ASIDE, "{damping} 1/s, {block}: {apart} m");
    }
}
