//! Links a custom kernel with files of riprap and runs it on custom buffers.
//!
//! For many cells it computes the populations of an equilibrium from density and velocity; a slot selects the equilibrium.
//! The sums of the populations must reproduce density and momentum; otherwise the program fails.
//!
//! `cargo run -p riprap-harness --example own_kernel`

use anyhow::{Result, ensure};
use riprap::{
    gpu::{kernel::Kernel, link::Program, readback::Readback},
    wgpu::{self, util::DeviceExt},
};
use riprap_harness::gpu;
use std::time::Duration;

const CELLS: usize = 1000;

/// After `needs`, a plain name is a file of riprap, and a name with a dollar sign a slot.
const FILL: &str = "// Populations f - w of each cell, from its velocity (xyz) and density (w).
// needs $lanes, moments, velocity, $equilibrium

@group(0) @binding(0) var<storage, read> states: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> populations: array<f32>;

@compute @workgroup_size(64)
fn fill(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x >= arrayLength(&states)) {
        return;
    }
    let state = states[id.x];
    var h = equilibrium(state.w, vec3_of(state.x, state.y, state.z));
    h[0u] = state.w - 1.0;
    from_moments(&h);
    for (var k = 0u; k < 27u; k++) { // unroll
        populations[27u * id.x + k] = h[k];
    }
}
";

fn main() -> Result<()> {
    let adapter = gpu::pick(None)?;
    let limits = wgpu::Limits::downlevel_defaults();
    let (device, queue) = gpu::open(&adapter, wgpu::Features::empty(), limits)?;
    let states: Vec<[f32; 4]> = (0..CELLS)
        .map(|n| [0.0, 1.0, 2.0, 3.0].map(|a| 0.1 * (n as f32 + a).sin()))
        .map(|[x, y, z, excess]| [x, y, z, 1.0 + excess])
        .collect();
    let input = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: Some("states"),
        contents: bytemuck::cast_slice(&states),
        usage: wgpu::BufferUsages::STORAGE,
    });
    let output = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("populations"),
        size: (27 * 4 * CELLS) as u64,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    for equilibrium in ["equilibrium_product", "equilibrium_second_order"] {
        let linked = Program::new("fill")
            .text("fill", FILL)
            .slot("lanes", "lanes_1")
            .slot("equilibrium", equilibrium)
            .link()?;
        let kernel = Kernel::new(&device, &linked, "fill", &[])?;
        let bind = kernel.bind(&device, &[("states", &input), ("populations", &output)])?;
        let mut encoder = device.create_command_encoder(&Default::default());
        kernel.record(
            &mut encoder.begin_compute_pass(&Default::default()),
            &bind,
            CELLS.div_ceil(64) as u32,
        );
        queue.submit([encoder.finish()]);
        let mut readback = Readback::default();
        let read = readback.read::<f32>(&device, &queue, &output, 27 * CELLS);
        let populations = gpu::drive(&device, Duration::from_secs(60), "the kernel", read)??;
        let worst = states
            .iter()
            .zip(populations.chunks(27))
            .map(|(state, f)| error(*state, f))
            .fold(0.0, f64::max);
        println!("{equilibrium}: density and momentum to {worst:.1e}");
        // 27 populations below 0.3, each with a rounding error of 2^-24 of itself in a few operations.
        ensure!(worst < 1e-6, "density or momentum is not that of the state");
    }
    Ok(())
}

/// Largest difference between the sums of the populations and density and momentum.
fn error([x, y, z, rho]: [f32; 4], f: &[f32]) -> f64 {
    let mut sums = [0.0; 4];
    for (k, f) in f.iter().enumerate() {
        let c = [k % 3, k / 3 % 3, k / 9].map(|at| at as f64 - 1.0);
        for (sum, factor) in sums.iter_mut().zip([c[0], c[1], c[2], 1.0]) {
            *sum += factor * f64::from(*f);
        }
    }
    let rho = f64::from(rho);
    let momentum = [x, y, z].map(|u| rho * f64::from(u));
    let wanted = [momentum[0], momentum[1], momentum[2], rho - 1.0];
    let each = sums.iter().zip(wanted);
    each.map(|(sum, wanted)| (sum - wanted).abs())
        .fold(0.0, f64::max)
}
