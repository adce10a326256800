//! What the fluid does to the faces of blocks, where a probe asks.

use super::{Coupled, Wet};
use crate::{
    Result,
    bodies::Pose,
    immersed::FaceLoad,
    scene::{ProbePlace, Scene},
};

/// Whether a probe of the scene follows the block called `name`, and whether one asks for its faces, or for its
/// safety, to which they belong.
pub(super) fn asked(scene: &Scene, name: &str) -> [bool; 2] {
    let of = |place: &ProbePlace| match place {
        ProbePlace::Block {
            block,
            faces,
            safety,
        } if block == name => Some(*faces || *safety),
        _ => None,
    };
    let probes = || scene.probes.iter().filter_map(|probe| of(&probe.place));
    [probes().next().is_some(), probes().any(|faces| faces)]
}

impl Wet {
    /// Records the sums of what the fluid did to single faces in the step `step`, and their way to the host;
    /// nothing where nobody asks.
    pub fn record_faces(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        step: u64,
    ) {
        let Some(sums) = self.immersed.face_sums() else {
            return;
        };
        let mut pass = encoder.begin_compute_pass(&Default::default());
        self.immersed.record_faces(&mut pass);
        drop(pass);
        let sums = (sums, self.immersed.face_sum_count());
        self.face_reading.record(device, encoder, sums, step);
    }

    /// Waits for the loads on faces that were recorded; they are those at the beginning of the step.
    pub(super) async fn read_faces(&mut self) -> Result<()> {
        for (_, sums) in self.face_reading.finish().await? {
            let poses = self.placed.iter().flatten();
            let loads = self.immersed.face_loads(&sums)?;
            let whole = |(loads, pose): (Vec<FaceLoad>, &Pose)| {
                let load = |load: FaceLoad| {
                    let weight = self.ambient.weight(load.centre);
                    load.at_face(weight, pose.centre)
                };
                loads.into_iter().map(load).collect()
            };
            self.faces = loads.into_iter().zip(poses).map(whole).collect();
        }
        Ok(())
    }
}

impl Coupled {
    /// The loads of the fluid on the faces of a block at the last exchange, part by part; none where no probe asks
    /// for them, or before the first exchange.
    pub fn faces(&self, block: usize) -> &[FaceLoad] {
        match self.asked.get(block) {
            Some(true) => self.wet.faces.get(block).map_or(&[], Vec::as_slice),
            _ => &[],
        }
    }
}
