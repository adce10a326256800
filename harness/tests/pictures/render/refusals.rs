//! What cannot be drawn is said.

use super::fixture::{DEVICE, body, level, plain_cube, refusal, speed};
use glam::DVec3;
use riprap_harness::render::{Camera, Drawing, Line, Renderer, View};

#[test]
fn what_cannot_be_drawn_is_said() {
    let meshes = [plain_cube()];
    let good = Drawing {
        meshes: &meshes,
        instances: vec![body(DVec3::ZERO), body(DVec3::X)],
        ..Drawing::default()
    };
    let with = |change: &dyn Fn(&mut Drawing<'_>)| {
        let mut drawing = good.clone();
        change(&mut drawing);
        refusal(&drawing)
    };
    let pose = with(&|d| d.instances[1].centre.y = f64::NAN);
    assert!(
        pose.contains("instances[1]") && pose.contains("pose"),
        "{pose}"
    );
    let turn = with(&|d| d.instances[0].deformation.y_axis.x = f64::INFINITY);
    assert!(turn.contains("instances[0]"), "{turn}");
    let value = with(&|d| d.instances[1].value = Some(f64::NAN));
    assert!(
        value.contains("instances[1]") && value.contains("value"),
        "{value}"
    );
    let mesh = with(&|d| d.instances[1].mesh = 7);
    assert!(mesh.contains("mesh 7"), "{mesh}");
    let range = with(&|d| d.colours = speed([1.0, 1.0]));
    assert!(range.contains("colours.range"), "{range}");
    let camera = with(&|d| {
        d.view = View::From(Camera {
            to: level().from,
            ..level()
        });
    });
    assert!(camera.contains("camera"), "{camera}");
    let up = with(&|d| {
        d.view = View::From(Camera {
            up: DVec3::Y,
            ..level()
        });
    });
    assert!(up.contains("parallel"), "{up}");
    let line = with(&|d| {
        d.lines = vec![Line {
            ends: [DVec3::ZERO, DVec3::NAN],
            colour: [0; 3],
            width: 1.0,
        }];
    });
    assert!(line.contains("lines[0]"), "{line}");
    let (device, queue) = &*DEVICE;
    for size in [[0, 10], [10, 1 << 20]] {
        let refused = Renderer::new(device, queue, size).err();
        assert!(refused.is_some_and(|error| error.to_string().contains("pixels")));
    }
}
