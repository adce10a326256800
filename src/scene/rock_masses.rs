//! Rock that joints have cut into blocks.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::Deserialize;

use super::block_shape::PlaneFace;
use super::solids::Shape;
use super::tagged::{need, refuse_others, through};

/// A convex volume of rock, cut into convex blocks by joints (Gardner, Kolb & Sitar 2017).
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
    /// Smaller pieces are left out, m³: the smallest block decides how long a time step may be.
    /// Default 0: only pieces that are too thin for contact, below 1e-4 of their size, are left out.
    #[schemars(default)]
    pub smallest_volume: f64,
    /// Pieces with a face nearer to their centroid than this part of their extent are left out, no
    /// unit. Default 0: as above.
    #[schemars(default)]
    pub smallest_thickness: f64,
    /// Width of the open joints, m: every face of every block lies half of it inside of where the cuts are,
    /// outer faces too. A fluid flows in joints of a cell and more. Default 0.
    #[schemars(default)]
    pub aperture: f64,
    /// Regions whose blocks, by their centroids, are fixed. Default none.
    #[schemars(default)]
    pub fixed: Vec<Shape>,
    /// Regions whose blocks, by their centroids, are left out. Default none.
    #[schemars(default)]
    pub removed: Vec<Shape>,
    /// Name of the material. Default the first one.
    #[schemars(default)]
    pub material: Option<String>,
    /// Whether its free blocks deform, each as a whole; the material then needs `youngs_modulus`. Default
    /// false: they are rigid.
    #[schemars(default)]
    pub deformable: bool,
    /// Stress that deformable blocks bear at the start without strain, as what the rock around them has
    /// pressed into them: xx, yy, zz, xy, yz, xz along the axes of the world, Pa; tension is positive. Default 0.
    #[schemars(default)]
    pub initial_stress: [f64; 6],
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
    /// Mean distance from joint to joint along their normal, m.
    pub spacing: f64,
    /// How the distances vary. Default `none`.
    #[serde(default)]
    pub distribution: Distribution,
    /// How far they vary, as a part of the spacing: for `uniform` half the width, below 1; for `normal`
    /// (at most 1) and `lognormal` (at most 10) the standard deviation. Default 0.25.
    pub scatter: Option<f64>,
    /// A point of one of the joints, m. Default (0, 0, 0).
    #[serde(default)]
    pub origin: [f64; 3],
    /// How much of each joint is open. Default all of it.
    pub persistence: Option<Persistence>,
}

/// Distribution of the distances from joint to joint, their mean being the spacing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Distribution {
    /// All the same.
    #[default]
    None,
    /// Uniform.
    Uniform,
    /// Normal, cut off at 0.1 and 1.9 times the spacing.
    Normal,
    /// Lognormal.
    Lognormal,
    /// Negative exponential, as of joints placed independently. Makes many thin blocks.
    Exponential,
}

/// Joints that are not open everywhere: each is divided into squares, some of them open. A joint cuts
/// a block that it meets through and through if it is open in the middle of the cut, else not at all.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Persistence {
    /// Part of the squares that is open, from 0 to 1.
    pub fraction: f64,
    /// Edge of the squares, m.
    pub length: f64,
}

impl JointSet {
    /// Scatter where none is given.
    pub const USUAL_SCATTER: f64 = 0.25;
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
    smallest_volume: f64,
    #[serde(default)]
    smallest_thickness: f64,
    #[serde(default)]
    aperture: f64,
    #[serde(default)]
    fixed: Vec<Shape>,
    #[serde(default)]
    removed: Vec<Shape>,
    material: Option<String>,
    #[serde(default)]
    deformable: bool,
    #[serde(default)]
    initial_stress: [f64; 6],
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
            smallest_volume: self.smallest_volume,
            smallest_thickness: self.smallest_thickness,
            aperture: self.aperture,
            fixed: self.fixed,
            removed: self.removed,
            material: self.material,
            deformable: self.deformable,
            initial_stress: self.initial_stress,
        })
    }
}

through!(Flat => RockMass);
