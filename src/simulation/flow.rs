//! A fluid on a lattice, with the cells of the blocks that are in it.

use crate::{
    Result,
    coupling::{ExchangeInterval, Fluid, FluidLoad, LatticeCoupling},
    geometry::Pose,
    lattice::{self, Lattice},
    scene::{
        Face, Scene,
        build::{face_velocity, lattice_key},
    },
    units::Units,
};

/// The fluid of a scene for as long as it runs.
pub(super) struct Flow<'a> {
    pub device: &'a wgpu::Device,
    pub queue: &'a wgpu::Queue,
    pub scene: &'a Scene,
    pub units: &'a Units,
    pub lattice: &'a mut Lattice,
    /// Velocity faces whose formulas contain the time.
    pub changing: &'a [Face],
    /// The coupling to the blocks in it, if there are any.
    pub coupling: Option<&'a mut LatticeCoupling>,
}

impl Fluid for Flow<'_> {
    fn time(&self) -> f64 {
        self.lattice.step() as f64 * self.units.time_step
    }

    async fn advance(
        &mut self,
        poses: &[Pose],
        interval: ExchangeInterval,
        end: f64,
    ) -> Result<Option<Vec<FluidLoad>>> {
        let last = (end / self.units.time_step).round() as u64;
        let mut encoder = self.device.create_command_encoder(&Default::default());
        if let Some(coupling) = &mut self.coupling {
            let (device, queue) = (self.device, self.queue);
            coupling
                .place(device, queue, self.lattice, &mut encoder, poses)
                .await?;
        }
        loop {
            let next = self.lattice.step() + 1;
            if self
                .coupling
                .as_ref()
                .is_some_and(|coupling| coupling.exchanges_at(interval, next, last))
            {
                return self.exchange(encoder).await;
            }
            self.lattice
                .record_psm(&mut encoder.begin_compute_pass(&Default::default()));
            if let Some(coupling) = self
                .coupling
                .as_mut()
                .filter(|coupling| coupling.needs_loads(interval, next, last))
            {
                coupling.record_loads(self.device, &mut encoder, next);
            }
            self.lattice
                .record_rest(&mut encoder.begin_compute_pass(&Default::default()));
            let coming = self.changed_faces();
            let goes_on = coming.as_ref().is_ok_and(|coming| coming.is_empty());
            if self.lattice.step() == last || !goes_on {
                // What is recorded counts as done, whatever the next step lacks. A velocity that changes is
                // written between two submissions.
                self.queue.submit([encoder.finish()]);
                self.set_faces()?;
                return Ok(None);
            }
        }
    }
}

impl Flow<'_> {
    /// Without blocks, until the time `end` (s).
    ///
    /// # Errors
    /// Those of formulas of faces.
    pub async fn run(&mut self, end: f64) -> Result<()> {
        while self.time() < end {
            self.advance(&[], ExchangeInterval::Static, end).await?;
        }
        Ok(())
    }

    /// The last step of a stretch, at whose end blocks and fluid meet: the fluid around them runs first, and the rest
    /// of it while their loads are read.
    async fn exchange(
        &mut self,
        mut encoder: wgpu::CommandEncoder,
    ) -> Result<Option<Vec<FluidLoad>>> {
        let (device, queue, step) = (self.device, self.queue, self.lattice.step() + 1);
        self.lattice
            .record_psm(&mut encoder.begin_compute_pass(&Default::default()));
        if let Some(coupling) = &mut self.coupling {
            coupling.record_loads(device, &mut encoder, step);
            coupling.record_faces(device, &mut encoder, step);
        }
        queue.submit([encoder.finish()]);
        let mut encoder = device.create_command_encoder(&Default::default());
        self.lattice
            .record_rest(&mut encoder.begin_compute_pass(&Default::default()));
        queue.submit([encoder.finish()]);
        let Some(coupling) = &mut self.coupling else {
            return Ok(None);
        };
        coupling.read_loads().await?;
        let loads = coupling.exchange();
        self.set_faces()?;
        Ok(Some(loads))
    }

    /// The velocity faces whose values at the present time are not those that they have.
    fn changed_faces(&self) -> Result<Vec<(Face, Vec<[f32; 3]>)>> {
        let mut changed = Vec::new();
        for &face in self.changing {
            let velocity = face_velocity(self.scene, self.units, face, self.time())?;
            let (axis, side) = (face.axis().index(), usize::from(face.is_max()));
            match &self.lattice.setup().faces[axis][side] {
                lattice::Face::Velocity(old) if *old == velocity => {}
                _ => changed.push((face, velocity)),
            }
        }
        Ok(changed)
    }

    /// Gives the velocity faces what they have at the present time.
    ///
    /// # Errors
    /// Those of their formulas.
    pub fn set_faces(&mut self) -> Result<()> {
        for (face, velocity) in self.changed_faces()? {
            let (axis, side) = (face.axis().index(), usize::from(face.is_max()));
            self.lattice
                .set_face_velocity(self.queue, axis, side, velocity)
                .map_err(|error| error.at_key(lattice_key))?;
        }
        Ok(())
    }
}
