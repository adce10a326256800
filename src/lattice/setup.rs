//! The setup of a lattice fluid, in lattice units (Δx = Δt = 1, ρ₀ = 1).

use super::SyntheticTurbulence;
use crate::gpu::Processor;

/// Lower bound of the odd rates from a Λ, from τ = 0.52 on.
const ODD_RATE_FLOOR: f64 = 0.8;
/// Those next to walls and next to solids for τ → ½. With 0.8 and the published rates the water of a stream of 0.1 cells per
/// step oscillates from cell to cell along walls with a wall model. Joints of blocks conduct less at higher rates.
const LOW_VISCOSITY_FLOORS: [f64; 2] = [1.6, 1.2];
/// Odd rates of [`Collision::Hermite`] away from walls and solids for τ → ½. With the published ones waves of a few cells grow in
/// a stream of 0.1 cells per step, by more than 3 ‰ per step at a viscosity of 1e-5.
const LOW_VISCOSITY_ODD_RATE: f64 = 1.9;
/// Its s18 and s20 for τ → ½; the published 1.98 leaves 98 % of a deviation after a step.
const LOW_VISCOSITY_S18_S20: f64 = 1.6;

/// Collision operator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Collision {
    /// One rate for every moment (Bhatnagar, Gross & Krook 1954).
    Bgk,
    /// Suga's moments made orthogonal with the lattice weights: stable at rest at every viscosity.
    Hermite,
    /// The published operator of Suga et al. 2015; linearly unstable at rest for τ > 0.559.
    Suga,
}

/// Equilibrium of the populations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Equilibrium {
    /// All 27 moments, Galilean invariant to order 6.
    Product,
    /// To second order in the velocity, as in the paper.
    SecondOrder,
}

/// Collision operator of the solid in a partially saturated cell (Gardner & Sitar 2018, eqs. 8–10).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SolidOperator {
    /// Holdych 2003: the default, with the least error of the drag.
    Holdych,
    /// Noble & Torczynski 1998, as printed in the paper.
    Noble,
    /// The second form of Noble & Torczynski 1998.
    Superposition,
}

/// Weight B of the solid operator in a cell with the solid fraction ε (Gardner & Sitar 2018, eq. 10).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SolidWeight {
    /// The weight with which the operator of Holdych has a grid-aligned plane at its true position in steady shear; ε is
    /// corrected for curved surfaces and edges.
    Exact,
    /// ε (τ − ½) / ((1 − ε) + (τ − ½)) (Noble & Torczynski 1998).
    Standard,
}

/// Storage of the populations; arithmetic is f32 in both.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Storage {
    /// 4 bytes per population.
    F32,
    /// 2 bytes per population; needs 2 or 4 lanes.
    F16,
}

/// Law of the wall for the friction of walls at rest that the grid does not resolve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WallModel {
    /// Werner & Wengle 1991: two powers; within 3 % of the log law (κ 0.384, B 4.27) for y⁺ from 30 to 2500.
    WernerWengle,
    /// Reichardt 1951, with these constants: at any y⁺.
    Reichardt,
}

/// Body force per volume.
#[derive(Clone, Debug, PartialEq)]
pub enum Force {
    /// No force, and no code for it.
    None,
    /// Uniform.
    Constant([f64; 3]),
    /// A field, one value per cell, x fastest.
    Field(Vec<[f32; 3]>),
}

/// A cell that static solids fill in part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceCell {
    /// Index in the domain, x fastest.
    pub cell: u32,
    /// Solid fraction, between 0 and 1.
    pub fraction: f32,
}

/// Boundary condition at a face of the domain.
#[derive(Clone, Debug, PartialEq)]
pub enum Face {
    /// Periodic: the opposite face.
    Periodic,
    /// A no-slip wall half a cell beyond the last cells, with its velocity, which is along the wall.
    Wall([f64; 3]),
    /// Specular reflection half a cell beyond the last cells.
    FreeSlip,
    /// Prescribed velocity at each cell of the face, lower axis fastest; can be changed while
    /// running by `Lattice::set_face_velocity`.
    Velocity(Vec<[f32; 3]>),
    /// Prescribed density ρ = 1 + 3p, which reflects sound (Latt et al. 2008).
    Pressure {
        /// Density at the face.
        density: f64,
    },
    /// Outlet that sound and vortices leave (Orlanski 1976); the mean density tends to the given one.
    Outflow {
        /// Density to which the mean over the face tends.
        density: f64,
    },
}

/// Relaxation rates of the moments other than shear (Suga et al. 2015, eq. 10).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rates {
    /// Energy: bulk viscosity ζ = 2/9 (1/s4 − ½).
    pub s4: f64,
    /// Third order, symmetric.
    pub s10: f64,
    /// Fifth order.
    pub s13: f64,
    /// Fourth order, trace.
    pub s16: f64,
    /// Sixth order.
    pub s17: f64,
    /// Fourth order, deviators.
    pub s18: f64,
    /// Fourth order, off-diagonal.
    pub s20: f64,
    /// Third order, antisymmetric.
    pub s23: f64,
    /// xyz.
    pub s26: f64,
}

impl Rates {
    /// The published constants.
    pub const SUGA: Self = Self {
        s4: 1.54,
        s10: 1.5,
        s13: 1.83,
        s16: 1.4,
        s17: 1.61,
        s18: 1.98,
        s20: 1.98,
        s23: 1.74,
        s26: 1.74,
    };

    /// One rate for all moments.
    pub fn equal(s: f64) -> Self {
        Self {
            s4: s,
            s10: s,
            s13: s,
            s16: s,
            s17: s,
            s18: s,
            s20: s,
            s23: s,
            s26: s,
        }
    }
}

/// All parameters of a lattice, from which its kernels are built. Create it by [`Setup::periodic`] and change its fields.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct Setup {
    /// Number of fluid cells along each axis.
    pub cells: [u32; 3],
    /// Kinematic viscosity, (τ − ½)/3.
    pub nu: f64,
    /// Collision operator.
    pub collision: Collision,
    /// Its constant rates; `None`: those of [`Setup::bulk_rates`].
    pub rates: Option<Rates>,
    /// Magic parameter Λ of the odd rates next to walls; `None` keeps `rates` there too.
    pub wall_lambda: Option<f64>,
    /// Magic parameter of the odd rates everywhere, without a floor, for laminar flows: 3/16 makes
    /// Poiseuille flow exact at every τ. `None` keeps `rates` away from walls.
    pub lambda: Option<f64>,
    /// Lower bound of the odd rates by `wall_lambda` and `solid_lambda`: lower rates are unstable in fast flow. `None`: that of
    /// [`Setup::odd_rate_floors`].
    pub odd_rate_floor: Option<f64>,
    /// Solid operator of blocks in the fluid; `None`: no blocks, and no code for them.
    pub solid_operator: Option<SolidOperator>,
    /// Weight of this operator; `None`: [`SolidWeight::Exact`] with [`SolidOperator::Holdych`], otherwise
    /// [`SolidWeight::Standard`].
    pub solid_weight: Option<SolidWeight>,
    /// Magic parameter of the odd rates in cells with a block and next to them, floored as next to walls;
    /// `None` keeps `rates` there too.
    pub solid_lambda: Option<f64>,
    /// Hydraulic aperture of the joints of blocks in contact, cells, within [`Setup::joint_aperture_range`]; `None`: the largest
    /// values for joints with one row of cells and with two, [`Setup::joint_apertures`].
    pub joint_aperture: Option<f64>,
    /// Equilibrium.
    pub equilibrium: Equilibrium,
    /// WALE constant; `None` is laminar.
    pub wale: Option<f64>,
    /// Steps from one evaluation of the eddy viscosity to the next: 1 or 2. With 2, odd steps reuse that of the step before
    /// and store their velocity for the next one, and a cell takes 8 bytes less.
    pub wale_interval: u32,
    /// Law of the wall for the friction of walls at rest, static solids and grid-aligned faces of blocks, if a wall is plane and
    /// has five cells of fluid in front of it, and with populations in 32 bits of the surfaces that `surface` describes, at any angle
    /// to the grid; no slip elsewhere. It needs `wale`. `None`: no code for it.
    pub wall_model: Option<WallModel>,
    /// Whether it also acts on faces of blocks at an angle to the grid, and on edges. It needs `wall_model`, the operator of
    /// Holdych, and populations in 32 bits.
    pub sloping_faces: bool,
    /// Equivalent sand roughness k_s of the faces of the domain, cells: lower and upper of x, y, z. 0 is smooth.
    pub wall_roughness: [[f64; 2]; 3],
    /// The same for each static solid cell, x fastest; empty if all are smooth.
    pub solid_roughness: Vec<f32>,
    /// Body force per volume.
    pub force: Force,
    /// Lower and upper face of x, y, z.
    pub faces: [[Face; 2]; 3],
    /// Synthetic turbulence added at velocity faces; `None`: no code for it.
    pub turbulence: [[Option<SyntheticTurbulence>; 2]; 3],
    /// Increase of the density from cell to cell along pressure and outflow faces: the hydrostatic one
    /// if gravity acts on the fluid. The middle of a face has the density of the face.
    pub open_face_gradient: [f64; 3],
    /// Static solid cells, x fastest; empty if there are none.
    pub solid: Vec<bool>,
    /// Cells that static solids fill in part, in ascending order; all others are `solid` or fluid.
    pub surface: Vec<SurfaceCell>,
    /// Storage of the populations.
    pub storage: Storage,
    /// Cells per invocation: 1, 2 or 4.
    pub lanes: u32,
    /// The axis along which these cells are distributed: 1 or 2. Bricks whose cells are all solid are skipped, so that the axis
    /// along which a scene changes least is the fastest.
    pub lane_axis: usize,
    /// Speed above which the guard stops the run; 0: no guard.
    pub max_speed: f64,
    /// Elements of a brick along x, y, z; their product is the workgroup: 32, 64, 128 or 256.
    pub brick: [u32; 3],
    /// Elements of a row along x are padded to a multiple of this where x is not periodic.
    pub row_alignment: u32,
    /// Storage bindings over which the populations are spread; `None` takes as many as the
    /// device's limits require.
    pub bindings: Option<u32>,
    /// Whether values go to and from memory in words of 64 bits, where there are four lanes: 1.25
    /// times the speed on lavapipe, the same bits. Needs [`wgpu::Features::SHADER_INT64`].
    pub wide: bool,
    /// Processor for which the kernels of blocks are built; `None`: that of the device. For [`Processor::Cpu`], all
    /// bricks run the kernel with flags if most have flags.
    pub processor: Option<Processor>,
}

impl Setup {
    /// A periodic box with the library's defaults: Hermite MRT, product equilibrium, f32, laminar.
    pub fn periodic(cells: [u32; 3], nu: f64) -> Self {
        let face = || [Face::Periodic, Face::Periodic];
        Self {
            cells,
            nu,
            collision: Collision::Hermite,
            rates: None,
            wall_lambda: Some(3.0 / 16.0),
            lambda: None,
            odd_rate_floor: None,
            solid_operator: None,
            solid_weight: None,
            solid_lambda: Some(0.1),
            joint_aperture: None,
            equilibrium: Equilibrium::Product,
            wale: None,
            wale_interval: 2,
            wall_model: None,
            sloping_faces: false,
            wall_roughness: [[0.0; 2]; 3],
            solid_roughness: Vec::new(),
            force: Force::None,
            faces: [face(), face(), face()],
            turbulence: [[None; 2]; 3],
            open_face_gradient: [0.0; 3],
            solid: Vec::new(),
            surface: Vec::new(),
            storage: Storage::F32,
            lanes: 1,
            lane_axis: 2,
            // Three quarters of the speed of sound: outside the range of the method, but before NaN.
            max_speed: 0.43,
            brick: [16, 2, 2],
            row_alignment: 1,
            bindings: None,
            wide: false,
            processor: None,
        }
    }

    /// The operator of cells with solid: that of blocks, or [`SolidOperator::Holdych`] if only static solids fill cells in part.
    pub fn operator(&self) -> Option<SolidOperator> {
        let at_rest = (!self.surface.is_empty()).then_some(SolidOperator::Holdych);
        self.solid_operator.or(at_rest)
    }

    /// Whether the eddy viscosity of an even step is kept for the odd one after it.
    pub fn keeps_eddy_viscosity(&self) -> bool {
        self.wale.is_some() && self.wale_interval == 2
    }

    /// Whether the wall model acts on blocks. With 16-bit storage GPUs lack the registers for it.
    pub fn has_block_friction(&self) -> bool {
        self.wall_model.is_some() && self.solid_operator.is_some() && self.storage == Storage::F32
    }

    /// Whether it acts on exact surfaces of solids at rest at any angle to the grid.
    pub fn has_surface_friction(&self) -> bool {
        self.wall_model.is_some() && !self.surface.is_empty() && self.storage == Storage::F32
    }

    /// Planes of the cells that solids at rest fill in part: the fraction; and for the wall model its share and the normal.
    pub(super) fn surface_planes(&self) -> u32 {
        if self.has_surface_friction() { 5 } else { 1 }
    }

    /// Whether it also acts on faces of blocks at an angle to the grid.
    pub fn has_sloping_friction(&self) -> bool {
        self.has_block_friction() && self.sloping_faces
    }

    /// The weight of the solid operator, [`SolidWeight::Standard`] without an operator.
    pub fn weight(&self) -> SolidWeight {
        let usual = match self.operator() {
            Some(SolidOperator::Holdych) => SolidWeight::Exact,
            _ => SolidWeight::Standard,
        };
        self.solid_weight.unwrap_or(usual)
    }

    /// Chooses the layout for a CPU adapter with these `features`: bricks that are rows of 32 or
    /// 64 elements, and the widest words that it supports. Its threads process the invocations of a workgroup one
    /// after the other, so that rows are the fastest: 1.25 times the speed of 16 × 2 × 2 on lavapipe.
    /// Invocations beyond the cells cost as much as others, so that rows are the longest with the fewest
    /// such invocations; rows that consist of padding only are skipped.
    pub fn use_cpu_layout(&mut self, features: wgpu::Features) {
        // Eight invocations are a vector of such an adapter.
        let length = self.cells[0];
        let long = match length.div_ceil(32) {
            1 => length.next_power_of_two().max(8),
            n if n % 2 == 1 => 32,
            _ => 64,
        };
        self.brick = [long, (32 / long).max(1), 1];
        self.wide = features.contains(wgpu::Features::SHADER_INT64);
        self.processor = Some(Processor::Cpu);
    }

    /// Chooses the layout for a GPU: bricks that are rows of up to 128 elements, aligned to its memory lines. On an H200 a
    /// plain step of 128³ cells with rows of 128, 64 and 32 reaches 0.89, 0.85 and 0.73 of the speed of copies, with bricks of
    /// 16 × 2 × 2 0.59. With blocks in the fluid rows have 32 elements: longer ones contain more cells that no block reaches.
    pub fn use_gpu_layout(&mut self) {
        let length = self.cells[0];
        // Invocations beyond the last cell are idle: at most one for eight cells.
        let fits = |long: &u32| (long - length % long) % long <= length / 8;
        let long = match self.solid_operator {
            Some(_) => None,
            None => [128, 64].into_iter().find(fits),
        };
        let long = long.unwrap_or(length.clamp(8, 32).next_power_of_two());
        self.brick = [long, (64 / long).max(1), 1];
        self.row_alignment = 32;
        self.processor = Some(Processor::Gpu);
    }

    /// Sets `lanes` cells per invocation, along y or z: the axis along which fewer elements hold fluid, z if they
    /// are equal. Returns false, without a change, if both axes are periodic and not divisible by `lanes`.
    pub fn spread_lanes(&mut self, lanes: u32) -> bool {
        if lanes == 1 {
            (self.lanes, self.lane_axis) = (1, 2);
            return true;
        }
        let elements = |axis| Some((self.fluid_elements(axis, lanes)?, axis));
        let least = [2, 1]
            .into_iter()
            .filter_map(elements)
            .min_by_key(|(elements, _)| *elements);
        if let Some((_, axis)) = least {
            (self.lanes, self.lane_axis) = (lanes, axis);
        }
        least.is_some()
    }

    /// Number of elements with fluid for `lanes` cells along an axis; `None` if that is impossible.
    fn fluid_elements(&self, axis: usize, lanes: u32) -> Option<u64> {
        let periodic = self.periodic_axes()[axis];
        if periodic && !self.cells[axis].is_multiple_of(lanes) {
            return None;
        }
        let padded = self.cells[axis].saturating_add(u32::from(!periodic));
        let mut elements = self.cells;
        elements[axis] = padded.div_ceil(lanes);
        if self.solid.is_empty() {
            return Some(elements.iter().map(|&n| u64::from(n)).product());
        }
        let [nx, ny, nz] = elements;
        let slab = elements[axis];
        let fluid = |at: [u32; 3]| {
            (0..lanes).any(|lane| {
                let mut cell = at;
                cell[axis] += lane * slab;
                let [x, y, z] = cell.map(|i| i as usize);
                let [cx, cy, _] = self.cells.map(|n| n as usize);
                cell[axis] < self.cells[axis] && !self.solid[x + cx * (y + cy * z)]
            })
        };
        let all = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])));
        Some(all.filter(|at| fluid(*at)).count() as u64)
    }

    /// Whether the kernels have words of 64 bits.
    pub fn is_wide(&self) -> bool {
        self.wide && self.lanes == 4
    }

    /// Features that a device needs for this setup.
    pub fn features(&self) -> wgpu::Features {
        match self.is_wide() {
            true => wgpu::Features::SHADER_INT64,
            false => wgpu::Features::empty(),
        }
    }

    /// Relaxation time of the laminar viscosity.
    pub fn tau(&self) -> f64 {
        0.5 + 3.0 * self.nu
    }

    /// s with (1/s − ½)(τ − ½) = Λ (Ginzburg & d'Humières 2003).
    pub fn odd_rate(&self, lambda: f64) -> f64 {
        1.0 / (0.5 + lambda / (self.tau() - 0.5))
    }

    /// Lower bound of the odd rates next to walls, and of those in partially saturated cells and next to them. Without a given
    /// one: 0.8 from τ = 0.52 on; from there up to 1.6 next to walls and 1.2 next to solids at τ = ½.
    pub fn odd_rate_floors(&self) -> [f64; 2] {
        LOW_VISCOSITY_FLOORS.map(|low| {
            let default = ODD_RATE_FLOOR + (low - ODD_RATE_FLOOR) * self.low_viscosity();
            self.odd_rate_floor.unwrap_or(default)
        })
    }

    /// The odd rate next to walls, and that in partially saturated cells and next to them; `None`: those of [`Setup::bulk_rates`].
    pub(super) fn odd_rates(&self) -> [Option<f64>; 2] {
        let everywhere = self.lambda.map(|lambda| self.odd_rate(lambda));
        let [walls, solids] = self.odd_rate_floors();
        [(self.wall_lambda, walls), (self.solid_lambda, solids)].map(|(lambda, floor)| {
            everywhere.or(lambda.map(|lambda| self.odd_rate(lambda).max(floor)))
        })
    }

    /// Rates of the moments other than shear away from walls and solids. Without given ones: the published ones, which with
    /// [`Collision::Hermite`] change linearly from τ = 0.52 to ½, there to 1.9 for odd moments and 1.6 for s18 and s20.
    pub fn bulk_rates(&self) -> Rates {
        let share = match self.collision {
            Collision::Hermite => self.low_viscosity(),
            Collision::Bgk | Collision::Suga => 0.0,
        };
        let published = Rates::SUGA;
        let to = |rate: f64, limit: f64| rate + share * (limit - rate);
        self.rates.unwrap_or(Rates {
            s10: to(published.s10, LOW_VISCOSITY_ODD_RATE),
            s13: to(published.s13, LOW_VISCOSITY_ODD_RATE),
            s18: to(published.s18, LOW_VISCOSITY_S18_S20),
            s20: to(published.s20, LOW_VISCOSITY_S18_S20),
            s23: to(published.s23, LOW_VISCOSITY_ODD_RATE),
            s26: to(published.s26, LOW_VISCOSITY_ODD_RATE),
            ..published
        })
    }

    /// 0 from τ = 0.52 on, 1 at τ = ½.
    fn low_viscosity(&self) -> f64 {
        1.0 - (3.0 * self.nu / 0.02).min(1.0)
    }

    /// Whether cells lie on a non-periodic axis, per axis.
    pub fn periodic_axes(&self) -> [bool; 3] {
        [0, 1, 2].map(|a| self.faces[a][0] == Face::Periodic)
    }

    /// Whether every cell is and stays a fluid cell without a wall next to it.
    pub fn is_all_fluid(&self) -> bool {
        self.periodic_axes() == [true; 3] && self.solid.is_empty() && self.operator().is_none()
    }
}
