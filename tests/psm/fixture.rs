//! A lattice with blocks, together with its f64 twin.

use kit::{
    Rig,
    twin::of_setup::{noise, poison, random_populations, twin_of},
    twin::{Solid, Twin, lattice::Q, lattice::W, tightness},
};
use riprap::{
    gpu::readback::Readback,
    lattice::{Grid, Lattice, Setup},
    psm::PLANES,
};

/// Index of a number in the saturation, by slot, plane, element of the brick and lane.
pub fn place(grid: &Grid, slot: usize, plane: usize, local: usize, lane: usize) -> usize {
    ((slot * PLANES + plane) * workgroup(grid) + local) * grid.lanes as usize + lane
}

pub fn workgroup(grid: &Grid) -> usize {
    grid.brick.iter().product::<u32>() as usize
}

/// The cell of an element of a brick in a lane, if it lies in the domain.
pub fn cell_of(grid: &Grid, brick: u32, local: usize, lane: usize) -> Option<usize> {
    let [bricks_x, bricks_y, _] = grid.bricks();
    let [x, y, _] = grid.brick;
    let local = local as u32;
    let mut cell = [
        x * (brick % bricks_x) + local % x,
        y * (brick / bricks_x % bricks_y) + local / x % y,
        grid.brick[2] * (brick / (bricks_x * bricks_y)) + local / (x * y),
    ];
    let inside = (0..3).all(|a| cell[a] < grid.elements[a]);
    cell[grid.lane_axis] += lane as u32 * grid.elements[grid.lane_axis];
    (inside && grid.contains(cell)).then(|| grid.index(cell))
}

/// All elements of the slots of some bricks with their cells: slot, element, lane, cell.
pub fn places(grid: &Grid, bricks: &[u32]) -> Vec<(usize, usize, usize, usize)> {
    let mut all = Vec::new();
    for (slot, &brick) in bricks.iter().enumerate() {
        for local in 0..workgroup(grid) {
            for lane in 0..grid.lanes as usize {
                if let Some(cell) = cell_of(grid, brick, local, lane) {
                    all.push((slot, local, lane, cell));
                }
            }
        }
    }
    all
}

/// A random solid of any kind, exactly equal in f32 and f64. The solid is as fast as the fluid, because the rounding depends on
/// its populations.
fn random_solid(cell: usize) -> Solid {
    let unit = |n: usize| 0.5 + 0.5 * noise(1_000_003 * (n + 1) + cell);
    let coarse = |x: f64| (x * 1024.0).round() / 1024.0;
    let (shares, deep) = match (unit(0) * 20.0) as u32 {
        0..=4 => return Solid::default(),
        5..=6 => {
            return Solid {
                beside: true,
                ..Solid::default()
            };
        }
        7..=13 => (coarse(unit(1)).max(1.0 / 1024.0), false),
        14 => (1.0 / 1024.0, false),
        15 => (1.0, false),
        // Two blocks in a cell, and one of them deep in another.
        16 => (1.0 + coarse(unit(1)), false),
        17 => (1.0 + coarse(unit(1)), true),
        18 => (1.0, false),
        _ => (1.0, true),
    };
    // Flush parts have more shares than the fraction that their planes leave.
    let flush = unit(6) > 0.5 && !deep;
    let fraction = f64::min(if flush { coarse(0.8 * shares) } else { shares }, 1.0);
    let shared = unit(5) > 0.5 && !deep;
    Solid {
        fraction,
        shares,
        velocity: [2, 3, 4].map(|n| f64::from((0.02 * (unit(n) - 0.5)) as f32)),
        beside: false,
        deep,
        tight: if shared { tightness(fraction) } else { 0.0 },
        shared,
        facing: unit(7) > 0.5,
    }
}

/// Planes 0 to 3, and the last one, of a solid in the layout of the saturation.
pub fn planes(solid: &Solid) -> [(usize, f32); 5] {
    let mark = match solid {
        Solid { beside: true, .. } => -1.0,
        Solid { deep: true, .. } => solid.shares + 8.0,
        Solid { tight, facing, .. } if *tight > 0.0 => {
            solid.shares + if *facing { 24.0 } else { 16.0 }
        }
        Solid { shared: true, .. } => solid.shares + 32.0,
        _ => solid.shares,
    };
    let [x, y, z] = solid.velocity;
    let all = [(0, mark), (1, x), (2, y), (3, z), (9, solid.fraction)];
    all.map(|(plane, value)| (plane, value as f32))
}

/// A lattice and its twin in the same state.
pub struct Subject {
    pub rig: Rig,
    pub setup: Setup,
    pub lattice: Lattice,
    pub twin: Twin,
}

impl Subject {
    /// A subject with random populations, in buffers that held NaN.
    pub fn new(setup: &Setup) -> Self {
        let rig = Rig::new();
        let mut twin = twin_of(setup);
        let start = random_populations(&mut twin);
        let mut lattice = Lattice::new(&rig.device, setup.clone()).unwrap();
        poison(&rig, &lattice);
        lattice
            .set_populations(&rig.device, &rig.queue, &start)
            .unwrap();
        Self {
            rig,
            setup: setup.clone(),
            lattice,
            twin,
        }
    }

    /// About two thirds of the bricks that contain fluid, in arbitrary order.
    pub fn some_bricks(&self) -> Vec<u32> {
        let all = self.all_bricks().into_iter();
        let mut some: Vec<u32> = all
            .filter(|&brick| noise(7 * brick as usize) < 0.4)
            .collect();
        some.sort_by(|a, b| noise(*a as usize + 500).total_cmp(&noise(*b as usize + 500)));
        some
    }

    /// All bricks with fluid cells.
    pub fn all_bricks(&self) -> Vec<u32> {
        let geometry = self.lattice.geometry();
        let lists = [&geometry.mixed, &geometry.plain, &geometry.surface];
        lists.into_iter().flatten().copied().collect()
    }

    /// Puts random solids in the cells of these bricks.
    pub fn fill(&mut self, bricks: &[u32]) {
        self.fill_with(bricks, random_solid);
    }

    /// Puts the solids `of` the cells in these bricks.
    pub fn fill_with(&mut self, bricks: &[u32], of: impl Fn(usize) -> Solid) {
        let grid = *self.lattice.grid();
        let (device, queue) = (&self.rig.device, &self.rig.queue);
        self.lattice.set_psm_bricks(device, queue, bricks).unwrap();
        let buffer = self.lattice.psm_planes().next().unwrap().1;
        let mut values = vec![f32::NAN; (buffer.size() / 4) as usize];
        for slot in 0..bricks.len() {
            let first = place(&grid, slot, 0, 0, 0);
            values[first..place(&grid, slot, 4, 0, 0)].fill(0.0);
            let last = place(&grid, slot, 9, 0, 0);
            values[last..place(&grid, slot + 1, 0, 0, 0)].fill(0.0);
        }
        let (_, solids) = self.twin.blocks.as_mut().unwrap();
        for (slot, local, lane, cell) in places(&grid, bricks) {
            let solid = of(cell);
            for (plane, value) in planes(&solid) {
                values[place(&grid, slot, plane, local, lane)] = value;
            }
            solids[cell] = solid;
        }
        queue.write_buffer(buffer, 0, bytemuck::cast_slice(&values));
    }

    /// Largest |f − f_twin| / w_i over the fluid cells.
    pub fn population_error(&mut self) -> f64 {
        let end = self.rig.populations(&mut self.lattice);
        let n = self.twin.domain.cell_count();
        let mut worst: f64 = 0.0;
        for cell in (0..n).filter(|&cell| !self.twin.domain.solid[cell]) {
            for q in 0..Q {
                let found = f64::from(end.values[q * n + cell]);
                assert!(found.is_finite(), "cell {cell}, direction {q} read poison");
                worst = worst.max((found - self.twin.f[cell][q]).abs() / W[q]);
            }
        }
        worst
    }

    /// Has the twin continue from the populations of the lattice, so that rounding errors do not add up.
    pub fn set_twin(&mut self) {
        let found = self.rig.populations(&mut self.lattice);
        let n = self.twin.domain.cell_count();
        for cell in (0..n).filter(|&cell| !self.twin.domain.solid[cell]) {
            for q in 0..Q {
                self.twin.f[cell][q] = f64::from(found.values[q * n + cell]);
            }
        }
    }

    /// The saturation after the fluid kernel.
    pub fn psm_planes(&self) -> Vec<f32> {
        let buffer = self.lattice.psm_planes().next().unwrap().1;
        let count = (buffer.size() / 4) as usize;
        let (device, queue) = (&self.rig.device, &self.rig.queue);
        let mut readback = Readback::default();
        self.rig
            .wait(readback.read(device, queue, buffer, count))
            .unwrap()
    }

    /// Largest error of B and of the force on one of two blocks in a cell, over the cells of these bricks; the twin must be at
    /// the start of the last step.
    pub fn force_error(&self, bricks: &[u32]) -> f64 {
        let (grid, found) = (self.lattice.grid(), self.psm_planes());
        let nu_t = self.twin.nu_t();
        let balance = self.twin.slip_balance(&nu_t);
        let mut worst: f64 = 0.0;
        for (slot, local, lane, cell) in places(grid, bricks) {
            let at = |plane| f64::from(found[place(grid, slot, plane, local, lane)]);
            let solid = self.twin.solid_at(cell);
            let clear = solid.shares == 0.0 && solid.fraction < 0.5;
            if !self.twin.domain.solid[cell] && clear {
                let (rho, u) = self.twin.macroscopic(cell);
                let there = [1.0, rho - 1.0, u[0], u[1], u[2]];
                for (plane, there) in (4..).zip(there) {
                    worst = worst.max((at(plane) - there).abs());
                }
                continue;
            }
            if self.twin.domain.solid[cell] || solid.shares == 0.0 {
                assert!((4..9).all(|plane| at(plane) == 0.0), "cell {cell}");
                continue;
            }
            let tau = self.twin.config.tau_eff(nu_t[cell]);
            let weight = self.twin.weight(cell, tau);
            // One of two blocks: three tenths of the solid, with its own velocity; a wall law is only for one block.
            let part = 0.3 * solid.shares;
            let differs = solid.shared || self.setup.wall_model.is_none();
            let own = |a| 0.01 * f64::from(u8::from(differs)) * noise(3 * cell + a);
            let velocity = [0, 1, 2].map(|a| solid.velocity[a] + own(a));
            let force = self.twin.force_on(cell, part, velocity, (tau, balance));
            worst = worst.max((part * at(4) - weight * part / solid.shares).abs());
            for a in 0..3 {
                let load = -part * (at(5) * velocity[a] + at(6 + a));
                assert!(load.is_finite(), "cell {cell}");
                worst = worst.max((load - force[a]).abs());
            }
        }
        worst
    }
}
