//! Devices that are too small or full: the error names what does not fit, its size, and a remedy.

use kit::{Rig, assert_contains, gpu};
use riprap::{Error, Result, scene::Scene, wgpu};

/// 16 × 16 × 16 cells, with `blocks` added.
fn flow(blocks: &str) -> Scene {
    stored("f32", blocks)
}

/// The same flow with the given storage of the populations.
fn stored(storage: &str, blocks: &str) -> Scene {
    scene(&format!(
        r#"
        domain = {{ size = [16, 16, 16], cell = 1 }}
        fluid = {{ density = 1, viscosity = 0.02 }}
        numerics = {{ time_step = 1, velocity_scale = 0.06, storage = "{storage}" }}
        rock = {{ gravity = [0, 0, 0] }}
        run = {{ steps = 1 }}
        materials = [{{ name = "rock", density = 2.65, normal_stiffness = 1e-2, friction = 30 }}]
        {blocks}
        "#
    ))
}

const BLOCK: &str = r#"blocks = [{ kind = "box", size = [12, 12, 12], position = [8, 8, 8] }]"#;

/// 40 × 20 particles.
fn water() -> Scene {
    scene(
        r#"
        domain = { size = [2, 0.1, 1.2] }
        fluid = { acceleration = [0, 0, -9.81] }
        particles = { spacing = 0.025, plane = true }
        water = [{ kind = "box", size = [1, 0.1, 0.5], position = [0.5, 0.05, 0.25] }]
        run = { duration = 1 }
        [boundaries]
        x_min = { kind = "wall" }
        x_max = { kind = "wall" }
        z_min = { kind = "wall" }
        z_max = { kind = "open" }
        "#,
    )
}

fn scene(text: &str) -> Scene {
    kit::scene::read(text).unwrap()
}

/// A device whose buffers and bindings hold at most `bytes` bytes.
fn small(bytes: u64) -> Rig {
    Rig::with_limits(wgpu::Limits {
        max_storage_buffer_binding_size: bytes,
        max_buffer_size: bytes,
        ..Rig::new().device.limits()
    })
}

/// The result of creating a simulation of a scene on a device.
fn made(rig: &Rig, scene: &Scene) -> Result<()> {
    rig.simulation(scene).map(|_| ())
}

#[test]
fn a_fluid_that_a_binding_does_not_hold_is_refused_with_its_bytes() {
    // A direction of 4096 cells takes 16 384 bytes. An output kernel has four bindings in addition to the populations.
    let bindings = Rig::new()
        .device
        .limits()
        .max_storage_buffers_per_shader_stage
        - 4;
    let least = 16_384 * u64::from(27_u32.div_ceil(bindings));
    let rig = small(least - 4);
    let (wants, has) = (least.to_string(), (least - 4).to_string());
    assert_contains(
        made(&rig, &flow("")).unwrap_err(),
        &["populations", &wants, &has, "larger cell"],
    );
    assert!(made(&small(least), &flow("")).is_ok());
}

#[test]
fn blocks_that_a_binding_does_not_hold_are_refused_with_their_bytes() {
    // The populations of 4096 cells in 16 bits fill three bindings of 80 000 bytes, and five more leave one of eight for the
    // nine numbers of each cell that the block reaches, 12³ at least.
    let rig = Rig::with_limits(wgpu::Limits {
        max_storage_buffers_per_shader_stage: 8,
        ..small(80_000).device.limits()
    });
    assert!(made(&rig, &stored("f16", "")).is_ok());
    // The cells are only known when the blocks are placed.
    let moved = rig
        .simulation(&stored("f16", BLOCK))
        .and_then(|mut made| rig.wait(made.advance(1)));
    assert_contains(
        moved.unwrap_err(),
        &[
            "cells that blocks reach",
            "80000",
            "fewer or smaller blocks",
        ],
    );
}

#[test]
fn water_that_a_buffer_does_not_hold_is_refused_with_its_bytes() {
    // 800 particles of water alone take 12 800 bytes of velocities.
    let rig = small(8_192);
    assert_contains(
        made(&rig, &water()).unwrap_err(),
        &["8192", "larger spacing"],
    );
    assert!(made(&Rig::new(), &water()).is_ok());
}

/// A device on which every allocation fails: wgpu compares its size with a fraction of the free memory that the driver
/// reports, here none. There is no such device with drivers that do not report free memory.
fn full() -> Option<Rig> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        memory_budget_thresholds: wgpu::MemoryBudgetThresholds {
            for_resource_creation: Some(0),
            for_device_loss: None,
        },
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let usual = gpu::selected().unwrap();
    let (name, backend) = (usual.get_info().name, usual.get_info().backend);
    let all = pollster::block_on(instance.enumerate_adapters(backend.into()));
    let adapter = all.into_iter().find(|a| a.get_info().name == name)?;
    let (device, queue) = gpu::open(&adapter, wgpu::Features::empty(), adapter.limits()).ok()?;
    let scope = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let _ = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 1 << 20,
        usage: wgpu::BufferUsages::STORAGE,
        mapped_at_creation: false,
    });
    let refused = pollster::block_on(scope.pop());
    refused.is_some().then_some(Rig { device, queue })
}

#[test]
fn a_device_without_memory_says_what_it_does_not_hold() {
    let Some(rig) = full() else {
        eprintln!("this driver does not say how much memory is free: not tested");
        return;
    };
    assert_contains(
        made(&rig, &flow("")).unwrap_err(),
        &["4096 cells", "larger cell"],
    );
    assert_contains(
        made(&rig, &flow(BLOCK)).unwrap_err(),
        &["4096 cells", "larger cell"],
    );
    assert_contains(
        made(&rig, &water()).unwrap_err(),
        &["800 particles", "larger spacing"],
    );
    // No pending error remains that could appear later.
    assert!(matches!(made(&rig, &water()), Err(Error::Device(_))));
}
