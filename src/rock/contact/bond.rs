//! A bond between two faces that touch: the contact patch, in the frames of both parts.

use super::{Placed, polygon::spread, thin_gap::face_pair};
use glam::{DMat3, DVec2, DVec3};

/// Largest gap between faces that touch, as a share of the smaller part's radius: the rounding of scenes and poses.
const TOUCHING_GAP: f64 = 1e-9;
/// Smallest area of a patch, as a share of the square of that radius. Parts that touch only along an edge have a patch
/// of the width of rounding, which is not bonded.
const SMALLEST_PATCH: f64 = 1e-6;

/// The patch in which two faces touch, fixed in both parts. Vectors of a part are in the frame of its undeformed block.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct Bond {
    /// m².
    pub area: f64,
    /// Mean overlap, m; 0 if the faces touch within rounding.
    pub overlap: f64,
    /// Centroid of the patch, relative to the centroids of the first and the second part, m.
    pub arms: [DVec3; 2],
    /// Unit normal from the first part to the second, in the frames of both.
    pub normals: [DVec3; 2],
    /// First principal axis of the patch, in the frame of the first part.
    pub axis: DVec3,
    /// Corners of the patch along the first and the second axis, from the centroid, m.
    pub corners: Vec<DVec2>,
    /// Largest distance between two corners, m.
    pub width: f64,
    /// ∫ x² dA along the first and the second axis, m⁴.
    pub seconds: [f64; 2],
}

/// A [`Bond`] at the present poses of its parts. Vectors are in world axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BondState {
    /// Half-way between the centroids of the patch, m.
    pub point: DVec3,
    /// Unit normal from the first part to the second.
    pub normal: DVec3,
    /// Mean overlap, m; negative if the bond is open.
    pub overlap: f64,
    /// Principal axes of the patch.
    pub axes: [DVec3; 2],
    /// Rotation of the second part relative to the first about each of the axes, rad.
    pub tilts: [f64; 2],
}

impl Bond {
    /// The bond of two parts that touch or overlap, if they do so with faces that are parallel within 5°, and not only
    /// along an edge.
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
        let corners = face_pair.polygon.corners.iter().map(|corner| {
            let arm = *corner - seconds.centre;
            DVec2::from(along.map(|axis: DVec2| axis.dot(arm)))
        });
        let [own, other] = [first, second].map(|part| part.deformation.inverse());
        // Normals transform with F⁻ᵀ.
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
            corners: corners.collect(),
            width: face_pair.polygon.width(),
            seconds: seconds.principal,
        })
    }

    /// State of the bond at the present poses of the parts.
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
}

impl BondState {
    /// Overlap at the point of largest opening, m: the minimum of u + θ₂ x₁ − θ₁ x₂ at the corners of the patch.
    pub fn smallest_overlap(&self, bond: &Bond) -> f64 {
        let slope = DVec2::new(self.tilts[1], -self.tilts[0]);
        let changes = bond.corners.iter().map(|corner| slope.dot(*corner));
        self.overlap + changes.fold(0.0, f64::min)
    }

    /// ∫ x xᵀ dA/A of the patch about its centroid, m².
    pub fn spread(&self, bond: &Bond) -> DMat3 {
        spread(self.axes, bond.seconds.map(|second| second / bond.area))
    }

    /// Bending moment of the pressure u + θ₂ x₁ − θ₁ x₂ of an elastic bed (Winkler) on the second part about the point,
    /// over its stiffness, m⁴: −(J₂ θ₁, J₁ θ₂), J the second moments.
    pub fn moment(&self, bond: &Bond) -> DVec3 {
        let [first, second] = bond.seconds;
        -(self.axes[0] * (second * self.tilts[0]) + self.axes[1] * (first * self.tilts[1]))
    }
}

/// F⁻ᵀ.
fn cofactor(deformation: DMat3) -> DMat3 {
    deformation.inverse().transpose()
}
