//! Least-squares planes through the pressures on areas.

use crate::geometry::outer;
use glam::{DMat3, DVec3};

/// Variance of positions, cells² per cell, below which a direction has no slope: far above the rounding of sums, far below
/// two rows of cells.
const MIN_VARIANCE: f64 = 1e-3;

/// ∫ 1, r and r rᵀ over an area, r from the centroid of the block, m², m³, m⁴.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AreaMoments {
    pub area: f64,
    pub first: DVec3,
    pub second: DMat3,
}

impl AreaMoments {
    pub const ZERO: Self = Self {
        area: 0.0,
        first: DVec3::ZERO,
        second: DMat3::ZERO,
    };

    /// The moments of a convex plane polygon, r from `centre`.
    pub fn of(corners: &[DVec3], centre: DVec3) -> Self {
        let mut sum = Self::ZERO;
        for k in 2..corners.len() {
            let [a, b, c] = [corners[0], corners[k - 1], corners[k]].map(|x| x - centre);
            let area = 0.5 * (b - a).cross(c - a).length();
            let whole = a + b + c;
            let squares = [a, b, c, whole]
                .map(|r| outer(r, r))
                .into_iter()
                .sum::<DMat3>();
            sum = sum.plus(&Self {
                area,
                first: area / 3.0 * whole,
                second: squares * (area / 12.0),
            });
        }
        sum
    }

    pub fn plus(&self, other: &Self) -> Self {
        Self {
            area: self.area + other.area,
            first: self.first + other.first,
            second: self.second + other.second,
        }
    }

    pub fn times(&self, factor: f64) -> Self {
        Self {
            area: factor * self.area,
            first: factor * self.first,
            second: self.second * factor,
        }
    }

    /// The moments scaled to an area of at most `limit` (m²).
    pub fn limited(&self, limit: f64) -> Self {
        self.times((limit / self.area.max(f64::MIN_POSITIVE)).min(1.0))
    }
}

/// ∫ p and ∫ p r over an area, N and N m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PressureSample {
    pub over: AreaMoments,
    pub force: f64,
    pub first: DVec3,
    /// Mean of the squared positions in one of its cells about the centre of the cell, m².
    pub cells: DMat3,
}

impl PressureSample {
    /// The sample projected onto a cut line, with its pressure extrapolated to the line.
    pub fn at_cut(self, cut: CutLine, cell: f64) -> Option<Self> {
        let plane = fit(&[self], cell)?;
        let area = self.over.area;
        let foot = self.over.first / area;
        let variance = self.over.second * (1.0 / area) - outer(foot, foot);
        let onto = DMat3::IDENTITY - outer(cut.along, cut.along);
        let place = foot + cut.along * cut.along.dot(cut.place - foot);
        let variance = onto * variance * onto;
        let pressure = plane.at(place);
        Some(Self {
            over: AreaMoments {
                area,
                first: area * place,
                second: (variance + outer(place, place)) * area,
            },
            force: area * pressure,
            first: area * (pressure * place + variance * plane.gradient),
            cells: onto * self.cells * onto,
        })
    }
}

/// The line on a face between its open and its closed part.
#[derive(Clone, Copy, Debug)]
pub(super) struct CutLine {
    /// A point on the line, from the centroid of the block, m.
    pub place: DVec3,
    /// Unit vector across it, towards the closed part.
    pub along: DVec3,
}

/// p = value + gradient·r, Pa.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct PressurePlane {
    pub value: f64,
    pub gradient: DVec3,
}

impl PressurePlane {
    pub fn at(&self, r: DVec3) -> f64 {
        self.value + self.gradient.dot(r)
    }
}

/// The least-squares plane through pressures in cells of `cell` m, without slope in directions with a single position.
/// `None` without samples.
pub(super) fn fit(samples: &[PressureSample], cell: f64) -> Option<PressurePlane> {
    let mut sum = PressureSample {
        over: AreaMoments::ZERO,
        force: 0.0,
        first: DVec3::ZERO,
        cells: DMat3::ZERO,
    };
    for sample in samples {
        sum.over = sum.over.plus(&sample.over);
        sum.force += sample.force;
        sum.first += sample.first;
    }
    if sum.over.area <= 0.0 {
        return None;
    }
    let mean = sum.over.first / sum.over.area;
    let variance = sum.over.second - outer(mean, mean) * sum.over.area;
    let regularisation = DMat3::IDENTITY * (MIN_VARIANCE * cell * cell * sum.over.area);
    let gradient = (variance + regularisation).inverse() * (sum.first - sum.force * mean);
    Some(PressurePlane {
        value: sum.force / sum.over.area - gradient.dot(mean),
        gradient,
    })
}

/// Reduces the slope of a plane about the centroid of the samples until its values at `places` lie within its range over
/// the areas of the samples: slopes between neighbouring cells do not extrapolate far.
pub(super) fn limited(
    plane: PressurePlane,
    samples: &[PressureSample],
    places: impl Iterator<Item = DVec3>,
) -> PressurePlane {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    let (mut centroid, mut area) = (DVec3::ZERO, 0.0);
    for PressureSample { over, cells, .. } in samples {
        let foot = over.first / over.area;
        let variance = over.second * (1.0 / over.area) - outer(foot, foot);
        let variance = variance + *cells;
        // Change of pressure from the centre of a rectangle to its edges along the gradient.
        let change = (3.0 * plane.gradient.dot(variance * plane.gradient)).max(0.0);
        low = low.min(plane.at(foot) - change.sqrt());
        high = high.max(plane.at(foot) + change.sqrt());
        centroid += over.first;
        area += over.area;
    }
    let centroid = centroid / area;
    let mean = plane.at(centroid);
    let factor = places.fold(1.0_f64, |factor, r| {
        let change = plane.at(r) - mean;
        let limit = if change > 0.0 {
            high - mean
        } else {
            mean - low
        };
        factor.min(limit.max(0.0) / change.abs().max(f64::MIN_POSITIVE))
    });
    let gradient = factor * plane.gradient;
    PressurePlane {
        value: mean - gradient.dot(centroid),
        gradient,
    }
}
