//! A program with rigid bodies and a loop of its own that has riprap put them into a fluid.
//!
//! A tetrahedron and a ball are thrown into water at rest in a periodic box. This program moves them itself,
//! by the simplest integrator there is; of riprap it uses the lattice, the solid fractions, the partially
//! saturated cells and the sums of what the fluid does to the bodies. Nothing else acts, so that what the
//! bodies lose the fluid must gain; otherwise the program fails.
//!
//! `cargo run --release -p riprap-harness --example own_bodies`

use glam::{DQuat, DVec3};
use riprap::{
    block::{Polyhedron, Shape},
    bodies::{Load, Pose},
    immersed::{Frame, Immersed, Submerged},
    lattice::{Lattice, Observer, Setup, SolidOperator, State},
    units::Units,
    wgpu,
};
use std::{error::Error, sync::Arc, time::Duration};

/// Cells along x, y, z.
const CELLS: [u32; 3] = [32, 32, 32];
/// One centimetre, a hundredth of a second, and water.
const UNITS: Units = Units {
    cell: 0.01,
    time_step: 0.01,
    density: 1000.0,
};
/// Kinematic viscosity, m²/s.
const VISCOSITY: f64 = 2e-4;
const STEPS: usize = 200;

/// What this program knows of a body; it would be a body of some physics engine.
struct Body {
    shape: Arc<Shape>,
    mass: f64,
    place: DVec3,
    turn: DQuat,
    velocity: DVec3,
    spin: DVec3,
}

impl Body {
    fn new(shape: Shape, density: f64, place: DVec3, velocity: DVec3) -> Self {
        Self {
            mass: density * shape.volume(),
            shape: shape.into(),
            place,
            turn: DQuat::IDENTITY,
            velocity,
            spin: DVec3::new(0.0, 0.0, 2.0),
        }
    }

    fn pose(&self) -> Pose {
        Pose::rigid(self.place, self.turn, self.velocity, self.spin)
    }

    /// Symplectic Euler; the inertia of both shapes is the same about every axis.
    fn step(&mut self, force: DVec3, torque: DVec3, dt: f64) {
        let inertia = self.mass / self.shape.volume() * self.shape.inertia().x_axis.x;
        self.velocity += force / self.mass * dt;
        self.spin += torque / inertia * dt;
        self.place += self.velocity * dt;
        self.turn = (DQuat::from_scaled_axis(self.spin * dt) * self.turn).normalize();
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
    let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;

    let mut setup = Setup::periodic(CELLS, UNITS.viscosity_to_lattice(VISCOSITY));
    setup.solid_operator = Some(SolidOperator::Holdych);
    let mut lattice = Lattice::new(&device, setup)?;
    let cells = CELLS.iter().map(|&n| n as usize).product();
    lattice.start(&device, &queue, &State::rest(cells), true)?;
    let mut observer = Observer::new(&device, &lattice)?;

    let mut bodies = [
        Body::new(
            Polyhedron::tetrahedron(0.12)?.into(),
            2650.0,
            DVec3::new(0.09, 0.16, 0.16),
            DVec3::new(0.03, 0.01, 0.0),
        ),
        Body::new(
            Shape::sphere(0.04)?,
            1500.0,
            DVec3::new(0.24, 0.16, 0.16),
            DVec3::new(-0.02, 0.0, 0.03),
        ),
    ];
    let frame = Frame {
        origin: DVec3::ZERO,
        units: UNITS,
    };
    let submerged = bodies.iter().map(|body| Submerged {
        shape: body.shape.clone(),
        loaded: true,
        faces: false,
    });
    let mut immersed = Immersed::new(&device, &lattice, frame, submerged.collect())?;

    let momentum = |bodies: &[Body]| -> DVec3 { bodies.iter().map(|b| b.mass * b.velocity).sum() };
    let start = momentum(&bodies);
    // Cells inside a body reflect what is in them, so that its loads swing from step to step: it feels the
    // mean of two. The first ones act from rest.
    let mut before = vec![Load::default(); bodies.len()];
    for _ in 0..STEPS {
        let poses: Vec<_> = bodies.iter().map(Body::pose).collect();
        immersed.place(&device, &queue, &mut lattice, &poses)?;
        let mut encoder = device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            immersed.record_cells(&mut pass);
            lattice.record_saturated(&mut pass);
            immersed.record_loads(&mut pass);
            lattice.record_rest(&mut pass);
        }
        let wrenches = read(&device, &queue, encoder, &immersed)?;
        let loads = immersed.loads(&wrenches)?;
        for ((body, now), before) in bodies.iter_mut().zip(&loads).zip(&before) {
            let force = 0.5 * (now.force + before.force);
            let torque = 0.5 * (now.torque() + before.torque());
            body.step(force, torque, UNITS.time_step);
        }
        before = loads;
    }

    let sums = observer.sums(&device, &queue, &mut lattice);
    let sums = wait(&device, sums)?;
    // Lattice units to kg m/s.
    let unit = UNITS.density * UNITS.cell.powi(4) / UNITS.time_step;
    let fluid = DVec3::from(sums.momentum) * unit;
    // Half of the last loads has yet to act.
    let coming: DVec3 = before.iter().map(|load| load.force).sum();
    let total = momentum(&bodies) + 0.5 * coming * UNITS.time_step + fluid;
    let error = (total - start).length() / start.length();
    println!(
        "{}: the bodies keep {:.1} % of their momentum, the water has the rest, to {error:.1e}",
        adapter.get_info().name,
        100.0 * momentum(&bodies).length() / start.length(),
    );
    // Rounding of f32 over the cells and steps.
    if error < 1e-4 {
        Ok(())
    } else {
        Err("momentum is not conserved".into())
    }
}

/// Submits, and reads the sums back.
fn read(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    mut encoder: wgpu::CommandEncoder,
    immersed: &Immersed,
) -> Result<Vec<f32>, Box<dyn Error>> {
    let bytes = 4 * immersed.wrench_count() as u64;
    let staging = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("wrenches"),
        size: bytes,
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    encoder.copy_buffer_to_buffer(immersed.wrenches(), 0, &staging, 0, bytes);
    queue.submit([encoder.finish()]);
    staging.map_async(wgpu::MapMode::Read, .., |_| {});
    device.poll(patience())?;
    Ok(bytemuck::pod_collect_to_vec(&staging.get_mapped_range(..)?))
}

/// Runs a future of riprap's to its end.
fn wait<T>(
    device: &wgpu::Device,
    future: impl Future<Output = riprap::Result<T>>,
) -> Result<T, Box<dyn Error>> {
    let mut future = std::pin::pin!(future);
    let mut context = std::task::Context::from_waker(std::task::Waker::noop());
    loop {
        if let std::task::Poll::Ready(done) = future.as_mut().poll(&mut context) {
            return Ok(done?);
        }
        device.poll(patience())?;
    }
}

fn patience() -> wgpu::PollType {
    wgpu::PollType::Wait {
        submission_index: None,
        timeout: Some(Duration::from_secs(60)),
    }
}
