//! Boxes that are none are refused by name, by every finder.

use super::finders::{Finders, on_host};
use kit::broadphase::scattered;
use riprap::rock::broadphase::{Aabb, Broadphase};

fn refused(finders: &mut Finders, spoil: impl Fn(&mut Aabb)) -> String {
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
}

#[test]
fn corners_that_are_not_finite() {
    let mut finders = Finders::new();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 2e30] {
        for axis in 0..3 {
            let name = ["along x", "along y", "along z"][axis];
            assert!(refused(&mut finders, |item| item.min[axis] = bad).contains(name));
            let message = refused(&mut finders, |item| item.max[axis] = bad);
            assert!(message.contains("finite"), "{message}");
        }
    }
}

#[test]
fn corners_the_wrong_way_round() {
    let mut finders = Finders::new();
    let message = refused(&mut finders, |item| {
        std::mem::swap(&mut item.min, &mut item.max)
    });
    assert!(message.contains("exchange the corners"), "{message}");
}
