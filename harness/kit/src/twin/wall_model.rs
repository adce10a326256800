//! A wall law instead of no slip on plane walls at rest: its stress is imposed on the populations that they return.

use super::domain::{Domain, Link};
use super::lattice::{C, OPPOSITE, Q, W};
use std::collections::HashSet;

/// Law of the velocity near a smooth wall, from which the stress follows.
#[derive(Clone, Copy, Debug)]
pub enum WallLaw {
    /// u⁺ = y⁺ up to 11.81, then 8.3 y⁺^(1/7) (Werner & Wengle 1991).
    WernerWengle,
    /// Reichardt 1951 with κ = 0.384, B = 4.27.
    Reichardt,
}

/// The model of the walls of a flow.
#[derive(Clone, Debug)]
pub struct WallModel {
    /// Law of smooth walls.
    pub law: WallLaw,
    /// k_s of the lower and upper face of x, y, z, cells.
    pub roughness: [[f64; 2]; 3],
    /// k_s of each solid cell, cells; empty if they are smooth.
    pub solid_roughness: Vec<f32>,
    /// Whether it acts on blocks.
    pub on_blocks: bool,
    /// Whether it also acts on faces at an angle to the grid.
    pub on_slopes: bool,
    /// Whether it acts on exact surfaces at rest at any angle.
    pub on_surfaces: bool,
    /// Fraction of each cell that solids at rest fill in part; empty if there are none.
    pub surface: Vec<f64>,
}

/// A cell whose face `axis`, `side` is a plane wall.
#[derive(Clone, Copy, Debug)]
struct Wall {
    cell: usize,
    axis: usize,
    side: usize,
}

impl Wall {
    /// The cell of a layer, counted from the wall.
    fn layer(&self, domain: &Domain, layer: usize) -> Option<usize> {
        let step = [1, -1][self.side];
        (0..layer).try_fold(self.cell, |cell, _| {
            domain.fluid_neighbour(cell, self.axis, step)
        })
    }

    /// The cell whose velocity the law reads.
    fn sample(&self, domain: &Domain) -> usize {
        self.layer(domain, 4).expect("five cells are fluid")
    }

    /// Tangential part of a vector.
    fn along(&self, mut u: [f64; 3]) -> [f64; 3] {
        u[self.axis] = 0.0;
        u
    }

    /// Whether a direction leads into the wall.
    fn is_into(&self, i: usize) -> bool {
        C[i][self.axis] == [-1, 1][self.side]
    }
}

pub(super) fn norm(u: [f64; 3]) -> f64 {
    u.iter().map(|v| v * v).sum::<f64>().sqrt()
}

impl WallLaw {
    /// u⁺ at y⁺.
    pub fn speed(self, y: f64) -> f64 {
        let k: f64 = 0.384;
        match self {
            Self::WernerWengle if y <= 11.81 => y,
            Self::WernerWengle => 8.3 * y.powf(1.0 / 7.0),
            Self::Reichardt => {
                let c = 4.27 - k.ln() / k;
                (1.0 + k * y).ln() / k + c * (1.0 - (-y / 11.0).exp() - y / 11.0 * (-y / 3.0).exp())
            }
        }
    }

    /// τ/ρ of a smooth wall, from the speed u at the distance y.
    pub(super) fn stress(self, u: f64, y: f64, nu: f64) -> f64 {
        if u == 0.0 {
            return 0.0;
        }
        match self {
            Self::WernerWengle if u * y / nu <= 11.81 * 11.81 => nu * u / y,
            Self::WernerWengle => (u / 8.3).powf(1.75) * (nu / y).powf(0.25),
            Self::Reichardt => {
                // y⁺ u⁺(y⁺) = u y / ν, by bisection of its logarithm.
                let (mut low, mut high) = (1e-9f64.ln(), 1e12f64.ln());
                for _ in 0..200 {
                    let middle = 0.5 * (low + high);
                    let wall_units = middle.exp();
                    if wall_units * self.speed(wall_units) < u * y / nu {
                        low = middle;
                    } else {
                        high = middle;
                    }
                }
                (nu * low.exp() / y).powi(2)
            }
        }
    }
}

impl WallModel {
    /// τ/ρ, by the log law of rough walls where that is larger.
    fn stress(&self, wall: &Wall, domain: &Domain, u: f64, y: f64, nu: f64) -> f64 {
        let at = domain.position(wall.cell)[wall.axis];
        let at_face = at == [0, domain.cells[wall.axis] - 1][wall.side];
        let inside = matches!(
            domain.faces[2 * wall.axis + wall.side],
            super::Face::Periodic
        );
        let k_s = if at_face && !inside {
            self.roughness[wall.axis][wall.side]
        } else if self.solid_roughness.is_empty() {
            0.0
        } else {
            let n = domain.cells[wall.axis];
            let mut behind = domain.position(wall.cell);
            behind[wall.axis] = (at + [n - 1, 1][wall.side]) % n;
            self.solid_roughness[domain.index(behind)].into()
        };
        self.rough_stress(u, y, nu, k_s)
    }

    /// The same for a roughness, cells.
    pub(super) fn rough_stress(&self, u: f64, y: f64, nu: f64, k_s: f64) -> f64 {
        let smooth = self.law.stress(u, y, nu);
        if k_s == 0.0 {
            return smooth;
        }
        let rough = 0.4 * u / (30.0 * y / k_s).max(2.0).ln();
        smooth.max(rough * rough)
    }

    /// The cells at plane walls with five cells of plain fluid in front of the wall, each with whether a block is in one of these.
    fn walls(&self, domain: &Domain, blocks: &[bool]) -> Vec<(Wall, bool)> {
        let mut walls = Vec::new();
        for axis in 0..3 {
            for side in 0..2 {
                for cell in (0..domain.cell_count()).filter(|&cell| !domain.solid[cell]) {
                    let wall = Wall { cell, axis, side };
                    let plane = (1..Q).all(|i| match domain.link(cell, i) {
                        Link::Bounce => wall.is_into(i),
                        Link::Fluid(_) | Link::Mirror { .. } => !wall.is_into(i),
                        Link::Moving(_) => false,
                    });
                    if plane && wall.layer(domain, 4).is_some() {
                        let marked = |cells: &dyn Fn(usize) -> bool| {
                            (0..5)
                                .filter_map(|layer| wall.layer(domain, layer))
                                .any(cells)
                        };
                        if !marked(&|cell| self.surface.get(cell).is_some_and(|e| *e > 0.0)) {
                            let block = |cell: usize| blocks.get(cell) == Some(&true);
                            walls.push((wall, marked(&block)));
                        }
                    }
                }
            }
        }
        walls
    }

    /// The fluid cells at these walls.
    pub(super) fn plane_cells(&self, domain: &Domain) -> impl Iterator<Item = usize> {
        let walls = self.walls(domain, &[]).into_iter();
        let edges = self.edges(domain, &[]).into_iter();
        let at_edges = edges.map(|([wall, _], _)| wall.cell);
        walls.map(|(wall, _)| wall.cell).chain(at_edges)
    }

    /// Friction on a wall: the tangential velocity that the law reads, the stress over the density, and the share of the model.
    fn friction(
        &self,
        wall: &Wall,
        domain: &Domain,
        nu: f64,
        u: &[[f64; 3]],
    ) -> ([f64; 3], f64, f64) {
        let along = wall.along(u[wall.sample(domain)]);
        let stress = self.stress(wall, domain, norm(along), 4.5, nu);
        (along, stress, share(stress.sqrt(), nu))
    }

    /// The cells at edges between two such walls, with both, and whether a block is in one of the five cells before these.
    fn edges(&self, domain: &Domain, blocks: &[bool]) -> Vec<([Wall; 2], bool)> {
        let mut edges = Vec::new();
        for cell in (0..domain.cell_count()).filter(|&cell| !domain.solid[cell]) {
            let sides = (0..3).flat_map(|axis| [0, 1].map(|side| Wall { cell, axis, side }));
            let straight = |wall: &Wall| {
                (1..7).any(|i| wall.is_into(i) && matches!(domain.link(cell, i), Link::Bounce))
            };
            let walls: Vec<Wall> = sides.filter(straight).collect();
            let [first, second] = walls[..] else {
                continue;
            };
            let into = |i| first.is_into(i) || second.is_into(i);
            let are_alone = (1..Q).all(|i| match domain.link(cell, i) {
                Link::Bounce => into(i),
                Link::Fluid(_) | Link::Mirror { .. } => !into(i),
                Link::Moving(_) => false,
            });
            let layers = |wall: &Wall| (0..5).map(|n| wall.layer(domain, n)).collect();
            let before: Option<Vec<usize>> = layers(&first);
            let beside: Option<Vec<usize>> = layers(&second);
            let (Some(mut cells), Some(others)) = (before, beside) else {
                continue;
            };
            cells.extend(others);
            let is_cut = |cell: &usize| self.surface.get(*cell).is_some_and(|e| *e > 0.0);
            if are_alone && first.axis != second.axis && !cells.iter().any(is_cut) {
                let blocked = cells.iter().any(|&cell| blocks.get(cell) == Some(&true));
                edges.push(([first, second], blocked));
            }
        }
        edges
    }

    /// The axis of an edge; the velocity along it that the law of each wall reads, and the stress of each over the density; the
    /// friction velocity of the first and the share of both.
    fn edge_friction(
        &self,
        walls: &[Wall; 2],
        domain: &Domain,
        nu: f64,
        u: &[[f64; 3]],
    ) -> (usize, [f64; 2], [f64; 2], f64, f64) {
        let axis = 3 - walls[0].axis - walls[1].axis;
        let read = |wall: &Wall| u[wall.sample(domain)][axis];
        let speeds = [read(&walls[0]), read(&walls[1])];
        let stress = [0, 1].map(|n| self.stress(&walls[n], domain, speeds[n].abs(), 4.5, nu));
        let part = share(stress[0].min(stress[1]).sqrt(), nu);
        let signed = [0, 1].map(|n| stress[n] * speeds[n].signum());
        (axis, speeds, signed, stress[0].sqrt(), part)
    }

    /// The cells up to four layers from these walls, each with its nearest wall, the layer, and whether a block is near the wall.
    fn near_walls(&self, domain: &Domain, blocks: &[bool]) -> Vec<(usize, Wall, usize, bool)> {
        let mut found = Vec::new();
        let edges = self.edges(domain, &[]);
        let mut taken: HashSet<usize> = edges.iter().map(|([wall, _], _)| wall.cell).collect();
        let mut growing = self.walls(domain, blocks);
        for layer in 0..4 {
            growing.retain(|(wall, blocked)| {
                let cell = wall.layer(domain, layer).expect("five cells are fluid");
                let own = taken.insert(cell);
                if own {
                    found.push((cell, *wall, layer, *blocked));
                }
                own
            });
        }
        found
    }

    /// The cells whose smallest eddy viscosity these walls give.
    pub(super) fn cells_near_walls(&self, domain: &Domain) -> HashSet<usize> {
        let near = self.near_walls(domain, &[]).into_iter();
        let edges = self.edges(domain, &[]).into_iter();
        let at_edges = edges.map(|([wall, _], _)| wall.cell);
        near.map(|(cell, ..)| cell).chain(at_edges).collect()
    }

    /// Smallest eddy viscosity of each cell: κ y u_τ of the nearest wall, tapered over four cells. `blocks` marks the cells with
    /// a block in the previous step; it may be empty.
    pub fn viscosity(&self, domain: &Domain, nu: f64, u: &[[f64; 3]], blocks: &[bool]) -> Vec<f64> {
        let mut found = vec![0.0; domain.cell_count()];
        for (cell, wall, layer, blocked) in self.near_walls(domain, blocks) {
            if !blocked {
                let (_, stress, part) = self.friction(&wall, domain, nu, u);
                let taper = [1.0, 0.75, 0.4, 0.15][layer];
                found[cell] = taper * 0.4 * (layer as f64 + 0.5) * stress.sqrt() * part;
            }
        }
        for (walls, blocked) in self.edges(domain, blocks) {
            if !blocked {
                let (.., friction, part) = self.edge_friction(&walls, domain, nu, u);
                found[walls[0].cell] = 0.4 * 0.5 * friction * part;
            }
        }
        found
    }

    /// Corrects populations returned by walls with no slip to the stress of the law: of the momentum P into the wall
    /// 2P would be lost; 2P − m/3 is lost with f_ī = f_i* − 6 w_i c_i·m. P is without the 3/2 Σ w_i c_i c_i·F of fluid at rest under
    /// a `force` F of each cell that the pressure balances.
    pub fn hand_over(
        &self,
        domain: &Domain,
        nu: f64,
        u: &[[f64; 3]],
        (blocks, force): (&[bool], &[[f64; 3]]),
        f: &mut [[f64; Q]],
    ) {
        for (wall, blocked) in self.walls(domain, blocks) {
            let (along, stress, part) = self.friction(&wall, domain, nu, u);
            if part == 0.0 || blocked {
                continue;
            }
            let speed = norm(along);
            let own = &mut f[wall.cell];
            let into = || (1..Q).filter(|&i| wall.is_into(i));
            let arriving = [0, 1, 2].map(|a| {
                into()
                    .map(|i| (own[OPPOSITE[i]] - at_rest(i, force[wall.cell])) * f64::from(C[i][a]))
                    .sum::<f64>()
            });
            let arriving = wall.along(arriving);
            let full = [0, 1, 2].map(|a| 3.0 * (2.0 * arriving[a] - stress * along[a] / speed));
            let bound = (2.0 * speed / norm(full)).min(1.0);
            for i in into() {
                let c_m: f64 = (0..3).map(|a| f64::from(C[i][a]) * full[a]).sum();
                own[OPPOSITE[i]] -= 6.0 * W[i] * part * bound * c_m;
            }
        }
        for (walls, blocked) in self.edges(domain, blocks) {
            let (axis, speeds, stress, _, part) = self.edge_friction(&walls, domain, nu, u);
            if part == 0.0 || blocked {
                continue;
            }
            let own = &mut f[walls[0].cell];
            let into: Vec<usize> = (1..Q)
                .filter(|&i| walls[0].is_into(i) || walls[1].is_into(i))
                .collect();
            let along = |i: usize| f64::from(C[i][axis]);
            let mut along_edge = [0.0; 3];
            along_edge[axis] = force[walls[0].cell][axis];
            let net = |i: usize| own[OPPOSITE[i]] - at_rest(i, along_edge);
            let arriving: f64 = into.iter().map(|&i| net(i) * along(i)).sum();
            let lost: f64 = into.iter().map(|&i| 6.0 * W[i] * along(i) * along(i)).sum();
            let most = 2.0 * speeds[0].abs().max(speeds[1].abs());
            let full = (2.0 * arriving - stress[0] - stress[1]) / lost;
            let m = part * full.clamp(-most, most);
            for i in into {
                own[OPPOSITE[i]] -= 6.0 * W[i] * along(i) * m;
            }
        }
    }
}

/// What the force adds to the population in a direction in fluid at rest.
pub(super) fn at_rest(i: usize, force: [f64; 3]) -> f64 {
    let along: f64 = (0..3).map(|a| f64::from(C[i][a]) * force[a]).sum();
    1.5 * W[i] * along
}

/// The share of the model: 0 up to y⁺ = 3 of the first cell, 1 from 6 on.
pub(super) fn share(friction: f64, nu: f64) -> f64 {
    let s = ((0.5 * friction / nu - 3.0) / 3.0).clamp(0.0, 1.0);
    s * s * (3.0 - 2.0 * s)
}
