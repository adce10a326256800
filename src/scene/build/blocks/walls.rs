//! The faces of a domain that hold blocks.

use super::{materials::held, solids::beyond};
use crate::{
    Result,
    geometry::{HalfSpace, Polyhedron, Shape},
    rock::Block,
    scene::{Boundary, Scene},
};
use glam::DVec3;

/// A fixed block behind each wall and each free-slip face: what keeps the fluid in keeps blocks in. They
/// leave through the others.
pub(super) fn blocks(scene: &Scene) -> Result<Vec<Block>> {
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
        let mut faces = beyond(scene).to_vec();
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
