//! Shapes of blocks.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::Deserialize;

use super::Part;
use super::tagged::{need, refuse_others};

/// Shape of a block or of a part of one.
#[derive(Clone, Debug, PartialEq, JsonSchema)]
#[schemars(tag = "kind", rename_all = "snake_case")]
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
    /// What all half-spaces have in common.
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
        #[schemars(default = "metre")]
        scale: f64,
        /// Whether the convex hull of the mesh stands for it. Default false.
        #[schemars(default)]
        hull: bool,
    },
    /// Parts that move as one. They may touch but not overlap.
    Compound {
        /// The parts.
        parts: Vec<Part>,
    },
}

impl BlockShape {
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

fn metre() -> f64 {
    1.0
}

/// The words for kinds.
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Kind {
    Box,
    Vertices,
    HalfSpaces,
    Tetrahedron,
    Octahedron,
    Dodecahedron,
    Icosahedron,
    Sphere,
    Mesh,
    Compound,
}

/// All keys of a shape.
pub(super) struct Keys {
    pub size: Option<[f64; 3]>,
    pub vertices: Option<Vec<[f64; 3]>>,
    pub faces: Option<Vec<PlaneFace>>,
    pub edge: Option<f64>,
    pub radius: Option<f64>,
    pub file: Option<PathBuf>,
    pub scale: Option<f64>,
    pub hull: Option<bool>,
    pub parts: Option<Vec<Part>>,
}

impl Keys {
    pub fn typed(self, kind: Kind) -> Result<BlockShape, String> {
        let given = [
            ("size", self.size.is_some()),
            ("vertices", self.vertices.is_some()),
            ("faces", self.faces.is_some()),
            ("edge", self.edge.is_some()),
            ("radius", self.radius.is_some()),
            ("file", self.file.is_some()),
            ("scale", self.scale.is_some()),
            ("hull", self.hull.is_some()),
            ("parts", self.parts.is_some()),
        ];
        let only = |kind, allowed: &[&str]| refuse_others(kind, allowed, &given);
        let edge = self.edge;
        let regular = |kind| {
            only(kind, &["edge"])?;
            need(edge, "edge", kind)
        };
        Ok(match kind {
            Kind::Box => {
                only("box", &["size"])?;
                BlockShape::Box {
                    size: need(self.size, "size", "box")?,
                }
            }
            Kind::Vertices => {
                only("vertices", &["vertices"])?;
                BlockShape::Vertices {
                    vertices: need(self.vertices, "vertices", "vertices")?,
                }
            }
            Kind::HalfSpaces => {
                only("half_spaces", &["faces"])?;
                BlockShape::HalfSpaces {
                    faces: need(self.faces, "faces", "half_spaces")?,
                }
            }
            Kind::Tetrahedron => BlockShape::Tetrahedron {
                edge: regular("tetrahedron")?,
            },
            Kind::Octahedron => BlockShape::Octahedron {
                edge: regular("octahedron")?,
            },
            Kind::Dodecahedron => BlockShape::Dodecahedron {
                edge: regular("dodecahedron")?,
            },
            Kind::Icosahedron => BlockShape::Icosahedron {
                edge: regular("icosahedron")?,
            },
            Kind::Sphere => {
                only("sphere", &["radius"])?;
                BlockShape::Sphere {
                    radius: need(self.radius, "radius", "sphere")?,
                }
            }
            Kind::Mesh => {
                only("mesh", &["file", "scale", "hull"])?;
                BlockShape::Mesh {
                    file: need(self.file, "file", "mesh")?,
                    scale: self.scale.unwrap_or_else(metre),
                    hull: self.hull.unwrap_or_default(),
                }
            }
            Kind::Compound => {
                only("compound", &["parts"])?;
                BlockShape::Compound {
                    parts: need(self.parts, "parts", "compound")?,
                }
            }
        })
    }
}
