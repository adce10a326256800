//! The kernels of a step and their shared buffers.

use super::{
    BodyMotion, CellGrid, Clock, CountingSort, Hull, NeighbourSearch, ReferencePosition, Scheme,
    Setup, SortedParticles, WallWork,
    bodies::{BodyLoads, HullSet, hull_starts},
    neighbour_lists::{NeighbourLists, PairKernels, PairPasses, boundary_capacity, fluid_capacity},
    probes::PressureProbes,
    program,
};
use crate::{
    Result,
    gpu::{
        bins::{WORKGROUP, at_most},
        buffers::zeroed,
        kernel::Kernel,
    },
};

/// Number of step limits that one invocation reduces.
const REDUCTION_WIDTH: u32 = 64;
const BOUNDARY_KERNELS: PairKernels = PairKernels {
    lists: "boundary_neighbour_lists",
    first: "boundary_pressure",
    second: "boundary_force",
};
const DELTA_KERNELS: PairKernels = PairKernels {
    lists: "neighbour_lists",
    first: "accelerate",
    second: "drift",
};
const MUELLER_KERNELS: PairKernels = PairKernels {
    lists: "neighbour_lists",
    first: "mueller_density",
    second: "mueller_accelerate",
};
/// Components of a load: force, and the sum of f ⊗ r.
pub(super) const LOAD_LEN: usize = 12;

/// Numbers of particles and bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Fluid particles, escaped ones included.
    pub fluid: u32,
    /// Boundary particles.
    pub boundary: u32,
    /// Boundary particles of bodies with loads, which come first.
    pub loaded_boundary: u32,
    /// Bodies.
    pub bodies: u32,
    /// Bodies with loads, which come first.
    pub loaded_bodies: u32,
}

/// A kernel with its bind group.
type Bound = (Kernel, wgpu::BindGroup);

/// The kernels with their bind groups and buffers.
#[derive(Debug)]
pub(super) struct Kernels {
    counts: Counts,
    sorting: CountingSort,
    pub fluid: SortedParticles,
    pub boundary: SortedParticles,
    pub reference_positions: wgpu::Buffer,
    pub strain_areas: wgpu::Buffer,
    pub motions: wgpu::Buffer,
    pub loads: wgpu::Buffer,
    pub clock: wgpu::Buffer,
    boundary_position: Bound,
    fluid_pairs: NeighbourLists,
    boundary_pairs: NeighbourLists,
    /// `None` with [`NeighbourSearch::Cells`].
    check_capacity: Option<Bound>,
    body_loads: BodyLoads,
    pub probes: PressureProbes,
    /// `apply_penalty`; `None` for the scheme without boundary particles.
    apply_penalty: Option<Bound>,
    /// `mueller_drift`; the scheme with boundary particles updates the positions in its second sum.
    mueller_drift: Option<Bound>,
    /// All buffers by the names of their bindings.
    buffers: Vec<(&'static str, wgpu::Buffer)>,
    /// The stages of the reduction of step limits to one, each with the number of its results.
    reduction: Vec<(Kernel, wgpu::BindGroup, u32)>,
    advance_clock: Bound,
}

/// Remedy if the particles do not fit on the device.
pub(super) const FEWER_PARTICLES: &str = "use a larger spacing, less water, or another adapter";

impl Kernels {
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        setup: &Setup,
        grid: &CellGrid,
        counts: Counts,
        hull_set: &HullSet,
    ) -> Result<Self> {
        let HullSet { hulls, planes } = hull_set;
        let buffer = |label, count: u32, one: usize| {
            let bytes = u64::from(count.max(1)) * one as u64;
            at_most(device, label, bytes, FEWER_PARTICLES)?;
            Ok::<_, crate::Error>(zeroed(device, label, bytes))
        };
        let reference_positions = buffer(
            "reference positions of boundary particles",
            counts.boundary,
            size_of::<ReferencePosition>(),
        )?;
        let strained = counts.loaded_boundary * u32::from(setup.deforms());
        let strain_areas = buffer("areas of boundary particles", strained, 48)?;
        let motions = buffer("motions of bodies", counts.bodies, size_of::<BodyMotion>())?;
        let forces = buffer("forces on boundary particles", counts.loaded_boundary, 16)?;
        let loads = buffer("loads of bodies", counts.loaded_bodies, 4 * LOAD_LEN)?;
        let new_velocities = buffer("new velocities", counts.fluid, 16)?;
        let wall_work = buffer("work of walls", counts.fluid, size_of::<WallWork>())?;
        let viscous = setup.laminar_viscosity > 0.0;
        let wall_velocities = buffer(
            "velocities of boundary particles",
            counts.boundary * u32::from(viscous),
            16,
        )?;
        let clock = buffer("clock", 1, size_of::<Clock>())?;
        let sorting = CountingSort::new(device, setup, grid)?;
        let fluid = sorting.buffers(device, grid, &clock, counts.fluid)?;
        let boundary = sorting.buffers(device, grid, &clock, counts.boundary)?;
        let hull_buffer = buffer("hulls", hulls.len() as u32, size_of::<Hull>())?;
        let plane_buffer = buffer("faces of hulls", planes.len() as u32, 16)?;
        queue.write_buffer(&hull_buffer, 0, bytemuck::cast_slice(hulls));
        queue.write_buffer(&plane_buffer, 0, bytemuck::cast_slice(planes));
        let hull_start_buffer = buffer("first hulls of bodies", counts.bodies + 1, 4)?;
        let starts = hull_starts(hulls, counts.bodies);
        queue.write_buffer(&hull_start_buffer, 0, bytemuck::cast_slice(&starts));
        let constants = program::constants(setup, grid);
        let kernel = |name: &str| {
            let linked = program::program(setup, grid, name).link()?;
            Kernel::new(device, &linked, name, &linked.constants_of(&constants))
        };
        let buffers = [
            ("particles", &fluid.sorted),
            ("starts", &fluid.starts),
            ("boundary", &boundary.sorted),
            ("boundary_starts", &boundary.starts),
            ("reference_positions", &reference_positions),
            ("strain_areas", &strain_areas),
            ("motions", &motions),
            ("clock", &clock),
            ("new_velocities", &new_velocities),
            ("moved", &fluid.unsorted),
            ("unsorted", &boundary.unsorted),
            ("forces", &forces),
            ("loads", &loads),
            ("hulls", &hull_buffer),
            ("hull_starts", &hull_start_buffer),
            ("planes", &plane_buffer),
            ("wall_work", &wall_work),
            ("wall_velocities", &wall_velocities),
            ("wall_velocities_out", &wall_velocities),
        ];
        let bound = |name: &str| {
            let kernel = kernel(name)?;
            let bind_group = kernel.bind(device, &buffers)?;
            Ok::<_, crate::Error>((kernel, bind_group))
        };
        let (body_loads, mueller_drift) = match setup.scheme {
            Scheme::Delta => {
                let kernel = kernel("body_load")?;
                (BodyLoads::of_boundary(device, kernel, &buffers)?, None)
            }
            Scheme::Mueller { .. } => {
                let kernel = kernel("mueller_load")?;
                let loads = BodyLoads::of_hulls(device, queue, kernel, counts, hulls, &buffers)?;
                (loads, Some(bound("mueller_drift")?))
            }
        };
        let pairs = |passes| NeighbourLists::new(device, queue, setup, grid, passes, &buffers);
        let boundary_pairs = pairs(PairPasses {
            kernels: BOUNDARY_KERNELS,
            count: counts.boundary,
            capacity: boundary_capacity(setup, grid),
        })?;
        let fluid_pairs = pairs(PairPasses {
            kernels: fluid_kernels(setup.scheme),
            count: counts.fluid,
            capacity: fluid_capacity(setup, grid),
        })?;
        let check_capacity = match setup.neighbours {
            NeighbourSearch::Cells => None,
            NeighbourSearch::Lists => Some(bound("check_capacity")?),
        };
        let apply_penalty = match setup.scheme {
            Scheme::Delta => Some(bound("apply_penalty")?),
            Scheme::Mueller { .. } => None,
        };
        let mut limits = new_velocities.clone();
        let (mut count, mut reduction) = (counts.fluid.max(1), Vec::new());
        while reduction.is_empty() || count > 1 {
            let reduce = kernel(if reduction.is_empty() {
                "reduce_particle_limits"
            } else {
                "reduce_limits"
            })?;
            count = count.div_ceil(REDUCTION_WIDTH);
            let reduced = buffer("reduced step limits", count, 16)?;
            let names = [
                ("new_velocities", &new_velocities),
                ("wall_work", &wall_work),
                ("limits", &limits),
                ("group_limits", &reduced),
            ];
            let bind_group = reduce.bind(device, &names)?;
            reduction.push((reduce, bind_group, count));
            limits = reduced;
        }
        let advance_clock = kernel("advance_clock")?;
        let clock_bind_group =
            advance_clock.bind(device, &[("limits", &limits), ("clock", &clock)])?;
        Ok(Self {
            counts,
            boundary_position: bound("boundary_position")?,
            body_loads,
            probes: PressureProbes::new(kernel("pressure_probes")?),
            mueller_drift,
            fluid_pairs,
            boundary_pairs,
            check_capacity,
            apply_penalty,
            buffers: buffers
                .map(|(name, buffer)| (name, buffer.clone()))
                .to_vec(),
            reduction,
            advance_clock: (advance_clock, clock_bind_group),
            sorting,
            fluid,
            boundary,
            reference_positions,
            strain_areas,
            motions,
            loads,
            clock,
        })
    }

    /// Rebuilds the neighbour lists with larger capacities; a capacity of 0 keeps the old lists.
    pub fn grow_lists(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        setup: &Setup,
        grid: &CellGrid,
        capacities: ListCapacities,
    ) -> Result<()> {
        let buffers: Vec<_> = self.buffers.iter().map(|(name, of)| (*name, of)).collect();
        let pairs = |passes| NeighbourLists::new(device, queue, setup, grid, passes, &buffers);
        if capacities.fluid > 0 {
            self.fluid_pairs = pairs(PairPasses {
                kernels: fluid_kernels(setup.scheme),
                count: self.counts.fluid,
                capacity: capacities.fluid,
            })?;
        }
        if capacities.boundary > 0 {
            self.boundary_pairs = pairs(PairPasses {
                kernels: BOUNDARY_KERNELS,
                count: self.counts.boundary,
                capacity: capacities.boundary,
            })?;
        }
        Ok(())
    }

    /// Sets the pressure probes, quanta.
    pub fn set_probes(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        probes: &[[i32; 4]],
    ) -> Result<()> {
        let buffers: Vec<_> = self.buffers.iter().map(|(name, of)| (*name, of)).collect();
        self.probes.set(device, queue, probes, &buffers)
    }

    /// Records the positions of the boundary particles.
    pub fn record_boundary(&self, encoder: &mut wgpu::CommandEncoder) {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        let groups = self.counts.boundary.div_ceil(WORKGROUP);
        let (kernel, bind_group) = &self.boundary_position;
        kernel.record(&mut pass, bind_group, groups);
        drop(pass);
        self.sorting.record(encoder, &self.boundary);
    }

    /// Records a step of the fluid particles.
    pub fn record_step(&self, encoder: &mut wgpu::CommandEncoder) {
        self.sorting.record(encoder, &self.fluid);
        let mut pass = encoder.begin_compute_pass(&Default::default());
        self.fluid_pairs.record_lists(&mut pass);
        self.boundary_pairs.record_lists(&mut pass);
        if let Some((kernel, bind_group)) = &self.check_capacity {
            kernel.record(&mut pass, bind_group, 1);
        }
        self.boundary_pairs.record_first(&mut pass);
        self.fluid_pairs.record_first(&mut pass);
        let groups = self.counts.fluid.div_ceil(WORKGROUP);
        if let Some((kernel, bind_group)) = &self.apply_penalty {
            kernel.record(&mut pass, bind_group, groups);
        }
        if self.counts.loaded_bodies > 0 {
            self.boundary_pairs.record_second(&mut pass);
            self.body_loads.record(&mut pass, self.counts.loaded_bodies);
        }
        self.probes.record(&mut pass);
        self.fluid_pairs.record_second(&mut pass);
        if let Some((kernel, bind_group)) = &self.mueller_drift {
            kernel.record(&mut pass, bind_group, groups);
        }
        for (kernel, bind_group, count) in &self.reduction {
            kernel.record(&mut pass, bind_group, count.div_ceil(WORKGROUP));
        }
        let (kernel, bind_group) = &self.advance_clock;
        kernel.record(&mut pass, bind_group, 1);
    }
}

/// Capacities of the neighbour list of a fluid particle and of a boundary particle.
#[derive(Clone, Copy, Debug)]
pub(super) struct ListCapacities {
    pub fluid: u32,
    pub boundary: u32,
}

fn fluid_kernels(scheme: Scheme) -> PairKernels {
    match scheme {
        Scheme::Delta => DELTA_KERNELS,
        Scheme::Mueller { .. } => MUELLER_KERNELS,
    }
}
