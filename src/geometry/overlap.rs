//! Whether two parts of a compound share some volume.

use super::cell::{Cell, Clip, Facet, ON};
use super::{Form, Part, Polyhedron};
use glam::DVec3;

/// Share of the smaller part that may be common to two: what rounding of their places makes of parts
/// that touch.
const COMMON: f64 = 1e-6;

impl Part {
    /// Whether the mass of the two would count twice somewhere.
    pub(super) fn overlaps(&self, other: &Self) -> bool {
        let apart = self.offset.distance(other.offset);
        if apart >= self.form.radius() + other.form.radius() {
            return false;
        }
        match (&self.form, &other.form) {
            (Form::Convex(a), Form::Convex(b)) => {
                let common = common_volume(a, self.offset, b, other.offset);
                common > COMMON * a.volume().min(b.volume())
            }
            (Form::Sphere { radius: a }, Form::Sphere { radius: b }) => {
                a + b - apart > COMMON * a.min(*b)
            }
            (Form::Sphere { radius }, Form::Convex(p)) => {
                p.distance(self.offset - other.offset) < (1.0 - COMMON) * radius
            }
            (Form::Convex(p), Form::Sphere { radius }) => {
                p.distance(other.offset - self.offset) < (1.0 - COMMON) * radius
            }
        }
    }
}

/// Volume of what is in both, m³.
fn common_volume(a: &Polyhedron, at_a: DVec3, b: &Polyhedron, at_b: DVec3) -> f64 {
    let facets = a.faces().iter().zip(a.loops()).map(|(face, ring)| Facet {
        plane: *face,
        source: 0,
        ring: ring.clone(),
    });
    let mut cell = Cell::new(a.vertices().to_vec(), facets.collect());
    let on = ON * a.radius();
    for face in b.faces() {
        if cell.clip(face.seen_from(at_a - at_b), 0, on) == Clip::Nothing {
            return 0.0;
        }
    }
    cell.moments(DVec3::ZERO).volume
}

impl Polyhedron {
    /// Distance of a point, m from the centroid; 0 inside.
    pub(crate) fn distance(&self, point: DVec3) -> f64 {
        let at = |v: u32| self.vertices()[v as usize];
        if self.faces().iter().all(|f| f.height(point) <= 0.0) {
            return 0.0;
        }
        let edges = self.edges().iter().map(|[a, b]| {
            let (a, along) = (at(*a), at(*b) - at(*a));
            let t = (point - a).dot(along) / along.length_squared();
            (a + along * t.clamp(0.0, 1.0)).distance(point)
        });
        // Of a face that the point is straight above.
        let faces = self.faces().iter().zip(self.loops());
        let faces = faces.filter_map(|(face, ring)| {
            let height = face.height(point);
            let mut sides = ring.iter().zip(ring.iter().cycle().skip(1));
            let above = sides.all(|(a, b)| {
                let inwards = face.normal.cross(at(*b) - at(*a));
                inwards.dot(point - at(*a)) >= 0.0
            });
            (height > 0.0 && above).then_some(height)
        });
        edges.chain(faces).fold(f64::INFINITY, f64::min)
    }
}
