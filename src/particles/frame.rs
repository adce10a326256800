//! The cells in which neighbours are found, and the border between SI and the units of the device.

use super::{Neighbours, Setup, Side};
use crate::{Error, Result, bodies::Load};
use glam::{DMat3, DVec3};

/// Bits of a spacing at most: the longest distance that matters, twelve spacings, still is exact in f32.
const MOST_BITS: i32 = 20;
/// Bits of a spacing at least: a thousandth of a spacing.
const LEAST_BITS: i32 = 10;
/// Bits of a place, so that differences of two and a period more do not overflow.
const PLACE_BITS: i32 = 29;

/// What lists of neighbours reach beyond the support, spacings. Water at a thirtieth of the speed of sound comes by
/// so much nearer to a wall in a dozen steps; longer lists cost more than they spare (lavapipe, h/Δx = 1.5 and 2).
const SKIN: f64 = 0.125;
/// Cells of a period at least, so that no cell is met twice.
const LEAST_CELLS: i32 = 5;

/// Cells and units. Lengths on the device are in spacings Δx, times in Δx/c₀, masses in those of a particle;
/// places are whole numbers of quanta from the lower corner of the frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Lower corner, m.
    pub origin: DVec3,
    /// Quanta a spacing, a power of two.
    pub quanta: f64,
    /// Cells along each axis.
    pub cells: [i32; 3],
    /// Edges of a cell, quanta.
    pub edge: [i32; 3],
    /// Quanta; 0 along axes that are not periodic.
    pub period: [i32; 3],
    /// Where a particle is still in the domain, or not yet through a wall: from, and to before, quanta.
    pub kept: [[i32; 3]; 2],
    /// What lists of neighbours reach beyond the support of the kernel function, spacings.
    pub skin: f64,
    spacing: f64,
    sound_speed: f64,
    /// Force of a particle's mass times Δx over the square of the unit of time, N.
    unit_force: f64,
    /// ρ₀ c₀², Pa.
    unit_pressure: f64,
}

impl Frame {
    /// The frame of a setup.
    ///
    /// # Errors
    /// [`Error::Scene`] if a periodic axis is not a whole number of spacings or shorter than five cells, or if the
    /// domain has too many spacings.
    pub fn new(setup: &Setup) -> Result<Self> {
        setup.check()?;
        match setup.neighbours {
            Neighbours::Cells => Self::with_skin(setup, 0.0),
            // A period of just five cells has no room for more.
            Neighbours::Lists => {
                Self::with_skin(setup, SKIN).or_else(|_| Self::with_skin(setup, 0.0))
            }
        }
    }

    fn with_skin(setup: &Setup, skin: f64) -> Result<Self> {
        let spacings = setup.size / setup.spacing;
        let margin = f64::from(setup.layers() + 1);
        let longest = (spacings + 2.0 * margin).max_element();
        let bits = (PLACE_BITS - longest.log2().ceil() as i32).min(MOST_BITS);
        if bits < LEAST_BITS {
            return Err(Error::scene(
                "particles.spacing",
                format!(
                    "the domain is {longest:.0} spacings long and places have {PLACE_BITS} bits; use a larger spacing, or a \
                     smaller domain"
                ),
            ));
        }
        let quanta = f64::from(1 << bits);
        // Half of what is found: neighbours are in this cell and two around it.
        let half = ((setup.smoothing + 0.5 * skin) * quanta).ceil() as i32;
        let mut frame = Self {
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
                // All are in one plane, in the middle of the only cell.
                frame.origin.y = setup.origin.y + 0.5 * (setup.size.y - setup.spacing);
                continue;
            }
            match setup.faces[axis] {
                [Side::Periodic, Side::Periodic] => {
                    frame.repeat(axis, length, half)?;
                }
                [Side::Periodic, _] | [_, Side::Periodic] => {
                    let message = "a periodic face wants the opposite one to be periodic";
                    return Err(Error::scene("boundaries", message));
                }
                sides => {
                    frame.origin[axis] = setup.origin[axis] - margin * setup.spacing;
                    let whole = ((length + 2.0 * margin) * quanta).ceil();
                    frame.cells[axis] = (whole / f64::from(half)).ceil() as i32;
                    // What is a spacing deep in a wall has passed it.
                    let through = |side| if side == Side::Open { 0.0 } else { 1.0 };
                    frame.kept[0][axis] = ((margin - through(sides[0])) * quanta).floor() as i32;
                    frame.kept[1][axis] =
                        ((margin + length + through(sides[1])) * quanta).ceil() as i32;
                }
            }
        }
        let cells = frame.cells.map(f64::from);
        if cells.iter().product::<f64>() >= f64::from(u32::MAX >> 2) {
            let message = "the frame of the search has over a billion cells; use a larger spacing";
            return Err(Error::scene("particles.spacing", message));
        }
        Ok(frame)
    }

    /// Makes an axis of `length` spacings periodic.
    fn repeat(&mut self, axis: usize, length: f64, half: i32) -> Result<()> {
        let name = ["x", "y", "z"][axis];
        let whole = length.round();
        if (length - whole).abs() > 1e-6 * whole {
            return Err(Error::scene(
                "domain.size",
                format!(
                    "{name} is periodic and {length:.6} spacings long; make it a whole number of them"
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
        let found = (LEAST_CELLS..=most)
            .rev()
            .find_map(|cells| Some((cells, fits(cells)?)));
        let Some((cells, edge)) = found else {
            return Err(Error::scene(
                "domain.size",
                format!(
                    "{name} is periodic and {whole} spacings long, and a particle must not meet another one twice; \
                     make it at least {} spacings, or use particles.plane",
                    (f64::from(LEAST_CELLS * half) / self.quanta).ceil()
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

    /// A place (m) in quanta, inside the period.
    pub fn place(&self, position: DVec3) -> [i32; 3] {
        let mut quanta = ((position - self.origin) / self.spacing * self.quanta).round();
        for axis in 0..3 {
            if self.period[axis] > 0 {
                quanta[axis] = quanta[axis].rem_euclid(f64::from(self.period[axis]));
            }
        }
        // Conversions saturate: what is far away stays far away.
        quanta.to_array().map(|q| q as i32)
    }

    /// The place of quanta, m.
    pub fn position(&self, place: [i32; 3]) -> DVec3 {
        self.origin + DVec3::from(place.map(f64::from)) / self.quanta * self.spacing
    }

    /// Whether a place lies in the frame.
    pub fn holds(&self, place: [i32; 3]) -> bool {
        (0..3).all(|axis| {
            let at = i64::from(place[axis]);
            let end = i64::from(self.edge[axis]) * i64::from(self.cells[axis]);
            let [from, to] = self.kept.map(|kept| i64::from(kept[axis]));
            (from.max(0)..to.min(end)).contains(&at)
        })
    }

    /// A length (m) in spacings.
    pub fn length(&self, length: DVec3) -> DVec3 {
        length / self.spacing
    }

    /// A velocity (m/s) in speeds of sound.
    pub fn velocity(&self, velocity: DVec3) -> DVec3 {
        velocity / self.sound_speed
    }

    /// A rate (1/s) in the unit of time.
    pub fn rate(&self, rate: DMat3) -> DMat3 {
        rate * self.unit_time()
    }

    /// An acceleration (m/s²).
    pub fn acceleration(&self, acceleration: DVec3) -> DVec3 {
        acceleration * (self.unit_time() / self.sound_speed)
    }

    /// s.
    pub fn unit_time(&self) -> f64 {
        self.spacing / self.sound_speed
    }

    /// Speed of sound, m/s.
    pub fn sound_speed(&self) -> f64 {
        self.sound_speed
    }

    /// The mean load over `time` (units of the device) of the twelve numbers that the device added up.
    pub fn load(&self, numbers: &[f32], time: f64) -> Load {
        let share = self.unit_force / time;
        let number = |n: usize| f64::from(numbers[n]) * share;
        let row = |i: usize| DVec3::new(number(3 + 3 * i), number(4 + 3 * i), number(5 + 3 * i));
        Load {
            force: DVec3::new(number(0), number(1), number(2)),
            // Rows i of f_i r_j are the columns of the transposed matrix.
            moment: DMat3::from_cols(row(0), row(1), row(2)).transpose() * self.spacing,
            ..Load::default()
        }
    }

    /// A work of the device in J.
    pub(super) fn work(&self, work: f32) -> f64 {
        f64::from(work) * self.unit_force * self.spacing
    }

    /// The mean pressure (Pa) over `time` (units of the device) of what the device added up.
    pub fn pressure(&self, sum: f32, time: f64) -> f64 {
        f64::from(sum) / time * self.unit_pressure
    }
}
