//! Lets riprap compute free water with the wgpu device and encoder of the host program.
//!
//! A column of water in a tank collapses and runs along the floor. The steps go into this program's encoder, and the
//! particles are read from riprap's buffer in its units. After a while the front must be farther than it gets without
//! pressure and nearer than at the speed √(2 g H); otherwise the program fails.
//!
//! `cargo run --release -p riprap-harness --example own_water`

use glam::{DMat3, DVec3};
use riprap::{
    geometry::Pose,
    gpu::readback::Readback,
    sph::{Body, Setup, Side, SphSolver},
    wgpu,
};
use riprap_harness::gpu;
use std::error::Error;

/// Particle spacing, m; the column is 10 particles wide and 20 high.
const SPACING: f64 = 0.05;
const COLUMN: [i32; 2] = [10, 20];
/// Simulated time, s.
const TIME: f64 = 0.3;

fn main() -> Result<(), Box<dyn Error>> {
    let adapter = gpu::pick(None)?;
    let (device, queue) = gpu::open(&adapter, wgpu::Features::empty(), adapter.limits())?;

    // Nothing varies along y. The floor and the wall behind the column are four layers of particles.
    let mut setup = Setup::tank(DVec3::new(2.0, 0.1, 1.2), SPACING, 50.0);
    setup.plane = true;
    setup.faces[2][1] = Side::Open;
    let point = |i: i32, k: i32| DVec3::new(f64::from(i) + 0.5, 1.0, f64::from(k) + 0.5) * SPACING;
    let (mut water, mut wall) = (Vec::new(), Vec::new());
    for k in -4..24 {
        for i in -4..44 {
            if i >= 0 && k >= 0 && i < COLUMN[0] && k < COLUMN[1] {
                water.push(point(i, k));
            } else if i < 0 || k < 0 {
                wall.push(point(i, k));
            }
        }
    }
    setup.bodies = vec![Body {
        boundary: wall,
        ..Body::default()
    }];
    let still = vec![DVec3::ZERO; water.len()];
    let pressures: Vec<f64> = water.iter().map(|x| 9810.0 * (1.0 - x.z)).collect();
    let mut particles = SphSolver::new(&device, &queue, setup, &water, &still, &pressures)?;
    let place = Pose {
        centre: DVec3::ZERO,
        deformation: DMat3::IDENTITY,
        velocity: DVec3::ZERO,
        deformation_rate: DMat3::ZERO,
    };

    // The largest number of steps that the time may take; those after its end do nothing.
    particles.begin(&queue, &[place], TIME)?;
    let most = (2.0 * TIME / particles.setup().acoustic_step()).ceil() as usize;
    for _ in 0..most.div_ceil(50) {
        let mut encoder = device.create_command_encoder(&Default::default());
        for _ in 0..50 {
            particles.record(&mut encoder);
        }
        queue.submit([encoder.finish()]);
    }
    let patience = std::time::Duration::from_secs(120);
    let mut readback = Readback::default();
    let read = readback.read(&device, &queue, particles.buffer(), water.len());
    let found: Vec<riprap::sph::Particle> = gpu::drive(&device, patience, "the water", read)??;
    let grid = particles.grid();
    let there = found.iter().filter(|particle| particle.at[0] >= 0);
    let front = there
        .map(|particle| grid.position(particle.at).x)
        .fold(0.0, f64::max);
    let start = f64::from(COLUMN[0]) * SPACING;
    println!("the front has run from {start:.2} to {front:.2} m in {TIME} s");
    let fastest = start + TIME * (2.0 * 9.81 * 1.0f64).sqrt();
    if front < start + 0.1 || front > fastest {
        return Err(format!("it should be between {:.2} and {fastest:.2} m", start + 0.1).into());
    }
    Ok(())
}
