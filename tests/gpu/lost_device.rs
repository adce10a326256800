//! A device that is lost during a run: the error reports the loss, and an earlier state can be continued.

use kit::{Rig, assert_contains};
use riprap::{
    Error, Result,
    scene::Scene,
    simulation::{Simulation, checkpoint::Checkpoint},
};
use std::time::Duration;

const FLOW: &str = r#"
domain = { size = [12, 8, 8], cell = 1 }
fluid = { density = 1, viscosity = 0.02 }
numerics = { time_step = 1, velocity_scale = 0.06 }
rock = { gravity = [0, 0, 0] }
run = { steps = 1 }
initial = { velocity = [0.05, 0, 0] }
materials = [{ name = "rock", density = 2.65, normal_stiffness = 1e-2, friction = 30 }]
blocks = [{ kind = "box", size = [3, 3, 3], position = [6, 4, 4] }]
"#;

const WATER: &str = r#"
domain = { size = [1, 0.1, 0.6] }
fluid = { acceleration = [0, 0, -9.81] }
particles = { spacing = 0.05, plane = true }
water = [{ kind = "box", size = [0.4, 0.1, 0.4], position = [0.2, 0.05, 0.2] }]
run = { duration = 1 }
[boundaries]
x_min = { kind = "wall" }
x_max = { kind = "wall" }
z_min = { kind = "wall" }
z_max = { kind = "open" }
"#;

fn scene(text: &str) -> Scene {
    kit::scene::read(text).unwrap()
}

/// Asserts the message of a lost device.
fn lost<T: std::fmt::Debug>(found: Result<T>) {
    let error = found.unwrap_err();
    assert!(matches!(error, Error::DeviceLost(_)), "{error}");
    let text = error.to_string();
    assert_contains(&text, &["device lost", "checkpoint"]);
}

/// Like [`Rig::wait`], but waiting itself may fail.
fn wait<T>(rig: &Rig, future: impl Future<Output = Result<T>>) -> Result<T> {
    let patience = std::time::Duration::from_secs(60);
    kit::gpu::drive(&rig.device, patience, "a test", future)?
}

#[test]
fn a_flow_with_blocks_says_that_its_device_is_lost() {
    let rig = Rig::new();
    let scene = scene(FLOW);
    let mut flow = rig.simulation(&scene).unwrap();
    rig.wait(flow.advance(7)).unwrap();
    let saved: Checkpoint = rig.wait(flow.checkpoint()).unwrap();
    rig.wait(flow.advance(3)).unwrap();
    let expected = rig.wait(flow.checkpoint()).unwrap();
    rig.device.destroy();
    lost(wait(&rig, flow.advance(5)));
    lost(wait(&rig, flow.totals()));
    lost(wait(&rig, flow.checkpoint()));
    // On another device.
    let rig = Rig::new();
    let mut flow = rig.simulation(&scene).unwrap();
    flow.restore(&saved).unwrap();
    rig.wait(flow.advance(3)).unwrap();
    assert!(rig.wait(flow.checkpoint()).unwrap() == expected);
}

#[test]
fn free_water_says_that_its_device_is_lost() {
    let rig = Rig::new();
    let scene = scene(WATER);
    let mut water = rig.simulation(&scene).unwrap();
    rig.wait(water.advance(2)).unwrap();
    rig.device.destroy();
    lost(wait(&rig, water.advance(2)));
    lost(wait(&rig, water.checkpoint()));
}

#[test]
fn a_scene_is_not_set_up_on_a_device_that_is_lost() {
    let rig = Rig::new();
    rig.device.destroy();
    let made = wait(&rig, Simulation::new(&rig.device, &rig.queue, &scene(FLOW)));
    assert!(made.is_err());
    let made = wait(
        &rig,
        Simulation::new(&rig.device, &rig.queue, &scene(WATER)),
    );
    assert!(made.is_err());
}

/// A buffer that is mapped by both methods of waiting, and a future that never completes.
#[test]
fn both_ways_of_waiting_end() {
    let rig = Rig::new();
    let (device, queue) = (&rig.device, &rig.queue);
    let buffer = device.create_buffer(&riprap::wgpu::BufferDescriptor {
        label: None,
        size: 16,
        usage: riprap::wgpu::BufferUsages::COPY_DST | riprap::wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    queue.write_buffer(&buffer, 0, &[7; 16]);
    for looks in [true, false] {
        let mut readback = riprap::gpu::readback::Readback::default();
        let read = readback.read::<u8>(device, queue, &buffer, 16);
        let patience = Duration::from_secs(60);
        let bytes = kit::gpu::drive_by(device, looks, patience, "a buffer", read).unwrap();
        assert_eq!(bytes.unwrap(), [7; 16]);
        let never = std::future::pending::<()>();
        let patience = Duration::from_millis(50);
        let silent = kit::gpu::drive_by(device, looks, patience, "nothing", never);
        assert!(matches!(silent, Err(Error::Timeout { .. })));
    }
}
