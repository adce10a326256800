//! Flow between planes that are static solids: positions of their surfaces, as partially saturated cells and as staircases.

use super::{CaseContext, Outcome, Record, fields};
use riprap::{
    lattice::{Force, Setup, SurfaceCell},
    psm::OBLIQUE_SHIFT,
};

/// Edge along x and y of the periodic box, cells.
const PERIOD: u32 = 32;
/// Cells along z.
const WIDE: u32 = 4;
/// Target of the largest velocity.
const SPEED: f64 = 0.01;
/// Normals in the plane of x and y, coprime integers, with the limit on the offset of a surface in cells.
const NORMALS: [([u32; 2], f64); 3] = [([1, 0], 0.03), ([2, 1], 0.03), ([1, 1], 0.06)];
/// Thickness of the solid between two gaps, cells: its surfaces pass through no corner.
const THICK: f64 = 6.7;

/// Offset of the surfaces, by the flux between them.
pub fn planes(context: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    let taus: &[f64] = match context.full {
        true => &[0.52, 0.6, 1.0, 1.5],
        false => &[0.6, 1.0],
    };
    for &tau in taus {
        for (normal, limit) in NORMALS {
            for along_z in [true, false] {
                for exact in [true, false] {
                    let planes = Planes {
                        normal,
                        tau,
                        along_z,
                        exact,
                    };
                    records.push(planes.measure(context, limit)?);
                }
            }
        }
    }
    Ok(records)
}

struct Planes {
    normal: [u32; 2],
    tau: f64,
    along_z: bool,
    /// Partially saturated cells if true; otherwise a cell is solid if its centre is.
    exact: bool,
}

impl Planes {
    /// Solid fraction of each cell of a layer, x fastest.
    fn fractions(&self) -> Vec<f64> {
        let [a, b] = self.normal.map(f64::from);
        let length = a.hypot(b);
        let (begin, period) = (0.37 * length, f64::from(PERIOD));
        // The solid lies between `begin` and `end` of a x + b y, and repeats with the period of the box.
        let end = begin + THICK * length;
        // As solids of a scene: with the weight of oblique planes.
        let outwards = f64::from(OBLIQUE_SHIFT) * (1.0 - (a.powi(4) + b.powi(4)) / length.powi(4));
        let [outer_begin, outer_end] = [begin - outwards * length, end + outwards * length];
        let repeats = self.normal.iter().sum::<u32>() + 1;
        let cell = |x: f64, y: f64| -> f64 {
            let at = a * x + b * y;
            (0..repeats)
                .map(|n| f64::from(n) * period - at)
                .map(|shift| below(a, b, outer_end + shift) - below(a, b, outer_begin + shift))
                .sum()
        };
        let centre = |x: f64, y: f64| {
            let at = (a * (x + 0.5) + b * (y + 0.5)).rem_euclid(period);
            f64::from(u8::from((begin..end).contains(&at)))
        };
        let n = PERIOD;
        let all = (0..n).flat_map(|y| (0..n).map(move |x| (f64::from(x), f64::from(y))));
        all.map(|(x, y)| if self.exact { cell(x, y) } else { centre(x, y) })
            .collect()
    }

    fn setup(&self, context: &CaseContext, push: [f64; 3]) -> Setup {
        let mut setup = context.setup([PERIOD, PERIOD, WIDE], (self.tau - 0.5) / 3.0);
        setup.force = Force::Constant(push);
        let layer = self.fractions();
        let all = (0..WIDE).flat_map(|_| layer.iter().copied());
        setup.solid = all.clone().map(|part| part > 1.0 - 1e-6).collect();
        let partly = (0..)
            .zip(all)
            .filter(|(_, part)| (1e-6..=1.0 - 1e-6).contains(part));
        setup.surface = partly
            .map(|(cell, part)| SurfaceCell {
                cell,
                fraction: part as f32,
            })
            .collect();
        setup
    }

    fn measure(&self, context: &CaseContext, limit: f64) -> anyhow::Result<Record> {
        let nu = (self.tau - 0.5) / 3.0;
        let [a, b] = self.normal.map(f64::from);
        let length = a.hypot(b);
        let spacing = f64::from(PERIOD) / length;
        let gap = spacing - THICK;
        let direction = match self.along_z {
            true => [0.0, 0.0, 1.0],
            false => [-b / length, a / length, 0.0],
        };
        let push = 8.0 * nu * SPEED / (gap * gap);
        let setup = self.setup(context, direction.map(|d| push * d));
        let fluid = setup.solid.iter().filter(|solid| !**solid).count() as f64;
        let rest = fields::state(setup.cells, |_| (0.0, [0.0; 3]));
        let mut flow = context.flow(setup, &rest, true)?;
        flow.advance((10.0 * gap * gap / (nu * 9.87)).max(1000.0) as u64)?;
        let mut momentum = 0.0;
        for _ in 0..4 {
            flow.advance(1)?;
            let sums = flow.sums()?.momentum;
            momentum += 0.25 * (0..3).map(|i| sums[i] * direction[i]).sum::<f64>();
        }
        // Without the half force: in partially saturated cells it is no part of the flux.
        let volume = f64::from(PERIOD * PERIOD * WIDE);
        let flux = (momentum - 0.5 * push * fluid) / volume * spacing;
        let apparent = (12.0 * nu * flux / push).cbrt();
        let quantity = format!(
            "{} normal to {:?} lies off by, cells, flow along {}, τ = {}",
            if self.exact { "surface" } else { "staircase" },
            self.normal,
            if self.along_z { "z" } else { "the planes" },
            self.tau
        );
        let outside = 0.5 * (gap - apparent).abs();
        let limit = self.exact.then_some(limit);
        Ok(flow.trial().at_most(quantity, outside, limit))
    }
}

/// Area of the unit square where a x + b y < s.
fn below(a: f64, b: f64, s: f64) -> f64 {
    if b == 0.0 {
        return (s / a).clamp(0.0, 1.0);
    }
    let square = |s: f64| s.max(0.0).powi(2);
    let area = square(s) - square(s - a) - square(s - b) + square(s - a - b);
    (area / (2.0 * a * b)).clamp(0.0, 1.0)
}
