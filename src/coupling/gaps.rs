//! Gaps between blocks that are narrower than a cell.

use crate::{
    Result,
    block::HalfSpace,
    bodies::{Blocks, Setup},
    broadphase::{Broadphase, Item},
    contact::Placed,
};
use std::collections::BTreeMap;

/// Part of a cell below which a gap is closed: the overlap of contacts and the rounding of scenes are of
/// this size, and no water stands in it.
const CLOSED: f64 = 1e-3;

/// Two blocks that are close to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// The blocks, the first one in the fluid.
    pub blocks: [usize; 2],
    /// Distance between the nearest of their faces and corners, m; for two edges across each other less
    /// than their distance. Negative where they overlap.
    pub width: f64,
}

impl Gap {
    /// Whether the blocks touch, in a lattice of cells of `cell` m.
    pub fn is_closed(&self, cell: f64) -> bool {
        self.width <= CLOSED * cell
    }
}

/// The pairs of blocks, one of them among the first `in_fluid`, that are less than a cell of `cell` m
/// apart, in their order.
pub(crate) async fn gaps(
    setup: &Setup,
    blocks: &Blocks,
    in_fluid: usize,
    cell: f64,
    finder: &mut impl Broadphase,
) -> Result<Vec<Gap>> {
    let mut parts = Vec::new();
    for (block, pose) in blocks.poses().iter().enumerate() {
        let own = setup.blocks[block].shape.parts().iter();
        parts.extend(own.map(|part| (block, Placed::of(part, pose))));
    }
    let (mut owners, mut placed) = (Vec::new(), Vec::new());
    for (part, way) in blocks.images() {
        let (block, at) = &parts[part];
        owners.push(*block);
        placed.push(Placed {
            centre: at.centre + way,
            ..at.clone()
        });
    }
    let grown = |(item, &block): (Item, &usize)| Item {
        min: item.min.map(|x| x - 0.5 * cell),
        max: item.max.map(|x| x + 0.5 * cell),
        // Solids and walls are one: what is between them is no joint.
        group: block.min(in_fluid) as u32,
    };
    let items: Vec<Item> = blocks.items().into_iter().zip(&owners).map(grown).collect();
    let mut narrowest = BTreeMap::new();
    for pair in finder.pairs(&items).await? {
        let [a, b] = pair.map(|part| part as usize);
        let width = gap(&placed[a], &placed[b]);
        if width < cell {
            // Images come after all others.
            let mut blocks = [owners[a], owners[b]];
            blocks.sort_unstable();
            let known = narrowest.entry(blocks).or_insert(width);
            *known = known.min(width);
        }
    }
    let found = |(blocks, width)| Gap { blocks, width };
    Ok(narrowest.into_iter().map(found).collect())
}

/// How far a part lies beyond the face of `own` that it is farthest from.
fn beyond(own: &Placed, other: &Placed) -> f64 {
    let apart = other.centre - own.centre;
    let face = |face: &HalfSpace| match other.faces.is_empty() {
        true => face.height(apart) - other.radius,
        false => {
            let heights = other.vertices.iter().map(|x| face.height(apart + *x));
            heights.fold(f64::INFINITY, f64::min)
        }
    };
    own.faces.iter().map(face).fold(f64::NEG_INFINITY, f64::max)
}

/// Distance of two parts, m.
fn gap(a: &Placed, b: &Placed) -> f64 {
    if a.faces.is_empty() && b.faces.is_empty() {
        return a.centre.distance(b.centre) - a.radius - b.radius;
    }
    beyond(a, b).max(beyond(b, a))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        block::{Polyhedron, Shape},
        bodies::{Block, Material},
        broadphase::HostBroadphase,
    };
    use glam::DVec3;

    #[test]
    fn cubes_in_a_row_and_a_ball_on_them() {
        let cube: std::sync::Arc<Shape> =
            std::sync::Arc::new(Polyhedron::cuboid(DVec3::ONE).unwrap().into());
        let at = |name: &str, x: f64| Block::new(name, cube.clone(), DVec3::X * x);
        let ball = Shape::sphere(0.25).unwrap();
        let list = vec![
            at("first", 0.0),
            at("second", 1.03),
            at("far", 2.23),
            Block::new("ball", ball, DVec3::new(0.0, 0.0, 0.8)),
            // Solids: the gap between them is none.
            at("wall", -1.0).fixed(),
            at("other wall", -2.01).fixed(),
        ];
        let setup = Setup {
            blocks: list,
            materials: vec![Material::default()],
            time_step: Some(1e-3),
            ..Setup::default()
        };
        let blocks = Blocks::new(setup.clone()).unwrap();
        let mut finder = HostBroadphase;
        let found = gaps(&setup, &blocks, 4, 0.1, &mut finder);
        let found = pollster::block_on(found).unwrap();
        let pairs: Vec<_> = found.iter().map(|gap| gap.blocks).collect();
        assert_eq!(pairs, [[0, 1], [0, 3], [0, 4]]);
        for (gap, width) in found.iter().zip([0.03, 0.05, 0.0]) {
            assert!((gap.width - width).abs() < 1e-12, "{gap:?}");
            assert_eq!(gap.is_closed(0.1), width == 0.0);
        }
    }
}
