//! Materials and the contact properties of their pairs.

use crate::{
    Result,
    rock::{
        Material, PairMaterial,
        law::{Elastic, Joint},
    },
    scene::{self, Scene},
};

/// The index of the material of a solid or wall; 0 if there are neither materials nor blocks that could touch it.
pub(super) fn held(scene: &Scene, key: &str, name: Option<&str>) -> Result<usize> {
    match scene.materials.is_empty() && !scene.has_blocks() {
        true => Ok(0),
        false => scene.material(key, name),
    }
}

/// The materials in their order; a default one if a scene without blocks has none.
pub(super) fn materials(scene: &Scene) -> Vec<Material> {
    let material = |material: &scene::Material| Material {
        elastic: material.youngs_modulus.map(|youngs_modulus| Elastic {
            youngs_modulus,
            poissons_ratio: material.poissons_ratio,
        }),
        density: material.density,
        joint: Joint {
            normal_stiffness: material.normal_stiffness,
            shear_stiffness: material.shear_stiffness(),
            friction_angle: material.friction.to_radians(),
            cohesion: material.cohesion,
            tensile_strength: material.tensile_strength,
            damping: material.damping,
        },
    };
    let mut materials: Vec<Material> = scene.materials.iter().map(material).collect();
    if materials.is_empty() && !scene.has_blocks() {
        materials.push(Material::default());
    }
    materials
}

/// The pairs with contact properties of their own; properties that a pair does not give follow from the two materials.
pub(super) fn pairs(scene: &Scene) -> Result<Vec<PairMaterial>> {
    let all = materials(scene);
    let pair = |(index, pair): (usize, &scene::MaterialPair)| {
        let mut materials = [0; 2];
        for (side, name) in pair.between.iter().enumerate() {
            let key = format!("material_pairs[{index}].between[{side}]");
            materials[side] = scene.material(&key, Some(name))?;
        }
        let [a, b] = materials.map(|material| all[material].joint);
        let usual = Joint::between(&a, &b);
        let joint = Joint {
            normal_stiffness: pair.normal_stiffness.unwrap_or(usual.normal_stiffness),
            shear_stiffness: pair.shear_stiffness.unwrap_or(usual.shear_stiffness),
            friction_angle: pair.friction.map_or(usual.friction_angle, f64::to_radians),
            cohesion: pair.cohesion.unwrap_or(usual.cohesion),
            tensile_strength: pair.tensile_strength.unwrap_or(usual.tensile_strength),
            damping: pair.damping.unwrap_or(usual.damping),
        };
        Ok(PairMaterial { materials, joint })
    };
    scene.material_pairs.iter().enumerate().map(pair).collect()
}
