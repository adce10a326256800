//! A simulation on a device of its own, every wait with an end.

use crate::gpu;
use riprap::{
    Result,
    checkpoint::Checkpoint,
    output::{Array, Image},
    scene::{Field, Scene},
    simulation::{Needs, Simulation, Totals},
    wgpu,
};
use std::time::Duration;

/// A step of 10⁸ cells takes a CPU adapter most of a minute, and compiling kernels as long; ten times
/// that is no longer slow but stuck.
const PATIENCE: Duration = Duration::from_secs(600);

/// A scene on a device.
pub struct Engine {
    pub adapter: wgpu::AdapterInfo,
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    pub needs: Needs,
    pub simulation: Simulation,
}

impl Engine {
    /// The scene at its start on the adapter called `adapter`, or on the best one.
    pub fn open(scene: &Scene, adapter: Option<&str>) -> Result<Self> {
        let adapter = gpu::pick(adapter)?;
        let needs = Needs::of(scene, &adapter)?;
        let (device, queue) = gpu::open(&adapter, needs.features, needs.limits.clone())?;
        let made = Simulation::new(&device, &queue, scene);
        let simulation = gpu::drive(&device, PATIENCE, "the kernels", made)??;
        Ok(Self {
            adapter: adapter.get_info(),
            device,
            queue,
            needs,
            simulation,
        })
    }

    pub fn scene(&self) -> &Scene {
        self.simulation.scene()
    }

    pub fn advance(&mut self, steps: u64) -> Result<()> {
        let what = format!("{steps} steps");
        let done = self.simulation.advance(steps);
        gpu::drive(&self.device, PATIENCE, &what, done)?
    }

    pub fn image(&mut self, fields: &[Field]) -> Result<Image> {
        let image = self.simulation.image(fields);
        gpu::drive(&self.device, PATIENCE, "reading the fields", image)?
    }

    pub fn read(&mut self, fields: &[Field], cells: &[u32]) -> Result<Vec<Array>> {
        let read = self.simulation.read(fields, cells);
        gpu::drive(&self.device, PATIENCE, "reading cells", read)?
    }

    pub fn totals(&mut self) -> Result<Totals> {
        let totals = self.simulation.totals();
        gpu::drive(&self.device, PATIENCE, "summing up", totals)?
    }

    pub fn checkpoint(&mut self) -> Result<Checkpoint> {
        let checkpoint = self.simulation.checkpoint();
        gpu::drive(&self.device, PATIENCE, "reading the state", checkpoint)?
    }
}
