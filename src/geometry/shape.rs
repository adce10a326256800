//! The shape of a block: one convex part, or a rigid compound of several.

use super::Polyhedron;
use super::solids::positive;
use crate::Result;
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

/// A convex part and where it sits.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// What it is.
    pub form: Form,
    /// Its centroid from that of the shape, in the shape's frame, m.
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

    /// Radius about the centroid that holds all parts, m.
    pub fn radius(&self) -> f64 {
        self.radius
    }
}

impl From<Polyhedron> for Shape {
    fn from(polyhedron: Polyhedron) -> Self {
        Self::single(Form::Convex(polyhedron))
    }
}
