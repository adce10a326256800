//! Gaps between blocks that are narrower than a cell.

use crate::{
    Result,
    geometry::HalfSpace,
    rock::{
        Blocks, Setup,
        broadphase::{Aabb, Broadphase},
        contact::Placed,
    },
};
use glam::DVec3;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Width, cells, below which a gap is closed and holds no water: of the size of contact overlaps and of the rounding of
/// scenes.
const CLOSED_GAP: f64 = 1e-3;

/// The gap between two neighbouring blocks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// The blocks, the first one in the fluid.
    pub blocks: [usize; 2],
    /// Distance between their nearest faces and corners, m; a lower bound for two crossing edges. Negative if they
    /// overlap.
    pub width: f64,
}

impl Gap {
    /// Whether the blocks touch, in a lattice of cells of `cell` m.
    pub fn is_closed(&self, cell: f64) -> bool {
        self.width <= CLOSED_GAP * cell
    }
}

/// The pairs of blocks, at least one of them among the first `in_fluid`, that are less than a cell (`cell`, m)
/// apart, in ascending order.
pub(crate) async fn gaps(
    setup: &Setup,
    blocks: &Blocks,
    in_fluid: usize,
    cell: f64,
    broadphase: &mut impl Broadphase,
) -> Result<Vec<Gap>> {
    let parts = placed_parts(setup, blocks);
    let (mut owners, mut placed) = (Vec::new(), Vec::new());
    for (part, shift) in blocks.images() {
        let (block, at) = &parts[part];
        owners.push(*block);
        placed.push(Placed {
            centre: at.centre + shift,
            ..at.clone()
        });
    }
    let grown = |(item, &block): (Aabb, &usize)| Aabb {
        min: item.min.map(|x| x - 0.5 * cell),
        max: item.max.map(|x| x + 0.5 * cell),
        // Solids and walls form one group: gaps between them are ignored.
        group: block.min(in_fluid) as u32,
    };
    let items: Vec<Aabb> = blocks.aabbs().into_iter().zip(&owners).map(grown).collect();
    let mut narrowest = BTreeMap::new();
    for pair in broadphase.pairs(&items).await? {
        let [a, b] = pair.map(|part| part as usize);
        let width = distance(&placed[a], &placed[b]);
        if width < cell * (1.0 - CLOSED_GAP) {
            // Images are the last items.
            let mut blocks = [owners[a], owners[b]];
            blocks.sort_unstable();
            let known = narrowest.entry(blocks).or_insert(width);
            *known = known.min(width);
        }
    }
    let found = |(blocks, width)| Gap { blocks, width };
    Ok(narrowest.into_iter().map(found).collect())
}

/// The narrowest open gap between one of the first `in_fluid` blocks and another block, a wall, or a periodic image of
/// these or of itself, in a lattice of cells of `cell` m; `None` if all are wider than `within` (m).
pub(crate) fn narrowest(
    setup: &Setup,
    blocks: &Blocks,
    (in_fluid, cell, within): (usize, f64, f64),
) -> Option<Gap> {
    let parts = placed_parts(setup, blocks);
    let period = setup.period.as_ref();
    let of_part = |(block, part): &(usize, Placed)| {
        let mut least: Option<Gap> = None;
        for (other, its) in &parts {
            // Each pair once; a block and itself only as images.
            if other < block {
                continue;
            }
            let apart = its.centre - part.centre;
            let near = part.radius + its.radius + within;
            let is_near = |shift: &DVec3| (apart + *shift).length_squared() <= near * near;
            let nearest = period.map_or(DVec3::ZERO, |period| period.nearest(apart));
            if !is_near(&nearest) {
                continue;
            }
            let shifts = period.map_or(vec![nearest], |period| period.image_shifts(apart, near));
            for shift in shifts.into_iter().filter(is_near) {
                if other == block && shift == DVec3::ZERO {
                    continue;
                }
                let image = Placed {
                    centre: its.centre + shift,
                    ..its.clone()
                };
                let found = Gap {
                    blocks: [*block, *other],
                    width: distance(part, &image),
                };
                let known = least.map_or(within, |least| least.width);
                if found.width < known && !found.is_closed(cell) {
                    least = Some(found);
                }
            }
        }
        least
    };
    let fluid = parts.iter().filter(|(block, _)| *block < in_fluid);
    let fluid: Vec<_> = fluid.collect();
    let all: Vec<Option<Gap>> = fluid.into_par_iter().map(of_part).collect();
    all.into_iter()
        .flatten()
        .min_by(|a, b| a.width.total_cmp(&b.width))
}

/// The convex parts of all blocks at their poses, with their blocks.
fn placed_parts(setup: &Setup, blocks: &Blocks) -> Vec<(usize, Placed)> {
    let mut placed = Vec::new();
    for (block, pose) in blocks.poses().iter().enumerate() {
        let parts = setup.blocks[block].shape.parts().iter();
        placed.extend(parts.map(|part| (block, Placed::of(part, pose))));
    }
    placed
}

/// The largest height of a part over the faces of `own`, m.
fn max_height(own: &Placed, other: &Placed) -> f64 {
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
fn distance(a: &Placed, b: &Placed) -> f64 {
    if a.faces.is_empty() && b.faces.is_empty() {
        return a.centre.distance(b.centre) - a.radius - b.radius;
    }
    max_height(a, b).max(max_height(b, a))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        geometry::{Polyhedron, Shape},
        rock::{Block, Material, Period, broadphase::HostBroadphase},
    };

    #[test]
    fn gaps_of_cubes_in_a_row_and_a_sphere_above() {
        let cube: std::sync::Arc<Shape> =
            std::sync::Arc::new(Polyhedron::cuboid(DVec3::ONE).unwrap().into());
        let at = |name: &str, x: f64| Block::new(name, cube.clone(), DVec3::X * x);
        let sphere = Shape::sphere(0.25).unwrap();
        let list = vec![
            at("first", 0.0),
            at("second", 1.03),
            at("far", 2.23),
            Block::new("sphere", sphere, DVec3::new(0.0, 0.0, 0.8)),
            // Two solids: the gap between them is ignored.
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
        let mut broadphase = HostBroadphase;
        let found = gaps(&setup, &blocks, 4, 0.1, &mut broadphase);
        let found = pollster::block_on(found).unwrap();
        let pairs: Vec<_> = found.iter().map(|gap| gap.blocks).collect();
        assert_eq!(pairs, [[0, 1], [0, 3], [0, 4]]);
        for (gap, width) in found.iter().zip([0.03, 0.05, 0.0]) {
            assert!((gap.width - width).abs() < 1e-12, "{gap:?}");
            assert_eq!(gap.is_closed(0.1), width == 0.0);
        }
    }

    /// A cube of 1 m in a periodic domain along x, and a wall 0.3 m below it.
    #[test]
    fn a_block_is_its_own_neighbour_in_a_periodic_domain() {
        let cube: std::sync::Arc<Shape> =
            std::sync::Arc::new(Polyhedron::cuboid(DVec3::ONE).unwrap().into());
        let at = |name: &str, x: DVec3| Block::new(name, cube.clone(), x);
        let narrowest = |length: f64, within: f64| {
            let setup = Setup {
                blocks: vec![at("cube", DVec3::ZERO), at("wall", -1.3 * DVec3::Z).fixed()],
                materials: vec![Material::default()],
                time_step: Some(1e-3),
                period: Some(Period {
                    origin: DVec3::splat(-0.7),
                    size: DVec3::new(length, f64::INFINITY, f64::INFINITY),
                }),
                ..Setup::default()
            };
            let blocks = Blocks::new(setup.clone()).unwrap();
            super::narrowest(&setup, &blocks, (1, 0.1, within))
        };
        for (length, pair, width) in [(1.2, [0, 0], 0.2), (2.0, [0, 1], 0.3)] {
            let found = narrowest(length, 0.6).unwrap();
            assert_eq!(found.blocks, pair);
            assert!((found.width - width).abs() < 1e-12, "{found:?}");
        }
        assert_eq!(narrowest(2.0, 0.25), None);
    }
}
