//! The shape of a block: one convex part, or a rigid compound of several that do not overlap.

use super::{
    Polyhedron,
    cell::{Cell, Clip, Facet, ON},
    min_max,
    polyhedron::positive,
    pose::outer,
};
use crate::{Error, Result};
use glam::{DMat3, DVec3};
use std::f64::consts::PI;

/// A convex part about its own centroid.
#[derive(Clone, Debug, PartialEq)]
pub enum Form {
    /// A convex polyhedron.
    Convex(Polyhedron),
    /// A sphere.
    Sphere {
        /// Radius, m.
        radius: f64,
    },
}

impl Form {
    /// Volume, m³.
    pub fn volume(&self) -> f64 {
        match self {
            Self::Convex(polyhedron) => polyhedron.volume(),
            Self::Sphere { radius } => 4.0 / 3.0 * PI * radius.powi(3),
        }
    }

    /// Inertia tensor about its centroid for a density of one, m⁵.
    pub fn inertia(&self) -> DMat3 {
        match self {
            Self::Convex(polyhedron) => polyhedron.inertia(),
            Self::Sphere { radius } => DMat3::IDENTITY * (8.0 / 15.0 * PI * radius.powi(5)),
        }
    }

    /// Largest distance of a point from its centroid, m.
    pub fn radius(&self) -> f64 {
        match self {
            Self::Convex(polyhedron) => polyhedron.radius(),
            Self::Sphere { radius } => *radius,
        }
    }
}

/// A convex part and its position in a shape.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Its convex form.
    pub form: Form,
    /// Position of its centroid relative to that of the shape, in the shape's frame, m.
    pub offset: DVec3,
}

/// The shape of a rigid block about its centroid. Blocks of one shape share it.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    pub(super) parts: Vec<Part>,
    pub(super) volume: f64,
    pub(super) inertia: DMat3,
    pub(super) radius: f64,
}

impl Shape {
    /// A sphere of this radius (m).
    ///
    /// # Errors
    /// If the radius is not positive.
    pub fn sphere(radius: f64) -> Result<Self> {
        positive("radius", radius)?;
        Ok(Self::single(Form::Sphere { radius }))
    }

    fn single(form: Form) -> Self {
        Self {
            volume: form.volume(),
            inertia: form.inertia(),
            radius: form.radius(),
            parts: vec![Part {
                form,
                offset: DVec3::ZERO,
            }],
        }
    }

    /// Convex parts, at least one.
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// Volume, m³.
    pub fn volume(&self) -> f64 {
        self.volume
    }

    /// Inertia tensor about the centroid for a density of one, m⁵.
    pub fn inertia(&self) -> DMat3 {
        self.inertia
    }

    /// Radius of the bounding sphere about the centroid, m.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Smallest and largest coordinate along a vector, m from the centroid; for spheres it must be a unit vector.
    pub(crate) fn extent(&self, along: DVec3) -> [f64; 2] {
        min_max(self.parts.iter().flat_map(|part| {
            let centre = along.dot(part.offset);
            let [low, high] = match &part.form {
                Form::Sphere { radius } => [-radius, *radius],
                Form::Convex(polyhedron) => {
                    min_max(polyhedron.vertices().iter().map(|v| along.dot(*v)))
                }
            };
            [centre + low, centre + high]
        }))
    }

    /// The rigid compound of `parts`, with offsets in any common frame (m), and its centroid (m) in that frame, which
    /// becomes the origin. Volume and inertia are sums over the parts; these must not overlap, or their mass would
    /// count twice.
    ///
    /// # Errors
    /// If there is no part, an offset is not finite, the radius of a sphere is not positive, or two parts overlap.
    pub fn compound(parts: Vec<Part>) -> Result<(Self, DVec3)> {
        if parts.is_empty() {
            let message = "a compound needs a part; give at least one";
            return Err(Error::argument("parts", message));
        }
        if let Some(bad) = parts.iter().position(|p| !p.offset.is_finite()) {
            return Err(Error::argument(
                format!("parts[{bad}].offset"),
                format!("{} is not finite; give numbers in m", parts[bad].offset),
            ));
        }
        for (index, part) in parts.iter().enumerate() {
            if let Form::Sphere { radius } = part.form {
                positive(&format!("parts[{index}].radius"), radius)?;
            }
            if let Some(other) = parts[..index].iter().position(|p| p.overlaps(part)) {
                let message = format!(
                    "it overlaps parts[{other}], and mass would count twice there; move or cut one \
                     of them, or give the outline of both as a mesh"
                );
                return Err(Error::argument(format!("parts[{index}]"), message));
            }
        }
        Ok(Self::disjoint(parts))
    }

    /// The rigid compound of parts that do not overlap, and its centroid (m).
    pub(super) fn disjoint(parts: Vec<Part>) -> (Self, DVec3) {
        let volume: f64 = parts.iter().map(|p| p.form.volume()).sum();
        let first: DVec3 = parts.iter().map(|p| p.offset * p.form.volume()).sum();
        let centroid = first / volume;
        let inertia = parts.iter().fold(DMat3::ZERO, |sum, part| {
            let r = part.offset - centroid;
            let steiner = DMat3::IDENTITY * r.length_squared() - outer(r, r);
            sum + part.form.inertia() + steiner * part.form.volume()
        });
        (Self::of(parts, centroid, volume, inertia), centroid)
    }

    /// Parts moved to their common centroid, with known mass properties.
    pub(super) fn of(parts: Vec<Part>, centroid: DVec3, volume: f64, inertia: DMat3) -> Self {
        let moved = parts.into_iter().map(|part| Part {
            offset: part.offset - centroid,
            ..part
        });
        let parts: Vec<Part> = moved.collect();
        Self {
            radius: parts.iter().map(Part::reach).fold(0.0, f64::max),
            parts,
            volume,
            inertia,
        }
    }
}

impl From<Polyhedron> for Shape {
    fn from(polyhedron: Polyhedron) -> Self {
        Self::single(Form::Convex(polyhedron))
    }
}

impl Part {
    /// Largest distance of a point from the centroid of the shape, m.
    fn reach(&self) -> f64 {
        match &self.form {
            Form::Convex(polyhedron) => {
                let places = polyhedron.vertices().iter().map(|v| *v + self.offset);
                let square = places.map(|p| p.length_squared());
                square.fold(0.0, f64::max).sqrt()
            }
            Form::Sphere { radius } => self.offset.length() + radius,
        }
    }

    /// Whether the two parts overlap by more than rounding.
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

/// Overlap of two parts, relative to the smaller one, that is tolerated: rounded positions make touching parts
/// overlap.
const COMMON: f64 = 1e-6;

/// Volume of the intersection, m³.
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
    /// Distance (m) of a point, given in m from the centroid; 0 inside.
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
        // Distances from faces that contain the foot of the perpendicular from the point.
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
