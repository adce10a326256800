//! Bodies of water at the start.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::Deserialize;

use super::block_shape::{BlockShape, Keys, Kind, PlaneFace};
use super::tagged::through;
use super::{Part, Rotation};

/// A body of water at the time 0; blocks and solids in it displace it.
#[derive(Clone, Debug, PartialEq, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Water {
    /// The shape, in its own frame.
    #[schemars(flatten)]
    pub shape: BlockShape,
    /// Where the origin of that frame is, m. Default (0, 0, 0).
    #[schemars(default)]
    pub position: [f64; 3],
    /// How it is turned about that origin. Default not at all.
    #[schemars(default)]
    pub rotation: Rotation,
    /// Velocity, m/s. Default at rest.
    #[schemars(default)]
    pub velocity: [f64; 3],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Flat {
    kind: Kind,
    size: Option<[f64; 3]>,
    vertices: Option<Vec<[f64; 3]>>,
    faces: Option<Vec<PlaneFace>>,
    edge: Option<f64>,
    radius: Option<f64>,
    file: Option<PathBuf>,
    scale: Option<f64>,
    hull: Option<bool>,
    parts: Option<Vec<Part>>,
    #[serde(default)]
    position: [f64; 3],
    #[serde(default)]
    rotation: Rotation,
    #[serde(default)]
    velocity: [f64; 3],
}

impl Flat {
    fn typed(self) -> Result<Water, String> {
        let keys = Keys {
            size: self.size,
            vertices: self.vertices,
            faces: self.faces,
            edge: self.edge,
            radius: self.radius,
            file: self.file,
            scale: self.scale,
            hull: self.hull,
            parts: self.parts,
        };
        Ok(Water {
            shape: keys.typed(self.kind)?,
            position: self.position,
            rotation: self.rotation,
            velocity: self.velocity,
        })
    }
}

through!(Flat => Water);
