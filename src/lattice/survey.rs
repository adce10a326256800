//! What lies around a cell, and the links to it.

use super::{
    C, Face, Grid, Link, Setup,
    directions::{direction, opposite},
};

/// Target of a direction from a fluid cell.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Beyond {
    Fluid,
    /// Static solid or a wall at rest.
    Wall,
    /// A wall or inlet with a velocity, normal to this axis.
    Moving(usize),
    /// Pressure or outflow face, by axis and side.
    Open(usize, usize),
    /// Free-slip faces normal to these axes.
    Slip([bool; 3]),
}

pub(super) struct Survey<'a> {
    pub setup: &'a Setup,
    pub grid: &'a Grid,
    periodic: [bool; 3],
}

impl<'a> Survey<'a> {
    pub fn new(setup: &'a Setup, grid: &'a Grid) -> Self {
        Self {
            setup,
            grid,
            periodic: setup.periodic_axes(),
        }
    }

    pub(super) fn is_solid(&self, cell: [u32; 3]) -> bool {
        let solid = &self.setup.solid;
        !solid.is_empty() && solid[self.grid.index(cell)]
    }

    /// Whether static solids fill the cell in part.
    pub(super) fn is_surface(&self, cell: [u32; 3]) -> bool {
        let index = self.grid.index(cell) as u32;
        let surface = &self.setup.surface;
        surface.binary_search_by_key(&index, |s| s.cell).is_ok()
    }

    /// Whether all 26 neighbours are fluid cells of the domain or may be treated so: a shortcut for most
    /// cells. Returns false for cells at faces if solids have to be looked up.
    pub(super) fn is_inside(&self, cell: [u32; 3]) -> bool {
        let off_the_face = |a: usize| (1..self.grid.cells[a].saturating_sub(1)).contains(&cell[a]);
        let solid = &self.setup.solid;
        if solid.is_empty() {
            return (0..3).all(|a| self.periodic[a] || off_the_face(a));
        }
        if !(0..3).all(off_the_face) {
            return false;
        }
        let [nx, ny, _] = self.grid.cells.map(|n| n as usize);
        let here = self.grid.index(cell);
        let rows = [0, nx, 2 * nx].into_iter().flat_map(|row| {
            [0, nx * ny, 2 * nx * ny].map(|plane| here - nx * ny - nx - 1 + row + plane)
        });
        rows.into_iter()
            .all(|first| !solid[first..first + 3].contains(&true))
    }

    /// The cell next to one in a direction, across periodic faces too; none outside the domain.
    pub(super) fn neighbour_in_domain(&self, cell: [u32; 3], c: [i32; 3]) -> Option<[u32; 3]> {
        self.grid.neighbour_in_domain(cell, c, self.periodic)
    }

    pub(super) fn padded_index(&self, [x, y, z]: [u32; 3]) -> u32 {
        let [nx, ny, _] = self.grid.padded();
        x + nx * (y + ny * z)
    }

    /// The neighbour of a cell on the inside of a face, or the cell itself where that is not fluid.
    pub(super) fn inner(&self, cell: [u32; 3], axis: usize, side: usize) -> u32 {
        let mut inward = [0; 3];
        inward[axis] = if side == 0 { 1 } else { -1 };
        let inner = self.grid.neighbour(cell, inward);
        let fluid = self.grid.contains(inner) && !self.is_solid(inner);
        self.padded_index(if fluid { inner } else { cell })
    }

    /// Target of direction `q`. If it crosses several faces, the first of velocity, solid, wall, moving wall, pressure or outflow,
    /// free slip applies: so the flow through a velocity face between walls or solids is exact.
    pub(super) fn beyond(&self, cell: [u32; 3], q: usize) -> Beyond {
        let mut to = cell;
        let mut crossed = [None; 3];
        for a in 0..3 {
            let n = i64::from(self.grid.cells[a]);
            let at = i64::from(cell[a]) + i64::from(C[q][a]);
            if (0..n).contains(&at) || self.periodic[a] {
                to[a] = at.rem_euclid(n) as u32;
            } else {
                crossed[a] = Some(usize::from(at >= n));
            }
        }
        // A solid next to the face continues beyond it.
        let nearest = [0, 1, 2].map(|a| if crossed[a].is_some() { cell[a] } else { to[a] });
        if self.is_solid(nearest) {
            let is_inlet = |axis: &usize| {
                let side = crossed[*axis];
                side.is_some_and(|side| matches!(self.setup.faces[*axis][side], Face::Velocity(_)))
            };
            return (0..3).find(is_inlet).map_or(Beyond::Wall, Beyond::Moving);
        }
        let mut found = Beyond::Fluid;
        let mut best = 0;
        let mut slip = [false; 3];
        for (axis, side) in (0..3).filter_map(|a| Some((a, crossed[a]?))) {
            let (rank, beyond) = match &self.setup.faces[axis][side] {
                Face::Velocity(_) => (5, Beyond::Moving(axis)),
                Face::Wall([0.0, 0.0, 0.0]) => (4, Beyond::Wall),
                Face::Wall(_) => (3, Beyond::Moving(axis)),
                Face::Pressure { .. } | Face::Outflow { .. } => (2, Beyond::Open(axis, side)),
                Face::FreeSlip | Face::Periodic => {
                    slip[axis] = true;
                    (1, Beyond::Slip(slip))
                }
            };
            if rank > best || rank == 1 && best == 1 {
                (best, found) = (rank, beyond);
            }
        }
        found
    }

    /// Index of the population that `cell` loads in direction `q` in an even step.
    fn incoming(&self, cell: [u32; 3], q: usize) -> (u32, u32) {
        if q % 2 == 1 {
            (self.grid.scalar_of(cell), q as u32 + 1)
        } else {
            let owner = self.grid.neighbour(cell, C[q - 1]);
            (self.grid.scalar_of(owner), q as u32 - 1)
        }
    }

    /// Adds a link: the population that `sender` sent in direction `sent` returns to `receiver` in direction `received`.
    pub(super) fn link(
        &self,
        sender: [u32; 3],
        sent: usize,
        receiver: [u32; 3],
        received: usize,
    ) -> Link {
        let arrived = self.grid.neighbour(sender, C[sent]);
        let (from, direction_from) = self.incoming(arrived, sent);
        let (to, direction_to) = self.incoming(receiver, received);
        Link {
            from,
            to,
            directions: direction_from | direction_to << 5,
            step: 0,
        }
    }

    /// Specular reflection at the faces normal to `axes`: what enters `cell` against `q` left the
    /// cell next to it towards the same faces; bounce-back where that one is not fluid.
    pub(super) fn slip(&self, cell: [u32; 3], q: usize, axes: [bool; 3]) -> Link {
        let entering = opposite(q);
        // The entering direction with its normal components reversed towards the face again.
        let sent = [0, 1, 2].map(|a| if axes[a] { C[q][a] } else { C[entering][a] });
        let tangential = [0, 1, 2].map(|a| if axes[a] { 0 } else { C[q][a] });
        let along = direction(tangential);
        let sent = direction(sent);
        if along == 0 {
            return self.link(cell, sent, cell, entering);
        }
        if self.beyond(cell, along) != Beyond::Fluid {
            return self.link(cell, q, cell, entering);
        }
        let sender = [0, 1, 2].map(|a| {
            let n = i64::from(self.grid.cells[a]);
            (i64::from(cell[a]) + i64::from(tangential[a])).rem_euclid(n) as u32
        });
        self.link(sender, sent, cell, entering)
    }
}
