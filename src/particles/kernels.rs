//! The kernels of a step and the memory that they share.

use super::{
    Clock, Frame, Home, Hull, Motion, Scheme, Setup,
    near::{Near, usual_room},
    program,
    sorting::{Sorted, Sorting},
};
use crate::{
    Result,
    kernel::Kernel,
    search::{WORKGROUP, at_most, storage},
};

/// Limits of which an invocation takes the least.
const RUN: u32 = 64;
/// Numbers of a load.
pub(super) const NUMBERS: usize = 12;

/// Numbers of particles and bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Numbers {
    /// Particles of water, those that have left included.
    pub water: u32,
    /// Particles of shells.
    pub shell: u32,
    /// Of them those of bodies with loads, which come first.
    pub loaded_shell: u32,
    /// Bodies.
    pub bodies: u32,
    /// Bodies with loads, which come first.
    pub loaded: u32,
}

/// All that is on the device.
#[derive(Debug)]
pub(super) struct Kernels {
    numbers: Numbers,
    sorting: Sorting,
    pub water: Sorted,
    pub shell: Sorted,
    pub homes: wgpu::Buffer,
    pub motions: wgpu::Buffer,
    pub loads: wgpu::Buffer,
    pub clock: wgpu::Buffer,
    place: (Kernel, wgpu::BindGroup),
    pressure: (Kernel, wgpu::BindGroup),
    near: Near,
    fresh: wgpu::Buffer,
    force: (Kernel, wgpu::BindGroup),
    load: (Kernel, wgpu::BindGroup),
    /// `mueller_drift`, where the sums leave the places to it.
    last: Option<(Kernel, wgpu::BindGroup)>,
    hulls: [wgpu::Buffer; 2],
    least: Kernel,
    /// From many limits to one, with the number of those that come out.
    leasts: Vec<(wgpu::BindGroup, u32)>,
    tick: (Kernel, wgpu::BindGroup),
}

impl Kernels {
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        setup: &Setup,
        frame: &Frame,
        numbers: Numbers,
        (hulls, planes): (&[Hull], &[[f32; 4]]),
    ) -> Result<Self> {
        let sorting = Sorting::new(device, setup, frame)?;
        let water = sorting.of(device, frame, numbers.water)?;
        let shell = sorting.of(device, frame, numbers.shell)?;
        let buffer = |label, count: u32, one: usize| {
            let bytes = u64::from(count.max(1)) * one as u64;
            at_most(device, label, bytes)?;
            Ok::<_, crate::Error>(storage(device, label, bytes))
        };
        let homes = buffer("homes of shells", numbers.shell, size_of::<Home>())?;
        let motions = buffer("motions of bodies", numbers.bodies, size_of::<Motion>())?;
        let forces = buffer("forces on shells", numbers.loaded_shell, 16)?;
        let loads = buffer("loads of bodies", numbers.loaded, 4 * NUMBERS)?;
        let fresh = buffer("velocities", numbers.water, 16)?;
        let clock = buffer("clock", 1, size_of::<Clock>())?;
        let hull_buffer = buffer("hulls", hulls.len() as u32, size_of::<Hull>())?;
        let plane_buffer = buffer("faces of hulls", planes.len() as u32, 16)?;
        queue.write_buffer(&hull_buffer, 0, bytemuck::cast_slice(hulls));
        queue.write_buffer(&plane_buffer, 0, bytemuck::cast_slice(planes));
        let constants = program::constants(setup, frame);
        let kernel = |name: &str| {
            let linked = program::program(setup, frame, name).link()?;
            Kernel::new(device, &linked, name, &constants)
        };
        let buffers = [
            ("particles", &water.sorted),
            ("starts", &water.starts),
            ("shell", &shell.sorted),
            ("shell_starts", &shell.starts),
            ("homes", &homes),
            ("motions", &motions),
            ("clock", &clock),
            ("fresh", &fresh),
            ("moved", &water.unsorted),
            ("unsorted", &shell.unsorted),
            ("forces", &forces),
            ("loads", &loads),
            ("hulls", &hull_buffer),
            ("planes", &plane_buffer),
        ];
        let bound = |name: &str| {
            let kernel = kernel(name)?;
            let bind = kernel.bind(device, &buffers)?;
            Ok::<_, crate::Error>((kernel, bind))
        };
        let (load, last) = match setup.scheme {
            Scheme::Delta => ("body_load", None),
            Scheme::Mueller { .. } => ("mueller_load", Some("mueller_drift")),
        };
        let room = usual_room(setup);
        let near = Near::new(device, queue, (setup, frame), numbers.water, room, &buffers)?;
        let least = kernel("least")?;
        let (mut limits, mut count, mut leasts) = (fresh.clone(), numbers.water.max(1), Vec::new());
        while count > 1 {
            count = count.div_ceil(RUN);
            let fewer = buffer("limits of runs", count, 16)?;
            let names = [("limits", &limits), ("run_limits", &fewer)];
            leasts.push((least.bind(device, &names)?, count));
            limits = fewer;
        }
        let tick = kernel("tick")?;
        let tick_bound = tick.bind(device, &[("limits", &limits), ("clock", &clock)])?;
        Ok(Self {
            numbers,
            place: bound("shell_place")?,
            pressure: bound("shell_pressure")?,
            force: bound("shell_force")?,
            load: bound(load)?,
            last: last.map(bound).transpose()?,
            near,
            fresh,
            hulls: [hull_buffer, plane_buffer],
            least,
            leasts,
            tick: (tick, tick_bound),
            sorting,
            water,
            shell,
            homes,
            motions,
            loads,
            clock,
        })
    }

    /// Makes the lists of neighbours longer.
    pub fn grow(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        (setup, frame): (&Setup, &Frame),
        capacity: u32,
    ) -> Result<()> {
        let buffers = [
            ("particles", &self.water.sorted),
            ("starts", &self.water.starts),
            ("shell", &self.shell.sorted),
            ("shell_starts", &self.shell.starts),
            ("clock", &self.clock),
            ("fresh", &self.fresh),
            ("moved", &self.water.unsorted),
            ("motions", &self.motions),
            ("hulls", &self.hulls[0]),
            ("planes", &self.hulls[1]),
        ];
        let count = self.numbers.water;
        self.near = Near::new(device, queue, (setup, frame), count, capacity, &buffers)?;
        Ok(())
    }

    /// Records where the shells are.
    pub fn record_shells(&self, encoder: &mut wgpu::CommandEncoder) {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        let groups = self.numbers.shell.div_ceil(WORKGROUP);
        self.place.0.record(&mut pass, &self.place.1, groups);
        drop(pass);
        self.sorting.record(encoder, &self.shell);
    }

    /// Records a step of the water, its shells in place.
    pub fn record_step(&self, encoder: &mut wgpu::CommandEncoder) {
        self.sorting.record(encoder, &self.water);
        let mut pass = encoder.begin_compute_pass(&Default::default());
        let shell = self.numbers.shell.div_ceil(WORKGROUP);
        self.pressure.0.record(&mut pass, &self.pressure.1, shell);
        self.near.record_first(&mut pass);
        if self.numbers.loaded > 0 {
            self.force.0.record(&mut pass, &self.force.1, shell);
            let bodies = self.numbers.loaded;
            self.load.0.record(&mut pass, &self.load.1, bodies);
        }
        self.near.record_second(&mut pass);
        if let Some((kernel, bind)) = &self.last {
            let water = self.numbers.water.div_ceil(WORKGROUP);
            kernel.record(&mut pass, bind, water);
        }
        for (bind, count) in &self.leasts {
            self.least
                .record(&mut pass, bind, count.div_ceil(WORKGROUP));
        }
        self.tick.0.record(&mut pass, &self.tick.1, 1);
    }
}
