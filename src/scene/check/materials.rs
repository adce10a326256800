//! Materials have mass and stiffness, and are there where they are named.

use super::rules::{finite, names, not_negative, positive, refuse};
use crate::error::Result;
use crate::scene::Scene;

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

    /// The number of the material called `name`, or of the first one; `key` is where it is named.
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

/// Shear stiffness and friction, cohesion and tensile strength, and damping of a contact at `key`.
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
