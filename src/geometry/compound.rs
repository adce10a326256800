//! Rigid compounds of convex parts.

use super::moments::outer;
use super::solids::positive;
use super::{Form, Part, Shape};
use crate::{Error, Result};
use glam::{DMat3, DVec3};

impl Shape {
    /// The rigid compound of `parts`, their offsets in any common frame (m), and its centroid (m) in
    /// that frame, which becomes the origin. Volume and inertia are the sums over the parts, which must
    /// not overlap, or their mass would count twice.
    ///
    /// # Errors
    /// If there is no part, an offset is not finite, a sphere has no radius, or two parts overlap.
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
        let volume: f64 = parts.iter().map(|p| p.form.volume()).sum();
        let first: DVec3 = parts.iter().map(|p| p.offset * p.form.volume()).sum();
        let centroid = first / volume;
        let inertia = parts.iter().fold(DMat3::ZERO, |sum, part| {
            let r = part.offset - centroid;
            let steiner = DMat3::IDENTITY * r.length_squared() - outer(r);
            sum + part.form.inertia() + steiner * part.form.volume()
        });
        Ok((Self::of(parts, centroid, volume, inertia), centroid))
    }

    /// Parts moved to their common centroid, whose mass properties are known.
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
}
