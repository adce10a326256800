//! How a block of a scene deforms, and what acts on points of it.

use crate::{
    Error, Result,
    geometry::{Form, Shape},
    rock::{Deformable, FixedPoint, PointLoad},
    scene,
};
use glam::{DMat3, DVec3};

/// Distance from the shape up to which a point is on its surface, as a part of its radius: what scenes round
/// their numbers to.
const ON: f64 = 1e-6;

/// What a table says of points of its block, from the centroid.
pub(super) struct Points {
    pub deformable: Option<Deformable>,
    pub point_loads: Vec<PointLoad>,
}

/// The points of the table `key`, whose `shape` has its `centroid` (m) in the block's own frame.
///
/// # Errors
/// [`Error::Scene`] naming a point that is not of the block, or the mesh of several parts that would have to
/// deform.
pub(super) fn points(
    key: &str,
    block: &scene::Block,
    shape: &Shape,
    centroid: DVec3,
) -> Result<Points> {
    if block.deformable && shape.parts().len() > 1 {
        return Err(Error::scene(
            format!("{key}.deformable"),
            format!(
                "its mesh is not convex and became {} parts, which are rigid; add hull = true, or remove \
                 deformable",
                shape.parts().len()
            ),
        ));
    }
    let place = |name: &str, number: usize, point: &[f64; 3]| {
        let from_centroid = DVec3::from(*point) - centroid;
        if holds(shape, from_centroid) {
            return Ok(from_centroid);
        }
        Err(Error::scene(
            format!("{key}.{name}[{number}].point"),
            format!(
                "{} m is not in the block; give a point of it, in the block's own frame, before position \
                 and rotation",
                DVec3::from(*point)
            ),
        ))
    };
    let mut fixed_points = Vec::new();
    for (number, held) in block.fixed_points.iter().enumerate() {
        let mut axes = [false; 3];
        for axis in &held.axes {
            axes[axis.index()] = true;
        }
        fixed_points.push(FixedPoint {
            point: place("fixed_points", number, &held.point)?,
            axes,
        });
    }
    let mut point_loads = Vec::new();
    for (number, load) in block.point_loads.iter().enumerate() {
        point_loads.push(PointLoad {
            point: place("point_loads", number, &load.point)?,
            force: load.force.clone(),
        });
    }
    Ok(Points {
        deformable: block.deformable.then(|| Deformable {
            initial_stress: symmetric(&block.initial_stress),
            fixed_points,
        }),
        point_loads,
    })
}

/// The matrix of xx, yy, zz, xy, yz, xz.
pub(super) fn symmetric([xx, yy, zz, xy, yz, xz]: &[f64; 6]) -> DMat3 {
    DMat3::from_cols(
        DVec3::new(*xx, *xy, *xz),
        DVec3::new(*xy, *yy, *yz),
        DVec3::new(*xz, *yz, *zz),
    )
}

/// Whether a point (m from the centroid) is in the shape or on it.
fn holds(shape: &Shape, point: DVec3) -> bool {
    let reach = ON * shape.radius();
    shape.parts().iter().any(|part| {
        let x = point - part.offset;
        match &part.form {
            Form::Sphere { radius } => x.length() <= radius + reach,
            Form::Convex(polyhedron) => {
                let mut faces = polyhedron.faces().iter();
                faces.all(|face| face.height(x) <= reach)
            }
        }
    })
}
