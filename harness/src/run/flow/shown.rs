//! What pictures see of a flow: its blocks and solids, and its cells.

use super::{super::views::Shown, Flow, PATIENCE, solids::pose};
use crate::gpu;
use riprap::{Result, geometry::Pose, output::Array, rock::Block, scene::Field};

impl Shown for Flow {
    fn blocks(&self) -> &[Block] {
        match self.simulation.coupled() {
            Some(coupled) => &coupled.setup().setup.blocks[..self.shown()],
            None => &self.solids,
        }
    }

    fn solids(&self) -> usize {
        match self.simulation.coupled() {
            Some(_) => self.simulation.scene().solids.len(),
            None => self.solids.len(),
        }
    }

    fn poses(&self) -> Vec<Pose> {
        match self.simulation.coupled() {
            Some(coupled) => {
                let mut poses = coupled.blocks().poses();
                poses.truncate(self.shown());
                poses
            }
            None => self.solids.iter().map(pose).collect(),
        }
    }

    fn read(&mut self, fields: &[Field], cells: &[u32]) -> Result<Vec<Array>> {
        let read = self.simulation.read(fields, cells);
        gpu::drive(&self.device, PATIENCE, "reading cells", read)?
    }
}
