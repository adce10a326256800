//! Lets riprap compute a flow on the wgpu device of the host program, together with its own kernel.
//!
//! Taylor–Green vortices decay in a periodic box. After every few steps a kernel of this program reads the velocity from
//! riprap's buffer on the device and sums the kinetic energy: flow and kernel share one encoder, and nothing is read back
//! until the end. The energy must decay as exp(-4νk²t); otherwise the program fails.
//!
//! `cargo run --release -p riprap-harness --example embed`

use riprap::{
    lattice::{Lattice, Observer, Setup, State},
    wgpu,
};
use std::{error::Error, f64::consts::TAU, sync::mpsc, time::Duration};

/// Cells along x, y, z; a multiple of 4, so that any number of lanes fits.
const CELLS: [u32; 3] = [32, 32, 4];
/// Kinematic viscosity, lattice units.
const NU: f64 = 0.02;
/// Largest speed at the start, lattice units: a Mach number of 0.035.
const SPEED: f64 = 0.02;
/// Steps between two evaluations of the energy.
const EVERY: usize = 20;
/// Evaluations of the energy: at the end a tenth of it is left.
const LOOKS: usize = 40;

/// One invocation sums one row of cells; the host sums the rows.
const ENERGY: &str = "
@group(0) @binding(0) var<storage, read> u: array<f32>;
@group(0) @binding(1) var<storage, read> v: array<f32>;
@group(0) @binding(2) var<storage, read> w: array<f32>;
@group(0) @binding(3) var<storage, read_write> energy: array<f32>;
override ROW: u32;

@compute @workgroup_size(32)
fn add_up(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x >= arrayLength(&energy)) {
        return;
    }
    var sum = 0.0;
    for (var i = 0u; i < ROW; i++) {
        let n = id.x * ROW + i;
        sum += 0.5 * (u[n] * u[n] + v[n] * v[n] + w[n] * w[n]);
    }
    energy[id.x] = sum;
}
";

fn main() -> Result<(), Box<dyn Error>> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
    let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;

    let mut lattice = Lattice::new(&device, Setup::periodic(CELLS, NU))?;
    lattice.start(&device, &queue, &vortices(), true)?;
    let mut observer = Observer::new(&device, &lattice)?;

    let rows = u64::from(CELLS[1] * CELLS[2]);
    let buffer = |bytes, usage| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("energy"),
            size: bytes,
            usage,
            mapped_at_creation: false,
        })
    };
    let energy = buffer(
        4 * rows,
        wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
    );
    let looks = buffer(
        4 * rows * (LOOKS as u64 + 1),
        wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
    );
    let (pipeline, bind) = energy_kernel(&device, &observer, &energy);

    for look in 0..=LOOKS {
        let mut encoder = device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            if look > 0 {
                (0..EVERY).for_each(|_| lattice.record(&mut pass));
            }
            observer.record(&mut lattice, &mut pass)?;
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &bind, &[]);
            pass.dispatch_workgroups((rows as u32).div_ceil(32), 1, 1);
        }
        encoder.copy_buffer_to_buffer(&energy, 0, &looks, 4 * rows * look as u64, 4 * rows);
        queue.submit([encoder.finish()]);
    }

    let sums: Vec<f64> = read(&device, &looks)?
        .chunks(rows as usize)
        .map(|rows| rows.iter().map(|&e| f64::from(e)).sum())
        .collect();
    let steps = (EVERY * LOOKS) as f64;
    let found = (sums[0] / sums[LOOKS]).ln() / steps;
    let k = TAU / f64::from(CELLS[0]);
    let exact = 4.0 * NU * k * k;
    let name = adapter.get_info().name;
    println!(
        "{name}: the energy decays at {found:.6e} a step, {exact:.6e} is exact, {:+.2} %",
        100.0 * (found / exact - 1.0)
    );
    // The lattice is of second order: (k Δx)²/12 = 0.3 % with 32 cells per wave.
    if (found / exact - 1.0).abs() < 0.02 {
        Ok(())
    } else {
        Err("the vortices decay at a wrong rate".into())
    }
}

/// u = U cos kx sin ky, v = -U sin kx cos ky at the centres of the cells.
fn vortices() -> State {
    let mut state = State::rest(CELLS.iter().map(|&n| n as usize).product());
    let [nx, ny, _] = CELLS.map(|n| n as usize);
    let angle = |i: usize, n: usize| TAU * (i as f64 + 0.5) / n as f64;
    for cell in 0..state.excess.len() {
        let (x, y) = (angle(cell % nx, nx), angle(cell / nx % ny, ny));
        state.velocity[0][cell] = (SPEED * x.cos() * y.sin()) as f32;
        state.velocity[1][cell] = (-SPEED * x.sin() * y.cos()) as f32;
        // p = -ρU²/4 (cos 2kx + cos 2ky), and ρ - 1 = 3p.
        let pressure = -0.25 * SPEED * SPEED * ((2.0 * x).cos() + (2.0 * y).cos());
        state.excess[cell] = (3.0 * pressure) as f32;
    }
    state
}

/// The program's own pipeline, bound to riprap's velocity and to its own buffer.
fn energy_kernel(
    device: &wgpu::Device,
    observer: &Observer,
    energy: &wgpu::Buffer,
) -> (wgpu::ComputePipeline, wgpu::BindGroup) {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("energy"),
        source: wgpu::ShaderSource::Wgsl(ENERGY.into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("energy"),
        layout: None,
        module: &module,
        entry_point: Some("add_up"),
        compilation_options: wgpu::PipelineCompilationOptions {
            constants: &[("ROW", f64::from(CELLS[0]))],
            ..Default::default()
        },
        cache: None,
    });
    let [u, v, w] = observer.velocity();
    let entries: Vec<_> = (0..)
        .zip([u, v, w, energy])
        .map(|(binding, buffer)| wgpu::BindGroupEntry {
            binding,
            resource: buffer.as_entire_binding(),
        })
        .collect();
    let bind = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("energy"),
        layout: &pipeline.get_bind_group_layout(0),
        entries: &entries,
    });
    (pipeline, bind)
}

/// Waits for the device, at most a minute, and reads the buffer.
fn read(device: &wgpu::Device, buffer: &wgpu::Buffer) -> Result<Vec<f32>, Box<dyn Error>> {
    let (send, receive) = mpsc::channel();
    buffer.map_async(wgpu::MapMode::Read, .., move |mapped| {
        // The receiver lives until the end of this function.
        let _ = send.send(mapped);
    });
    device.poll(wgpu::PollType::Wait {
        submission_index: None,
        timeout: Some(Duration::from_secs(60)),
    })?;
    receive.try_recv()??;
    let view = buffer.get_mapped_range(..)?;
    Ok(bytemuck::pod_collect_to_vec(&view))
}
