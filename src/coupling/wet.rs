//! The side of blocks on which a lattice feels them.

use super::{Ambient, Felt, Gathered, Pace, Reading, loads::sum};
use crate::{
    Error, Result,
    bodies::{Load, Period, Pose},
    immersed::{FaceLoad, Frame, Immersed, Submerged},
    lattice::Lattice,
    scene::Scene,
    units::Units,
};
use glam::DVec3;

/// The cells of blocks in a lattice, and what it does to these.
#[derive(Debug)]
pub(crate) struct Wet {
    pub(super) immersed: Immersed,
    pub(super) reading: Reading,
    pub(super) face_reading: Reading,
    /// Of the blocks in the fluid; empty before the first exchange.
    pub(super) faces: Vec<Vec<FaceLoad>>,
    pub(super) ambient: Ambient,
    pub(super) gathered: Gathered,
    average: bool,
    /// Number of blocks in the fluid, the first ones.
    in_fluid: usize,
    /// The poses, of all blocks, of which the cells have been computed.
    pub(super) placed: Option<Vec<Pose>>,
}

impl Wet {
    pub(super) fn new(
        device: &wgpu::Device,
        lattice: &Lattice,
        (scene, units): (&Scene, &Units),
        blocks: Vec<Submerged>,
        period: Option<Period>,
    ) -> Result<Self> {
        let frame = Frame {
            origin: DVec3::from(scene.domain.origin),
            units: *units,
        };
        Ok(Self {
            in_fluid: blocks.len(),
            immersed: Immersed::new(device, lattice, frame, blocks)?,
            reading: Reading::default(),
            face_reading: Reading::default(),
            faces: Vec::new(),
            ambient: Ambient {
                density: scene.fluid.density,
                acceleration: scene.fluid.acceleration.clone(),
                gravity: DVec3::from(scene.rock.gravity),
                period,
            },
            gathered: Gathered::default(),
            average: scene.coupling.average,
            placed: None,
        })
    }

    /// Puts the blocks at `poses` and records their cells, unless that is done.
    ///
    /// # Errors
    /// If the device does not hold the cells: [`Error::Device`] where its memory ends, after which the simulation is
    /// to be made anew.
    pub async fn place(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        lattice: &mut Lattice,
        encoder: &mut wgpu::CommandEncoder,
        poses: &[Pose],
    ) -> Result<()> {
        if self.placed.as_deref() == Some(poses) {
            return Ok(());
        }
        self.placed = None;
        let in_fluid = self.in_fluid;
        // What a buffer that is none is bound to is not valid either.
        let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let validity = device.push_error_scope(wgpu::ErrorFilter::Validation);
        let placed = self
            .immersed
            .place(device, queue, lattice, &poses[..in_fluid]);
        let [validity, memory] = [validity.pop(), memory.pop()];
        let refused = validity.await.or(memory.await);
        placed?;
        if let Some(error) = refused {
            return Err(Error::Device(format!(
                "it does not hold the cells of {in_fluid} blocks in the fluid ({error}); use fewer or smaller ones, or \
                 a larger cell"
            )));
        }
        self.immersed
            .record_cells(&mut encoder.begin_compute_pass(&Default::default()));
        self.placed = Some(poses.to_vec());
        Ok(())
    }

    /// Whether fluid and blocks meet at the end of the step `step`, counted from 1, of those until `last`.
    pub fn meets(&self, pace: Pace, step: u64, last: u64) -> bool {
        match pace {
            // The loads change nothing; those who ask about them look after the last step.
            Pace::Still => step == last && self.immersed.wrench_count() > 0,
            Pace::Asleep(interval) | Pace::Awake(interval) => step.is_multiple_of(interval),
        }
    }

    /// Whether the loads of the step `step`, counted from 1, are wanted: of all steps while a block moves, else
    /// for their mean also of the step before fluid and blocks meet.
    pub fn wants(&self, pace: Pace, step: u64, last: u64) -> bool {
        matches!(pace, Pace::Awake(_))
            || self.meets(pace, step, last)
            || self.average && self.meets(pace, step + 1, last)
    }

    /// Records the sums of what the fluid did to the blocks in the step `step`, and their way to the host.
    pub fn record_loads(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        step: u64,
    ) {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        self.immersed.record_loads(&mut pass);
        drop(pass);
        let sums = (self.immersed.wrenches(), self.immersed.wrench_count());
        self.reading.record(device, encoder, sums, step);
    }

    /// Waits for the loads that were recorded and adds them to those since the last exchange.
    ///
    /// # Errors
    /// If the device is lost.
    pub async fn read_loads(&mut self) -> Result<()> {
        for (step, sums) in self.reading.finish().await? {
            let poses = self.placed.iter().flatten();
            let flow =
                |(load, pose): (Load, &Pose)| sum(load, self.ambient.push(&load, pose.centre));
            let loads = self.immersed.loads(&sums)?.into_iter().zip(poses);
            self.gathered
                .add(step, loads.map(flow).collect(), self.average);
        }
        self.read_faces().await
    }

    /// Ends the time since the last exchange: the blocks feel the mean of its loads.
    pub fn exchange(&mut self) -> Vec<Felt> {
        let flows = self.gathered.take().unwrap_or_default();
        let felt = |flow: Load| Felt {
            flow,
            buoyancy: self.ambient.buoyancy(&flow),
        };
        flows.into_iter().map(felt).collect()
    }
}
