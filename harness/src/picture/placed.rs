//! Blocks that a plane intersects.

use super::section::Plane;
use glam::{DMat3, DVec2, DVec3};
use riprap::geometry::Form;
use riprap::output::ImageData;
use std::f64::consts::TAU;

/// Corners of the polygon by which the section of a sphere is drawn: off the circle by r(1 − cos π/96), less than half a
/// pixel for all that fit a picture.
const AROUND: usize = 96;

/// A convex part of a block at its position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed<'a> {
    /// Its shape relative to its own centroid.
    pub form: &'a Form,
    /// Position of that centroid, m.
    pub centre: DVec3,
    /// Deformation gradient F: a point X of the form is at `centre` + F X.
    pub deformation: DMat3,
}

impl Placed<'_> {
    /// The convex polygon in which `plane` intersects the part, m along the two other axes in their order; `None` if it does
    /// not.
    pub fn outline(&self, plane: Plane) -> Option<Vec<[f64; 2]>> {
        let points = match self.form {
            Form::Convex(block) => self.crossings(block.vertices(), block.edges(), plane),
            Form::Sphere { radius } => self.circle(*radius, plane),
        };
        let [a, b] = plane.others();
        let flat = points.iter().map(|p| DVec2::new(p[a], p[b]));
        around(flat.collect())
    }

    /// Intersections of the edges of a polyhedron with the plane.
    fn crossings(&self, vertices: &[DVec3], edges: &[[u32; 2]], plane: Plane) -> Vec<DVec3> {
        let place = |x: &DVec3| self.centre + self.deformation * *x;
        let corners: Vec<DVec3> = vertices.iter().map(place).collect();
        let height = |corner: DVec3| corner[plane.normal] - plane.position;
        let ends = edges
            .iter()
            .map(|ends| ends.map(|end| corners[end as usize]));
        ends.filter_map(|[from, to]| {
            let (below, above) = (height(from), height(to));
            // A corner in the plane counts as above it, so that each crossing is found.
            ((below < 0.0) != (above < 0.0)).then(|| from.lerp(to, below / (below - above)))
        })
        .collect()
    }

    /// The circle in which the plane intersects a sphere: in the frame of the form the plane n·x = p is (Fᵀn)·X = p − n·centre.
    fn circle(&self, radius: f64, plane: Plane) -> Vec<DVec3> {
        let normal = self.deformation.row(plane.normal);
        let middle =
            (plane.position - self.centre[plane.normal]) / normal.length_squared() * normal;
        let square = radius * radius - middle.length_squared();
        // NaN if the normal is not finite.
        if square.is_nan() || square <= 0.0 {
            return Vec::new();
        }
        let x = normal.any_orthogonal_vector().normalize();
        let y = normal.normalize().cross(x);
        let points = (0..AROUND).map(|index| {
            let (sin, cos) = (TAU * index as f64 / AROUND as f64).sin_cos();
            self.centre + self.deformation * (middle + square.sqrt() * (cos * x + sin * y))
        });
        points.collect()
    }

    /// Whether `point` (m) is inside.
    pub fn holds(&self, point: DVec3) -> bool {
        let local = self.deformation.inverse() * (point - self.centre);
        match self.form {
            Form::Convex(block) => block.faces().iter().all(|face| face.height(local) <= 0.0),
            Form::Sphere { radius } => local.length_squared() <= radius * radius,
        }
    }

    /// Smallest and largest coordinates, m.
    pub fn bounds(&self) -> [DVec3; 2] {
        let half = match self.form {
            Form::Convex(block) => {
                let places = block.vertices().iter().map(|x| self.deformation * *x);
                let (low, high) = places
                    .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), x| {
                        (l.min(x), h.max(x))
                    });
                return [self.centre + low, self.centre + high];
            }
            // The farthest point of the ellipsoid F X, |X| = r, along n is at the distance r |Fᵀn|.
            Form::Sphere { radius } => DVec3::from_array(
                [0, 1, 2].map(|axis| radius * self.deformation.row(axis).length()),
            ),
        };
        [self.centre - half, self.centre + half]
    }
}

/// For each cell of `image`, whether its centre is in one of `blocks`.
pub fn cells_in(image: &ImageData, blocks: &[Placed<'_>]) -> Vec<bool> {
    let mut inside = vec![false; image.cell_count()];
    for block in blocks {
        let [low, high] = block.bounds();
        let [x, y, z] = [0, 1, 2].map(|axis| {
            let place = |end: f64| (end - image.origin[axis]) / image.spacing - 0.5;
            let begin = place(low[axis]).ceil().max(0.0) as usize;
            let end = place(high[axis])
                .floor()
                .min(image.cells[axis] as f64 - 1.0)
                + 1.0;
            begin..end.max(0.0) as usize
        });
        for k in z {
            for j in y.clone() {
                for i in x.clone() {
                    let centre = DVec3::new(i as f64, j as f64, k as f64) + 0.5;
                    let centre = DVec3::from(image.origin) + image.spacing * centre;
                    inside[image.cell_index(i, j, k)] |= block.holds(centre);
                }
            }
        }
    }
    inside
}

/// Corners of a convex polygon in their order around it; `None` if they enclose no area.
fn around(mut corners: Vec<DVec2>) -> Option<Vec<[f64; 2]>> {
    let middle = corners.iter().sum::<DVec2>() / corners.len().max(1) as f64;
    let angle = |corner: &DVec2| (*corner - middle).to_angle();
    corners.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    let next = corners.iter().cycle().skip(1);
    let pairs = corners.iter().zip(next);
    let twice: f64 = pairs
        .map(|(a, b)| (*a - middle).perp_dot(*b - middle))
        .sum();
    (twice > 0.0).then(|| corners.iter().map(|corner| corner.to_array()).collect())
}
