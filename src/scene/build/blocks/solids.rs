//! Solids and the faces of the domain as fixed blocks; regions.

use super::{
    materials::held,
    shapes::{in_mesh, mesh_shape},
};
use crate::{
    Error, Result,
    geometry::{HalfSpace, Polyhedron, Shape},
    rock::Block,
    scene::{self, Boundary, Particles, Scene, Solid},
};
use glam::DVec3;

/// The solid `index` as a fixed block.
pub(super) fn block(scene: &Scene, index: usize, solid: &Solid) -> Result<Block> {
    let key = format!("solids[{index}]");
    let (shape, centre) = shape(scene, &solid.shape, &key)?;
    let name = match &solid.name {
        Some(name) => name.clone(),
        None => format!("solid_{}", index + 1),
    };
    let material = held(scene, &format!("{key}.material"), solid.material.as_deref())?;
    Ok(Block {
        material,
        ..Block::new(name, shape, centre).fixed()
    })
}

fn shape(scene: &Scene, shape: &scene::Shape, key: &str) -> Result<(Shape, DVec3)> {
    match shape {
        scene::Shape::Box { min, max } => {
            let (min, max) = (DVec3::from(*min), DVec3::from(*max));
            let made = Polyhedron::cuboid(max - min)
                .map_err(|error| error.at_key(|what| format!("{key}.{what}")))?;
            Ok((made.into(), 0.5 * (min + max)))
        }
        scene::Shape::HalfSpace { point, normal } => {
            let plane = HalfSpace::through(DVec3::from(*point), DVec3::from(*normal));
            let mut faces = scene.domain.beyond().to_vec();
            faces.push(plane);
            let (made, centroid) = Polyhedron::from_half_spaces(&faces)
                .map_err(|error| error.at_key(|what| format!("{key}.{what}")))?;
            Ok((made.into(), centroid))
        }
        scene::Shape::Sphere { center, radius } => Ok((
            Shape::sphere(*radius).map_err(|error| error.at_key(|what| format!("{key}.{what}")))?,
            DVec3::from(*center),
        )),
        scene::Shape::Terrain { .. } => {
            let terrain = scene.terrain(shape)?;
            let terrain = terrain.ok_or_else(|| Error::scene(key, "is no terrain"))?;
            let domain = &scene.domain;
            let (min, max) = match domain.is_given() {
                true => (domain.origin, domain.end()),
                false => ([f64::NEG_INFINITY; 3], [f64::INFINITY; 3]),
            };
            // The particles of a solid fill the support of the kernel.
            let layers = |particles: &Particles| (2.0 * particles.smoothing).ceil() + 1.0;
            let particles = scene.particles.as_ref();
            let depth = particles.map_or(0.0, |it| layers(it) * it.spacing);
            let bottom = match domain.is_given() {
                true => min[2] - depth,
                false => f64::INFINITY,
            };
            let made = terrain.shape([min[0], min[1]], [max[0], max[1]], bottom);
            made.map_err(|error| error.at_key(|what| format!("{key}.{what}")))
        }
        scene::Shape::Mesh {
            file,
            scale,
            translate,
        } => {
            let (made, centroid) = mesh_shape(&scene.dir().join(file), *scale, false)?;
            Ok((made, DVec3::from(*translate) + centroid))
        }
    }
}

/// A fixed block behind each wall and each free-slip face, which confine blocks as they confine the fluid. Blocks
/// leave through other faces.
pub(super) fn walls(scene: &Scene) -> Result<Vec<Block>> {
    let material = held(scene, "materials", None)?;
    let (low, high) = (
        DVec3::from(scene.domain.origin),
        DVec3::from(scene.domain.end()),
    );
    let mut blocks = Vec::new();
    for (face, boundary) in scene.boundaries.iter() {
        if !matches!(boundary, Boundary::Wall { .. } | Boundary::FreeSlip) {
            continue;
        }
        let (axis, side) = (face.axis().index(), usize::from(face.is_max()));
        // Into the domain, from a point of the face.
        let mut normal = DVec3::ZERO;
        normal[axis] = if side == 0 { 1.0 } else { -1.0 };
        let point = if side == 0 { low } else { high };
        let mut faces = scene.domain.beyond().to_vec();
        faces.push(HalfSpace::through(point, normal));
        let (shape, centre) = Polyhedron::from_half_spaces(&faces)?;
        let name = format!("wall_{}", face.name());
        blocks.push(Block {
            material,
            ..Block::new(name, Shape::from(shape), centre).fixed()
        });
    }
    Ok(blocks)
}

/// A test of whether one of the regions contains a point (m).
///
/// # Errors
/// If the file of a mesh cannot be read.
pub(super) fn holds(scene: &Scene, regions: &[scene::Shape]) -> Result<impl Fn(DVec3) -> bool> {
    let mut inside: Vec<Box<dyn Fn(DVec3) -> bool>> = Vec::with_capacity(regions.len());
    for region in regions {
        inside.push(match region {
            scene::Shape::Box { min, max } => {
                let (min, max) = (DVec3::from(*min), DVec3::from(*max));
                Box::new(move |x| x.cmpge(min).all() && x.cmple(max).all())
            }
            scene::Shape::HalfSpace { point, normal } => {
                let (point, normal) = (DVec3::from(*point), DVec3::from(*normal));
                Box::new(move |x| normal.dot(x - point) <= 0.0)
            }
            scene::Shape::Sphere { center, radius } => {
                let (centre, radius) = (DVec3::from(*center), *radius);
                Box::new(move |x| x.distance(centre) <= radius)
            }
            scene::Shape::Mesh {
                file,
                scale,
                translate,
            } => {
                let path = scene.dir().join(file);
                in_mesh(&path, *scale, DVec3::from(*translate))?
            }
            scene::Shape::Terrain { .. } => {
                let terrain = scene.terrain(region)?;
                Box::new(move |x| {
                    let height = terrain
                        .as_ref()
                        .and_then(|terrain| terrain.height(x.x, x.y));
                    height.is_some_and(|height| x.z <= height)
                })
            }
        });
    }
    Ok(move |x: DVec3| inside.iter().any(|holds| holds(x)))
}
