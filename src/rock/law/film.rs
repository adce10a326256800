//! The resistance of a film of fluid that is squeezed out of a thin gap, in addition to that of a grid which does not resolve
//! gaps narrower than h₀: lubrication theory (Reynolds 1886; for spheres the leading term of Brenner 1961),
//! less its value at that gap (Nguyen & Ladd 2002, Phys. Rev. E 66:046708).

use super::LoadDelay;
use crate::{
    Error, Result,
    rock::{
        check::positive,
        contact::{GapShape, ThinGap},
    },
};
use std::f64::consts::PI;

/// A fluid between blocks whose flow in thin gaps is not resolved by the fluid solver.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// Dynamic viscosity μ, Pa s; 0 for an inviscid fluid.
    pub viscosity: f64,
    /// Gap h₀ above which the flow is resolved if one side is a sphere, m.
    pub round: f64,
    /// The same between faces, m.
    pub flat: f64,
    /// Gap below which the resistance no longer grows, the roughness of the faces, m.
    pub roughness: f64,
    /// Delay of the loads of the fluid; `None` without delay.
    pub delay: Option<LoadDelay>,
    /// Blocks along which the fluid slips, ascending. Between one of them and a block without slip the resistance is a
    /// quarter.
    pub slip: Vec<usize>,
}

impl Film {
    /// Checks the numbers.
    ///
    /// # Errors
    /// [`Error::Argument`] naming the number and its range.
    pub fn check(&self) -> Result<()> {
        if !(self.viscosity >= 0.0 && self.viscosity.is_finite()) {
            let message = format!("{} must not be negative Pa s", self.viscosity);
            return Err(Error::argument("film.viscosity", message));
        }
        positive("film.round", self.round, "m")?;
        positive("film.flat", self.flat, "m")?;
        positive("film.roughness", self.roughness, "m")?;
        self.delay.iter().try_for_each(LoadDelay::check)
    }

    /// Widest gap with a film, m.
    pub fn reach(&self) -> f64 {
        let delay = self.delay.map_or(0.0, |delay| delay.range);
        self.round.max(self.flat).max(delay)
    }

    /// Normal force over the closing velocity of the gap, N s/m: 6πμR²(1/h − 1/h₀) for spheres,
    /// 3μJ(1/h³ − 1/h₀³) for faces, which is 3πμR⁴/2 (1/h³ − 1/h₀³) for discs.
    pub fn resistance(&self, thin_gap: &ThinGap) -> f64 {
        match &thin_gap.shape {
            GapShape::Round { radius } => {
                6.0 * PI
                    * self.viscosity
                    * radius
                    * radius
                    * self.excess(thin_gap.gap, self.round, 1)
            }
            GapShape::Flat {
                torsion, flatness, ..
            } => {
                3.0 * self.viscosity * torsion * flatness * self.excess(thin_gap.gap, self.flat, 3)
            }
        }
    }

    /// Moment over the tilt rate of the gap, N m s, about each axis of two faces.
    pub fn tilting(&self, thin_gap: &ThinGap) -> [f64; 2] {
        match &thin_gap.shape {
            GapShape::Round { .. } => [0.0; 2],
            GapShape::Flat {
                tilts, flatness, ..
            } => tilts.map(|tilt| {
                self.viscosity * tilt * flatness * self.excess(thin_gap.gap, self.flat, 3)
            }),
        }
    }

    /// 1/hⁿ − 1/h₀ⁿ, 0 above h₀.
    fn excess(&self, gap: f64, range: f64, n: i32) -> f64 {
        let h = gap.max(self.roughness);
        (h.powi(-n) - range.powi(-n)).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn film() -> Film {
        Film {
            viscosity: 0.1,
            round: 1.0,
            flat: 1.0,
            roughness: 1e-3,
            delay: None,
            slip: Vec::new(),
        }
    }

    fn thin_gap(gap: f64, shape: GapShape) -> ThinGap {
        ThinGap {
            normal: DVec3::Z,
            point: DVec3::ZERO,
            gap,
            shape,
        }
    }

    /// Brenner 1961, Chem. Eng. Sci. 16:242: drag of a sphere that approaches a plane, over the Stokes drag.
    fn brenner(gap: f64) -> f64 {
        let alpha = (1.0f64 + gap).acosh();
        let term = |n: i32| {
            let n = f64::from(n);
            let (a, b) = ((n + 0.5) * alpha, 2.0 * alpha);
            let above = 2.0 * (2.0 * a).sinh() + (2.0 * n + 1.0) * b.sinh();
            let below = 4.0 * a.sinh().powi(2) - ((2.0 * n + 1.0) * alpha.sinh()).powi(2);
            n * (n + 1.0) / ((2.0 * n - 1.0) * (2.0 * n + 3.0)) * (above / below - 1.0)
        };
        let terms = (1..).map(term).take_while(|term| *term > 1e-12);
        4.0 / 3.0 * alpha.sinh() * terms.take(100_000).sum::<f64>()
    }

    #[test]
    fn a_sphere_near_a_plane_meets_the_exact_resistance_as_the_gap_closes() {
        let (film, r) = (film(), 10.0);
        let stokes = 6.0 * PI * film.viscosity * r;
        let rise = |h: f64| film.resistance(&thin_gap(h, GapShape::Round { radius: r })) / stokes;
        for h in [0.5, 0.2, 0.1, 0.05, 0.01] {
            let exact = brenner(h / r) - brenner(film.round / r);
            // The omitted term ⅕ ln(h₀/h) is small compared with R/h.
            let error = (rise(h) - exact).abs();
            assert!(
                error < 0.21 * (film.round / h).ln(),
                "{h}: {} of {exact}",
                rise(h)
            );
            assert!(error < 0.02 * exact, "{h}: {} of {exact}", rise(h));
        }
        assert_eq!(rise(1.0), 0.0);
        assert_eq!(rise(1e-9), rise(1e-3));
    }

    #[test]
    fn discs_meet_reynolds() {
        let (film, r, h) = (film(), 8.0f64, 0.1f64);
        let shape = GapShape::Flat {
            area: PI * r * r,
            moments: [0.25 * PI * r.powi(4); 2],
            torsion: 0.5 * PI * r.powi(4),
            axes: [DVec3::X, DVec3::Y],
            tilts: [PI / 8.0 * r.powi(6); 2],
            flatness: 1.0,
        };
        let found = film.resistance(&thin_gap(h, shape));
        let reynolds = 1.5 * PI * film.viscosity * r.powi(4) * (h.powi(-3) - 1.0);
        assert!((found / reynolds - 1.0).abs() < 1e-12);
    }
}
