//! Gauges and pressure probes: interpolation of particles at points.

use super::{Setup, Side, Wendland, kernels::FEWER_PARTICLES, neighbour_lists::Buffers};
use crate::{
    Result,
    gpu::{
        bins::{WORKGROUP, at_most},
        buffers::zeroed,
        kernel::{Kernel, largest_binding},
    },
};
use glam::{DMat3, DVec2, DVec3};

/// Water fraction at the free surface relative to that below it: half of the kernel is above a flat surface.
const SURFACE_FRACTION: f64 = 0.5;
/// Water fraction below which a particle is a drop: half of the fraction at a flat surface.
const DROP_FRACTION: f64 = 0.25;
/// Mean square distance of particles along an axis, relative to h², that is added to the true one of a fit.
const LEAST_SPREAD: f64 = 1e-4;

/// Particles with the kernel that interpolates them.
#[derive(Clone, Copy, Debug)]
pub struct Interpolator<'a> {
    /// Positions of the particles, m.
    pub positions: &'a [DVec3],
    /// Interpolation kernel.
    pub kernel: Wendland,
    /// Particle spacing Δx, m.
    pub spacing: f64,
    /// Period of the domain, m; 0 along axes that are not periodic.
    pub period: DVec3,
    /// Whether the flow is planar (nothing varies along y).
    pub plane: bool,
}

impl<'a> Interpolator<'a> {
    /// An interpolator of particles at `positions` (m).
    pub fn new(setup: &Setup, positions: &'a [DVec3]) -> Self {
        let period = |axis: usize| match setup.faces[axis][0] {
            Side::Periodic => setup.size[axis],
            _ => 0.0,
        };
        Self {
            positions,
            kernel: setup.kernel(),
            spacing: setup.spacing,
            period: DVec3::new(period(0), period(1), period(2)),
            plane: setup.plane,
        }
    }

    /// The same gauges for other particles.
    fn with_positions<'b>(&self, positions: &'b [DVec3]) -> Interpolator<'b> {
        Interpolator {
            positions,
            kernel: self.kernel,
            ..*self
        }
    }

    /// Volume of a particle, m³; in a plane its area, m².
    fn volume(&self) -> f64 {
        self.spacing.powi(if self.plane { 2 } else { 3 })
    }

    /// Vector from `at` to a particle or its nearest periodic image, m.
    fn separation(&self, at: DVec3, position: DVec3) -> DVec3 {
        let mut r = position - at;
        for axis in 0..3 {
            if self.period[axis] > 0.0 {
                r[axis] -= self.period[axis] * (r[axis] / self.period[axis]).round();
            }
        }
        if self.plane {
            r.y = 0.0;
        }
        r
    }

    /// Fraction of the kernel at `at` (m) that water covers: 1 in the interior, ½ at a flat surface.
    pub fn water_fraction(&self, at: DVec3) -> f64 {
        let weights = self.positions.iter();
        let weights = weights.map(|x| self.kernel.at(self.separation(at, *x).length()));
        self.volume() * weights.sum::<f64>()
    }

    /// Value at `at` (m) of the plane that the `values` of the particles fit best (moving least squares with the kernel as
    /// weight, Lancaster & Salkauskas 1981), so that linear profiles are exact up to walls. Drops have their Shepard mean, after
    /// subtraction of a uniform `gradient` (per metre), such as that of the hydrostatic pressure. `None` if no particle is
    /// within the support.
    pub fn mean(&self, at: DVec3, values: &[f64], gradient: DVec3) -> Option<f64> {
        let (mut weights, mut first, mut second) = (0.0, DVec3::ZERO, DMat3::ZERO);
        let (mut sum, mut moment) = (0.0, DVec3::ZERO);
        for (x, value) in self.positions.iter().zip(values) {
            let r = self.separation(at, *x);
            let weight = self.kernel.at(r.length());
            let value = value - gradient.dot(r);
            let lever = weight * r;
            weights += weight;
            first += lever;
            second += DMat3::from_cols(lever * r.x, lever * r.y, lever * r.z);
            sum += weight * value;
            moment += value * lever;
        }
        if weights <= 0.0 {
            return None;
        }
        if weights * self.volume() < DROP_FRACTION {
            return Some(sum / weights);
        }
        // Keeps the matrix regular in planar flow and in sheets of one layer.
        let least = LEAST_SPREAD * weights * self.kernel.smoothing_length.powi(2);
        let slope = (second + DMat3::from_diagonal(DVec3::splat(least))).inverse() * first;
        Some((sum - slope.dot(moment)) / (weights - slope.dot(first)))
    }

    /// Height of the free surface at (x, y), m: the highest point at which the water fraction is half of its maximum
    /// in the column, so that drops do not count. In water too shallow for that, the top of the highest particle.
    /// `None` if no particle is within h of the vertical line.
    pub fn level(&self, [x, y]: [f64; 2]) -> Option<f64> {
        let on_axis = |z: f64| DVec3::new(x, y, z);
        let axis_distance = |p: &DVec3| {
            let r = self.separation(on_axis(p.z), *p);
            DVec2::new(r.x, r.y).length()
        };
        let column: Vec<DVec3> = self
            .positions
            .iter()
            .copied()
            .filter(|p| axis_distance(p) < self.kernel.support())
            .collect();
        let near = column
            .iter()
            .filter(|p| axis_distance(p) <= self.kernel.smoothing_length);
        let top = near.map(|p| p.z).reduce(f64::max)?;
        let low = column.iter().map(|p| p.z).fold(top, f64::min);
        let column = self.with_positions(&column);
        // Samples from above, in steps over which the kernel is nearly linear.
        let step = 0.25 * self.spacing;
        let count = ((top - low) / step).ceil() as usize + 1;
        let above = top + self.kernel.support();
        let steps = count + (self.kernel.support() / step).ceil() as usize;
        let fractions: Vec<f64> = (0..=steps)
            .map(|i| column.water_fraction(on_axis(above - i as f64 * step)))
            .collect();
        let most = fractions.iter().copied().fold(0.0, f64::max);
        if most < SURFACE_FRACTION {
            return Some(top + 0.5 * self.spacing);
        }
        let surface = SURFACE_FRACTION * most;
        let first = fractions.iter().position(|fraction| *fraction >= surface)?;
        let before = fractions.get(first.wrapping_sub(1)).copied().unwrap_or(0.0);
        let part = (surface - before) / (fractions[first] - before);
        Some(above - (first as f64 - 1.0 + part) * step)
    }

    /// Indices of the particles in the box between two corners (m); planar flow ignores y.
    pub fn inside(&self, min: DVec3, max: DVec3) -> impl Iterator<Item = usize> {
        let plane = self.plane;
        let inside = move |x: &DVec3| {
            let mut inside = x.cmpge(min) & x.cmple(max);
            inside.set(1, plane || inside.test(1));
            inside.all()
        };
        let all = self.positions.iter().enumerate();
        all.filter_map(move |(n, x)| inside(x).then_some(n))
    }

    /// Position of the particle in the box between two corners (m) that is farthest along `direction`, without drops;
    /// `None` if there is none.
    pub fn farthest(&self, min: DVec3, max: DVec3, direction: DVec3) -> Option<DVec3> {
        let inside = self.inside(min, max);
        let mut positions: Vec<DVec3> = inside.map(|n| self.positions[n]).collect();
        positions.sort_unstable_by(|a, b| direction.dot(*b).total_cmp(&direction.dot(*a)));
        positions
            .into_iter()
            .find(|p| self.water_fraction(*p) >= DROP_FRACTION)
    }
}

/// The kernel `pressure_probes` with its buffers, which grow with the number of probes.
#[derive(Debug)]
pub(super) struct PressureProbes {
    kernel: Kernel,
    count: u32,
    memory: Option<Memory>,
}

#[derive(Debug)]
struct Memory {
    /// Number of probes that the buffers hold.
    capacity: u32,
    probes: wgpu::Buffer,
    pressures: wgpu::Buffer,
    bind_group: wgpu::BindGroup,
}

impl PressureProbes {
    /// The kernel without probes.
    pub fn new(kernel: Kernel) -> Self {
        Self {
            kernel,
            count: 0,
            memory: None,
        }
    }

    /// Sets the probes: position in quanta, and the weight of a wall probe (see the kernel).
    pub fn set(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        probes: &[[i32; 4]],
        others: &Buffers<'_>,
    ) -> Result<()> {
        at_most(
            device,
            "pressure probes",
            16 * probes.len() as u64,
            FEWER_PARTICLES,
        )?;
        self.count = probes.len() as u32;
        let capacity = self.memory.as_ref().map_or(0, |memory| memory.capacity);
        if self.count > capacity {
            let most = largest_binding(&device.limits()) / 16;
            let capacity = (2 * u64::from(self.count)).min(most);
            let buffer = zeroed(device, "pressure probes", 16 * capacity);
            let pressures = zeroed(device, "probe pressures", 4 * capacity);
            let own = [("probes", &buffer), ("pressures", &pressures)];
            self.memory = Some(Memory {
                capacity: capacity as u32,
                bind_group: self.kernel.bind(device, &[&own, others].concat())?,
                probes: buffer,
                pressures,
            });
        }
        if let Some(memory) = &self.memory {
            queue.write_buffer(&memory.probes, 0, bytemuck::cast_slice(probes));
        }
        Ok(())
    }

    /// Sets the sums to zero.
    pub fn reset(&self, queue: &wgpu::Queue) {
        if let Some(memory) = &self.memory {
            queue.write_buffer(&memory.pressures, 0, &vec![0; 4 * memory.capacity as usize]);
        }
    }

    /// Records the kernel for one step.
    pub fn record(&self, pass: &mut wgpu::ComputePass<'_>) {
        if let (Some(memory), 1..) = (&self.memory, self.count) {
            let groups = self.count.div_ceil(WORKGROUP);
            self.kernel.record(pass, &memory.bind_group, groups);
        }
    }

    /// Number of probes.
    pub fn count(&self) -> usize {
        self.count as usize
    }

    /// Time integrals of the pressure in device units, one for each probe, padded to the capacity.
    pub fn pressures(&self) -> Option<&wgpu::Buffer> {
        self.memory.as_ref().map(|memory| &memory.pressures)
    }
}
