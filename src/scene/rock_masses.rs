//! Rock that joints have cut into blocks.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::Deserialize;

use super::block_shape::PlaneFace;
use super::solids::Shape;
use super::tagged::{need, refuse_others, through};

/// A convex volume of rock, cut into blocks by joints (Gardner, Kolb & Sitar 2017).
#[derive(Clone, Debug, PartialEq, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct RockMass {
    /// Name; its blocks are called `_1`, `_2`, … after it. Default `rock_mass_` and the number of
    /// this table, from 1.
    #[schemars(default)]
    pub name: Option<String>,
    /// The volume before the joints cut it.
    #[schemars(flatten)]
    pub volume: Volume,
    /// The joint sets, in the order in which they cut.
    pub joints: Vec<JointSet>,
    /// Seed of what is random in spacings and persistence. Default 0. The same seed gives the same
    /// blocks on every machine.
    #[schemars(default)]
    pub seed: u64,
    /// The direction against which dips are measured. Default against gravity.
    #[schemars(default)]
    pub up: Option<[f64; 3]>,
    /// The direction from which dip directions are measured, clockwise seen from above. Default
    /// (0, 1, 0).
    #[schemars(default = "north")]
    pub north: [f64; 3],
    /// Regions whose blocks, by their centroids, are fixed. Default none.
    #[schemars(default)]
    pub fixed: Vec<Shape>,
    /// Regions whose blocks, by their centroids, are left out. Default none.
    #[schemars(default)]
    pub removed: Vec<Shape>,
    /// Name of the material. Default the first one.
    #[schemars(default)]
    pub material: Option<String>,
}

/// A convex volume.
#[derive(Clone, Debug, PartialEq, JsonSchema)]
#[schemars(tag = "kind", rename_all = "snake_case")]
pub enum Volume {
    /// A box along the axes.
    Box {
        /// Lower corner, m.
        min: [f64; 3],
        /// Upper corner, m.
        max: [f64; 3],
    },
    /// The hull of points.
    Vertices {
        /// The points, m, at least four.
        vertices: Vec<[f64; 3]>,
    },
    /// What all half-spaces have in common.
    HalfSpaces {
        /// The faces, at least four; distances are from the origin of the scene.
        faces: Vec<PlaneFace>,
    },
    /// The hull of a closed triangle mesh.
    Mesh {
        /// STL or OBJ file, relative to the scene's file.
        file: PathBuf,
        /// Length of the file's unit, m. Default 1.
        #[schemars(default = "metre")]
        scale: f64,
        /// Where the file's origin goes, m, after scaling. Default (0, 0, 0).
        #[schemars(default)]
        translate: [f64; 3],
    },
}

/// Parallel joints.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JointSet {
    /// Angle between the joints and the horizontal, degrees, from 0 to 90.
    pub dip: f64,
    /// Compass direction in which the joints fall, degrees clockwise from north.
    pub dip_direction: f64,
    /// Mean distance between two joints along their normal, m.
    pub spacing: f64,
    /// How far a distance may be from the mean, as a part of it, from 0 to below 1: distances are
    /// spread evenly over spacing · (1 ± scatter). Default 0.
    #[serde(default)]
    pub scatter: f64,
    /// Probability that a joint cuts a block that it meets, from above 0 to 1. Default 1.
    #[serde(default = "through_all")]
    pub persistence: f64,
}

fn through_all() -> f64 {
    1.0
}

fn metre() -> f64 {
    1.0
}

fn north() -> [f64; 3] {
    [0.0, 1.0, 0.0]
}

#[derive(Deserialize)]
#[serde(rename_all = "snake_case")]
enum Kind {
    Box,
    Vertices,
    HalfSpaces,
    Mesh,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Flat {
    kind: Kind,
    name: Option<String>,
    min: Option<[f64; 3]>,
    max: Option<[f64; 3]>,
    vertices: Option<Vec<[f64; 3]>>,
    faces: Option<Vec<PlaneFace>>,
    file: Option<PathBuf>,
    scale: Option<f64>,
    translate: Option<[f64; 3]>,
    joints: Vec<JointSet>,
    #[serde(default)]
    seed: u64,
    up: Option<[f64; 3]>,
    #[serde(default = "north")]
    north: [f64; 3],
    #[serde(default)]
    fixed: Vec<Shape>,
    #[serde(default)]
    removed: Vec<Shape>,
    material: Option<String>,
}

impl Flat {
    fn typed(self) -> Result<RockMass, String> {
        let given = [
            ("min", self.min.is_some()),
            ("max", self.max.is_some()),
            ("vertices", self.vertices.is_some()),
            ("faces", self.faces.is_some()),
            ("file", self.file.is_some()),
            ("scale", self.scale.is_some()),
            ("translate", self.translate.is_some()),
        ];
        let only = |kind, allowed: &[&str]| refuse_others(kind, allowed, &given);
        let volume = match self.kind {
            Kind::Box => {
                only("box", &["min", "max"])?;
                Volume::Box {
                    min: need(self.min, "min", "box")?,
                    max: need(self.max, "max", "box")?,
                }
            }
            Kind::Vertices => {
                only("vertices", &["vertices"])?;
                Volume::Vertices {
                    vertices: need(self.vertices, "vertices", "vertices")?,
                }
            }
            Kind::HalfSpaces => {
                only("half_spaces", &["faces"])?;
                Volume::HalfSpaces {
                    faces: need(self.faces, "faces", "half_spaces")?,
                }
            }
            Kind::Mesh => {
                only("mesh", &["file", "scale", "translate"])?;
                Volume::Mesh {
                    file: need(self.file, "file", "mesh")?,
                    scale: self.scale.unwrap_or_else(metre),
                    translate: self.translate.unwrap_or_default(),
                }
            }
        };
        Ok(RockMass {
            name: self.name,
            volume,
            joints: self.joints,
            seed: self.seed,
            up: self.up,
            north: self.north,
            fixed: self.fixed,
            removed: self.removed,
            material: self.material,
        })
    }
}

through!(Flat => RockMass);
