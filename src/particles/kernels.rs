//! The kernels of a step and the memory that they share.

use super::{
    Clock, Frame, Home, Hull, Motion, Neighbours, Scheme, Setup, Shelter,
    asked::Asked,
    loads::{Loads, starts},
    near::{Names, Near, shell_room, usual_room},
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
/// The kernels that meet pairs.
const OF_SHELL: Names = ["shell_neighbours", "shell_pressure", "shell_force"];
const OF_DELTA: Names = ["neighbours", "accelerate", "drift"];
const OF_MUELLER: Names = ["neighbours", "mueller_density", "mueller_move"];
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
    near: Near,
    near_shell: Near,
    /// The gate that lists must pass, if there are any.
    admit: Option<(Kernel, wgpu::BindGroup)>,
    load: Loads,
    pub asked: Asked,
    /// `keep_out`, where walls are shells.
    keep_out: Option<(Kernel, wgpu::BindGroup)>,
    /// `mueller_drift`, where the sums leave the places to it.
    last: Option<(Kernel, wgpu::BindGroup)>,
    /// All by the names of their bindings.
    buffers: Vec<(&'static str, wgpu::Buffer)>,
    /// From many limits to one, with the number of those that come out.
    leasts: Vec<(Kernel, wgpu::BindGroup, u32)>,
    tick: (Kernel, wgpu::BindGroup),
}

/// What to change where particles do not fit.
pub(super) const FEWER_PARTICLES: &str = "use a larger spacing, less water, or another adapter";

impl Kernels {
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        setup: &Setup,
        frame: &Frame,
        numbers: Numbers,
        (hulls, planes): (&[Hull], &[[f32; 4]]),
    ) -> Result<Self> {
        let buffer = |label, count: u32, one: usize| {
            let bytes = u64::from(count.max(1)) * one as u64;
            at_most(device, label, bytes, FEWER_PARTICLES)?;
            Ok::<_, crate::Error>(storage(device, label, bytes))
        };
        let homes = buffer("homes of shells", numbers.shell, size_of::<Home>())?;
        let motions = buffer("motions of bodies", numbers.bodies, size_of::<Motion>())?;
        let forces = buffer("forces on shells", numbers.loaded_shell, 16)?;
        let loads = buffer("loads of bodies", numbers.loaded, 4 * NUMBERS)?;
        let fresh = buffer("velocities", numbers.water, 16)?;
        let shelter = buffer(
            "particles beside shells",
            numbers.water,
            size_of::<Shelter>(),
        )?;
        let viscous = setup.laminar_viscosity > 0.0;
        let clinging = buffer(
            "velocities of shells",
            numbers.shell * u32::from(viscous),
            16,
        )?;
        let clock = buffer("clock", 1, size_of::<Clock>())?;
        let sorting = Sorting::new(device, setup, frame)?;
        let water = sorting.of(device, frame, &clock, numbers.water)?;
        let shell = sorting.of(device, frame, &clock, numbers.shell)?;
        let hull_buffer = buffer("hulls", hulls.len() as u32, size_of::<Hull>())?;
        let plane_buffer = buffer("faces of hulls", planes.len() as u32, 16)?;
        queue.write_buffer(&hull_buffer, 0, bytemuck::cast_slice(hulls));
        queue.write_buffer(&plane_buffer, 0, bytemuck::cast_slice(planes));
        let hull_starts = buffer("hulls of bodies", numbers.bodies + 1, 4)?;
        let of_bodies = starts(hulls, numbers.bodies);
        queue.write_buffer(&hull_starts, 0, bytemuck::cast_slice(&of_bodies));
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
            ("hull_starts", &hull_starts),
            ("planes", &plane_buffer),
            ("shelter", &shelter),
            ("clinging", &clinging),
            ("clinging_out", &clinging),
        ];
        let bound = |name: &str| {
            let kernel = kernel(name)?;
            let bind = kernel.bind(device, &buffers)?;
            Ok::<_, crate::Error>((kernel, bind))
        };
        let (of_water, load, last) = match setup.scheme {
            Scheme::Delta => {
                let kernel = kernel("body_load")?;
                let load = Loads::of_shells(device, kernel, &buffers)?;
                (OF_DELTA, load, None)
            }
            Scheme::Mueller { .. } => {
                let kernel = kernel("mueller_load")?;
                let all = (numbers, hulls);
                let load = Loads::of_hulls(device, queue, kernel, all, &buffers)?;
                (OF_MUELLER, load, Some("mueller_drift"))
            }
        };
        let near = |names, count, room| {
            Near::new(
                device,
                queue,
                (setup, frame),
                names,
                (count, room),
                &buffers,
            )
        };
        let near_shell = near(OF_SHELL, numbers.shell, shell_room(setup, frame))?;
        let near = near(of_water, numbers.water, usual_room(setup, frame))?;
        let admit = match setup.neighbours {
            Neighbours::Cells => None,
            Neighbours::Lists => Some(bound("admit")?),
        };
        let keep_out = match setup.scheme {
            Scheme::Delta => Some(bound("keep_out")?),
            Scheme::Mueller { .. } => None,
        };
        let (mut limits, mut count, mut leasts) = (fresh.clone(), numbers.water.max(1), Vec::new());
        while leasts.is_empty() || count > 1 {
            let least = kernel(match leasts.is_empty() {
                true => "least_of_water",
                false => "least",
            })?;
            count = count.div_ceil(RUN);
            let fewer = buffer("limits of runs", count, 16)?;
            let names = [
                ("fresh", &fresh),
                ("shelter", &shelter),
                ("limits", &limits),
                ("run_limits", &fewer),
            ];
            let bound = least.bind(device, &names)?;
            leasts.push((least, bound, count));
            limits = fewer;
        }
        let tick = kernel("tick")?;
        let tick_bound = tick.bind(device, &[("limits", &limits), ("clock", &clock)])?;
        Ok(Self {
            numbers,
            place: bound("shell_place")?,
            load,
            asked: Asked::new(kernel("pressure_at")?),
            last: last.map(bound).transpose()?,
            near,
            near_shell,
            admit,
            keep_out,
            buffers: buffers.map(|(name, of)| (name, of.clone())).to_vec(),
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

    /// Makes the lists of neighbours longer: those of the water, of shells, or both, to the rooms that are not 0.
    pub fn grow(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        (setup, frame): (&Setup, &Frame),
        [water, shell]: [u32; 2],
    ) -> Result<()> {
        let buffers: Vec<_> = self.buffers.iter().map(|(name, of)| (*name, of)).collect();
        let of_water = match setup.scheme {
            Scheme::Delta => OF_DELTA,
            Scheme::Mueller { .. } => OF_MUELLER,
        };
        let near = |names, count, room| {
            Near::new(
                device,
                queue,
                (setup, frame),
                names,
                (count, room),
                &buffers,
            )
        };
        if water > 0 {
            self.near = near(of_water, self.numbers.water, water)?;
        }
        if shell > 0 {
            self.near_shell = near(OF_SHELL, self.numbers.shell, shell)?;
        }
        Ok(())
    }

    /// Sets the places that are asked about, quanta.
    pub fn ask(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        places: &[[i32; 4]],
    ) -> Result<()> {
        let buffers: Vec<_> = self.buffers.iter().map(|(name, of)| (*name, of)).collect();
        self.asked.ask(device, queue, places, &buffers)
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
        self.near.record_lists(&mut pass);
        self.near_shell.record_lists(&mut pass);
        if let Some((kernel, bind)) = &self.admit {
            kernel.record(&mut pass, bind, 1);
        }
        self.near_shell.record_first(&mut pass);
        self.near.record_first(&mut pass);
        let water = self.numbers.water.div_ceil(WORKGROUP);
        if let Some((kernel, bind)) = &self.keep_out {
            kernel.record(&mut pass, bind, water);
        }
        if self.numbers.loaded > 0 {
            self.near_shell.record_second(&mut pass);
            self.load.record(&mut pass, self.numbers.loaded);
        }
        self.asked.record(&mut pass);
        self.near.record_second(&mut pass);
        if let Some((kernel, bind)) = &self.last {
            kernel.record(&mut pass, bind, water);
        }
        for (least, bind, count) in &self.leasts {
            least.record(&mut pass, bind, count.div_ceil(WORKGROUP));
        }
        self.tick.0.record(&mut pass, &self.tick.1, 1);
    }
}
