//! What cannot be drawn is reported.

use super::fixture::{DEVICE, body, level, plain_cube, renderer, speed};
use glam::DVec3;
use riprap_harness::picture::{Plane, Trace};
use riprap_harness::render::{Camera, Drawing, Drops, FluidPlane, Line, Renderer, Traces, View};

#[test]
fn what_cannot_be_drawn_is_said() {
    let meshes = [plain_cube()];
    let colours = || speed([0.0, 1.0]).expect("colours");
    let plane = FluidPlane {
        plane: Plane {
            normal: 1,
            position: 0.0,
        },
        origin: [-1.0, -0.5],
        spacing: 0.5,
        cells: [4, 2],
        values: vec![0.0; 8],
        colours: colours(),
    };
    let good = Drawing {
        meshes: &meshes,
        instances: vec![body(DVec3::ZERO), body(DVec3::X)],
        planes: vec![plane.clone(), plane],
        traces: Some(Traces {
            lines: vec![Trace {
                points: vec![DVec3::ZERO, DVec3::X],
                speeds: vec![1.0; 2],
            }],
            colours: colours(),
        }),
        drops: Some(Drops {
            drops: vec![riprap_harness::render::Drop {
                centre: DVec3::ZERO,
                value: 0.0,
            }],
            radius: 0.1,
            colours: colours(),
        }),
        lines: vec![Line {
            ends: [DVec3::ZERO, DVec3::X],
            colour: [0; 3],
            width: 1.0,
        }],
        ..Drawing::default()
    };
    let renderer = renderer([640, 240]);
    renderer.render(&good).expect("a picture");
    type Change = fn(&mut Drawing<'_>);
    let cases: [(Change, &[&str]); 15] = [
        (
            |d| d.instances[1].centre.y = f64::NAN,
            &["instances[1]", "pose"],
        ),
        (
            |d| d.instances[0].deformation.y_axis.x = f64::INFINITY,
            &["instances[0]"],
        ),
        (
            |d| d.instances[1].value = Some(f64::NAN),
            &["instances[1]", "value"],
        ),
        (|d| d.instances[1].mesh = 7, &["mesh 7"]),
        (|d| d.colours = speed([1.0, 1.0]), &["colours.range"]),
        (
            |d| {
                let to = level().from;
                d.view = View::From(Camera { to, ..level() });
            },
            &["camera"],
        ),
        (
            |d| {
                let up = DVec3::Y;
                d.view = View::From(Camera { up, ..level() });
            },
            &["parallel"],
        ),
        (|d| d.lines[0].ends[1] = DVec3::NAN, &["lines[0]"]),
        (
            |d| d.planes[1].values.truncate(7),
            &["planes[1]", "7 values for 4 × 2"],
        ),
        (
            |d| d.planes[1].plane.normal = 3,
            &["planes[1]", "give 0 (x)"],
        ),
        (|d| d.planes[1].spacing = 0.0, &["a positive size"]),
        (|d| d.planes[1].plane.position = f64::NAN, &["not finite"]),
        (
            |d| d.planes[1].colours.range = Some([1.0; 2]),
            &["the lower first"],
        ),
        (
            |d| {
                if let Some(traces) = &mut d.traces {
                    traces.lines[0].speeds.truncate(1);
                }
            },
            &["traces", "one speed"],
        ),
        (
            |d| {
                if let Some(drops) = &mut d.drops {
                    drops.radius = 0.0;
                }
            },
            &["drops", "radius"],
        ),
    ];
    for (change, words) in cases {
        let mut drawing = good.clone();
        change(&mut drawing);
        let error = renderer.render(&drawing).expect_err("an error").to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    }
    let (device, queue) = &*DEVICE;
    for size in [[0, 10], [10, 1 << 20]] {
        let refused = Renderer::new(device, queue, size).err();
        assert!(refused.is_some_and(|error| error.to_string().contains("pixels")));
    }
}
