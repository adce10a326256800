//! Rock masses, cut into blocks by joints.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::Deserialize;

use super::block_shape::{PlaneFace, half_spaces, metre, points};
use super::rules::{direction, finite, names, not_negative, ordered, positive, refuse};
use super::tagged::Kind;
use super::{Scene, Shape};
use crate::error::Result;

/// A convex volume of rock, cut into convex blocks by joints (Gardner, Kolb & Sitar 2017).
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct RockMass {
    /// Name; its blocks are called `_1`, `_2`, … after it. Default `rock_mass_` and the number of
    /// this table, from 1.
    #[serde(default)]
    pub name: Option<String>,
    /// The volume before the joints cut it.
    #[serde(rename = "kind")]
    #[schemars(flatten)]
    pub volume: Volume,
    /// The joint sets, in the order in which they cut.
    pub joints: Vec<JointSet>,
    /// Seed of random spacings and persistence. Default 0. The same seed gives the same
    /// blocks on every machine.
    #[serde(default)]
    pub seed: u64,
    /// The upward direction, from which dips are measured. Default against gravity.
    #[serde(default)]
    pub up: Option<[f64; 3]>,
    /// The direction from which dip directions are measured, clockwise seen from above. Default (0, 1, 0).
    #[serde(default = "north")]
    pub north: [f64; 3],
    /// Smaller pieces are left out, m³: the smallest block limits the time step. Default 0: only pieces that are too
    /// thin for contact, below 1e-4 of their size, are left out.
    #[serde(default)]
    pub smallest_volume: f64,
    /// Pieces with a face nearer to their centroid than this fraction of their extent are left out, no unit. Default 0: as for
    /// `smallest_volume`.
    #[serde(default)]
    pub smallest_thickness: f64,
    /// Width of the open joints, m: every face of every block is set back by half of it, including outer faces. A
    /// fluid flows in joints of a cell and more. Default 0.
    #[serde(default)]
    pub aperture: f64,
    /// Regions whose blocks, by their centroids, are fixed. Default none.
    #[serde(default)]
    pub fixed: Vec<Shape>,
    /// Regions whose blocks, by their centroids, are left out. Default none.
    #[serde(default)]
    pub removed: Vec<Shape>,
    /// Name of the material. Default the first one.
    #[serde(default)]
    pub material: Option<String>,
    /// Whether its free blocks deform, each as a whole; the material then needs `youngs_modulus`. Default
    /// false: they are rigid.
    #[serde(default)]
    pub deformable: bool,
    /// Stress of deformable blocks at zero strain, such as the in-situ stress of
    /// the rock: xx, yy, zz, xy, yz, xz along the axes of the world, Pa; tension is positive. Default 0.
    #[serde(default)]
    pub initial_stress: [f64; 6],
}

/// A convex volume.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(tag = "kind")]
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
    /// The intersection of half-spaces.
    HalfSpaces {
        /// The faces, at least four; distances are from the origin of the scene.
        faces: Vec<PlaneFace>,
    },
    /// The hull of a closed triangle mesh.
    Mesh {
        /// STL or OBJ file, relative to the scene's file.
        file: PathBuf,
        /// Length of the file's unit, m. Default 1.
        #[serde(default = "metre")]
        scale: f64,
        /// Where the file's origin goes, m, after scaling. Default (0, 0, 0).
        #[serde(default)]
        translate: [f64; 3],
    },
}

impl Volume {
    pub(super) const KINDS: &[Kind] = &[
        ("box", "min max", ""),
        ("vertices", "vertices", ""),
        ("half_spaces", "faces", ""),
        ("mesh", "file", "scale translate"),
    ];
}

/// Parallel joints.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JointSet {
    /// Angle between the joints and the horizontal, degrees, from 0 to 90.
    pub dip: f64,
    /// Compass direction in which the joints dip, degrees clockwise from north.
    pub dip_direction: f64,
    /// Mean distance from joint to joint along their normal, m.
    pub spacing: f64,
    /// Distribution of the distances. Default `none`.
    #[serde(default)]
    pub distribution: Distribution,
    /// Amount of variation, as a fraction of the spacing: for `uniform` half the width, below 1; for `normal`
    /// (at most 1) and `lognormal` (at most 10) the standard deviation. Default 0.25.
    pub scatter: Option<f64>,
    /// A point of one of the joints, m. Default (0, 0, 0).
    #[serde(default)]
    pub origin: [f64; 3],
    /// Persistence: how much of each joint is open. Default all of it.
    pub persistence: Option<Persistence>,
}

/// Distribution of the distances from joint to joint; their mean is the spacing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Distribution {
    /// All distances are equal.
    #[default]
    None,
    /// Uniform.
    Uniform,
    /// Normal, cut off at 0.1 and 1.9 times the spacing.
    Normal,
    /// Lognormal.
    Lognormal,
    /// Negative exponential, for joints placed independently. Makes many thin blocks.
    Exponential,
}

/// Joints that are not open everywhere: each is divided into squares, some of them open. A joint cuts a block
/// completely if it is open in the middle of the cut, otherwise not at all.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Persistence {
    /// Fraction of the squares that is open, from 0 to 1.
    pub fraction: f64,
    /// Edge of the squares, m.
    pub length: f64,
}

impl JointSet {
    /// Default amount of variation.
    pub const USUAL_SCATTER: f64 = 0.25;
}

fn north() -> [f64; 3] {
    [0.0, 1.0, 0.0]
}

impl Scene {
    pub(super) fn check_rock_masses(&self) -> Result<()> {
        let named = self.rock_masses.iter().enumerate();
        names(
            "rock_masses",
            named.filter_map(|(i, mass)| Some((i, mass.name.as_deref()?))),
        )?;
        for (index, mass) in self.rock_masses.iter().enumerate() {
            let key = format!("rock_masses[{index}]");
            self.material(&format!("{key}.material"), mass.material.as_deref())?;
            if mass.deformable {
                self.check_elastic(&key, mass.material.as_deref())?;
                finite(format!("{key}.initial_stress"), &mass.initial_stress)?;
            } else if mass.initial_stress != [0.0; 6] {
                return refuse(
                    format!("{key}.initial_stress"),
                    "belongs to deformable blocks; add deformable = true, or remove it",
                );
            }
            match &mass.volume {
                Volume::Box { min, max } => ordered(&key, *min, *max)?,
                Volume::Vertices { vertices } => points(&format!("{key}.vertices"), vertices)?,
                Volume::HalfSpaces { faces } => half_spaces(&format!("{key}.faces"), faces)?,
                Volume::Mesh {
                    scale, translate, ..
                } => {
                    positive(format!("{key}.scale"), *scale, "m")?;
                    finite(format!("{key}.translate"), translate)?;
                }
            }
            for (number, set) in mass.joints.iter().enumerate() {
                joints(&format!("{key}.joints[{number}]"), set)?;
            }
            if let Some(up) = &mass.up {
                direction(format!("{key}.up"), up)?;
            } else if self.rock.gravity == [0.0; 3] {
                return refuse(
                    format!("{key}.up"),
                    "without gravity nothing says which way is up; give up, such as [0, 0, 1]",
                );
            }
            direction(format!("{key}.north"), &mass.north)?;
            let smallest = mass.smallest_volume;
            not_negative(format!("{key}.smallest_volume"), smallest, "m³")?;
            let thinnest = mass.smallest_thickness;
            not_negative(format!("{key}.smallest_thickness"), thinnest, "")?;
            not_negative(format!("{key}.aperture"), mass.aperture, "m")?;
            let regions = [("fixed", &mass.fixed), ("removed", &mass.removed)];
            for (name, regions) in regions {
                for (number, region) in regions.iter().enumerate() {
                    self.check_region(&format!("{key}.{name}[{number}]"), region)?;
                }
            }
        }
        Ok(())
    }
}

fn joints(key: &str, set: &JointSet) -> Result<()> {
    if !(0.0..=90.0).contains(&set.dip) {
        return refuse(
            format!("{key}.dip"),
            format!(
                "is {} degrees; joints dip from 0 (flat) to 90 (upright)",
                set.dip
            ),
        );
    }
    finite(format!("{key}.dip_direction"), &[set.dip_direction])?;
    positive(format!("{key}.spacing"), set.spacing, "m")?;
    finite(format!("{key}.origin"), &set.origin)?;
    if let Some(scatter) = set.scatter {
        let most = match set.distribution {
            Distribution::Uniform => 1.0f64.next_down(),
            Distribution::Normal => 1.0,
            Distribution::Lognormal => 10.0,
            Distribution::None | Distribution::Exponential => {
                return refuse(
                    format!("{key}.scatter"),
                    "has no meaning for this distribution; remove it, or give distribution = \
                     \"uniform\", \"normal\" or \"lognormal\"",
                );
            }
        };
        if !(0.0..=most).contains(&scatter) {
            return refuse(
                format!("{key}.scatter"),
                format!("is {scatter}; it lies from 0 to {most:.0}, below 1 where uniform"),
            );
        }
    }
    if let Some(Persistence { fraction, length }) = set.persistence {
        positive(format!("{key}.persistence.length"), length, "m")?;
        if !(0.0..=1.0).contains(&fraction) {
            return refuse(
                format!("{key}.persistence.fraction"),
                format!("is {fraction}; it lies from 0 to 1 (joints open everywhere)"),
            );
        }
    }
    Ok(())
}
