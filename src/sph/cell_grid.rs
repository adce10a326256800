//! The cell grid of the neighbour search, and the conversion between SI and device units.

use super::{NeighbourSearch, Setup, Side};
use crate::{Error, Result, geometry::Load};
use glam::{DMat3, DVec3};

/// Largest number of bits per spacing: the longest distance in a sum, twelve spacings, is exact in f32.
const MAX_SPACING_BITS: i32 = 20;
/// Smallest number of bits per spacing: the resolution is a thousandth of a spacing.
const MIN_SPACING_BITS: i32 = 10;
/// Bits of a coordinate: the difference of two coordinates plus a period does not overflow.
const COORDINATE_BITS: i32 = 29;

/// Skin of the neighbour lists beyond the support, spacings. Water at a thirtieth of the speed of sound covers it in a
/// dozen steps; longer lists cost more than they save (lavapipe, h/Δx = 1.5 and 2).
const SKIN: f64 = 0.125;
/// Smallest number of cells in a period, so that no cell is visited twice.
const MIN_PERIODIC_CELLS: i32 = 5;

/// Cell grid and device units. Lengths on the device are in spacings Δx, times in Δx/c₀, masses in particle masses.
/// Coordinates are whole numbers of quanta from the lower corner of the grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellGrid {
    /// Lower corner, m.
    pub origin: DVec3,
    /// Quanta per spacing, a power of two.
    pub quanta: f64,
    /// Cells along each axis.
    pub cells: [i32; 3],
    /// Edge lengths of a cell, quanta.
    pub edge: [i32; 3],
    /// Period, quanta; 0 along axes that are not periodic.
    pub period: [i32; 3],
    /// Half-open range of coordinates of particles that have not escaped: the domain and one spacing into its walls, quanta.
    pub kept: [[i32; 3]; 2],
    /// Skin of the neighbour lists beyond the support of the kernel function, spacings.
    pub skin: f64,
    spacing: f64,
    sound_speed: f64,
    /// Unit of force m c₀²/Δx, N.
    unit_force: f64,
    /// ρ₀ c₀², Pa.
    unit_pressure: f64,
}

impl CellGrid {
    /// The grid of a setup.
    ///
    /// # Errors
    /// [`Error::Argument`] if a periodic axis is not a whole number of spacings or shorter than five cells, or if the
    /// domain has too many spacings.
    pub fn new(setup: &Setup) -> Result<Self> {
        setup.check()?;
        match setup.neighbours {
            NeighbourSearch::Cells => Self::with_skin(setup, 0.0),
            // A period of five cells leaves no space for a skin.
            NeighbourSearch::Lists => {
                Self::with_skin(setup, SKIN).or_else(|_| Self::with_skin(setup, 0.0))
            }
        }
    }

    fn with_skin(setup: &Setup, skin: f64) -> Result<Self> {
        let spacings = setup.size / setup.spacing;
        let margin = f64::from(setup.layers() + 1);
        let longest = (spacings + 2.0 * margin).max_element();
        let bits = (COORDINATE_BITS - longest.log2().ceil() as i32).min(MAX_SPACING_BITS);
        if bits < MIN_SPACING_BITS {
            return Err(Error::argument(
                "spacing",
                format!(
                    "the domain is {longest:.0} spacings long and coordinates have {COORDINATE_BITS} bits; use a larger \
                     spacing, or a smaller domain"
                ),
            ));
        }
        let quanta = f64::from(1 << bits);
        // Half of the search radius: neighbours are at most two cells away.
        let half = ((setup.smoothing + 0.5 * skin) * quanta).ceil() as i32;
        let mut grid = Self {
            origin: setup.origin,
            quanta,
            cells: [1; 3],
            edge: [half; 3],
            period: [0; 3],
            kept: [[i32::MIN; 3], [i32::MAX; 3]],
            skin,
            spacing: setup.spacing,
            sound_speed: setup.sound_speed,
            unit_force: setup.particle_mass() * setup.spacing / setup.unit_time().powi(2),
            unit_pressure: setup.density * setup.sound_speed.powi(2),
        };
        for axis in 0..3 {
            let length = spacings[axis];
            if setup.plane && axis == 1 {
                // All particles are in one plane, in the middle of the only cell.
                grid.origin.y = setup.origin.y + 0.5 * (setup.size.y - setup.spacing);
                continue;
            }
            match setup.faces[axis] {
                [Side::Periodic, Side::Periodic] => {
                    grid.set_periodic(axis, length, half)?;
                }
                [Side::Periodic, _] | [_, Side::Periodic] => {
                    let message = "one of two opposite faces is periodic; make both periodic";
                    return Err(Error::argument("faces", message));
                }
                sides => {
                    grid.origin[axis] = setup.origin[axis] - margin * setup.spacing;
                    let whole = ((length + 2.0 * margin) * quanta).ceil();
                    grid.cells[axis] = (whole / f64::from(half)).ceil() as i32;
                    // A particle a spacing deep in a wall has escaped.
                    let wall_depth = |side| if side == Side::Open { 0.0 } else { 1.0 };
                    grid.kept[0][axis] = ((margin - wall_depth(sides[0])) * quanta).floor() as i32;
                    grid.kept[1][axis] =
                        ((margin + length + wall_depth(sides[1])) * quanta).ceil() as i32;
                }
            }
        }
        let cells = grid.cells.map(f64::from);
        if cells.iter().product::<f64>() >= f64::from(u32::MAX >> 2) {
            let message = "the neighbour search has over a billion cells; use a larger spacing";
            return Err(Error::argument("spacing", message));
        }
        Ok(grid)
    }

    /// Makes an axis of `length` spacings periodic.
    fn set_periodic(&mut self, axis: usize, length: f64, half: i32) -> Result<()> {
        let name = ["x", "y", "z"][axis];
        let whole = length.round();
        if (length - whole).abs() > 1e-6 * whole {
            return Err(Error::argument(
                "size",
                format!(
                    "{name} is periodic and {length:.6} spacings long; make it a whole number of spacings"
                ),
            ));
        }
        let period = (whole * self.quanta) as i32;
        // The last cell may be a little shorter than the others.
        let fits = |cells: i32| {
            let edge = (f64::from(period) / f64::from(cells)).ceil() as i32;
            (edge >= half && period - edge * (cells - 1) >= half).then_some(edge)
        };
        let most = period / half;
        let found = (MIN_PERIODIC_CELLS..=most)
            .rev()
            .find_map(|cells| Some((cells, fits(cells)?)));
        let Some((cells, edge)) = found else {
            return Err(Error::argument(
                "size",
                format!(
                    "{name} is periodic and {whole} spacings long, and a pair of particles must interact once only; \
                     make it at least {} spacings, or use particles.plane",
                    (f64::from(MIN_PERIODIC_CELLS * half) / self.quanta).ceil()
                ),
            ));
        };
        (self.period[axis], self.cells[axis], self.edge[axis]) = (period, cells, edge);
        Ok(())
    }

    /// Number of cells.
    pub fn cell_count(&self) -> u64 {
        self.cells.map(|n| n as u64).iter().product()
    }

    /// Coordinates of a position (m) in quanta, inside the period.
    pub fn quantise(&self, position: DVec3) -> [i32; 3] {
        let mut quanta = ((position - self.origin) / self.spacing * self.quanta).round();
        for axis in 0..3 {
            if self.period[axis] > 0 {
                quanta[axis] = quanta[axis].rem_euclid(f64::from(self.period[axis]));
            }
        }
        // The conversion saturates, so positions far outside stay outside.
        quanta.to_array().map(|q| q as i32)
    }

    /// Position (m) of coordinates in quanta.
    pub fn position(&self, quanta: [i32; 3]) -> DVec3 {
        self.origin + DVec3::from(quanta.map(f64::from)) / self.quanta * self.spacing
    }

    /// Whether coordinates in quanta are inside the grid.
    pub fn contains(&self, quanta: [i32; 3]) -> bool {
        (0..3).all(|axis| {
            let at = i64::from(quanta[axis]);
            let end = i64::from(self.edge[axis]) * i64::from(self.cells[axis]);
            let [from, to] = self.kept.map(|kept| i64::from(kept[axis]));
            (from.max(0)..to.min(end)).contains(&at)
        })
    }

    /// Converts a length from m to spacings.
    pub fn length(&self, length: DVec3) -> DVec3 {
        length / self.spacing
    }

    /// Converts a velocity from m/s to speeds of sound.
    pub fn velocity(&self, velocity: DVec3) -> DVec3 {
        velocity / self.sound_speed
    }

    /// Converts a rate from 1/s to device units.
    pub fn rate(&self, rate: DMat3) -> DMat3 {
        rate * self.unit_time()
    }

    /// Converts an acceleration from m/s² to device units.
    pub fn acceleration(&self, acceleration: DVec3) -> DVec3 {
        acceleration * (self.unit_time() / self.sound_speed)
    }

    /// Unit of time Δx/c₀, s.
    pub fn unit_time(&self) -> f64 {
        self.spacing / self.sound_speed
    }

    /// Speed of sound, m/s.
    pub fn sound_speed(&self) -> f64 {
        self.sound_speed
    }

    /// Mean load over `time` (device units) from its time integral: force, and rows of Σ f ⊗ r.
    pub fn load(&self, sums: &[f32], time: f64) -> Load {
        let unit = self.unit_force / time;
        let value = |n: usize| f64::from(sums[n]) * unit;
        let row = |i: usize| DVec3::new(value(3 + 3 * i), value(4 + 3 * i), value(5 + 3 * i));
        Load {
            force: DVec3::new(value(0), value(1), value(2)),
            // Rows i of f_i r_j are the columns of the transposed matrix.
            moment: DMat3::from_cols(row(0), row(1), row(2)).transpose() * self.spacing,
            ..Load::default()
        }
    }

    /// Converts A n ⊗ r from m³ to device units, in which it times a pressure is a moment.
    pub(super) fn strain_area(&self, area: DMat3) -> DMat3 {
        area * (self.unit_pressure / (self.unit_force * self.spacing))
    }

    /// Converts a work from device units to J.
    pub(super) fn work(&self, work: f32) -> f64 {
        f64::from(work) * self.unit_force * self.spacing
    }

    /// Mean pressure (Pa) over `time` (device units) from its time integral.
    pub fn pressure(&self, sum: f32, time: f64) -> f64 {
        f64::from(sum) / time * self.unit_pressure
    }
}
