//! What blocks are made of.

use schemars::JsonSchema;
use serde::Deserialize;

/// A rock, and how its joints push, slide and break.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Name by which blocks refer to it.
    pub name: String,
    /// Density, kg/m³.
    pub density: f64,
    /// Normal stiffness k_n of a contact per its area, Pa/m.
    pub normal_stiffness: f64,
    /// Shear stiffness k_s of a contact per its area, Pa/m. Default 0.8 of the normal stiffness, the
    /// ratio 2(1 − ν)/(2 − ν) of Mindlin (1949) at ν = 1/3.
    pub shear_stiffness: Option<f64>,
    /// Angle of friction φ, degrees, from 0 to below 90.
    pub friction: f64,
    /// Cohesion c, Pa, of every contact. Default 0.
    #[serde(default)]
    pub cohesion: f64,
    /// Tensile strength σ_t, Pa, of faces that touch at the start, parallel to 5° and with no gap between them (nor an
    /// overlap beyond 1 % of the block). Such a bond pulls over the area that it begins with, bends as an elastic bed,
    /// and breaks for good where its tension reaches σ_t at an edge, or where it has slipped by σ_t/k_s; cohesion and
    /// friction stay. Under tension its shear strength is the cohesion alone. A weight that comes on at once, as that of
    /// a block that hangs from the start, swings to as much as twice itself: damping takes from that. Edges, corners and
    /// spheres have no bonds, and no bond resists a twist about its normal by a spring. Default 0.
    #[serde(default)]
    pub tensile_strength: f64,
    /// Damping ratio ζ of a contact's normal motion, no unit, from 0 to below 1. Default 0.1, at
    /// which a block rebounds with 0.74 of its speed.
    #[serde(default = "Material::usual_damping")]
    pub damping: f64,
    /// Young's modulus E of the rock itself, Pa, which its deformable blocks need; the stiffer and the smaller
    /// they are, the shorter the step. Default none.
    pub youngs_modulus: Option<f64>,
    /// Poisson's ratio ν of the rock itself, no unit, between -1 and 0.5. Default 0.25.
    #[serde(default = "Material::usual_ratio")]
    pub poissons_ratio: f64,
}

impl Material {
    /// Shear stiffness where none is given, of the normal stiffness.
    pub const SHEAR_RATIO: f64 = 0.8;

    fn usual_damping() -> f64 {
        0.1
    }

    fn usual_ratio() -> f64 {
        0.25
    }

    /// Shear stiffness, given or not, Pa/m.
    pub fn shear_stiffness(&self) -> f64 {
        self.shear_stiffness
            .unwrap_or(Self::SHEAR_RATIO * self.normal_stiffness)
    }
}

/// How two materials meet, where that does not follow from each of them.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MaterialPair {
    /// Names of the two materials; they may be the same.
    pub between: [String; 2],
    /// Normal stiffness per area, Pa/m. Default: as without this table.
    pub normal_stiffness: Option<f64>,
    /// Shear stiffness per area, Pa/m. Default: as without this table.
    pub shear_stiffness: Option<f64>,
    /// Angle of friction, degrees, from 0 to below 90. Default: as without this table.
    pub friction: Option<f64>,
    /// Cohesion, Pa. Default: as without this table.
    pub cohesion: Option<f64>,
    /// Tensile strength, Pa. Default: as without this table.
    pub tensile_strength: Option<f64>,
    /// Damping ratio, no unit, from 0 to below 1. Default: as without this table.
    pub damping: Option<f64>,
}
