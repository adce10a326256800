//! The domain is a whole number of cells, and not too many of them.

use super::rules::{finite, positive, refuse};
use crate::error::Result;
use crate::scene::{Axis, Scene};

/// How far from whole the number of cells may be: far above the rounding of a division, far
/// below anything that a user could mean.
const WHOLE: f64 = 1e-6;
/// Most cells: kernels index the 27 populations of each with 32 bits.
const MOST_CELLS: f64 = (u32::MAX / 27) as f64;

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

    /// Without fluid there are no cells, and there need not be a box.
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

/// `value` without the noise of binary fractions, to be typed back.
fn tidy(value: f64) -> f64 {
    format!("{value:.12e}").parse().unwrap_or(value)
}
