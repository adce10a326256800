//! A bond between two faces that touch: the patch of contact, in the frames of both parts.

use super::{Placed, thin_gap::face_pair};
use glam::{DMat3, DVec2, DVec3};

/// Gap up to which faces touch, as a share of the smaller part's radius: the rounding of scenes and poses.
const TOUCHING_GAP: f64 = 1e-9;
/// Least area of a patch, as a share of the square of that radius: parts that touch with an edge alone have one of the
/// width of rounding, over which nothing is bonded.
const SMALLEST_PATCH: f64 = 1e-6;

/// The patch in which two faces touch, fixed in both parts; none where its area is 0. Vectors of a part are along
/// the axes of its block's frame, before it deforms.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct Bond {
    /// m².
    pub area: f64,
    /// Mean overlap, m; 0 where the faces touch within rounding.
    pub overlap: f64,
    /// Centroid of the patch, from that of the first and of the second part, m.
    pub arms: [DVec3; 2],
    /// Unit normal from the first part to the second, as both carry it.
    pub normals: [DVec3; 2],
    /// First principal axis of the patch, as the first part carries it.
    pub axis: DVec3,
    /// Least and largest distance of a corner from the centroid along the first and the second axis, m.
    pub extents: [[f64; 2]; 2],
    /// ∫ x² dA along the first and the second axis, m⁴.
    pub seconds: [f64; 2],
}

/// A [`Bond`] at the present poses of its parts, vectors along the axes of the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BondState {
    /// Half-way between the centroids of the patch, m.
    pub point: DVec3,
    /// Unit normal from the first part to the second.
    pub normal: DVec3,
    /// Mean overlap; less than 0 where the bond is open, m.
    pub overlap: f64,
    /// Principal axes of the patch.
    pub axes: [DVec3; 2],
    /// Rotation of the second part against the first about each of the axes, rad.
    pub tilts: [f64; 2],
}

impl Bond {
    /// The bond of two parts that touch or overlap, if they do so with faces that are parallel to 5°, and not along an
    /// edge alone.
    pub fn between(first: &Placed, second: &Placed) -> Option<Self> {
        if first.is_sphere() || second.is_sphere() {
            return None;
        }
        let radius = first.radius.min(second.radius);
        let range = TOUCHING_GAP * radius;
        let face_pair =
            face_pair(first, second, range).filter(|face_pair| face_pair.flatness == 1.0)?;
        let seconds = face_pair.polygon.second_moments()?;
        if seconds.area <= SMALLEST_PATCH * radius * radius {
            return None;
        }
        let normal = face_pair.normal();
        let overlap = -(face_pair.gap + face_pair.slope.dot(seconds.centre));
        let point = face_pair.lift(seconds.centre) - face_pair.out * (0.5 * overlap);
        let axis = face_pair.x * seconds.axis.x + face_pair.y * seconds.axis.y;
        let along = [seconds.axis, face_pair.flat(normal.cross(axis))];
        let extents = along.map(|axis: DVec2| {
            let heights = face_pair.polygon.corners.iter();
            let heights = heights.map(|corner| axis.dot(*corner - seconds.centre));
            heights.fold([0.0, 0.0], |[smallest_overlap, most]: [f64; 2], height| {
                [smallest_overlap.min(height), most.max(height)]
            })
        });
        let [own, other] = [first, second].map(|part| part.deformation.inverse());
        // Planes go with F⁻ᵀ.
        let back = |part: &Placed| (part.deformation.transpose() * normal).normalize();
        Some(Self {
            area: seconds.area,
            overlap: overlap.max(0.0),
            arms: [
                own * (point - first.centre),
                other * (point - second.centre),
            ],
            normals: [back(first), back(second)],
            axis: own * axis,
            extents,
            seconds: seconds.principal,
        })
    }

    /// Its state at the present poses of the parts.
    pub fn state(&self, first: &Placed, second: &Placed) -> BondState {
        let carried =
            |part: &Placed, normal: DVec3| (cofactor(part.deformation) * normal).normalize();
        let [a, b] = [
            first.centre + first.deformation * self.arms[0],
            second.centre + second.deformation * self.arms[1],
        ];
        let [n_a, n_b] = [
            carried(first, self.normals[0]),
            carried(second, self.normals[1]),
        ];
        let normal = (n_a + n_b).normalize();
        let axis = (first.deformation * self.axis).reject_from_normalized(normal);
        let axis = axis.normalize();
        let axes = [axis, normal.cross(axis)];
        let tilt = n_a.cross(n_b);
        BondState {
            point: 0.5 * (a + b),
            normal,
            overlap: self.overlap - (b - a).dot(normal),
            axes,
            tilts: axes.map(|axis| tilt.dot(axis)),
        }
    }

    /// Largest extent of the patch, m.
    pub fn width(&self) -> f64 {
        let [along, across] = self
            .extents
            .map(|[smallest_overlap, most]| most - smallest_overlap);
        along.hypot(across)
    }
}

impl BondState {
    /// Overlap where the opening is the largest, m: u + θ₂ x₁ − θ₁ x₂ at the corners of the rectangle along the
    /// axes that holds the patch.
    pub fn smallest_overlap(&self, bond: &Bond) -> f64 {
        let smallest_overlap = |slope: f64, [low, high]: [f64; 2]| (slope * low).min(slope * high);
        self.overlap
            + smallest_overlap(self.tilts[1], bond.extents[0])
            + smallest_overlap(-self.tilts[0], bond.extents[1])
    }

    /// Moment of bending alone: a bond has no spring in torsion, about its normal. That of the pressure u + θ₂ x₁ − θ₁ x₂ of an elastic bed (Winkler) on the second part about the point, over
    /// its stiffness, m⁴: −(J₂ θ₁, J₁ θ₂), J the second moments.
    pub fn moment(&self, bond: &Bond) -> DVec3 {
        let [first, second] = bond.seconds;
        -(self.axes[0] * (second * self.tilts[0]) + self.axes[1] * (first * self.tilts[1]))
    }
}

/// F⁻ᵀ.
fn cofactor(deformation: DMat3) -> DMat3 {
    deformation.inverse().transpose()
}
