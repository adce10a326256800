//! A table of `blocks`: its block and the copies of it.

use super::deformable;
use super::shapes::{rotation, shape};
use crate::{
    Result,
    formula::Formula,
    rock::{Block, Motion},
    scene::{self, Repeat, Scene},
};
use glam::{DQuat, DVec3};
use std::sync::Arc;

/// Where the own frame of a block is.
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
    let about_centroid = deformable::points(&key, block, &shape, centroid)?;
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

/// The copies of `places` that a row makes, those places themselves first.
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
