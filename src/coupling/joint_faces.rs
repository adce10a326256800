//! Faces of blocks in joints: the neighbours over a face, the area that they cover, and the pressure on it.

use super::Coupled;
use crate::{
    geometry::{Form, HalfSpace, Load, Part, Pose, Shape, area_of, corners, outer},
    rock::{Period, Periods, contact::Placed},
};
use glam::DVec3;
use std::collections::HashMap;

/// Heights over a face, cells, at which another block makes it a joint: the thinner fluid transmits only pressure. The
/// first height finds blocks in contact.
const JOINT_HEIGHTS: [f64; 4] = [0.25, 1.0, 2.0, 3.0];
/// Fraction of a face that the other block must cover. It excludes the block under an adjacent face, which shares an edge
/// with this one.
const MIN_COVERED: f64 = 0.01;

impl Coupled<'_> {
    /// Whether each plane face of a block, part by part, is in a joint: another block, a solid or a wall of the domain
    /// lies within three cells over at least 1 % of the face.
    pub fn faces_in_joints(&self, block: usize) -> Vec<bool> {
        let poses = self.blocks().poses();
        let setup = &self.setup().setup.blocks;
        let cell = self.solid_cells().frame().units.cell;
        let neighbours = self.neighbour_parts(block, JOINT_HEIGHTS[JOINT_HEIGHTS.len() - 1] * cell);
        let parts = setup[block].shape.parts().iter();
        parts
            .flat_map(|part| part_faces_in_joints(part, &poses[block], &neighbours, cell))
            .collect()
    }

    /// The parts of other blocks, solids and walls that may lie within `distance` (m) of a block, as periodic images where
    /// these are nearer.
    pub(super) fn neighbour_parts(&self, block: usize, distance: f64) -> Vec<Placed> {
        let setup = &self.setup().setup.blocks;
        let poses = Poses {
            poses: &self.blocks().poses(),
            periods: self.blocks().periods(),
        };
        let all = 0..setup.len();
        let found = neighbour_parts(|n| &*setup[n].shape, poses, block, (all, distance));
        found.into_iter().map(|other| other.part).collect()
    }
}

fn part_faces_in_joints(part: &Part, pose: &Pose, neighbours: &[Placed], cell: f64) -> Vec<bool> {
    let Form::Convex(shape) = &part.form else {
        return Vec::new();
    };
    let own = Placed::of(part, pose);
    let in_joint = |(face, plane): (usize, &crate::geometry::HalfSpace)| {
        let polygon = corners(shape, face, part.offset, pose);
        let min_area = MIN_COVERED * area_of(&polygon).1.length();
        let heights = JOINT_HEIGHTS.map(|height| height * cell);
        let covers =
            |other: &Placed| covered_polygon(&polygon, plane.normal, other, heights).1 > min_area;
        neighbours.iter().any(covers)
    };
    own.faces.iter().enumerate().map(in_joint).collect()
}

/// A part of a neighbouring block.
#[derive(Clone, Debug)]
pub(super) struct NeighbourPart {
    /// Index of its block.
    pub block: usize,
    /// Periodic offset of this image, m.
    pub offset: DVec3,
    pub part: Placed,
}

/// The poses of all blocks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Poses<'a> {
    pub poses: &'a [Pose],
    pub periods: Option<&'a Periods>,
}

impl Poses<'_> {
    fn period(&self) -> Option<Period> {
        self.periods.map(|periods| periods.period)
    }
}

/// A uniform grid of blocks, which finds the neighbours of a block without visiting all blocks.
#[derive(Debug)]
pub(super) struct NearBlocks<'a> {
    poses: Poses<'a>,
    /// Edges of a cell, m.
    cell: DVec3,
    /// Number of cells along periodic axes.
    count: [Option<i64>; 3],
    blocks: HashMap<[i64; 3], Vec<usize>>,
    /// Whether each block is too large for a cell.
    large: Vec<bool>,
}

impl<'a> NearBlocks<'a> {
    /// A grid of blocks at `poses` with the radii `radius` (m), for searches within `distance` (m).
    pub fn new(radius: impl Fn(usize) -> f64, poses: Poses<'a>, distance: f64) -> Self {
        let radii: Vec<f64> = (0..poses.poses.len()).map(radius).collect();
        let mut ascending = radii.clone();
        ascending.sort_by(f64::total_cmp);
        // Assumes that most blocks are of similar size and that walls are few.
        let usual = 2.0 * ascending.get(radii.len() / 2).copied().unwrap_or_default();
        let least = 2.0 * usual + distance;
        let count = [0, 1, 2].map(|axis| {
            let period = poses
                .period()
                .filter(|period| period.size[axis].is_finite())?;
            Some(((period.size[axis] / least) as i64).max(1))
        });
        let cell = DVec3::from([0, 1, 2].map(|axis| match (count[axis], poses.period()) {
            (Some(count), Some(period)) => period.size[axis] / count as f64,
            _ => least,
        }));
        let mut found = Self {
            poses,
            cell,
            count,
            blocks: HashMap::new(),
            large: radii.iter().map(|radius| *radius > usual).collect(),
        };
        for block in (0..radii.len()).filter(|block| !found.large[*block]) {
            let at = found.cell_of(block);
            found.blocks.entry(at).or_default().push(block);
        }
        found
    }

    fn cell_of(&self, block: usize) -> [i64; 3] {
        let centre = self.poses.poses[block].centre;
        let place = match self.poses.period() {
            Some(period) => period.wrapped(centre) - period.origin,
            None => centre,
        };
        let at = (place / self.cell).floor();
        [0, 1, 2].map(|axis| self.wrapped(axis, at[axis] as i64))
    }

    fn wrapped(&self, axis: usize, at: i64) -> i64 {
        self.count[axis].map_or(at, |count| at.rem_euclid(count))
    }

    /// All blocks that may lie within the search distance of a block, including itself, in ascending order.
    pub fn near(&self, block: usize) -> Vec<usize> {
        if self.large[block] {
            return (0..self.large.len()).collect();
        }
        let at = self.cell_of(block);
        let mut found: Vec<usize> = (0..self.large.len()).filter(|n| self.large[*n]).collect();
        for n in 0..27 {
            let step = [n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1];
            let key = [0, 1, 2].map(|axis| self.wrapped(axis, at[axis] + step[axis]));
            found.extend(self.blocks.get(&key).into_iter().flatten());
        }
        found.sort_unstable();
        found.dedup();
        found
    }
}

/// The parts of the blocks, solids and walls `others` that may lie within `distance` (m) of a block, in all periodic images,
/// and the parts of its own images. Along an axis that a block fills, it has no images.
pub(super) fn neighbour_parts<'a>(
    shape: impl Fn(usize) -> &'a Shape,
    Poses { poses, periods }: Poses<'_>,
    block: usize,
    (others, distance): (impl IntoIterator<Item = usize>, f64),
) -> Vec<NeighbourPart> {
    let mut found = Vec::new();
    let (centre, reach) = (poses[block].centre, shape(block).radius() + distance);
    for other in others {
        let pose = &poses[other];
        let limit = reach + shape(other).radius();
        let apart = pose.centre - centre;
        let offsets = match periods {
            Some(periods) => periods.image_shifts([block, other], apart, limit),
            None => vec![DVec3::ZERO],
        };
        for offset in offsets {
            let itself = other == block && offset == DVec3::ZERO;
            if itself || (apart + offset).length() > limit {
                continue;
            }
            let image = Pose {
                centre: pose.centre + offset,
                ..*pose
            };
            let within = |part: &&Part| {
                let apart = image.point(part.offset) - centre;
                apart.length() <= reach + part.form.radius()
            };
            let parts = shape(other).parts().iter().filter(within);
            found.extend(parts.map(|part| NeighbourPart {
                block: other,
                offset,
                part: Placed::of(part, &image),
            }));
        }
    }
    found
}

/// The section of a part over a plane polygon, projected onto the polygon, and its area (m²), at the one of the `heights`
/// (m) over the polygon at which the area is largest.
pub(super) fn covered_polygon(
    polygon: &[DVec3],
    normal: DVec3,
    part: &Placed,
    heights: impl IntoIterator<Item = f64>,
) -> (Vec<DVec3>, f64) {
    let mut largest = (Vec::new(), 0.0);
    for height in heights {
        let offset = height * normal;
        let separates = |face: &HalfSpace| {
            let height = |x: &DVec3| face.height(*x + offset - part.centre);
            polygon.iter().all(|x| height(x) >= 0.0)
        };
        if part.faces.iter().any(separates) {
            continue;
        }
        let mut section = part.clipped(polygon.iter().map(|x| x + offset).collect());
        let area = area_of(&section).1.length();
        if area > largest.1 {
            section.iter_mut().for_each(|x| *x -= offset);
            largest = (section, area);
        }
    }
    largest
}

/// Levels of subdivision of a triangle that the water line crosses.
const SUBDIVISIONS: u32 = 3;

/// Adds a pressure on a polygon with the outward normal `normal` to the load on a block at `centre`. A quadrature with
/// three points per triangle is exact for the moment of a linear pressure; triangles that are partly dry are subdivided.
pub(super) fn add_pressure(
    load: &mut Load,
    corners: &[DVec3],
    normal: DVec3,
    centre: DVec3,
    pressure: impl Fn(DVec3) -> f64,
) {
    for pair in corners.windows(2).skip(1) {
        let triangle = [corners[0], pair[0], pair[1]];
        add_pressure_on_triangle(load, triangle, (normal, centre), &pressure, SUBDIVISIONS);
    }
}

fn add_pressure_on_triangle(
    load: &mut Load,
    [a, b, c]: [DVec3; 3],
    (normal, centre): (DVec3, DVec3),
    pressure: &impl Fn(DVec3) -> f64,
    subdivisions: u32,
) {
    let dry = [a, b, c].map(|x| pressure(x) == 0.0);
    if subdivisions > 0 && dry.contains(&true) && dry.contains(&false) {
        let [ab, bc, ca] = [0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)];
        for part in [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]] {
            add_pressure_on_triangle(load, part, (normal, centre), pressure, subdivisions - 1);
        }
        return;
    }
    let third = (b - a).cross(c - a).length() / 6.0;
    let whole = a + b + c;
    for x in [a, b, c].map(|corner| (3.0 * corner + whole) / 6.0) {
        let force = -third * pressure(x) * normal;
        load.force += force;
        load.moment += outer(force, x - centre);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Polyhedron;
    use glam::{DQuat, DVec3};

    /// Spheres of two sizes and a large one, in a box with or without periodic axes.
    #[test]
    fn the_parts_near_a_block_are_those_of_a_look_at_all_blocks() {
        let sizes = [0.2, 0.3, 5.0].map(|radius| Shape::sphere(radius).unwrap());
        let shape = |n: usize| match n {
            0 => &sizes[2],
            _ => &sizes[n % 2],
        };
        let poses: Vec<Pose> = (0..400)
            .map(|n| {
                // Multiples of irrational numbers are evenly distributed.
                let at = DVec3::new(0.7548, 0.5698, 0.3172) * f64::from(n);
                let centre = (at - at.floor()) * DVec3::new(9.0, 7.0, 8.0) - DVec3::splat(2.0);
                Pose::at_rest(centre, DQuat::IDENTITY)
            })
            .collect();
        let period = |size: [f64; 3]| Period {
            origin: DVec3::splat(-2.0),
            size: DVec3::from(size),
        };
        let periods = [
            None,
            Some(period([9.0, f64::INFINITY, 8.0])),
            Some(period([f64::INFINITY, 7.0, f64::INFINITY])),
        ];
        for period in periods {
            let periods = period.map(|period| Periods {
                period,
                filled: vec![[false; 3]; 400],
            });
            let poses = Poses {
                poses: &poses,
                periods: periods.as_ref(),
            };
            let near = NearBlocks::new(|n| shape(n).radius(), poses, 0.1);
            let mut fewest = usize::MAX;
            for block in 0..400 {
                let of = |others: Vec<usize>| {
                    let found = neighbour_parts(shape, poses, block, (others, 0.1));
                    let found = found.into_iter();
                    found
                        .map(|part| (part.block, part.offset))
                        .collect::<Vec<_>>()
                };
                fewest = fewest.min(near.near(block).len());
                assert_eq!(of(near.near(block)), of((0..400).collect()), "{block}");
            }
            assert!(fewest < 100, "{fewest}");
        }
    }

    #[test]
    fn a_face_is_in_a_joint_under_a_near_block() {
        let cube = |x: f64, y: f64| {
            let pose = Pose::at_rest(DVec3::new(x, y, 0.0), DQuat::IDENTITY);
            let part = Part {
                form: Form::Convex(Polyhedron::cuboid(DVec3::ONE).unwrap()),
                offset: DVec3::ZERO,
            };
            (part, pose)
        };
        let (part, pose) = cube(0.0, 0.0);
        // Half over the face at +x with a gap of 0.2, in contact at −x, too far at +y.
        let neighbours = [cube(1.2, 0.5), cube(-1.0, 0.0), cube(0.0, 1.5)];
        let neighbours = neighbours.map(|(part, pose)| Placed::of(&part, &pose));
        let own = Placed::of(&part, &pose);
        let found = part_faces_in_joints(&part, &pose, &neighbours, 0.1);
        for (face, found) in own.faces.iter().zip(found) {
            assert_eq!(found, face.normal.x.abs() > 0.5, "{}", face.normal);
        }
    }
}
