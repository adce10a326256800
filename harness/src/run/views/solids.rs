//! Static solids as they are drawn.

use riprap::{
    geometry::Pose,
    rock::Block,
    scene::{Material, Scene, build::block_setup},
};

/// The solids of a scene as fixed blocks. What encloses no volume, or cannot be cut into convex parts, is left to the
/// cells to show, and so are the holes of meshes.
pub fn solid_blocks(scene: &Scene) -> Vec<Block> {
    let one = |index: usize| {
        let mut alone = scene.clone();
        alone.solids = vec![scene.solids[index].clone()];
        alone.solids[0].material = None;
        // Nothing depends on it: nothing moves.
        alone.materials = vec![Material {
            name: String::new(),
            density: 1.0,
            normal_stiffness: 1.0,
            shear_stiffness: None,
            friction: 0.0,
            youngs_modulus: None,
            poissons_ratio: 0.25,
            cohesion: 0.0,
            tensile_strength: 0.0,
            damping: 0.0,
        }];
        alone.material_pairs.clear();
        alone.blocks.clear();
        alone.rock_masses.clear();
        alone.probes.clear();
        // After it come the faces of the domain that hold blocks, which are none to be seen.
        block_setup(&alone).map(|made| made.setup.blocks.into_iter().next())
    };
    let drawn = (0..scene.solids.len()).filter(|index| !scene.solids[*index].void);
    drawn
        .filter_map(|index| one(index).ok())
        .flatten()
        .collect()
}

/// Where a block is that does not move.
pub fn pose(block: &Block) -> Pose {
    Pose::rigid(block.centre, block.rotation, block.velocity, block.spin)
}
