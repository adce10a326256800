//! The load of a fluid on one plane face of a block.

use super::{FACE_LOAD, Frame};
use crate::geometry::{PlaneFace, area_of, outer};
use glam::{DMat3, DVec3};

/// Load of a fluid on one plane face of a block, from two layers of cells along it, or from the first one if other solids are in
/// them; coarse for a face of few cells. A face without a fluid cell along it has no load.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct FaceLoad {
    /// The face.
    pub face: PlaneFace,
    /// Area of the face inside the domain and outside seams with other parts of its block, m². For a part longer than a
    /// period it is the area in one period, like the load on a block.
    pub inside: f64,
    /// Centroid of that area, m; of the whole face if it is all seam.
    pub centre: DVec3,
    /// Area with fluid along it, m²: `inside` times the fraction of adjacent cells that contain only fluid.
    pub wetted: f64,
    /// Force on the wetted area, N: minus its pressure times the normal, and shear.
    pub force: DVec3,
    /// Moment of this force about the centroid of the block, N m.
    pub moment: DVec3,
    /// Mean of the projections of the cell centres in the first layer onto the face, m: with few cells it differs from
    /// the centroid of the wetted area.
    pub foot: DVec3,
    /// Second moments of these projections about their mean, m².
    pub spread: DMat3,
    /// Gradient of the pressure along the face, Pa/m, which shifts the force from `foot` to [`FaceLoad::acts_at`].
    pub slope: DVec3,
    /// Height over the face to which the pressure belongs, m: the mean of the cell centres in the first layer, or zero if
    /// the load is extrapolated to the face.
    pub height: f64,
    /// Number of cells with fluid in the first layer.
    pub cells: u32,
}

impl FaceLoad {
    /// Mean pressure on the wetted area, Pa, positive onto the rock; NaN without fluid
    /// along it.
    pub fn pressure(&self) -> f64 {
        -self.force.dot(self.face.normal) / self.wetted
    }

    /// Mean shear stress on the wetted area, Pa; NaN without fluid along it.
    pub fn shear(&self) -> DVec3 {
        let normal = self.face.normal;
        (self.force - self.force.dot(normal) * normal) / self.wetted
    }

    /// Point of action of the force of the mean traction, m: the centroid of a face
    /// that is completely wet except for seams, else `foot`.
    pub fn acts_at(&self) -> DVec3 {
        match self.wetted == self.inside {
            true => self.centre,
            false => self.foot,
        }
    }

    /// Difference of the normal force by the pressure at [`FaceLoad::acts_at`] and by that at `foot`, N.
    pub(crate) fn shifted(&self) -> f64 {
        self.wetted * self.slope.dot(self.acts_at() - self.foot)
    }

    /// Creates the load from the [`FACE_LOAD`] sums of each layer, the centroid `block` (m) of the block, the polygon of the face
    /// in the domain, and the `seams` in it.
    pub(super) fn new(
        frame: &Frame,
        (face, block): (PlaneFace, DVec3),
        (corners, seams): (&[DVec3], &[Vec<DVec3>]),
        sums: &[f32],
    ) -> Self {
        let (centre, inside) = outside(corners, seams, face.centre);
        let (first, second) = sums.split_at(FACE_LOAD);
        let Some(near) = Layer::of(first) else {
            return Self {
                face,
                inside,
                centre,
                ..Self::default()
            };
        };
        let wetted = inside * near.wet;
        let cell = frame.units.cell;
        let normal = face.normal;
        // The traction of a cell acts on an equal share of the wetted area.
        let share = wetted / (cell * cell) * frame.units.force_from_lattice(1.0);
        let moment = near.mean(3) * (wetted / (cell * cell)) * frame.units.torque_from_lattice(1.0);
        let force = near.mean(0) * share;
        let foot = near.mean(7) * cell;
        let [across, aside] = [near.mean(10), near.mean(13)].map(|square| square * cell * cell);
        let squares = DMat3::from_cols(
            DVec3::new(across.x, aside.z, aside.y),
            DVec3::new(aside.z, across.y, aside.x),
            DVec3::new(aside.y, aside.x, across.z),
        );
        // All projections lie in the face: components across it are rounding errors.
        let along = DMat3::IDENTITY - outer(normal, normal);
        let mut load = Self {
            face,
            inside,
            centre,
            wetted,
            force,
            moment,
            foot: block + foot,
            spread: along * (squares - outer(foot, foot)) * along,
            slope: DVec3::ZERO,
            height: near.height() * cell,
            cells: near.cells as u32,
        };
        // Next to a seam only cells outside the seam count. Points closer together than a cell do not determine a slope.
        let couple = load.moment - (load.foot - block).cross(force);
        let own = DMat3::IDENTITY * (cell * cell / 12.0);
        load.slope = (load.spread + own).inverse() * -normal.cross(couple) / wetted;
        if let Some(far) = Layer::of(second).filter(|far| near.is_like(far)) {
            let between = far.mean(7) * cell - foot;
            let shifted = wetted * load.slope.dot(between) * normal;
            let weight = near.height() / (far.height() - near.height());
            load.force += weight * (force - (far.mean(0) * share + shifted));
            load.height = 0.0;
        }
        load.force -= load.shifted() * normal;
        load.moment = couple + (load.acts_at() - block).cross(load.force);
        load
    }

    /// Adds the pressure difference by a body force of `weight` (N/m³) between the cells and the face.
    pub(crate) fn at_face(mut self, weight: DVec3, block: DVec3) -> Self {
        let normal = self.face.normal;
        let force = weight.dot(normal) * self.height * self.wetted * normal;
        self.force += force;
        self.moment += (self.acts_at() - block).cross(force);
        self
    }
}

/// Largest difference of the number of cells in the two layers, as a fraction of those in the first: beyond it the layers do not
/// represent the same area.
const UNLIKE: f64 = 0.25;

/// Least distance of the mean heights of the two layers, cells: few cells of a face at an angle to the grid may be closer, and do
/// not determine the change across the layers.
const APART: f64 = 0.5;

/// Means over the cells with fluid in a layer along a face.
struct Layer<'a> {
    sums: &'a [f32],
    /// Number of these cells.
    cells: f64,
    /// Their fraction of all cells of the layer.
    wet: f64,
}

impl<'a> Layer<'a> {
    /// `None` without fluid.
    fn of(sums: &'a [f32]) -> Option<Self> {
        let [cells, all] = [FACE_LOAD - 2, FACE_LOAD - 1].map(|n| f64::from(sums[n]));
        let wet = cells / all;
        (cells > 0.0).then_some(Self { sums, cells, wet })
    }

    fn mean(&self, first: usize) -> DVec3 {
        DVec3::from_array([0, 1, 2].map(|n| f64::from(self.sums[first + n]))) / self.cells
    }

    /// Mean height of the centres of the cells over the face, cells.
    fn height(&self) -> f64 {
        f64::from(self.sums[6]) / self.cells
    }

    /// Whether the tractions of this layer and the `far` one determine those at the face. The extrapolation is exact for
    /// pressures that are linear in the height and for quadratic velocities.
    fn is_like(&self, far: &Self) -> bool {
        let difference = (far.cells - self.cells).abs();
        self.wet == 1.0
            && far.wet == 1.0
            && difference <= UNLIKE * self.cells
            && far.height() - self.height() >= APART
    }
}

/// Fraction of a face below which the area outside seams is a rounding error.
const SLIVER: f64 = 1e-9;

/// Centroid and area of a polygon outside `seams`; the centroid is `middle` if the area is zero.
fn outside(corners: &[DVec3], seams: &[Vec<DVec3>], middle: DVec3) -> (DVec3, f64) {
    let (centre, whole) = area_of(corners);
    let whole = whole.length();
    let (mut area, mut moment) = (whole, whole * centre);
    for seam in seams {
        let (centre, covered) = area_of(seam);
        area -= covered.length();
        moment -= covered.length() * centre;
    }
    if seams.is_empty() {
        return (centre, whole);
    }
    match area > SLIVER * whole {
        true => (moment / area, area),
        false => (middle, 0.0),
    }
}
