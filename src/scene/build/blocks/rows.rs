//! A table of `blocks`: its block, deformation, point loads and copies.

use super::shapes::{rotation, shape};
use crate::{
    Error, Result,
    formula::Formula,
    geometry::{Form, Shape},
    rock::{Block, Deformable, FixedPoint, Motion, PointLoad},
    scene::{self, Repeat, Scene},
};
use glam::{DMat3, DQuat, DVec3};
use std::sync::Arc;

/// Position and rotation of a block's own frame.
#[derive(Clone, Copy)]
struct Place {
    position: DVec3,
    rotation: DQuat,
}

/// The blocks of the table `index`.
pub(super) fn blocks(scene: &Scene, index: usize, block: &scene::Block) -> Result<Vec<Block>> {
    let key = format!("blocks[{index}]");
    let (shape, centroid) = shape(scene, &key, &block.shape)?;
    let shape = Arc::new(shape);
    let material = scene.material(&format!("{key}.material"), block.material.as_deref())?;
    let name = match &block.name {
        Some(name) => name.clone(),
        None => format!("block_{}", index + 1),
    };
    let mut places = vec![Place {
        position: DVec3::from(block.position),
        rotation: rotation(&block.rotation),
    }];
    for row in &block.repeat {
        places = row_of(&places, row);
    }
    let about_centroid = points(&key, block, &shape, centroid)?;
    let alone = places.len() == 1;
    let made = places.into_iter().enumerate().map(|(number, place)| Block {
        name: if alone {
            name.clone()
        } else {
            format!("{name}_{}", number + 1)
        },
        shape: shape.clone(),
        material,
        centre: place.position + place.rotation * centroid,
        rotation: place.rotation,
        velocity: start(&block.velocity),
        spin: start(&block.spin),
        motion: match block.motion {
            scene::Motion::Free => Motion::Free,
            scene::Motion::Fixed => Motion::Fixed,
            scene::Motion::Driven => Motion::Driven {
                velocity: block.velocity.clone(),
                spin: block.spin.clone(),
            },
        },
        deformable: about_centroid.deformable.clone(),
        point_loads: about_centroid.point_loads.clone(),
        acceleration: block.acceleration.clone(),
    });
    Ok(made.collect())
}

/// The places of a row: `places` themselves, then their copies.
fn row_of(places: &[Place], row: &Repeat) -> Vec<Place> {
    let (turn, about) = (rotation(&row.turn), DVec3::from(row.about));
    let mut list = places.to_vec();
    for _ in 1..row.count {
        let last = &list[list.len() - places.len()..];
        let next: Vec<Place> = last
            .iter()
            .map(|place| Place {
                position: about + turn * (place.position - about) + DVec3::from(row.step),
                rotation: (turn * place.rotation).normalize(),
            })
            .collect();
        list.extend(next);
    }
    list
}

/// The value of formulas at the time 0.
fn start(formulas: &[Formula; 3]) -> DVec3 {
    DVec3::from(formulas.each_ref().map(|f| f.eval_at([0.0; 3], 0.0)))
}

/// Distance from a shape within which a point counts as on its surface, relative to the radius of the shape: the
/// rounding of numbers in scenes.
const ON: f64 = 1e-6;

/// The points of the block of a table, relative to the centroid.
struct Points {
    deformable: Option<Deformable>,
    point_loads: Vec<PointLoad>,
}

/// The points of the table `key`, whose `shape` has its `centroid` (m) in the block's own frame.
///
/// # Errors
/// [`Error::Scene`] naming a point outside the block, or a deformable mesh that has several parts.
fn points(key: &str, block: &scene::Block, shape: &Shape, centroid: DVec3) -> Result<Points> {
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
