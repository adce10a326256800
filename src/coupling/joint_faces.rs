//! Faces of blocks in joints: the neighbours over a face, the area that they cover, and the pressure on it.

use super::Coupled;
use crate::{
    geometry::{Form, HalfSpace, Load, Part, Pose, Shape, outer},
    psm::{area_of, corners},
    rock::{Period, contact::Placed},
};
use glam::DVec3;

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
            period: self.blocks().period(),
        };
        let found = neighbour_parts(|n| &*setup[n].shape, poses, block, distance);
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
    /// Number of its block.
    pub block: usize,
    /// Periodic offset of this image, m.
    pub offset: DVec3,
    pub part: Placed,
}

/// The poses of all blocks.
#[derive(Clone, Copy, Debug)]
pub(super) struct Poses<'a> {
    pub poses: &'a [Pose],
    pub period: Option<Period>,
}

/// The parts of the other blocks, solids and walls that may lie within `distance` (m) of a block, in all periodic images,
/// and those of its own images.
pub(super) fn neighbour_parts<'a>(
    shape: impl Fn(usize) -> &'a Shape,
    Poses { poses, period }: Poses<'_>,
    block: usize,
    distance: f64,
) -> Vec<NeighbourPart> {
    let mut found = Vec::new();
    let (centre, reach) = (poses[block].centre, shape(block).radius() + distance);
    for (other, pose) in poses.iter().enumerate() {
        let limit = reach + shape(other).radius();
        let apart = pose.centre - centre;
        let offsets = match period {
            Some(period) => period.image_shifts(apart, limit),
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

/// The section of a part over a plane polygon, projected onto it, and its area (m²): at the one of the `heights` (m) over
/// the polygon where it is largest.
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

    #[test]
    fn a_face_is_in_a_joint_under_a_near_block() {
        let cube = |x: f64, y: f64| {
            let pose = Pose::rigid(
                DVec3::new(x, y, 0.0),
                DQuat::IDENTITY,
                DVec3::ZERO,
                DVec3::ZERO,
            );
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
