//! Couples rigid bodies of the host program, with its own time loop, to a fluid of riprap.
//!
//! A tetrahedron and a ball of rock are released in water at rest. This program moves them itself, by the simplest
//! integrator; from riprap it uses the lattice, the solid fractions, the partially saturated cells and the sums of the
//! loads of the fluid on the bodies. Three steps turn these sums into forces on rock: adding its buoyancy, since the water
//! here has no weight; averaging over two steps; and removing the inertia of the fluid inside the body's cells. The ball
//! must start as in theory, with its added mass of water; otherwise the program fails.
//!
//! `cargo run --release -p riprap-harness --example own_bodies`

use glam::{DQuat, DVec3};
use riprap::{
    coupling::{AddedMass, Ambient, FluidLoad, InteriorInertia, MassProperties},
    formula::Formula,
    geometry::{Load, Polyhedron, Pose, Shape},
    lattice::{Lattice, Setup, SolidOperator, State},
    psm::{Frame, SolidBlock, SolidCells},
    units::Units,
    wgpu,
};
use std::{error::Error, sync::Arc, time::Duration};

/// Cells along x, y, z.
const CELLS: [u32; 3] = [64, 32, 32];
/// A cell of one centimetre, a time step of a hundredth of a second, and water.
const UNITS: Units = Units {
    cell: 0.01,
    time_step: 0.01,
    density: 1000.0,
};
/// Kinematic viscosity, m²/s.
const VISCOSITY: f64 = 2e-5;
/// m/s²; in the time of this program, a fall of millimetres.
const GRAVITY: DVec3 = DVec3::new(0.0, 0.0, -0.2);
const STEPS: usize = 40;
const BALL_DENSITY: f64 = 2650.0;

/// State of a body; in an application, a body of a physics engine.
struct Body {
    shape: Arc<Shape>,
    mass: f64,
    place: DVec3,
    turn: DQuat,
    velocity: DVec3,
    spin: DVec3,
    interior: InteriorInertia,
    added_mass: AddedMass,
    before: Option<Load>,
}

impl Body {
    fn new(shape: Shape, density: f64, place: DVec3) -> Self {
        Self {
            mass: density * shape.volume(),
            added_mass: AddedMass::bound(shape.volume(), shape.inertia(), UNITS.cell),
            shape: shape.into(),
            place,
            turn: DQuat::IDENTITY,
            velocity: DVec3::ZERO,
            spin: DVec3::ZERO,
            interior: InteriorInertia::default(),
            before: None,
        }
    }

    fn pose(&self) -> Pose {
        Pose::rigid(self.place, self.turn, self.velocity, self.spin)
    }

    /// Force (N) and torque (N m) on the rock, weight included, from the load on its cells in this step.
    fn force_and_torque(&mut self, load: &Load, ambient: &Ambient) -> [DVec3; 2] {
        // Full cells reflect their populations, so that loads oscillate from step to step.
        let before = self.before.replace(*load).unwrap_or(*load);
        let cell_load = FluidLoad {
            flow: Load {
                force: 0.5 * (load.force + before.force),
                moment: 0.5 * (load.moment + before.moment),
                ..*load
            },
            buoyancy: ambient.buoyancy(load),
        };
        // The inertia of both shapes is the same about every axis.
        let properties = MassProperties {
            mass: self.mass,
            volume: self.shape.volume(),
            inertia: self.shape.inertia(),
            gravity: GRAVITY,
            added: self.added_mass,
        };
        let pose = self.pose();
        let load = (self.interior).load(
            &cell_load,
            &pose,
            &properties,
            UNITS.density,
            UNITS.time_step,
        );
        [load.force + self.mass * GRAVITY, load.torque()]
    }

    /// Symplectic Euler.
    fn step(&mut self, [force, torque]: [DVec3; 2], dt: f64) {
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

    let mut bodies = [
        Body::new(
            Polyhedron::tetrahedron(0.12)?.into(),
            2650.0,
            DVec3::new(0.16, 0.16, 0.16),
        ),
        Body::new(
            Shape::sphere(0.05)?,
            BALL_DENSITY,
            DVec3::new(0.48, 0.16, 0.16),
        ),
    ];
    let frame = Frame {
        origin: DVec3::ZERO,
        units: UNITS,
    };
    let solids = bodies
        .iter()
        .map(|body| SolidBlock::new(body.shape.clone()));
    let mut cells = SolidCells::new(&device, &lattice, frame, solids.collect())?;

    // The water has no weight of its own: its pressure is relative to the hydrostatic one.
    let ambient = Ambient {
        density: UNITS.density,
        acceleration: std::array::from_fn(|_| Formula::number(0.0)),
        gravity: GRAVITY,
        period: None,
    };
    for _ in 0..STEPS {
        let poses: Vec<_> = bodies.iter().map(Body::pose).collect();
        cells.place(&device, &queue, &mut lattice, &poses)?;
        let mut encoder = device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            cells.record_cells(&mut pass);
            lattice.record_psm(&mut pass);
            cells.record_loads(&mut pass);
            lattice.record_rest(&mut pass);
        }
        let wrenches = read(&device, &queue, encoder, &cells)?;
        let loads = cells.loads(&wrenches)?;
        for (body, load) in bodies.iter_mut().zip(&loads) {
            let pull = body.force_and_torque(load, &ambient);
            body.step(pull, UNITS.time_step);
        }
    }

    // The added mass of a ball is half of the water it displaces.
    let heavier = BALL_DENSITY - UNITS.density;
    let rate = heavier / (BALL_DENSITY + 0.5 * UNITS.density) * GRAVITY.z;
    let exact = rate * STEPS as f64 * UNITS.time_step;
    let found = bodies[1].velocity.z;
    println!(
        "{}: after {STEPS} steps the ball sinks at {:.4} m/s, in theory at {:.4} m/s",
        adapter.get_info().name,
        -found,
        -exact
    );
    // The tolerance covers viscosity and the periodic images of the ball in a box of three diameters.
    if (found / exact - 1.0).abs() < 0.1 {
        Ok(())
    } else {
        Err("the ball does not set out as it should".into())
    }
}

/// Submits, and reads the sums back.
fn read(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    mut encoder: wgpu::CommandEncoder,
    cells: &SolidCells,
) -> Result<Vec<f32>, Box<dyn Error>> {
    let bytes = 4 * cells.wrench_count() as u64;
    let staging = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("wrenches"),
        size: bytes,
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    encoder.copy_buffer_to_buffer(cells.wrenches(), 0, &staging, 0, bytes);
    queue.submit([encoder.finish()]);
    staging.map_async(wgpu::MapMode::Read, .., |_| {});
    device.poll(patience())?;
    Ok(bytemuck::pod_collect_to_vec(&staging.get_mapped_range(..)?))
}

fn patience() -> wgpu::PollType {
    wgpu::PollType::Wait {
        submission_index: None,
        timeout: Some(Duration::from_secs(60)),
    }
}
