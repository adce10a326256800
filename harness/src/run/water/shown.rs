//! What pictures see of water: its blocks and solids, and its particles.

use super::{super::views::Shown, Engine, Pond};
use crate::render::{Colours, Drop, Drops};
use riprap::{
    Result,
    bodies::{Block, Pose},
    output::Array,
    scene::Field,
};

/// Radius of a ball of the volume of a particle, (3/4π)^⅓, of the spacing.
const BALL: f64 = 0.62;

impl Shown for Pond {
    fn blocks(&self) -> &[Block] {
        &self.simulation.setup().setup.blocks[..self.shown()]
    }

    fn solids(&self) -> usize {
        self.scene().solids.len()
    }

    fn poses(&self) -> Vec<Pose> {
        let mut poses = self.simulation.blocks().poses();
        poses.truncate(self.shown());
        poses
    }

    fn read(&mut self, _: &[Field], _: &[u32]) -> Result<Vec<Array>> {
        Ok(Vec::new())
    }

    fn drops(&mut self, speed: Option<f64>) -> Result<Option<Drops>> {
        let water = self.water()?;
        let setup = self.simulation.particles().setup();
        let drop = |(x, v): (&glam::DVec3, &glam::Vec3)| Drop {
            centre: *x,
            value: v.as_dvec3().length(),
        };
        let largest = setup.largest_speed();
        Ok(Some(Drops {
            drops: water
                .positions
                .iter()
                .zip(&water.velocities)
                .map(drop)
                .collect(),
            radius: BALL * setup.spacing,
            colours: Colours {
                label: "speed".into(),
                unit: "m/s".into(),
                range: Some([0.0, speed.unwrap_or(largest)]),
            },
        }))
    }
}
