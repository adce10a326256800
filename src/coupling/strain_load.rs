//! The part of a fluid's load that strains a block, from the loads on its faces.

use crate::{geometry::outer, psm::FaceLoad};
use glam::{DMat3, DVec3};

/// Fraction of a face below which the area without fluid along it is a rounding error.
const ROUNDING: f64 = 1e-9;

/// The skew part of Σ f ⊗ r over the cells of a block, which is its torque, with the symmetric part over its faces. The parts of faces
/// in joints and those of less than a cell have the mean pressure of the others, with the gradient of a `body_force` (N/m³).
pub(super) fn with_strain_part(
    cells: DMat3,
    faces: &[FaceLoad],
    centre: DVec3,
    body_force: DVec3,
) -> DMat3 {
    let wet: f64 = faces.iter().map(|load| load.wetted).sum();
    let at_centre = faces.iter().filter(|load| load.wetted > 0.0).map(|load| {
        let place = load.acts_at() - centre;
        load.wetted * (load.pressure() - body_force.dot(place))
    });
    let at_centre = at_centre.sum::<f64>() / wet.max(f64::MIN_POSITIVE);
    let at_face = |load: &FaceLoad| {
        let place = load.acts_at() - centre;
        let normal = load.face.normal;
        // n × ∫ p (x − x₀) dA, of a pressure that varies over the face.
        let couple = load.moment - place.cross(load.force);
        let whole = load.face.area * (load.face.centre - centre);
        let covered = load.face.area - load.wetted;
        let wet = outer(load.force, place) + outer(normal, normal.cross(couple));
        if covered <= ROUNDING * load.face.area {
            return wet;
        }
        let middle = (whole - load.wetted * place) / covered;
        let pressure = at_centre + body_force.dot(middle);
        wet - outer(pressure * covered * normal, middle)
    };
    let faces = faces
        .iter()
        .fold(DMat3::ZERO, |sum, load| sum + at_face(load));
    0.5 * (cells - cells.transpose() + faces + faces.transpose())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Form, Polyhedron, Pose, Shape, corners, plane_faces};
    use glam::DQuat;

    /// In water at rest the stress of any block is minus the pressure at its centroid, also with a face in a joint.
    #[test]
    fn strains_in_water_at_rest_are_isotropic() {
        let shape: Shape = Polyhedron::tetrahedron(0.3).unwrap().into();
        let turn = DQuat::from_scaled_axis(DVec3::new(0.3, -0.8, 0.5));
        let centre = DVec3::new(1.0, 2.0, 0.5);
        let pose = Pose::at_rest(centre, turn);
        let weight = DVec3::new(100.0, 0.0, -9810.0);
        let pressure = |x: DVec3| 5000.0 + weight.dot(x - centre);
        let part = &shape.parts()[0];
        let Form::Convex(polyhedron) = &part.form else {
            panic!("a polyhedron")
        };
        let load = |face: crate::geometry::PlaneFace| {
            let c = corners(polyhedron, face.face, part.offset, &pose);
            // Exact for the products of pressure and lever.
            let middles = [0, 1, 2].map(|k| c[k].midpoint(c[(k + 1) % 3]));
            let pushes = middles.map(|x| -pressure(x) * face.area / 3.0 * face.normal);
            let levers = middles.map(|x| x - centre).into_iter();
            FaceLoad {
                face,
                inside: face.area,
                centre: face.centre,
                wetted: face.area,
                force: pushes.into_iter().sum(),
                moment: levers.zip(pushes).map(|(r, f)| r.cross(f)).sum(),
                ..FaceLoad::default()
            }
        };
        let faces: Vec<_> = plane_faces(0, part, &pose).into_iter().map(load).collect();
        let torque = DMat3::from_cols(DVec3::ZERO, DVec3::X, DVec3::ZERO);
        let of = |faces: &[FaceLoad]| with_strain_part(torque, faces, centre, weight);
        let expected =
            DMat3::IDENTITY * (-5000.0 * shape.volume()) + (torque - torque.transpose()) * 0.5;
        let miss = (of(&faces) - expected).to_cols_array();
        assert!(miss.iter().all(|miss| miss.abs() < 1e-9), "{miss:?}");

        // The mean pressure of the other faces, and not its variation over the face in the joint.
        let mut dry = faces;
        (dry[1].wetted, dry[1].force, dry[1].moment) = Default::default();
        let trace = |m: DMat3| m.x_axis.x + m.y_axis.y + m.z_axis.z;
        let [found, expected] = [of(&dry), expected].map(trace);
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    }
}
