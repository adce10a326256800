//! A flow over time: collide every cell, then stream.

use super::collide::collide;
use super::domain::{Domain, Link};
use super::lattice::{C, OPPOSITE, Q, W, c_dot, macroscopic};
use super::rates::{Config, OddClass};
use super::solid::{Solid, SolidOperator, force_on, solid_change, tightness};
use super::{WallModel, equilibrium, wale};

/// Force per cell.
#[derive(Clone, Debug)]
pub enum Force {
    /// The same in every cell.
    Uniform([f64; 3]),
    /// One value per cell.
    Field(Vec<[f64; 3]>),
}

/// State of a flow.
#[derive(Clone, Debug)]
pub struct Twin {
    /// Grid and boundaries.
    pub domain: Domain,
    /// Collision.
    pub config: Config,
    /// Body force.
    pub force: Force,
    /// Solid operator, and the solid in each cell; `None` without blocks.
    pub blocks: Option<(SolidOperator, Vec<Solid>)>,
    /// Wall law on walls at rest; `None` for no slip.
    pub wall_model: Option<WallModel>,
    /// Shifted populations before collision; 0 in solids.
    pub f: Vec<[f64; Q]>,
    /// Steps since the start.
    steps: u64,
    /// Velocity for WALE and wall models, of the step before or, in an odd step, of the one before that.
    previous_velocity: Option<Vec<[f64; 3]>>,
    /// Excess of the density before the last collision.
    pub(super) previous_density: Vec<f64>,
    /// Eddy viscosity of the step before by WALE alone.
    previous_nu_t: Vec<f64>,
    /// Cells that had a block in that step, for the wall model; empty before the first step.
    pub(super) blocks_before: Vec<bool>,
    links: Vec<[Link; Q]>,
}

impl Twin {
    /// Fluid at rest, ρ = 1, without force. The domain must not be changed afterwards.
    pub fn new(domain: Domain, config: Config) -> Self {
        Self {
            f: vec![[0.0; Q]; domain.cell_count()],
            links: domain.links(),
            domain,
            config,
            force: Force::Uniform([0.0; 3]),
            blocks: None,
            wall_model: None,
            steps: 0,
            previous_velocity: None,
            previous_density: Vec::new(),
            previous_nu_t: Vec::new(),
            blocks_before: Vec::new(),
        }
    }

    /// Restarts from ρ and u of each cell (see [`equilibrium::consistent`]).
    pub fn start(&mut self, rho: &[f64], u: &[[f64; 3]]) {
        self.f = equilibrium::consistent(&self.domain, &self.config, rho, u);
        (self.steps, self.previous_velocity) = (0, None);
    }

    /// Force on a cell.
    pub fn force_at(&self, cell: usize) -> [f64; 3] {
        match &self.force {
            Force::Uniform(force) => *force,
            Force::Field(values) => values[cell],
        }
    }

    /// The part of it that the pressure balances in fluid at rest: none along periodic axes.
    pub(super) fn balanced_force(&self, cell: usize) -> [f64; 3] {
        let force = self.force_at(cell);
        [0, 1, 2].map(|a| match self.domain.faces[2 * a] {
            super::Face::Periodic => 0.0,
            _ => force[a],
        })
    }

    /// Density and velocity of a cell; 1 and 0 in solids.
    pub fn macroscopic(&self, cell: usize) -> (f64, [f64; 3]) {
        if self.domain.solid[cell] {
            return (1.0, [0.0; 3]);
        }
        macroscopic(&self.f[cell], self.force_at(cell))
    }

    /// Density of every cell.
    pub fn density(&self) -> Vec<f64> {
        self.cells().map(|cell| self.macroscopic(cell).0).collect()
    }

    /// Velocity of every cell.
    pub fn velocity(&self) -> Vec<[f64; 3]> {
        self.cells().map(|cell| self.macroscopic(cell).1).collect()
    }

    /// The solid in a cell.
    pub fn solid_at(&self, cell: usize) -> Solid {
        let Some((_, cells)) = &self.blocks else {
            return Solid::default();
        };
        let own = cells[cell];
        let at_wall = self.tight_at_wall(cell);
        Solid {
            tight: own.tight.max(at_wall),
            facing: own.facing && at_wall == 0.0,
            ..own
        }
    }

    fn tight_at_wall(&self, cell: usize) -> f64 {
        match &self.blocks {
            Some((_, cells))
                if cells[cell].shares > 0.0
                    && !cells[cell].deep
                    && self.domain.walls_at(cell).next().is_some() =>
            {
                tightness(cells[cell].fraction)
            }
            _ => 0.0,
        }
    }

    /// Momentum parallel to walls at rest that the fluid of a full cell has lost to them by bounce-back.
    fn lost_to_walls(&self, cell: usize) -> [f64; 3] {
        let mut lost = [0.0; 3];
        let tight = self.tight_at_wall(cell);
        if tight == 0.0 {
            return lost;
        }
        for normal in self.domain.walls_at(cell) {
            for i in 0..Q {
                let along = |a: usize| normal[a] == 0;
                let out: i32 = (0..3).map(|a| C[i][a] * normal[a]).sum();
                if out == -1 {
                    for a in (0..3).filter(|&a| along(a)) {
                        lost[a] -= 2.0 * tight * self.f[cell][i] * f64::from(C[i][a]);
                    }
                }
            }
        }
        lost
    }

    /// Force on a block with the share `part` of a cell that moves there with `velocity`.
    /// `balance`: that of [`Self::slip_balance`].
    pub fn force_on(
        &self,
        cell: usize,
        part: f64,
        velocity: [f64; 3],
        (tau, balance): (f64, f64),
    ) -> [f64; 3] {
        let solid = self.solid_at(cell);
        let change = self.solid_change(cell, velocity, tau);
        let force = force_on(self.weight(cell, tau), &solid, part, &change);
        let lost = self.lost_to_walls(cell);
        let nu_t = (tau - self.config.tau_eff(0.0)) / 3.0;
        let gain = self.sloping_gain(cell, &self.collided_in(cell, nu_t), balance);
        let gained = |a: usize| (0..Q).map(|i| gain[i] * f64::from(C[i][a])).sum::<f64>();
        [0, 1, 2].map(|a| {
            let at_walls = lost[a] * part / solid.shares.max(1.0);
            force[a] + at_walls - gained(a) * part / solid.shares
        })
    }

    /// B of the momentum in a cell.
    pub fn weight(&self, cell: usize, tau: f64) -> f64 {
        let weight = self.solid_at(cell).weight(&self.config, tau);
        weight.max(self.part_of_law(cell))
    }

    fn is_beside_wall(&self, cell: usize) -> bool {
        let mut links = self.links[cell].iter();
        links.any(|link| matches!(link, Link::Bounce | Link::Moving(_)))
    }

    /// Eddy viscosity of every cell in the coming step; 0 in solids and without WALE. It is reduced by the solid fraction,
    /// since the rotation of blocks would contribute to it.
    pub fn nu_t(&self) -> Vec<f64> {
        let mut near_wall = vec![0.0; self.domain.cell_count()];
        if let Some(model) = &self.wall_model {
            let u = &self.velocity_before();
            near_wall = model.viscosity(&self.domain, self.config.nu(), u, &self.blocks_before);
            self.add_above_surface(&mut near_wall);
            self.add_near_blocks(&mut near_wall);
            self.add_above_slopes(&mut near_wall);
        }
        let by_wale = self.nu_t_by_wale();
        self.cells()
            .map(|cell| by_wale[cell].max(near_wall[cell]) * (1.0 - self.solid_at(cell).fraction))
            .collect()
    }

    /// The same by WALE alone, without blocks.
    fn nu_t_by_wale(&self) -> Vec<f64> {
        let Some(c_w) = self.config.c_w else {
            return vec![0.0; self.domain.cell_count()];
        };
        if self.steps % self.config.wale_interval == 1 {
            return self.previous_nu_t.clone();
        }
        let u = &self.velocity_before();
        self.cells()
            .map(|cell| match self.domain.solid[cell] {
                true => 0.0,
                false => wale::nu_t(&wale::gradient(&self.domain, u, cell), c_w),
            })
            .collect()
    }

    /// The velocity used by eddy viscosity and wall model.
    fn velocity_before(&self) -> Vec<[f64; 3]> {
        let before = self.previous_velocity.clone();
        before.unwrap_or_else(|| self.velocity())
    }

    /// The same in a cell.
    pub(super) fn velocity_before_at(&self, cell: usize) -> [f64; 3] {
        match &self.previous_velocity {
            Some(before) => before[cell],
            None => self.macroscopic(cell).1,
        }
    }

    /// Whether a cell is next to a bounce-back wall, or in or next to a block.
    pub fn odd_class(&self, cell: usize) -> OddClass {
        if self.solid_at(cell).is_near() {
            return OddClass::Block;
        }
        if self.is_beside_wall(cell) {
            OddClass::Wall
        } else {
            OddClass::Bulk
        }
    }

    /// Populations after the collision of the coming step.
    pub fn collided(&self) -> Vec<[f64; Q]> {
        let nu_t = self.nu_t();
        let balance = self.slip_balance(&nu_t);
        self.cells()
            .map(|cell| {
                if self.domain.solid[cell] {
                    return [0.0; Q];
                }
                let found = self.collided_in(cell, nu_t[cell]);
                let gain = self.sloping_gain(cell, &found, balance);
                std::array::from_fn(|i| found[i] + gain[i])
            })
            .collect()
    }

    /// Populations of a cell after the collision.
    pub(super) fn collided_in(&self, cell: usize, nu_t: f64) -> [f64; Q] {
        let (f, force) = (&self.f[cell], self.force_at(cell));
        let fluid = collide(&self.config, f, force, nu_t, self.odd_class(cell));
        self.saturate(cell, &fluid, self.config.tau_eff(nu_t))
    }

    /// f* = f + (1 − B)(fluid − f) + B Ω^s.
    fn saturate(&self, cell: usize, fluid: &[f64; Q], tau: f64) -> [f64; Q] {
        let solid = self.solid_at(cell);
        let b = self.weight(cell, tau);
        let change = self.solid_change(cell, solid.velocity, tau);
        let f = &self.f[cell];
        let others = solid.higher_weight(&self.config, tau);
        let others = others.max(self.part_of_law(cell));
        let more: [f64; Q] = std::array::from_fn(|i| change[i] - (fluid[i] - f[i]));
        let momentum = [0, 1, 2].map(|a| (0..Q).map(|i| more[i] * f64::from(C[i][a])).sum::<f64>());
        std::array::from_fn(|i| {
            fluid[i] + others * more[i] + (b - others) * 3.0 * W[i] * c_dot(i, momentum)
        })
    }

    /// Ω^s of a solid in a cell that moves with `u_s`; 0 without blocks.
    pub fn solid_change(&self, cell: usize, u_s: [f64; 3], tau: f64) -> [f64; Q] {
        let Some((operator, cells)) = &self.blocks else {
            return [0.0; Q];
        };
        let how = (*operator, cells[cell].damping(*operator));
        let (f, force) = (&self.f[cell], self.force_at(cell));
        let slides = match cells[cell].shares > 0.0 {
            true => self.sliding_velocity(cell, u_s),
            false => self.velocity_at_surface(cell),
        };
        let mut change = solid_change(&self.config, how, f, force, tau, slides);
        self.apply_wall_stress(cell, u_s, &mut change);
        change
    }

    /// Collide, then stream.
    pub fn step(&mut self) {
        let before = self.velocity_before();
        let nu_t = self.nu_t_by_wale();
        let velocity: Vec<_> = self
            .cells()
            .map(|cell| self.solid_at(cell).mean_velocity(self.macroscopic(cell).1))
            .collect();
        let collided = self.collided();
        self.previous_density = self.f.iter().map(|f| f.iter().sum()).collect();
        self.f = self
            .cells()
            .map(|cell| {
                if self.domain.solid[cell] {
                    return [0.0; Q];
                }
                self.stream(&collided, cell)
            })
            .collect();
        if let Some((_, cells)) = &self.blocks {
            self.blocks_before = cells.iter().map(|cell| cell.shares > 0.0).collect();
        }
        // The coming step evaluates the eddy viscosity from this velocity, or uses that of this one again.
        self.steps += 1;
        let kept = match self.steps % self.config.wale_interval {
            0 => velocity,
            _ => before,
        };
        self.previous_nu_t = nu_t;
        if let Some(model) = &self.wall_model {
            // The model acts before the coming step, on the populations that have arrived.
            let (nu, blocks) = (self.config.nu(), &self.blocks_before);
            let force: Vec<_> = self.cells().map(|cell| self.balanced_force(cell)).collect();
            model.hand_over(&self.domain, nu, &kept, (blocks, &force), &mut self.f);
        }
        self.previous_velocity = Some(kept);
        self.exchange_at_surface();
    }

    /// Several steps.
    pub fn run(&mut self, steps: usize) {
        for _ in 0..steps {
            self.step();
        }
    }

    /// Populations arriving at a cell. Off moving walls f_ī = f_i* − 6 w_i ρ c_i·u_w (Ladd 1994), with ρ the resulting density:
    /// summing over all directions, ρ = (1 + Σ f̃ without the wall's term) / (1 + 6 Σ w_i c_i·u_w).
    fn stream(&self, collided: &[[f64; Q]], cell: usize) -> [f64; Q] {
        let mut f = [0.0; Q];
        let mut wall_term = [0.0; Q];
        for i in 0..Q {
            let r = OPPOSITE[i];
            f[r] = match self.links[cell][i] {
                Link::Fluid(neighbour) => collided[neighbour][r],
                Link::Mirror { cell, direction } => collided[cell][direction],
                Link::Bounce => collided[cell][i],
                Link::Moving(u_w) => {
                    wall_term[r] = 6.0 * W[i] * c_dot(i, u_w);
                    collided[cell][i]
                }
            };
        }
        let rho = (1.0 + f.iter().sum::<f64>()) / (1.0 + wall_term.iter().sum::<f64>());
        std::array::from_fn(|r| f[r] - rho * wall_term[r])
    }

    fn cells(&self) -> std::ops::Range<usize> {
        0..self.domain.cell_count()
    }
}
