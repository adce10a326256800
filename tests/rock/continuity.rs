//! What moves all blocks a little changes their way a little: nothing in a contact jumps.

use crate::fixture::{blocks, cuboid, joint, run, setup};
use glam::DVec3;
use riprap::{
    geometry::Load,
    rock::{Block, Blocks, Setup},
};

/// When the push begins, s: the stack is at rest.
const REST: f64 = 4.0;

/// A stack of three whose middle one is pushed sideways, harder than friction holds it, the upper one set
/// `aside` by so much (m).
fn pushed(aside: f64, damping: f64, which: usize) -> Blocks {
    let floor = Block::new("floor", cuboid(20.0, 20.0, 1.0), DVec3::Z * -0.5).fixed();
    let mut list = vec![floor];
    for (i, x) in [0.0, 0.02 + aside, 0.04].into_iter().enumerate() {
        let at = DVec3::new(x, 0.0, 0.5 + i as f64);
        list.push(Block::new(format!("stack {i}"), cuboid(1.0, 1.0, 1.0), at));
    }
    let mut blocks = blocks(Setup {
        damping,
        ..setup(list, joint(1e7, 30.0))
    });
    run(&mut blocks, REST);
    let mut loads = [Load::default(); 4];
    loads[which].force = DVec3::X * 6e4;
    blocks.load(&loads).expect("one load a block");
    blocks
}

/// The blocks tilt by more than ten degrees on each other, from lying on faces to standing on edges and
/// back, some faces being upright to the last bit.
#[test]
fn a_pushed_stack_forgets_what_set_it_aside() {
    const ASIDE: f64 = 1e-8;
    for (damping, which) in [(8.0, 3), (0.0, 2)] {
        let [mut one, mut two] = [0.0, ASIDE].map(|aside| pushed(aside, damping, which));
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
        // Blocks of 1 m that fall over go apart as cosh(t √(3g/2h)), 3.5 in half a second.
        assert!(apart < 3.5 * ASIDE, "{damping} 1/s, {which}: {apart} m");
    }
}
