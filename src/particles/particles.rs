//! Water of particles on the device.

use super::{
    Clock, Frame, Home, Motion, Numbers, Particle, Setup, State, Water, Works,
    check::check_exchange,
    followed::Followed,
    hulls,
    kernels::{Kernels, NUMBERS},
    layout::order_those_left,
    near,
};
use crate::{
    Error, Result,
    bodies::{Load, Pose},
    readback::{self, Readback},
};
use glam::{DMat3, DVec3};

/// Steps that are recorded at once: one wait for all of them must end on a slow adapter too.
const BATCH: u64 = 16;
/// Share of the acoustic step below which a step is no longer one: the water moves at a hundred times the speed
/// that it was set up for.
const SHORTEST: f32 = 1e-3;

/// What an exchange has led to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Exchange {
    /// Mean load on each body over the time of the exchange; nothing on those that are not asked about.
    pub loads: Vec<Load>,
    /// Mean pressure of the water at each place that is asked about, Pa; 0 where there is none.
    pub pressures: Vec<f64>,
    /// Steps that the water took.
    pub steps: u32,
    /// Steps of them that sorted the particles, and made lists of neighbours if there are any.
    pub sorts: u32,
}

/// Water of particles, with walls and blocks.
///
/// δ-SPH: Monaghan (1992) with the Wendland C2 function, density diffusion of Fourtakas et al. (2019), walls of
/// Adami, Hu & Adams (2012). Nothing here blocks: somebody must poll the device while a future is awaited.
#[derive(Debug)]
pub struct Particles {
    setup: Setup,
    frame: Frame,
    numbers: Numbers,
    /// Bodies in the order of the device, those with loads first, and the place of each in it.
    order: Vec<usize>,
    number: Vec<usize>,
    /// First particle of each shell in the order of the device, and one more.
    first: Vec<u32>,
    kernels: Kernels,
    clock: Clock,
    followed: Followed,
    works: Works,
    /// Whether the shells that never move are in their places.
    placed: bool,
    report: Option<wgpu::Buffer>,
    readback: Readback,
    steps: u64,
    /// Whether the next step sorts in any case.
    renewed: bool,
}

impl Particles {
    /// Water at rest or in motion: places (m), velocities (m/s) and pressures (Pa) of its particles at the time 0.
    ///
    /// # Errors
    /// [`Error::Scene`] if the setup or the water is not as it must be; [`Error::Limit`] of the device.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        setup: Setup,
        positions: &[DVec3],
        velocities: &[DVec3],
        pressures: &[f64],
    ) -> Result<Self> {
        let frame = Frame::new(&setup)?;
        if positions.len() != velocities.len() || positions.len() != pressures.len() {
            let message = "there must be a velocity and a pressure for each particle";
            return Err(Error::scene("water", message));
        }
        let too_many = |count: usize| {
            u32::try_from(count).map_err(|_| {
                let message = format!("{count} particles are too many; use a larger spacing");
                Error::scene("particles.spacing", message)
            })
        };
        let mut order: Vec<usize> = (0..setup.bodies.len()).collect();
        order.sort_by_key(|&body| !setup.bodies[body].loaded);
        let mut number = vec![0; order.len()];
        let mut first = vec![0];
        let (mut homes, mut loaded_shell) = (Vec::new(), 0);
        for (place, &body) in order.iter().enumerate() {
            number[body] = place;
            let shell = &setup.bodies[body].shell;
            homes.extend(shell.iter().map(|x| Home {
                place: frame.length(*x).as_vec3().to_array(),
                body: place as u32,
            }));
            first.push(too_many(homes.len())?);
            if setup.bodies[body].loaded {
                loaded_shell = first[place + 1];
            }
        }
        let numbers = Numbers {
            water: too_many(positions.len())?,
            shell: first[order.len()],
            loaded_shell,
            bodies: order.len() as u32,
            loaded: setup.bodies.iter().filter(|body| body.loaded).count() as u32,
        };
        let (hulls, planes) = hulls::hulls(&setup, &frame, &order);
        hulls::check(device, &hulls)?;
        if positions.is_empty() {
            let message = "there is no particle; give one at least, or leave the water out";
            return Err(Error::scene("water", message));
        }
        let kernels = Kernels::new(device, queue, &setup, &frame, numbers, (&hulls, &planes))?;
        let mut particles = Vec::with_capacity(positions.len().max(1));
        for (id, position) in positions.iter().enumerate() {
            let at = frame.place(*position);
            let (velocity, pressure) = (velocities[id], pressures[id]);
            let finite = position.is_finite()
                && frame.velocity(velocity).as_vec3().is_finite()
                && pressure.is_finite();
            if !(finite && frame.holds(at)) {
                return Err(Error::scene(
                    "water",
                    format!(
                        "particle {id} at {position} m with {velocity} m/s and {pressure} Pa is not in the domain, or \
                         not finite"
                    ),
                ));
            }
            setup.check_pressure(id, pressure)?;
            particles.push(Particle {
                at,
                id: id as u32,
                velocity: frame.velocity(velocity).as_vec3().to_array(),
                excess: setup.excess(pressure) as f32,
            });
        }
        // Room for one, that is nowhere.
        let nowhere = Particle {
            at: [-1; 3],
            ..Particle::default()
        };
        particles.resize(positions.len().max(1), nowhere);
        queue.write_buffer(&kernels.water.unsorted, 0, bytemuck::cast_slice(&particles));
        let shells: Vec<_> = (0..numbers.shell)
            .map(|id| Particle { id, ..nowhere })
            .collect();
        queue.write_buffer(&kernels.shell.sorted, 0, bytemuck::cast_slice(&shells));
        queue.write_buffer(&kernels.homes, 0, bytemuck::cast_slice(&homes));
        if homes.is_empty() {
            queue.write_buffer(&kernels.shell.unsorted, 0, bytemuck::bytes_of(&nowhere));
        }
        let fastest = velocities.iter().map(|v| v.length()).fold(0.0, f64::max);
        Ok(Self {
            clock: Clock {
                limit: first_limit(&setup, &frame, fastest),
                ..Clock::default()
            },
            followed: Followed::new(&setup.bodies),
            works: Works::default(),
            placed: false,
            report: None,
            readback: Readback::default(),
            steps: 0,
            renewed: true,
            setup,
            frame,
            numbers,
            order,
            number,
            first,
            kernels,
        })
    }

    /// The longest step (s) that the water allowed at last.
    pub fn limit(&self) -> f64 {
        f64::from(self.clock.limit) * self.frame.unit_time()
    }

    /// Lets the water run for `time` (s) beside bodies that are where `poses` has them and move on as they do, in as
    /// many steps as it wants.
    ///
    /// # Errors
    /// Those of [`Particles::begin`]; [`Error::ParticleLost`] if a particle is nowhere, or the water so fast that time
    /// stands still; [`Error::DeviceLost`].
    pub async fn advance(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        poses: &[Pose],
        time: f64,
    ) -> Result<Exchange> {
        self.begin(queue, poses, time)?;
        loop {
            let wanted = (f64::from(self.clock.left) / f64::from(self.clock.limit)).ceil();
            let batch = (wanted as u64).clamp(1, BATCH);
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
            if self.clock.crowd + self.clock.shell_crowd > 0 {
                self.make_room(device, queue)?;
                continue;
            }
            self.look()?;
            if self.clock.step == 0.0 {
                self.renewed = false;
                self.steps += u64::from(self.clock.steps);
                let done = self.exchange(bytemuck::cast_slice(sums), time);
                self.book(&done.loads, poses, time);
                return Ok(done);
            }
        }
    }

    /// Sets the time and the places of the bodies for an exchange of `time` (s), of which the steps are then
    /// recorded: [`Particles::advance`] does all of it.
    ///
    /// # Errors
    /// [`Error::Scene`] if there is not one pose for each body, one is not finite or leaves no volume, or the time is not
    /// greater than 0.
    pub fn begin(&mut self, queue: &wgpu::Queue, poses: &[Pose], time: f64) -> Result<()> {
        check_exchange(poses, self.setup.bodies.len(), time)?;
        // Rounding moves blocks out of a plane, and water there evades along y.
        let flat: Vec<Pose>;
        let poses = match self.setup.plane {
            true => {
                let middle = self.setup.origin.y + 0.5 * self.setup.size.y;
                flat = poses.iter().map(|pose| pose.in_plane(middle)).collect();
                &flat
            }
            false => poses,
        };
        let motions: Vec<Motion> = self
            .order
            .iter()
            .enumerate()
            .map(|(place, &body)| {
                let pose = &poses[body];
                let shell = [self.first[place], self.first[place + 1] - self.first[place]];
                let counts = self.setup.bodies[body].accelerates;
                let known = self.followed.acceleration(body, pose).filter(|_| counts);
                let (rate, change) = known.unwrap_or((DVec3::ZERO, DMat3::ZERO));
                let unit = self.frame.unit_time();
                Motion::of(
                    self.frame.place(pose.centre),
                    shell,
                    [
                        self.frame.velocity(pose.velocity),
                        self.frame.acceleration(rate),
                    ],
                    [
                        pose.deformation,
                        self.frame.rate(pose.deformation_rate),
                        change * (unit * unit),
                    ],
                    !self.setup.bodies[body].slips,
                )
            })
            .collect();
        queue.write_buffer(&self.kernels.motions, 0, bytemuck::cast_slice(&motions));
        let travel = f64::from(self.clock.travel) + self.followed.jump(poses) / self.setup.spacing;
        let stale = self.renewed || self.clock.stale != 0 || travel > self.frame.skin;
        let left = (time / self.frame.unit_time()) as f32;
        self.clock = Clock {
            step: left / (left / self.clock.limit).ceil().max(1.0),
            elapsed: 0.0,
            left,
            steps: 0,
            sorts: 0,
            pressed: 0.0,
            pushed: 0.0,
            stale: stale.into(),
            travel: if stale { 0.0 } else { travel as f32 },
            body_speed: (self.followed.fastest(poses) / self.frame.sound_speed()) as f32,
            ..self.clock
        };
        queue.write_buffer(&self.kernels.clock, 0, bytemuck::bytes_of(&self.clock));
        let none = vec![0.0f32; NUMBERS * self.numbers.loaded.max(1) as usize];
        queue.write_buffer(&self.kernels.loads, 0, bytemuck::cast_slice(&none));
        self.kernels.asked.begin(queue);
        self.followed.follow(poses, time);
        // Until it is known what the clock has come to.
        self.renewed = true;
        Ok(())
    }

    /// Has the next step sort the particles anew. Between two such calls their order, and with it the rounding of
    /// all sums, depends on what came before: a run and its restart have the same bits if both call this at the
    /// time of the checkpoint, as [`Particles::restore`] does.
    pub fn renew(&mut self) {
        self.renewed = true;
    }

    /// Makes the lists of neighbours longer and goes on with the step that waits for it.
    fn make_room(&mut self, device: &wgpu::Device, queue: &wgpu::Queue) -> Result<()> {
        let rooms = [self.clock.crowd, self.clock.shell_crowd].map(near::more_room);
        self.kernels
            .grow(device, queue, (&self.setup, &self.frame), rooms)?;
        (self.clock.crowd, self.clock.shell_crowd) = (0, 0);
        self.clock.step = self.clock.held;
        queue.write_buffer(&self.kernels.clock, 0, bytemuck::bytes_of(&self.clock));
        Ok(())
    }

    /// Records a step of the exchange into the caller's encoder; one that is over does nothing. A list of neighbours
    /// that has no room stops the exchange, which [`Particles::advance`] mends; with [`Neighbours::Cells`] there are no lists.
    ///
    /// [`Neighbours::Cells`]: super::Neighbours::Cells
    pub fn record(&mut self, encoder: &mut wgpu::CommandEncoder) {
        let moves = self.setup.bodies.iter().any(|body| body.moves);
        if moves || !self.placed {
            self.kernels.record_shells(encoder);
            self.placed = true;
        }
        self.kernels.record_step(encoder);
    }

    /// Sets the places (m) in the water where the exchanges to come say what its pressure was, beside loads: those in
    /// water, then those on walls, each with the share of the kernel that water in front of it covers: less of it presses
    /// less.
    ///
    /// # Errors
    /// [`Error::Scene`] if a place is not finite; [`Error::Limit`] if the device has no room for so many.
    pub fn ask(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        places: &[DVec3],
        walls: &[(DVec3, f64)],
    ) -> Result<()> {
        let mut all = places.iter().chain(walls.iter().map(|(x, _)| x));
        if let Some(bad) = all.position(|x| !x.is_finite()) {
            let message = "is not finite; give a place in m";
            return Err(Error::scene(format!("places[{bad}]"), message));
        }
        let place = |(x, most): (DVec3, f32)| {
            let [x, y, z] = self.frame.place(x);
            [x, y, z, most.to_bits().cast_signed()]
        };
        let walls = walls.iter().map(|(x, share)| (*x, share.recip() as f32));
        let places = places.iter().map(|x| (*x, 0.0)).chain(walls);
        let places: Vec<_> = places.map(place).collect();
        self.kernels.ask(device, queue, &places)
    }

    /// Records the way of clock, loads and pressures to the host.
    fn report(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
    ) -> wgpu::Buffer {
        let clock = size_of::<Clock>() as u64;
        let loads = 4 * (NUMBERS * self.numbers.loaded as usize) as u64;
        let asked = &self.kernels.asked;
        let pressures = asked.pressures();
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

    /// Whether all particles are somewhere and time goes on.
    fn look(&self) -> Result<()> {
        let shortest = SHORTEST * (self.setup.acoustic_step() / self.frame.unit_time()) as f32;
        let (cause, id) = match self.clock {
            Clock {
                fault: 0, limit, ..
            } if limit >= shortest => return Ok(()),
            Clock {
                fault: 0, limit, ..
            } => (
                format!(
                    "water is so fast that a step would be {:.2e} s",
                    f64::from(limit) * self.frame.unit_time()
                ),
                None,
            ),
            Clock { fault, .. } => (
                "its density or velocity is not a number".to_owned(),
                Some(fault - 1),
            ),
        };
        Err(Error::ParticleLost {
            particle: id,
            step: self.steps + u64::from(self.clock.steps),
            cause,
            remedy: "give particles.largest_speed the speed that water really reaches, or use a smaller \
                     particles.courant; look for water that is squeezed between blocks"
                .into(),
        })
    }

    fn exchange(&self, sums: &[f32], time: f64) -> Exchange {
        let unit = time / self.frame.unit_time();
        let (loads, pressures) = sums.split_at(NUMBERS * self.numbers.loaded as usize);
        let load = |&place: &usize| match loads.get(place * NUMBERS..(place + 1) * NUMBERS) {
            Some(numbers) if self.setup.plane => self.frame.load(numbers, unit).in_plane(),
            Some(numbers) => self.frame.load(numbers, unit),
            None => Load::default(),
        };
        let asked = pressures.iter().take(self.kernels.asked.count());
        Exchange {
            loads: self.number.iter().map(load).collect(),
            pressures: asked.map(|sum| self.frame.pressure(*sum, unit)).collect(),
            steps: self.clock.steps,
            sorts: self.clock.sorts,
        }
    }

    /// Books the works of an exchange of `time` (s).
    fn book(&mut self, loads: &[Load], poses: &[Pose], time: f64) {
        let moving = self.setup.bodies.iter().zip(loads.iter().zip(poses));
        let moving = moving.filter(|(body, _)| body.moves);
        self.works.bodies += moving
            .map(|(_, (load, pose))| -load.work(pose, &pose.after(time)))
            .sum::<f64>();
        self.works.pushed += self.frame.work(self.clock.pushed);
        self.works.pressed += self.frame.work(self.clock.pressed);
    }

    /// What was done to the water in the exchanges of [`Particles::advance`] since the start.
    pub fn works(&self) -> Works {
        self.works
    }

    /// The water as it is.
    ///
    /// # Errors
    /// [`Error::DeviceLost`].
    pub async fn water(&mut self, device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Water> {
        let particles = self.particles(device, queue).await?;
        Ok(Water::of(&self.setup, &self.frame, &particles))
    }

    /// The particles in the units and the order of the device, those that have left among them by their ids.
    ///
    /// # Errors
    /// [`Error::DeviceLost`].
    pub async fn particles(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
    ) -> Result<Vec<Particle>> {
        let count = self.numbers.water as usize;
        let buffer = &self.kernels.water.unsorted;
        let mut particles = self.readback.read(device, queue, buffer, count).await?;
        order_those_left(&mut particles);
        Ok(particles)
    }

    /// What [`Particles::restore`] wants besides the particles.
    pub fn state(&self) -> State {
        State {
            limit: self.clock.limit,
            escaped: self.clock.escaped,
            steps: self.steps,
            lasted: self.followed.lasted,
            before: self.followed.before.clone(),
            works: self.works,
        }
    }

    /// Whether particles are as many as these.
    ///
    /// # Errors
    /// [`Error::Scene`] if not.
    pub fn check(&self, particles: &[Particle]) -> Result<()> {
        if particles.len() == self.numbers.water as usize {
            return Ok(());
        }
        Err(Error::scene(
            "restart",
            format!(
                "the checkpoint has {} particles and the scene {}; restart with the scene that wrote it",
                particles.len(),
                self.numbers.water
            ),
        ))
    }

    /// Goes back to a state of this water, to the same bits.
    ///
    /// # Errors
    /// If it is of another number of particles.
    pub fn restore(
        &mut self,
        queue: &wgpu::Queue,
        particles: &[Particle],
        state: &State,
    ) -> Result<()> {
        self.check(particles)?;
        let bytes = bytemuck::cast_slice(particles);
        queue.write_buffer(&self.kernels.water.unsorted, 0, bytes);
        self.clock = Clock {
            limit: state.limit,
            escaped: state.escaped,
            // Nobody meets those that had left.
            missed: state.escaped,
            ..Clock::default()
        };
        self.steps = state.steps;
        self.followed = self.followed.restored(&state.before, state.lasted);
        self.works = state.works;
        self.placed = false;
        self.renewed = true;
        Ok(())
    }

    /// The [`Particle`]s on the device, in no order; what has left has a negative place.
    pub fn buffer(&self) -> &wgpu::Buffer {
        &self.kernels.water.unsorted
    }

    /// Their [`Clock`] on the device.
    pub fn clock(&self) -> &wgpu::Buffer {
        &self.kernels.clock
    }

    /// The setup.
    pub fn setup(&self) -> &Setup {
        &self.setup
    }

    /// Cells and units.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Numbers of particles and bodies.
    pub fn numbers(&self) -> Numbers {
        self.numbers
    }

    /// Particles that have left the domain.
    pub fn escaped(&self) -> u32 {
        self.clock.escaped
    }

    /// The highest speed of the water at the end of any step since the start or the restart, m/s.
    pub fn fastest(&self) -> f64 {
        f64::from(self.clock.fastest) * self.frame.sound_speed()
    }

    /// Steps of the water since the start.
    pub fn steps(&self) -> u64 {
        self.steps
    }
}

/// The longest first step, of water that is pushed by gravity alone and moves at `fastest` (m/s), in units of the
/// device.
fn first_limit(setup: &Setup, frame: &Frame, fastest: f64) -> f32 {
    let h = setup.smoothing;
    let by_force = (h / frame.acceleration(setup.gravity).length().max(1e-30)).sqrt();
    let by_sound = h / (10.0 * fastest / setup.sound_speed).max(1.0);
    let by_friction = setup.friction_step() / frame.unit_time();
    (setup.courant * by_force.min(by_sound)).min(by_friction) as f32
}
