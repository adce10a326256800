//! Blocks, solids and particles of a run for rendering.

use super::{super::views::Shown, Engine, SphRun};
use crate::render::{Colours, Drop, Drops};
use riprap::{Result, geometry::Pose, output::Array, rock::Block, scene::Field};

/// Radius of a sphere with the volume of a particle, (3/4π)^⅓, in spacings.
const SPHERE_RADIUS: f64 = 0.62;

impl Shown for SphRun {
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
            radius: SPHERE_RADIUS * setup.spacing,
            colours: Colours {
                label: "speed".into(),
                unit: "m/s".into(),
                range: Some([0.0, speed.unwrap_or(largest)]),
            },
        }))
    }
}
