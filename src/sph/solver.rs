//! The particle solver on the device.

mod state;

pub use state::{ExternalWork, SphState};

use super::{
    BodyMotion, CellGrid, Clock, Counts, Particle, ReferencePosition, Setup,
    bodies::{BodyHistory, check_loop_iterations, hulls},
    kernels::{Kernels, LOAD_LEN, ListCapacities},
    layout::columns,
    neighbour_lists::grown_capacity,
};
use crate::{
    Error, Result,
    geometry::{Load, Pose},
    gpu::readback::{self, Readback},
};
use glam::{DMat3, DVec3};

/// Steps per submission, few enough that a slow adapter completes it before its timeout.
const BATCH: u64 = 16;
/// Shortest step relative to the acoustic step. A shorter step means that the flow is a hundred times as fast as the setup
/// allows for.
const MIN_STEP_RATIO: f32 = 1e-3;

/// Result of an exchange.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExchangeResult {
    /// Mean load on each body over the exchange; zero for bodies that are not [`loaded`](super::Body::loaded).
    pub loads: Vec<Load>,
    /// Mean pressure at each probe, Pa; 0 where there is no water.
    pub pressures: Vec<f64>,
    /// Steps of the exchange.
    pub steps: u32,
    /// Steps that sorted the particles and rebuilt the neighbour lists, if there are any.
    pub sorts: u32,
}

/// SPH solver for water with walls and blocks, on the device.
///
/// δ-SPH: Monaghan (1992) with the Wendland C2 function, density diffusion of Fourtakas et al. (2019), walls of
/// Adami, Hu & Adams (2012). No method blocks: the caller must poll the device while it awaits a future.
#[derive(Debug)]
pub struct SphSolver {
    setup: Setup,
    grid: CellGrid,
    counts: Counts,
    /// Indices of the bodies in the order of the device, those with loads first.
    order: Vec<usize>,
    /// Place of each body in the order of the device.
    rank: Vec<usize>,
    /// Index of the first boundary particle of each body in the order of the device, and their number as the last entry.
    first: Vec<u32>,
    kernels: Kernels,
    clock: Clock,
    history: BodyHistory,
    work: ExternalWork,
    /// Whether the boundary particles of fixed bodies are in place.
    boundary_placed: bool,
    report: Option<wgpu::Buffer>,
    readback: Readback,
    steps: u64,
    /// Whether the next step sorts the particles regardless of the displacement.
    force_sort: bool,
}

impl SphSolver {
    /// A solver for particles with these positions (m), velocities (m/s) and pressures (Pa) at the time 0.
    ///
    /// # Errors
    /// [`Error::Argument`] if the setup or the particles are invalid; [`Error::Limit`] if the device cannot hold them.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        setup: Setup,
        positions: &[DVec3],
        velocities: &[DVec3],
        pressures: &[f64],
    ) -> Result<Self> {
        let grid = CellGrid::new(&setup)?;
        if positions.len() != velocities.len() || positions.len() != pressures.len() {
            let message = "positions, velocities and pressures differ in number; give one of each for each particle";
            return Err(Error::argument("positions", message));
        }
        let particle_count = |count: usize| {
            u32::try_from(count).map_err(|_| {
                let message = format!("{count} particles are too many; use a larger spacing");
                Error::argument("spacing", message)
            })
        };
        let mut order: Vec<usize> = (0..setup.bodies.len()).collect();
        order.sort_by_key(|&body| !setup.bodies[body].loaded);
        let mut rank = vec![0; order.len()];
        let mut first = vec![0];
        let (mut reference_positions, mut loaded_boundary) = (Vec::new(), 0);
        let deforms = setup.deforms();
        let mut strain_areas = Vec::new();
        for (place, &body) in order.iter().enumerate() {
            rank[body] = place;
            let boundary = &setup.bodies[body].boundary;
            reference_positions.extend(boundary.iter().map(|x| ReferencePosition {
                position: grid.length(*x).as_vec3().to_array(),
                body: place as u32,
            }));
            first.push(particle_count(reference_positions.len())?);
            if setup.bodies[body].loaded {
                loaded_boundary = first[place + 1];
                if deforms {
                    let areas = &setup.bodies[body].strain_areas;
                    strain_areas.extend(areas.iter().map(|area| columns(grid.strain_area(*area))));
                    strain_areas.resize(loaded_boundary as usize, columns(DMat3::ZERO));
                }
            }
        }
        let counts = Counts {
            fluid: particle_count(positions.len())?,
            boundary: first[order.len()],
            loaded_boundary,
            bodies: order.len() as u32,
            loaded_bodies: setup.bodies.iter().filter(|body| body.loaded).count() as u32,
        };
        let hull_set = hulls(&setup, &grid, &order);
        check_loop_iterations(device, &hull_set.hulls)?;
        if positions.is_empty() {
            let message = "there is no particle; give one at least, or leave the water out";
            return Err(Error::argument("positions", message));
        }
        let kernels = Kernels::new(device, queue, &setup, &grid, counts, &hull_set)?;
        let mut particles = Vec::with_capacity(positions.len());
        for (id, position) in positions.iter().enumerate() {
            let at = grid.quantise(*position);
            let (velocity, pressure) = (velocities[id], pressures[id]);
            let finite = position.is_finite()
                && grid.velocity(velocity).as_vec3().is_finite()
                && pressure.is_finite();
            if !(finite && grid.contains(at)) {
                return Err(Error::argument(
                    "positions",
                    format!(
                        "particle {id} at {position} m with {velocity} m/s and {pressure} Pa is outside the domain or \
                         not finite; give finite values inside the domain"
                    ),
                ));
            }
            setup.check_pressure(id, pressure)?;
            particles.push(Particle {
                at,
                id: id as u32,
                velocity: grid.velocity(velocity).as_vec3().to_array(),
                excess: setup.excess(pressure) as f32,
            });
        }
        // Buffers hold at least one particle; a dummy one lies outside the domain.
        let outside = Particle {
            at: [-1; 3],
            ..Particle::default()
        };
        particles.resize(positions.len().max(1), outside);
        queue.write_buffer(&kernels.fluid.unsorted, 0, bytemuck::cast_slice(&particles));
        let boundary: Vec<_> = (0..counts.boundary)
            .map(|id| Particle { id, ..outside })
            .collect();
        queue.write_buffer(&kernels.boundary.sorted, 0, bytemuck::cast_slice(&boundary));
        queue.write_buffer(
            &kernels.reference_positions,
            0,
            bytemuck::cast_slice(&reference_positions),
        );
        let areas = bytemuck::cast_slice(&strain_areas);
        queue.write_buffer(&kernels.strain_areas, 0, areas);
        if reference_positions.is_empty() {
            let buffer = &kernels.boundary.unsorted;
            queue.write_buffer(buffer, 0, bytemuck::bytes_of(&outside));
        }
        let fastest = velocities.iter().map(|v| v.length()).fold(0.0, f64::max);
        Ok(Self {
            clock: Clock {
                step_limit: first_step_limit(&setup, &grid, fastest),
                ..Clock::default()
            },
            history: BodyHistory::new(&setup.bodies),
            work: ExternalWork::default(),
            boundary_placed: false,
            report: None,
            readback: Readback::default(),
            steps: 0,
            force_sort: true,
            setup,
            grid,
            counts,
            order,
            rank,
            first,
            kernels,
        })
    }

    /// Upper bound on the length of the next step, s.
    pub fn step_limit(&self) -> f64 {
        f64::from(self.clock.step_limit) * self.grid.unit_time()
    }

    /// Advances the water by `time` (s), in as many steps as stability requires. The bodies start at `poses` and move
    /// with the rates of the poses.
    ///
    /// # Errors
    /// The errors of [`SphSolver::begin`]; [`Error::ParticleLost`] if the state of a particle is not finite or the stable step
    /// becomes too short; [`Error::DeviceLost`].
    pub async fn advance(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        poses: &[Pose],
        time: f64,
    ) -> Result<ExchangeResult> {
        self.begin(queue, poses, time)?;
        loop {
            let steps = (f64::from(self.clock.remaining) / f64::from(self.clock.step_limit)).ceil();
            let batch = (steps as u64).clamp(1, BATCH);
            let mut encoder = device.create_command_encoder(&Default::default());
            for _ in 0..batch {
                self.record(&mut encoder);
            }
            let report = self.report(device, &mut encoder);
            queue.submit([encoder.finish()]);
            let words: Vec<u32> = readback::map(device, &report, report.size()).await?;
            self.report = Some(report);
            let (clock, sums) = words.split_at(size_of::<Clock>() / 4);
            self.clock = *bytemuck::from_bytes(bytemuck::cast_slice(clock));
            if self.clock.overflow + self.clock.boundary_overflow > 0 {
                self.grow_lists(device, queue)?;
                continue;
            }
            self.check_clock()?;
            if self.clock.step == 0.0 {
                self.force_sort = false;
                self.steps += u64::from(self.clock.steps);
                let result = self.result(bytemuck::cast_slice(sums), time);
                self.add_work(&result.loads, poses, time);
                return Ok(result);
            }
        }
    }

    /// Begins an exchange of `time` (s) with the bodies at `poses`. [`SphSolver::record`] then records its steps;
    /// [`SphSolver::advance`] does both.
    ///
    /// # Errors
    /// [`Error::Argument`] if the number of poses differs from the number of bodies, a pose is not finite or its deformation
    /// not invertible, or the time is not greater than 0.
    pub fn begin(&mut self, queue: &wgpu::Queue, poses: &[Pose], time: f64) -> Result<()> {
        check_exchange(poses, self.setup.bodies.len(), time)?;
        // Rounding moves blocks out of the plane, which would push particles along y.
        let planar: Vec<Pose>;
        let poses = if self.setup.plane {
            let middle = self.setup.origin.y + 0.5 * self.setup.size.y;
            planar = poses.iter().map(|pose| pose.in_plane(middle)).collect();
            &planar
        } else {
            poses
        };
        let motions: Vec<BodyMotion> = (0..self.order.len())
            .map(|place| self.motion(place, poses))
            .collect();
        queue.write_buffer(&self.kernels.motions, 0, bytemuck::cast_slice(&motions));
        let displacement =
            f64::from(self.clock.list_displacement) + self.history.jump(poses) / self.setup.spacing;
        let stale = self.force_sort || self.clock.stale != 0 || displacement > self.grid.skin;
        let remaining = (time / self.grid.unit_time()) as f32;
        self.clock = Clock {
            step: remaining / (remaining / self.clock.step_limit).ceil().max(1.0),
            elapsed: 0.0,
            remaining,
            steps: 0,
            sorts: 0,
            boundary_work: 0.0,
            penalty_work: 0.0,
            crossings: [0; 3],
            stale: stale.into(),
            list_displacement: if stale { 0.0 } else { displacement as f32 },
            max_body_speed: (self.history.max_speed(poses) / self.grid.sound_speed()) as f32,
            ..self.clock
        };
        queue.write_buffer(&self.kernels.clock, 0, bytemuck::bytes_of(&self.clock));
        let zeros = vec![0.0f32; LOAD_LEN * self.counts.loaded_bodies.max(1) as usize];
        queue.write_buffer(&self.kernels.loads, 0, bytemuck::cast_slice(&zeros));
        self.kernels.probes.reset(queue);
        self.history.record(poses, time);
        // The host does not know the displacement until it reads the clock.
        self.force_sort = true;
        Ok(())
    }

    /// Motion of the body that is at `place` in the order of the device.
    fn motion(&self, place: usize, poses: &[Pose]) -> BodyMotion {
        let index = self.order[place];
        let (body, pose) = (&self.setup.bodies[index], &poses[index]);
        let known = self.history.acceleration(index, pose);
        let known = known.filter(|_| body.accelerates);
        let (acceleration, change) = known.unwrap_or((DVec3::ZERO, DMat3::ZERO));
        let (grid, unit) = (&self.grid, self.grid.unit_time());
        BodyMotion {
            centre: grid.quantise(pose.centre),
            first: self.first[place],
            velocity: grid.velocity(pose.velocity).as_vec3().to_array(),
            count: self.first[place + 1] - self.first[place],
            acceleration: grid.acceleration(acceleration).as_vec3().to_array(),
            no_slip: if body.free_slip { 0.0 } else { 1.0 },
            deformation: columns(pose.deformation),
            deformation_rate: columns(grid.rate(pose.deformation_rate)),
            deformation_acceleration: columns(change * (unit * unit)),
        }
    }

    /// Forces the next step to sort the particles. The order of the particles, and with it the rounding of all sums,
    /// depends on the steps since the last forced sort: a run and its restart have the same bits if both call this at
    /// the time of the checkpoint, as [`SphSolver::restore`] does.
    pub fn force_sort(&mut self) {
        self.force_sort = true;
    }

    /// Enlarges the neighbour lists and resumes the postponed step.
    fn grow_lists(&mut self, device: &wgpu::Device, queue: &wgpu::Queue) -> Result<()> {
        let capacities = ListCapacities {
            fluid: grown_capacity(self.clock.overflow),
            boundary: grown_capacity(self.clock.boundary_overflow),
        };
        self.kernels
            .grow_lists(device, queue, &self.setup, &self.grid, capacities)?;
        (self.clock.overflow, self.clock.boundary_overflow) = (0, 0);
        self.clock.step = self.clock.pending_step;
        queue.write_buffer(&self.kernels.clock, 0, bytemuck::bytes_of(&self.clock));
        Ok(())
    }

    /// Records a step of the exchange into the caller's encoder. Steps after the end of the exchange do nothing. A
    /// neighbour list that overflows stops the exchange; [`SphSolver::advance`] enlarges it and resumes.
    /// [`NeighbourSearch::Cells`] uses no lists.
    ///
    /// [`NeighbourSearch::Cells`]: super::NeighbourSearch::Cells
    pub fn record(&mut self, encoder: &mut wgpu::CommandEncoder) {
        let moves = self.setup.bodies.iter().any(|body| body.moves);
        if moves || !self.boundary_placed {
            self.kernels.record_boundary(encoder);
            self.boundary_placed = true;
        }
        self.kernels.record_step(encoder);
    }

    /// Sets the pressure probes of the next exchanges: positions (m) in the water, then positions on walls, each with
    /// the fraction of the kernel in front of the wall that water can cover. The pressure on a wall is reduced where
    /// water covers less than that.
    ///
    /// # Errors
    /// [`Error::Argument`] if a position is not finite; [`Error::Limit`] if the device cannot hold the probes.
    pub fn set_probes(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        in_water: &[DVec3],
        on_walls: &[(DVec3, f64)],
    ) -> Result<()> {
        let mut all = in_water.iter().chain(on_walls.iter().map(|(x, _)| x));
        if let Some(bad) = all.position(|x| !x.is_finite()) {
            let message = "is not finite; give a position in m";
            return Err(Error::argument(format!("probes[{bad}]"), message));
        }
        let probe = |(x, weight): (DVec3, f32)| {
            let [x, y, z] = self.grid.quantise(x);
            [x, y, z, weight.to_bits().cast_signed()]
        };
        let on_walls = on_walls.iter();
        let on_walls = on_walls.map(|(x, fraction)| (*x, fraction.recip() as f32));
        let all = in_water.iter().map(|x| (*x, 0.0)).chain(on_walls);
        let probes: Vec<_> = all.map(probe).collect();
        self.kernels.set_probes(device, queue, &probes)
    }

    /// Records the copies of clock, loads and pressures to the host.
    fn report(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
    ) -> wgpu::Buffer {
        let clock = size_of::<Clock>() as u64;
        let loads = 4 * (LOAD_LEN * self.counts.loaded_bodies as usize) as u64;
        let pressures = self.kernels.probes.pressures();
        let size = clock + loads + pressures.map_or(0, wgpu::Buffer::size);
        let report = self.report.take().filter(|kept| kept.size() == size);
        let report = report.unwrap_or_else(|| readback::staging(device, size));
        encoder.copy_buffer_to_buffer(&self.kernels.clock, 0, &report, 0, clock);
        if loads > 0 {
            encoder.copy_buffer_to_buffer(&self.kernels.loads, 0, &report, clock, loads);
        }
        if let Some(pressures) = pressures {
            let size = pressures.size();
            encoder.copy_buffer_to_buffer(pressures, 0, &report, clock + loads, size);
        }
        report
    }

    /// Checks that all particles are finite and the step is not too short.
    fn check_clock(&self) -> Result<()> {
        let unit = self.grid.unit_time();
        let shortest = MIN_STEP_RATIO * (self.setup.acoustic_step() / unit) as f32;
        let Clock {
            invalid_particle,
            step_limit,
            ..
        } = self.clock;
        let (cause, particle) = if invalid_particle > 0 {
            let cause = "its density or velocity is not a number".to_owned();
            (cause, Some(invalid_particle - 1))
        } else if step_limit >= shortest {
            return Ok(());
        } else {
            let step = f64::from(step_limit) * unit;
            let cause = format!("water is so fast that a step would be {step:.2e} s");
            (cause, None)
        };
        Err(Error::ParticleLost {
            particle,
            step: self.steps + u64::from(self.clock.steps),
            cause,
            remedy:
                "set particles.largest_speed to the speed that the water reaches, or use a smaller \
                     particles.courant; check for water that is squeezed between blocks"
                    .into(),
        })
    }

    fn result(&self, sums: &[f32], time: f64) -> ExchangeResult {
        let duration = time / self.grid.unit_time();
        let (loads, pressures) = sums.split_at(LOAD_LEN * self.counts.loaded_bodies as usize);
        let load = |&place: &usize| match loads.get(place * LOAD_LEN..(place + 1) * LOAD_LEN) {
            Some(sums) if self.setup.plane => self.grid.load(sums, duration).in_plane(),
            Some(sums) => self.grid.load(sums, duration),
            None => Load::default(),
        };
        let probes = pressures.iter().take(self.kernels.probes.count());
        ExchangeResult {
            loads: self.rank.iter().map(load).collect(),
            pressures: probes
                .map(|sum| self.grid.pressure(*sum, duration))
                .collect(),
            steps: self.clock.steps,
            sorts: self.clock.sorts,
        }
    }

    /// Adds the work of an exchange of `time` (s).
    fn add_work(&mut self, loads: &[Load], poses: &[Pose], time: f64) {
        let moving = self.setup.bodies.iter().zip(loads.iter().zip(poses));
        let moving = moving.filter(|(body, _)| body.moves);
        self.work.bodies += moving
            .map(|(_, (load, pose))| -load.work(pose, &pose.after(time)))
            .sum::<f64>();
        self.work.penalty += self.grid.work(self.clock.penalty_work);
        self.work.boundary += self.grid.work(self.clock.boundary_work);
        let crossings = DVec3::from_array(self.clock.crossings.map(f64::from));
        let mass = self.setup.particle_mass();
        self.work.gravity += mass * self.setup.gravity.dot(crossings * self.setup.size);
    }
}

/// Checks that there is a valid pose for each of `bodies` bodies, and that `time` (s) is positive.
///
/// # Errors
/// [`Error::Argument`] naming the first invalid value.
fn check_exchange(poses: &[Pose], bodies: usize, time: f64) -> Result<()> {
    if poses.len() != bodies {
        let message = format!("{} poses for {bodies} bodies; give one each", poses.len());
        return Err(Error::argument("poses", message));
    }
    for (body, pose) in poses.iter().enumerate() {
        let key = || format!("poses[{body}]");
        if !pose.is_finite() {
            let message = "is not finite; check the motion of this body";
            return Err(Error::argument(key(), message));
        }
        pose.check_volume(key)?;
    }
    if time > 0.0 && time.is_finite() {
        return Ok(());
    }
    let message = format!("is {time} s; give a number greater than 0");
    Err(Error::argument("time", message))
}

/// Longest first step of water at `max_speed` (m/s) that only gravity accelerates, in units of the device.
fn first_step_limit(setup: &Setup, grid: &CellGrid, max_speed: f64) -> f32 {
    let h = setup.smoothing;
    let by_force = (h / grid.acceleration(setup.gravity).length().max(1e-30)).sqrt();
    let by_sound = h / (10.0 * max_speed / setup.sound_speed).max(1.0);
    let by_viscosity = setup.viscous_step() / grid.unit_time();
    (setup.courant * by_force.min(by_sound)).min(by_viscosity) as f32
}
