//! Materials of blocks.

use schemars::JsonSchema;
use serde::Deserialize;

use super::Scene;
use super::rules::{finite, names, not_negative, positive, refuse};
use crate::error::Result;

/// A rock and its contact properties.
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
    /// Tensile strength σ_t, Pa, of faces that touch at the start, parallel within 5° and with no gap between them (nor an
    /// overlap beyond 1 % of the block). Such a bond carries tension over its initial area, resists bending like an elastic
    /// foundation, and breaks permanently if its tension reaches σ_t at an edge, or if it has slipped by σ_t/k_s; cohesion and
    /// friction remain. Under tension its shear strength is the cohesion alone. A weight applied suddenly, such as that of a
    /// block that hangs from the start, causes up to twice the static force; damping reduces it. Edges, corners and spheres
    /// have no bonds. Default 0.
    #[serde(default)]
    pub tensile_strength: f64,
    /// Damping ratio ζ of a contact's normal motion, no unit, from 0 to below 1. Default 0.1, at
    /// which a block rebounds with 0.74 of its speed. At 0, edges and corners that collide gain energy as well as lose it, as their
    /// springs conserve it only at a constant area of contact: `contact_loss` is the sum.
    #[serde(default = "Material::usual_damping")]
    pub damping: f64,
    /// Young's modulus E of the rock itself, Pa, required for deformable blocks; the stiffer and smaller
    /// they are, the shorter the time step. Default none.
    pub youngs_modulus: Option<f64>,
    /// Poisson's ratio ν of the rock itself, no unit, between -1 and 0.5. Default 0.25.
    #[serde(default = "Material::usual_ratio")]
    pub poissons_ratio: f64,
}

impl Material {
    /// Default shear stiffness over the normal stiffness.
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

/// Contact properties of a pair of materials, which replace those derived from each of them.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
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

impl Scene {
    pub(super) fn check_materials(&self) -> Result<()> {
        let named = self.materials.iter().map(|material| material.name.as_str());
        names("materials", named.enumerate())?;
        for (index, material) in self.materials.iter().enumerate() {
            let key = |key: &str| format!("materials[{index}].{key}");
            positive(key("density"), material.density, "kg/m³")?;
            positive(key("normal_stiffness"), material.normal_stiffness, "Pa/m")?;
            if let Some(modulus) = material.youngs_modulus {
                positive(key("youngs_modulus"), modulus, "Pa")?;
            }
            let ratio = material.poissons_ratio;
            if !(ratio > -1.0 && ratio < 0.5) {
                let message = format!(
                    "is {ratio}; Poisson's ratio lies between -1 and 0.5, both excluded, such as 0.25"
                );
                return refuse(key("poissons_ratio"), message);
            }
            let shear = material.shear_stiffness;
            law(
                &format!("materials[{index}]"),
                [shear, Some(material.friction)],
                [material.cohesion, material.tensile_strength].map(Some),
                Some(material.damping),
            )?;
        }
        for (index, pair) in self.material_pairs.iter().enumerate() {
            let key = format!("material_pairs[{index}]");
            for (side, name) in pair.between.iter().enumerate() {
                self.material(&format!("{key}.between[{side}]"), Some(name))?;
            }
            let same = |other: &crate::scene::MaterialPair| {
                let [a, b] = &other.between;
                other.between == pair.between || [b, a] == [&pair.between[0], &pair.between[1]]
            };
            if self.material_pairs[..index].iter().any(same) {
                return refuse(
                    format!("{key}.between"),
                    "these two are listed twice; keep one of the tables",
                );
            }
            if let Some(stiffness) = pair.normal_stiffness {
                positive(format!("{key}.normal_stiffness"), stiffness, "Pa/m")?;
            }
            law(
                &key,
                [pair.shear_stiffness, pair.friction],
                [pair.cohesion, pair.tensile_strength],
                pair.damping,
            )?;
        }
        Ok(())
    }

    /// The index of the material called `name`, or of the first one; `key` is the key that names it.
    pub(crate) fn material(&self, key: &str, name: Option<&str>) -> Result<usize> {
        if self.materials.is_empty() {
            return refuse(
                "materials",
                "blocks need a material; add [[materials]] with name, density, normal_stiffness \
                 and friction",
            );
        }
        let Some(name) = name else { return Ok(0) };
        let found = self.materials.iter().position(|m| m.name == name);
        found.map_or_else(
            || {
                let there: Vec<_> = self.materials.iter().map(|m| m.name.as_str()).collect();
                refuse(
                    key,
                    format!(
                        "there is no material `{name}`; there are: {}",
                        there.join(", ")
                    ),
                )
            },
            Ok,
        )
    }
}

/// Checks shear stiffness and friction, cohesion and tensile strength, and damping of a contact at `key`.
fn law(
    key: &str,
    [shear, friction]: [Option<f64>; 2],
    strengths: [Option<f64>; 2],
    damping: Option<f64>,
) -> Result<()> {
    if let Some(shear) = shear {
        not_negative(format!("{key}.shear_stiffness"), shear, "Pa/m")?;
    }
    if let Some(angle) = friction
        && !(0.0..90.0).contains(&angle)
    {
        return refuse(
            format!("{key}.friction"),
            format!("is {angle} degrees; an angle of friction lies from 0 to below 90"),
        );
    }
    for (name, strength) in ["cohesion", "tensile_strength"].into_iter().zip(strengths) {
        if let Some(strength) = strength {
            not_negative(format!("{key}.{name}"), strength, "Pa")?;
        }
    }
    let Some(ratio) = damping else { return Ok(()) };
    finite(format!("{key}.damping"), &[ratio])?;
    if !(0.0..1.0).contains(&ratio) {
        return refuse(
            format!("{key}.damping"),
            format!("is {ratio}; a damping ratio lies from 0 to below 1, such as 0.1"),
        );
    }
    Ok(())
}
