//! The device of a validation, and a flow that runs on it.

use super::record::{Trial, describe};
use crate::gpu;
use kit::clock::{PATIENCE, Spent, Stopwatch};
use riprap::{
    gpu::{kernel::submit_pass, readback::Readback},
    lattice::{Derived, Fault, Lattice, Observer, Populations, Setup, State, Sums, WallStress},
    wgpu,
};
use std::time::Instant;

/// Cell updates in one submission: under a second on a CPU, several milliseconds on a GPU.
pub const SUBMISSION: u64 = 20_000_000;
/// Steps at the start of a run that are not timed: drivers compile at the first dispatch, boundaries begin with the second step,
/// and even and odd steps have kernels of their own.
pub const WARM_UP: u64 = 4;

/// The device on which the cases run, and their options.
#[derive(Debug)]
pub struct CaseContext {
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// Whether the adapter computes on the CPU.
    pub software: bool,
    /// Whether to run the long form of the cases.
    pub full: bool,
}

impl CaseContext {
    /// Opens the adapter whose description contains `name`, or the first one, with all its limits.
    pub fn open(name: Option<&str>, full: bool) -> anyhow::Result<Self> {
        let adapter = gpu::pick(name)?;
        let info = adapter.get_info();
        let wide = adapter.features() & wgpu::Features::SHADER_INT64;
        println!("on {}", gpu::describe(&info));
        let (device, queue) = gpu::open(&adapter, wide, adapter.limits())?;
        Ok(Self {
            full,
            ..Self::on(&device, &queue)
        })
    }

    /// The short form on an open device.
    pub fn on(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        Self {
            device: device.clone(),
            queue: queue.clone(),
            software: gpu::is_software(&device.adapter_info()),
            full: false,
        }
    }

    /// A periodic box with the library's defaults and the lanes and bricks that suit the adapter.
    pub fn setup(&self, cells: [u32; 3], nu: f64) -> Setup {
        let mut setup = Setup::periodic(cells, nu);
        if self.software {
            setup.use_cpu_layout(self.device.features());
            if cells[2].is_multiple_of(4) {
                setup.lanes = 4;
            }
        } else {
            setup.use_gpu_layout();
        }
        setup
    }

    /// A flow that starts from a state; with `non_equilibrium`, its viscous stress is included.
    pub fn flow(
        &self,
        setup: Setup,
        state: &State,
        non_equilibrium: bool,
    ) -> anyhow::Result<Flow<'_>> {
        let mut flow = self.still(setup)?;
        flow.lattice
            .start(&self.device, &self.queue, state, non_equilibrium)?;
        Ok(flow)
    }

    /// A flow that continues from populations.
    pub fn resumed(&self, setup: Setup, populations: &Populations) -> anyhow::Result<Flow<'_>> {
        let mut flow = self.still(setup)?;
        flow.lattice
            .set_populations(&self.device, &self.queue, populations)?;
        Ok(flow)
    }

    fn still(&self, setup: Setup) -> anyhow::Result<Flow<'_>> {
        let lattice = Lattice::new(&self.device, setup)?;
        Ok(Flow {
            context: self,
            lattice,
            observer: None,
            seconds: 0.0,
            stepping: Spent::default(),
        })
    }

    /// Waits for a future, at most as long as a device may be silent.
    pub fn drive<T>(&self, what: &str, future: impl Future<Output = T>) -> riprap::Result<T> {
        gpu::drive(&self.device, PATIENCE, what, future)
    }
}

/// A running lattice, with the time spent on it.
///
/// Its methods return an error if the device is lost or silent, and those that run steps if the flow leaves the range of
/// the method.
#[derive(Debug)]
pub struct Flow<'a> {
    context: &'a CaseContext,
    lattice: Lattice,
    /// Created on first use.
    observer: Option<Observer>,
    seconds: f64,
    stepping: Spent,
}

impl Flow<'_> {
    /// Setup and cost of the run so far.
    pub fn trial(&self) -> Trial {
        Trial {
            setup: describe(self.lattice.setup()),
            cells: self.lattice.grid().cell_count() as u64,
            steps: self.lattice.step(),
            seconds: self.seconds,
            stepping: self.stepping,
        }
    }

    /// Runs steps until they are done or the guard finds a fault.
    pub fn try_advance(&mut self, steps: u64) -> anyhow::Result<Option<Fault>> {
        let begin = Instant::now();
        let cells = self.lattice.grid().cell_count() as u64;
        let chunk = (SUBMISSION / cells).clamp(1, 512);
        let (device, queue) = (&self.context.device, &self.context.queue);
        let end = self.lattice.step() + steps;
        let mut fault = None;
        while fault.is_none() && self.lattice.step() < end {
            let warm = self.lattice.step() >= WARM_UP;
            let most = if warm { chunk } else { WARM_UP };
            let some = most.min(end - self.lattice.step());
            let watch = Stopwatch::start();
            submit_pass(device, queue, |pass| {
                (0..some).for_each(|_| self.lattice.record(pass));
            });
            fault = self.fault()?;
            if warm {
                self.stepping += watch.spent();
            }
        }
        self.seconds += begin.elapsed().as_secs_f64();
        Ok(fault)
    }

    /// Runs steps.
    pub fn advance(&mut self, steps: u64) -> anyhow::Result<()> {
        match self.try_advance(steps)? {
            None => Ok(()),
            Some(Fault { step, cell }) => {
                let setup = describe(self.lattice.setup());
                anyhow::bail!("diverged at step {step} in cell {cell:?}: {setup}")
            }
        }
    }

    fn observer(&mut self) -> riprap::Result<(&mut Observer, &mut Lattice, &CaseContext)> {
        let observer = match self.observer.take() {
            Some(made) => made,
            None => Observer::new(&self.context.device, &self.lattice)?,
        };
        let observer = self.observer.insert(observer);
        Ok((observer, &mut self.lattice, self.context))
    }

    /// The fault that the guard found, if any; also waits for all submitted work.
    fn fault(&mut self) -> riprap::Result<Option<Fault>> {
        let (observer, lattice, context) = self.observer()?;
        let future = observer.fault(&context.device, &context.queue, lattice);
        context.drive("a validation case", future)?
    }

    /// Density and velocity, lattice units.
    pub fn state(&mut self) -> anyhow::Result<State> {
        let begin = Instant::now();
        let (observer, lattice, context) = self.observer()?;
        let future = observer.state(&context.device, &context.queue, lattice);
        let state = context.drive("reading a state", future)??;
        self.seconds += begin.elapsed().as_secs_f64();
        Ok(state)
    }

    /// Sets the velocities of the cells of the velocity face x−.
    pub fn set_inlet(&mut self, velocity: Vec<[f32; 3]>) -> anyhow::Result<()> {
        let lattice = &mut self.lattice;
        Ok(lattice.set_face_velocity(&self.context.queue, 0, 0, velocity)?)
    }

    /// Velocities of moving faces in the last step, nine values per cell.
    pub fn wall_velocities(&mut self) -> anyhow::Result<Vec<f32>> {
        let Some(buffer) = self.lattice.wall_velocity_buffer() else {
            return Ok(Vec::new());
        };
        let context = self.context;
        let mut readback = Readback::default();
        let read = readback.read(
            &context.device,
            &context.queue,
            buffer,
            (buffer.size() / 4) as usize,
        );
        Ok(context.drive("velocities of faces", read)??)
    }

    /// Stresses on the walls of a wall model in the last step, lattice units.
    pub fn wall_stresses(&mut self) -> anyhow::Result<Vec<WallStress>> {
        let context = self.context;
        let future = self.lattice.wall_stresses(&context.device, &context.queue);
        Ok(context.drive("reading wall stresses", future)??)
    }

    /// A field derived from the velocity gradient, lattice units.
    pub fn derived(&mut self, quantity: Derived) -> anyhow::Result<Vec<f32>> {
        let (observer, lattice, context) = self.observer()?;
        let future = observer.derived(&context.device, &context.queue, lattice, quantity);
        Ok(context.drive("reading a field", future)??)
    }

    /// Sums over the fluid, lattice units.
    pub fn sums(&mut self) -> anyhow::Result<Sums> {
        let (observer, lattice, context) = self.observer()?;
        let future = observer.sums(&context.device, &context.queue, lattice);
        Ok(context.drive("reading sums", future)??)
    }

    /// The populations in canonical order.
    pub fn populations(&mut self) -> anyhow::Result<Populations> {
        let context = self.context;
        let future = self.lattice.populations(&context.device, &context.queue);
        Ok(context.drive("reading populations", future)??)
    }
}
