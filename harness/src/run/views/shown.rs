//! What pictures ask of an engine.

use super::super::engine::Engine;
use crate::{picture::Placed, render::Drops};
use riprap::{
    geometry::{Pose, Shape},
    output::Array,
    rock::Block,
    scene::Field,
};
use std::{collections::HashMap, sync::Arc};

/// An engine with something to be seen in space.
pub trait Shown: Engine {
    /// The blocks, static solids last; none where there is only a fluid in a box.
    fn blocks(&self) -> &[Block];

    /// How many of the blocks are static solids, which cells of a fluid show as well.
    fn solids(&self) -> usize;

    /// Where the blocks are.
    fn poses(&self) -> Vec<Pose>;

    /// The given fields on the given cells of the fluid, SI. A scene without fluid asks for none.
    fn read(&mut self, fields: &[Field], cells: &[u32]) -> riprap::Result<Vec<Array>>;

    /// The particles of water, if that is what flows; `speed` (m/s) has the last colour, if it is given.
    fn drops(&mut self, _speed: Option<f64>) -> riprap::Result<Option<Drops>> {
        Ok(None)
    }
}

/// The convex parts of the blocks of `engine`, where `poses` say.
pub fn placed<'a>(engine: &'a impl Shown, poses: &[Pose]) -> Vec<Placed<'a>> {
    parts(engine.blocks(), poses)
}

/// Those of the blocks that are no static solids.
pub fn immersed<'a>(engine: &'a impl Shown, poses: &[Pose]) -> Vec<Placed<'a>> {
    let blocks = engine.blocks();
    parts(&blocks[..blocks.len() - engine.solids()], poses)
}

fn parts<'a>(blocks: &'a [Block], poses: &[Pose]) -> Vec<Placed<'a>> {
    let blocks = blocks.iter().zip(poses);
    let parts = blocks.flat_map(|(block, pose)| {
        block.shape.parts().iter().map(|part| Placed {
            form: &part.form,
            centre: pose.point(part.offset),
            deformation: pose.deformation,
        })
    });
    parts.collect()
}

/// Calls `with` for each different shape; says which of all their parts is the first of each.
pub fn each_shape(blocks: &[Block], mut with: impl FnMut(&Shape)) -> HashMap<*const Shape, usize> {
    let mut first = HashMap::new();
    let mut parts = 0;
    for block in blocks {
        first.entry(Arc::as_ptr(&block.shape)).or_insert_with(|| {
            with(&block.shape);
            let at = parts;
            parts += block.shape.parts().len();
            at
        });
    }
    first
}
