//! Blocks, solids and particles of a run, as pictures show them.

use super::super::scene_run::SceneRun;
use crate::{
    picture::Placed,
    render::{Colours, Drop, Drops},
};
use riprap::{
    Result,
    geometry::{Pose, Shape},
    rock::Block,
    scene::{Material, Scene, build::block_setup},
    sph::SphSolver,
};
use std::{collections::HashMap, sync::Arc};

/// Radius of a sphere with the volume of a particle, (3/4π)^⅓, in spacings.
const SPHERE_RADIUS: f64 = 0.62;

impl SceneRun {
    /// The blocks, static solids last; none for a fluid in an empty box.
    pub(in super::super) fn blocks(&self) -> &[Block] {
        match self.rock() {
            Some(rock) => &rock.setup.blocks[..rock.shown],
            None => &self.solids,
        }
    }

    /// Number of the static solids among the blocks, which cells of a lattice show as well.
    pub(in super::super) fn solids(&self) -> usize {
        match self.rock() {
            Some(_) => self.scene().solids.len(),
            None => self.solids.len(),
        }
    }

    /// Poses of the blocks.
    pub(in super::super) fn poses(&self) -> Vec<Pose> {
        match self.rock() {
            Some(rock) => {
                let mut poses = rock.blocks.poses();
                poses.truncate(rock.shown);
                poses
            }
            None => self.solids.iter().map(pose).collect(),
        }
    }

    /// The particles of free water, if there is any; `speed` (m/s), if given, is that of the last colour.
    pub(in super::super) fn drops(&mut self, speed: Option<f64>) -> Result<Option<Drops>> {
        if self.simulation.particles().is_none() {
            return Ok(None);
        }
        let water = self.water()?;
        let moving = water.positions.iter().zip(&water.velocities);
        let drops = moving.map(|(centre, velocity)| Drop {
            centre: *centre,
            value: velocity.as_dvec3().length(),
        });
        let drops: Vec<Drop> = drops.collect();
        let setup = self.simulation.particles().map(SphSolver::setup);
        Ok(setup.map(|setup| Drops {
            drops,
            radius: SPHERE_RADIUS * setup.spacing,
            colours: Colours {
                label: "speed".into(),
                unit: "m/s".into(),
                range: Some([0.0, speed.unwrap_or(setup.largest_speed())]),
            },
        }))
    }
}

/// The convex parts of the blocks of `run` at `poses`.
pub fn placed<'a>(run: &'a SceneRun, poses: &[Pose]) -> Vec<Placed<'a>> {
    parts(run.blocks(), poses)
}

/// The parts of the blocks that are not static solids.
pub fn immersed<'a>(run: &'a SceneRun, poses: &[Pose]) -> Vec<Placed<'a>> {
    let blocks = run.blocks();
    parts(&blocks[..blocks.len() - run.solids()], poses)
}

fn parts<'a>(blocks: &'a [Block], poses: &[Pose]) -> Vec<Placed<'a>> {
    let blocks = blocks.iter().zip(poses);
    let parts = blocks.flat_map(|(block, pose)| {
        block.shape.parts().iter().map(|part| Placed {
            form: &part.form,
            centre: pose.point(part.offset),
            deformation: pose.deformation,
        })
    });
    parts.collect()
}

/// Calls `with` for each different shape; returns the index of its first part among the parts of all of them.
pub fn each_shape(blocks: &[Block], mut with: impl FnMut(&Shape)) -> HashMap<*const Shape, usize> {
    let mut first = HashMap::new();
    let mut parts = 0;
    for block in blocks {
        first.entry(Arc::as_ptr(&block.shape)).or_insert_with(|| {
            with(&block.shape);
            let at = parts;
            parts += block.shape.parts().len();
            at
        });
    }
    first
}

/// The solids of a scene as fixed blocks. Solids that enclose no volume or cannot be cut into convex parts are only shown
/// by their cells, and so are the holes of meshes.
pub fn solid_blocks(scene: &Scene) -> Vec<Block> {
    let one = |index: usize| {
        let mut alone = scene.clone();
        alone.solids = vec![scene.solids[index].clone()];
        alone.solids[0].material = None;
        // The values are irrelevant: nothing moves.
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
        // The first block is the solid; those after it represent faces of the domain and are not shown.
        block_setup(&alone).map(|made| made.setup.blocks.into_iter().next())
    };
    let drawn = (0..scene.solids.len()).filter(|index| !scene.solids[*index].void);
    drawn
        .filter_map(|index| one(index).ok())
        .flatten()
        .collect()
}

/// The pose of a block that does not move.
fn pose(block: &Block) -> Pose {
    Pose::rigid(block.centre, block.rotation, block.velocity, block.spin)
}
