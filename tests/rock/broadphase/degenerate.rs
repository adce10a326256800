//! Degenerate boxes: coincident, without size, far away, huge. The list is still the brute-force list, and invalid boxes
//! are refused.

use super::{Finders, on_host};
use kit::{
    assert_contains,
    broadphase::{Random, brute_force, item, scattered},
};
use riprap::rock::broadphase::{Aabb, Broadphase};

fn agree(items: &[Aabb]) -> usize {
    let found = Finders::new().pairs(items);
    assert!(found == brute_force(items), "{} pairs", found.len());
    found.len()
}

#[test]
fn everything_in_one_place() {
    let boxes: Vec<_> = (0..307).map(|n| item([-3.0; 3], [0.5; 3], n)).collect();
    assert_eq!(agree(&boxes), 307 * 306 / 2);
    let points: Vec<_> = (0..307).map(|n| item([7.0; 3], [0.0; 3], n)).collect();
    assert_eq!(agree(&points), 307 * 306 / 2);
}

/// Boxes in cells of a single group are not compared: 10¹⁰ comparisons would be noticeable.
#[test]
fn everything_of_one_group() {
    let boxes = vec![item([-3.0; 3], [0.5; 3], 4); 100_000];
    assert_eq!(Finders::new().pairs(&boxes), [[0; 2]; 0]);
}

/// Corners on a coarse lattice: faces, edges and corners touch exactly, often on cell borders.
#[test]
fn boxes_that_just_touch_pair() {
    let mut random = Random(11);
    let boxes: Vec<_> = (0..997)
        .map(|group| {
            let min = [(); 3].map(|()| f64::from(random.bits() % 41) - 20.0);
            let edges = [(); 3].map(|()| f64::from(random.bits() % 4));
            item(min, edges, group)
        })
        .collect();
    agree(&boxes);
}

/// Neighbours in f64 that are the same number in f32.
#[test]
fn a_gap_that_f32_does_not_see_is_a_gap() {
    let gap = 1e-12;
    let boxes: Vec<_> = (0..101)
        .map(|n| item([f64::from(n) * (1.0 + gap), 0.0, 0.0], [1.0; 3], n))
        .collect();
    assert_eq!(agree(&boxes), 0);
}

/// Terrain of 10 km, gravel of 1 cm at one spot of it, and a rock of 1 m among it.
#[test]
fn gravel_on_terrain() {
    let mut random = Random(12);
    let mut boxes = vec![
        item([-5000.0, -5000.0, -100.0], [10_000.0, 10_000.0, 100.0], 0),
        item([4000.05, -3000.0, 0.0], [1.0; 3], 1),
    ];
    boxes.extend((2..1009).map(|group| {
        let at = [4000.0, -3000.0, -0.05].map(|x| x + random.between(0.0, 0.15));
        item(at, [random.between(0.005, 0.01); 3], group)
    }));
    assert!(agree(&boxes) > 1009);
}

/// One box 10³⁰ m away does not spoil the search for the others.
#[test]
fn far_away_and_next_to_nothing() {
    let mut boxes: Vec<_> = (0..211)
        .map(|n| item([f64::from(n) * 1e-20, 0.0, 0.0], [1e-20; 3], n))
        .collect();
    boxes.push(item([1e30, -1e30, 1e30], [1e20; 3], 1000));
    boxes.push(item([-1e30; 3], [2e30; 3], 1001));
    agree(&boxes);
}

/// All levels at once: each box contains all smaller ones.
#[test]
fn nested_boxes_of_all_sizes() {
    let boxes: Vec<_> = (0..191)
        .map(|n| {
            let half = 0.51 * f64::exp2(f64::from(n) - 95.0);
            item([-half; 3], [2.0 * half; 3], n as u32)
        })
        .collect();
    assert_eq!(agree(&boxes), 191 * 190 / 2);
}

/// Thin plates and needles: each cell contains many.
#[test]
fn plates_and_needles() {
    let mut random = Random(13);
    let boxes: Vec<_> = (0..997)
        .map(|group| {
            let mut edges = [1.0; 3];
            edges[random.bits() as usize % 3] = 0.001;
            edges[random.bits() as usize % 3] = 0.001;
            item([(); 3].map(|()| random.between(-4.0, 4.0)), edges, group)
        })
        .collect();
    agree(&boxes);
}

/// Every broadphase refuses invalid boxes with a message that names the box.
#[test]
fn corners_that_are_none_are_refused() {
    let mut finders = Finders::new();
    let mut refusal = |spoil: &dyn Fn(&mut Aabb)| {
        let mut messages = Vec::new();
        for count in [20, 200] {
            let mut items = scattered(count, 1.0, 4);
            spoil(&mut items[17]);
            let device = finders.rig.wait(finders.device.pairs(&items));
            messages.push(device.unwrap_err().to_string());
            messages.push(on_host(&items).unwrap_err().to_string());
        }
        assert!(messages.iter().all(|m| m.starts_with("items[17]: ")));
        messages.remove(0)
    };
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 2e30] {
        for (axis, name) in ["along x", "along y", "along z"].into_iter().enumerate() {
            assert_contains(refusal(&|item| item.min[axis] = bad), &[name]);
            assert_contains(refusal(&|item| item.max[axis] = bad), &["finite"]);
        }
    }
    let turned = refusal(&|item| std::mem::swap(&mut item.min, &mut item.max));
    assert_contains(turned, &["exchange the corners"]);
}
