//! Shapes of blocks.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::Deserialize;

use super::Part;
use super::rules::{direction, finite, positive, refuse};
use super::tagged::Kind;
use crate::error::Result;

/// Shape of a block or of a part of one.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(tag = "kind")]
pub enum BlockShape {
    /// A box about its centre.
    Box {
        /// Edges, m.
        size: [f64; 3],
    },
    /// The hull of points.
    Vertices {
        /// The points, m, at least four.
        vertices: Vec<[f64; 3]>,
    },
    /// The intersection of half-spaces.
    HalfSpaces {
        /// The faces, at least four.
        faces: Vec<PlaneFace>,
    },
    /// A regular tetrahedron about its centre.
    Tetrahedron {
        /// Length of an edge, m.
        edge: f64,
    },
    /// A regular octahedron about its centre.
    Octahedron {
        /// Length of an edge, m.
        edge: f64,
    },
    /// A regular dodecahedron about its centre.
    Dodecahedron {
        /// Length of an edge, m.
        edge: f64,
    },
    /// A regular icosahedron about its centre.
    Icosahedron {
        /// Length of an edge, m.
        edge: f64,
    },
    /// A sphere about its centre.
    Sphere {
        /// Radius, m.
        radius: f64,
    },
    /// A closed triangle mesh; one that is not convex becomes a compound of convex parts.
    Mesh {
        /// STL or OBJ file, relative to the scene's file.
        file: PathBuf,
        /// Length of the file's unit, m. Default 1.
        #[serde(default = "metre")]
        scale: f64,
        /// Whether the convex hull replaces the mesh. Default false.
        #[serde(default)]
        hull: bool,
    },
    /// Parts that move as one body. They may touch but not overlap.
    Compound {
        /// The parts.
        parts: Vec<Part>,
    },
}

impl BlockShape {
    pub(super) const KINDS: &[Kind] = &[
        ("box", "size", ""),
        ("vertices", "vertices", ""),
        ("half_spaces", "faces", ""),
        ("tetrahedron", "edge", ""),
        ("octahedron", "edge", ""),
        ("dodecahedron", "edge", ""),
        ("icosahedron", "edge", ""),
        ("sphere", "radius", ""),
        ("mesh", "file", "scale hull"),
        ("compound", "parts", ""),
    ];

    /// Its `kind` in a scene.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Box { .. } => "box",
            Self::Vertices { .. } => "vertices",
            Self::HalfSpaces { .. } => "half_spaces",
            Self::Tetrahedron { .. } => "tetrahedron",
            Self::Octahedron { .. } => "octahedron",
            Self::Dodecahedron { .. } => "dodecahedron",
            Self::Icosahedron { .. } => "icosahedron",
            Self::Sphere { .. } => "sphere",
            Self::Mesh { .. } => "mesh",
            Self::Compound { .. } => "compound",
        }
    }
}

/// A face of a block: the points x of the block have normal · x ≤ distance.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlaneFace {
    /// Outward normal, of any length.
    pub normal: [f64; 3],
    /// Distance of the plane from the origin of the block's own frame along the normal, m.
    pub distance: f64,
}

/// Default length of the unit of a mesh, m.
pub(super) fn metre() -> f64 {
    1.0
}

/// Checks the numbers of the shape in the table `key`.
pub(super) fn check(key: &str, shape: &BlockShape) -> Result<()> {
    match shape {
        BlockShape::Box { size } => {
            for (axis, edge) in size.iter().enumerate() {
                positive(format!("{key}.size[{axis}]"), *edge, "m")?;
            }
            Ok(())
        }
        BlockShape::Vertices { vertices } => points(&format!("{key}.vertices"), vertices),
        BlockShape::HalfSpaces { faces } => half_spaces(&format!("{key}.faces"), faces),
        BlockShape::Tetrahedron { edge }
        | BlockShape::Octahedron { edge }
        | BlockShape::Dodecahedron { edge }
        | BlockShape::Icosahedron { edge } => positive(format!("{key}.edge"), *edge, "m"),
        BlockShape::Sphere { radius } => positive(format!("{key}.radius"), *radius, "m"),
        BlockShape::Mesh { scale, .. } => positive(format!("{key}.scale"), *scale, "m"),
        BlockShape::Compound { parts } => {
            if parts.is_empty() {
                return refuse(format!("{key}.parts"), "has no parts; list at least one");
            }
            for (number, part) in parts.iter().enumerate() {
                let key = format!("{key}.parts[{number}]");
                check(&key, &part.shape)?;
                finite(format!("{key}.position"), &part.position)?;
                part.rotation.check(&format!("{key}.rotation"))?;
            }
            Ok(())
        }
    }
}

/// Checks the corners of a body, which must be enough for a volume.
pub(super) fn points(key: &str, points: &[[f64; 3]]) -> Result<()> {
    for (number, point) in points.iter().enumerate() {
        finite(format!("{key}[{number}]"), point)?;
    }
    if points.len() < 4 {
        return refuse(
            key,
            format!("{} points have no volume; give at least 4", points.len()),
        );
    }
    Ok(())
}

/// Checks the faces of a body, which must be enough for a volume.
pub(super) fn half_spaces(key: &str, faces: &[PlaneFace]) -> Result<()> {
    for (number, face) in faces.iter().enumerate() {
        direction(format!("{key}[{number}].normal"), &face.normal)?;
        finite(format!("{key}[{number}].distance"), &[face.distance])?;
    }
    if faces.len() < 4 {
        return refuse(
            key,
            format!("{} half-spaces bound nothing; give at least 4", faces.len()),
        );
    }
    Ok(())
}
