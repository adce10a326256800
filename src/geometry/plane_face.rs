//! Plane faces of blocks: polygons, areas and centroids.

use super::{Form, Part, Polyhedron, Pose, clip};
use glam::DVec3;

/// A plane face of a block at its present position.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct PlaneFace {
    /// Number of the part among those of the block.
    pub part: usize,
    /// Number of the face among those of the part.
    pub face: usize,
    /// Its centroid, m.
    pub centre: DVec3,
    /// Outward unit normal.
    pub normal: DVec3,
    /// m².
    pub area: f64,
}

/// The plane faces of a part at a pose; `part` is its number in the block.
pub fn plane_faces(part: usize, of: &Part, pose: &Pose) -> Vec<PlaneFace> {
    let Form::Convex(shape) = &of.form else {
        return Vec::new();
    };
    let face = |face: usize| {
        let corners = corners(shape, face, of.offset, pose);
        let (centre, vector) = area_of(&corners);
        PlaneFace {
            part,
            face,
            centre,
            normal: vector.normalize_or_zero(),
            area: vector.length(),
        }
    };
    (0..shape.faces().len()).map(face).collect()
}

/// A box, infinite along periodic axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// Lower corner, m.
    pub low: DVec3,
    /// Upper corner, m.
    pub high: DVec3,
}

impl Window {
    /// Clips a plane polygon to the box.
    pub fn clipped(&self, mut corners: Vec<DVec3>) -> Vec<DVec3> {
        for axis in 0..3 {
            let [low, high] = [self.low[axis], self.high[axis]];
            if low.is_finite() {
                clip(&mut corners, |x| low - x[axis]);
            }
            if high.is_finite() {
                clip(&mut corners, |x| x[axis] - high);
            }
        }
        corners
    }
}

/// Corners of a face at a pose, m, counter-clockwise seen from outside.
pub fn corners(shape: &Polyhedron, face: usize, offset: DVec3, pose: &Pose) -> Vec<DVec3> {
    let corner = |&v: &u32| pose.point(offset + shape.vertices()[v as usize]);
    shape.loops()[face].iter().map(corner).collect()
}

/// Centroid and area of a plane polygon, the area as a vector along its normal.
pub fn area_of(corners: &[DVec3]) -> (DVec3, DVec3) {
    let Some(&first) = corners.first() else {
        return Default::default();
    };
    let triangles = || {
        corners
            .windows(2)
            .map(|pair| [pair[0] - first, pair[1] - first])
    };
    let vector: DVec3 = triangles().map(|[a, b]| 0.5 * a.cross(b)).sum();
    let along = vector.normalize_or_zero();
    let moment: DVec3 = triangles()
        .map(|[a, b]| 0.5 * a.cross(b).dot(along) * (a + b) / 3.0)
        .sum();
    let area = vector.length();
    let centre = if area > 0.0 {
        moment / area
    } else {
        DVec3::ZERO
    };
    (first + centre, vector)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_cuts_what_sticks_out_and_leaves_the_rest_as_it_is() {
        let square = |x: f64| {
            [(0.1, 0.2), (0.7, 0.2), (0.7, 0.9), (0.1, 0.9)]
                .map(|(u, v)| DVec3::new(x + u, v, 0.3))
                .to_vec()
        };
        let window = Window {
            low: DVec3::new(0.0, f64::NEG_INFINITY, 0.0),
            high: DVec3::new(1.0, f64::INFINITY, 1.0),
        };
        assert_eq!(window.clipped(square(0.0)), square(0.0));
        let (centre, area) = area_of(&window.clipped(square(0.5)));
        assert!((area - DVec3::Z * 0.28).length() < 1e-15);
        assert!((centre - DVec3::new(0.8, 0.55, 0.3)).length() < 1e-15);
        assert_eq!(window.clipped(square(2.0)), []);
    }

    #[test]
    fn faces_of_a_turned_box_close_it() {
        let shape = Polyhedron::cuboid(DVec3::new(2.0, 3.0, 4.0)).unwrap();
        let turn = glam::DQuat::from_rotation_y(0.7);
        let pose = Pose::at_rest(DVec3::ONE, turn);
        let part = Part {
            form: Form::Convex(shape),
            offset: DVec3::X,
        };
        let faces = plane_faces(0, &part, &pose);
        let area: f64 = faces.iter().map(|face| face.area).sum();
        assert!((area - 2.0 * (6.0 + 8.0 + 12.0)).abs() < 1e-12);
        let volume: f64 = faces
            .iter()
            .map(|face| face.area * face.normal.dot(face.centre - DVec3::ONE) / 3.0)
            .sum();
        assert!((volume - 24.0).abs() < 1e-12, "{volume}");
        let middle = faces.iter().map(|face| face.centre).sum::<DVec3>() / 6.0;
        assert!((middle - pose.point(DVec3::X)).length() < 1e-12);
    }
}
