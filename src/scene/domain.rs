//! The computed domain and its cells.

use glam::DVec3;
use schemars::JsonSchema;
use serde::Deserialize;

use super::rules::{finite, positive, refuse};
use super::{Axis, Face, Scene};
use crate::{error::Result, geometry::HalfSpace};

/// Tolerance of points outside the domain, relative to its largest coordinate: some thousand times the rounding of f64.
const ROUNDING: f64 = 1e-12;

/// The computed box of space, divided into cubic cells for a fluid on a lattice. The default has no extent: no
/// domain.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Domain {
    /// Lower corner, m. Default (0, 0, 0).
    #[serde(default)]
    pub origin: [f64; 3],
    /// Edges, m. For a fluid on a lattice each is a whole number of cells.
    pub size: [f64; 3],
    /// Edge of a cell, m. Required for a fluid on a lattice.
    #[serde(default)]
    pub cell: f64,
}

impl Domain {
    /// The domain extended by its longest edge on each side. Along a periodic axis this is farther than any block reaches, so
    /// the box is the same in all periods.
    pub(crate) fn beyond(&self) -> [HalfSpace; 6] {
        let longest = self.size.into_iter().fold(0.0, f64::max);
        let end = self.end();
        std::array::from_fn(|face| {
            let (axis, sign) = (face / 2, if face % 2 == 0 { -1.0 } else { 1.0 });
            let mut normal = DVec3::ZERO;
            normal[axis] = sign;
            let at = if face % 2 == 0 {
                self.origin[axis]
            } else {
                end[axis]
            };
            HalfSpace {
                normal,
                distance: sign * at + longest,
            }
        })
    }

    /// Whether the scene has a domain.
    pub fn is_given(&self) -> bool {
        *self != Self::default()
    }

    /// Number of cells along x, y, z.
    pub fn cells(&self) -> [u32; 3] {
        self.size.map(|edge| (edge / self.cell).round() as u32)
    }

    /// Number of cells in all.
    pub fn cell_count(&self) -> usize {
        self.cells().iter().map(|n| *n as usize).product()
    }

    /// Upper corner, m.
    pub fn end(&self) -> [f64; 3] {
        std::array::from_fn(|a| self.origin[a] + self.size[a])
    }

    /// Centre of the domain, m.
    pub fn middle(&self) -> [f64; 3] {
        std::array::from_fn(|a| self.origin[a] + 0.5 * self.size[a])
    }

    /// Centre of the cell `ijk`, counted from 0 at the lower corner, m.
    pub fn centre(&self, ijk: [u32; 3]) -> [f64; 3] {
        std::array::from_fn(|a| self.origin[a] + (f64::from(ijk[a]) + 0.5) * self.cell)
    }

    /// Centres of all cells, x fastest, m.
    pub fn centres(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        let [nx, ny, nz] = self.cells();
        (0..nz).flat_map(move |k| {
            (0..ny).flat_map(move |j| (0..nx).map(move |i| self.centre([i, j, k])))
        })
    }

    /// Position of the plane of `face` along its axis, m.
    pub fn face_position(&self, face: Face) -> f64 {
        let axis = face.axis().index();
        if face.is_max() {
            self.end()[axis]
        } else {
            self.origin[axis]
        }
    }

    /// Centres of the outer cell faces on `face`, the lower of the two in-plane axes fastest, m.
    pub fn face_points(&self, face: Face) -> impl Iterator<Item = [f64; 3]> + '_ {
        let axis = face.axis().index();
        let [fast, slow] = face.axis().others().map(Axis::index);
        let cells = self.cells();
        let plane = self.face_position(face);
        (0..cells[slow]).flat_map(move |s| {
            (0..cells[fast]).map(move |f| {
                let mut ijk = [0; 3];
                ijk[fast] = f;
                ijk[slow] = s;
                let mut point = self.centre(ijk);
                point[axis] = plane;
                point
            })
        })
    }

    /// Whether `point` (m) lies in the domain, to a millionth of a cell or the rounding of decimal numbers: a domain of
    /// 7.6 m from −1.2 m ends at 6.3999… m.
    pub fn contains(&self, point: [f64; 3]) -> bool {
        let end = self.end();
        let largest = [self.origin, end].concat();
        let largest = largest.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let slack = (1e-6 * self.cell).max(ROUNDING * largest);
        (0..3).all(|a| point[a] >= self.origin[a] - slack && point[a] <= end[a] + slack)
    }
}

/// Tolerance of the number of cells from an integer: far above the rounding of a division, far
/// below any intended fraction.
const WHOLE: f64 = 1e-6;
/// Largest number of cells: kernels index them, and the padding of a folded dispatch, with 32 bits.
const MOST_CELLS: f64 = 4_290_773_055.0;

impl Scene {
    pub(super) fn check_domain(&self) -> Result<()> {
        let domain = &self.domain;
        if !self.has_fluid() {
            return self.check_dry_domain();
        }
        if let Some(particles) = &self.particles {
            return self.check_particle_domain(particles);
        }
        if !domain.is_given() {
            return refuse(
                "domain",
                "a fluid needs a box to flow in; add [domain] with size and cell",
            );
        }
        positive("domain.cell", domain.cell, "m")?;
        finite("domain.origin", &domain.origin)?;
        for axis in Axis::ALL {
            let size = domain.size[axis.index()];
            let key = format!("domain.size[{}]", axis.index());
            positive(key.as_str(), size, "m")?;
            let cells = size / domain.cell;
            if (cells - cells.round()).abs() > WHOLE || cells.round() < 1.0 {
                let below = cells.floor().max(1.0) * domain.cell;
                let above = (cells.floor() + 1.0).max(2.0) * domain.cell;
                return refuse(
                    key,
                    format!(
                        "{size} m along {} is {cells:.6} cells of {} m, not a whole number; the \
                         nearest sizes that fit are {} and {} m",
                        axis.name(),
                        domain.cell,
                        tidy(below),
                        tidy(above)
                    ),
                );
            }
        }
        let count: f64 = domain
            .size
            .iter()
            .map(|s| (s / domain.cell).round())
            .product();
        if count > MOST_CELLS {
            let coarser = domain.cell * (count / MOST_CELLS).cbrt();
            return refuse(
                "domain.cell",
                format!(
                    "the domain has {count:.3e} cells, more than {MOST_CELLS:.3e}; use cell ≥ \
                     {coarser:.3e} m or a smaller domain"
                ),
            );
        }
        Ok(())
    }

    /// Checks the domain of a scene without fluid, which has no cells and need not have a domain.
    fn check_dry_domain(&self) -> Result<()> {
        let domain = &self.domain;
        if !domain.is_given() {
            return Ok(());
        }
        finite("domain.origin", &domain.origin)?;
        for (axis, size) in domain.size.iter().enumerate() {
            positive(format!("domain.size[{axis}]"), *size, "m")?;
        }
        Ok(())
    }
}

/// `value` rounded to as many digits as a user would type.
fn tidy(value: f64) -> f64 {
    format!("{value:.12e}").parse().unwrap_or(value)
}
