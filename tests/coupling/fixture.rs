//! A running coupled scene, and measurements of it.

use glam::DVec3;
use kit::{Rig, scene::for_kernels};
use riprap::{
    Result,
    coupling::FluidLoad,
    geometry::Pose,
    scene::{Kernels, Scene},
    simulation::Simulation,
};

/// Time step, s.
pub const STEP: f64 = 0.25;
/// Density of the fluid, kg/m³.
pub const DENSITY: f64 = 1000.0;

/// A rock material of the given density (kg/m³), soft enough for long sub-steps.
pub fn material(name: &str, density: f64) -> String {
    format!(
        "[[materials]]\nname = \"{name}\"\ndensity = {density}\nnormal_stiffness = 1e5\nfriction = 30\n"
    )
}

/// A box of fluid of 1000 kg/m³ without gravity, with cells of 0.5 m and steps of 0.25 s, so that no conversion factor is one.
pub fn fluid(cells: [u32; 3], nu: f64) -> String {
    let size = cells.map(|n| 0.5 * f64::from(n));
    // ν Δx²/Δt = ν 0.5²/0.25.
    format!(
        "[domain]\nsize = {size:?}\ncell = 0.5\n[fluid]\ndensity = 1000\nviscosity = {nu}\n[run]\nsteps = 1\n"
    )
}

/// The same fluid with the given acceleration, m/s².
pub fn accelerated_fluid(cells: [u32; 3], nu: f64, acceleration: [f64; 3]) -> String {
    let accelerated = format!("acceleration = {acceleration:?}\nviscosity");
    fluid(cells, nu).replace("viscosity", &accelerated)
}

/// A block called "stone" on the floor in water at rest, which falls asleep; `more` is added to the scene.
pub fn resting(more: &str) -> String {
    format!(
        r#"{}{}damping = 0.7
        [boundaries]
        z_min = {{ kind = "wall" }}
        z_max = {{ kind = "wall" }}
        [rock]
        sleep = {{ speed = 2e-3, time = 1.5 }}
        gravity = [0, 0, -0.01]
        [numerics]
        time_step = 0.25
        velocity_scale = 0.1
        [[blocks]]
        name = "stone"
        kind = "box"
        size = [2, 2, 1]
        position = [2, 3, 0.5]
        {more}"#,
        fluid([12, 12, 8], 0.1),
        material("rock", 10_000.0)
    )
}

/// Walls on all sides.
pub const WALLS: &str = r#"[boundaries]
    x_min = { kind = "wall" }
    x_max = { kind = "wall" }
    y_min = { kind = "wall" }
    y_max = { kind = "wall" }
    z_min = { kind = "wall" }
    z_max = { kind = "wall" }
"#;

pub struct World {
    pub rig: Rig,
    pub sim: Simulation,
}

impl World {
    pub fn new(text: &str) -> Self {
        match Self::try_new(text) {
            Ok(world) => world,
            Err(error) => panic!("{error}\n{text}"),
        }
    }

    /// The scene `text` with the given kernels.
    pub fn with(text: &str, kernels: Kernels) -> Self {
        let scene = kit::scene::read(text).unwrap();
        Self::of(&for_kernels(&scene, kernels)).unwrap()
    }

    pub fn try_new(text: &str) -> Result<Self> {
        Self::of(&kit::scene::read(text)?)
    }

    fn of(scene: &Scene) -> Result<Self> {
        let rig = Rig::new();
        let sim = rig.simulation(scene)?;
        Ok(Self { rig, sim })
    }

    pub fn advance(&mut self, steps: u64) {
        self.try_advance(steps).unwrap();
    }

    pub fn try_advance(&mut self, steps: u64) -> Result<()> {
        self.rig.wait(self.sim.advance(steps))
    }

    /// Momentum of the fluid in all cells, kg m/s, and its mass, kg.
    pub fn fluid(&mut self) -> (DVec3, f64) {
        let totals = self.rig.wait(self.sim.totals()).unwrap();
        (DVec3::from(totals.momentum), totals.mass)
    }

    /// Poses of the blocks.
    pub fn poses(&self) -> Vec<Pose> {
        self.sim.coupled().unwrap().blocks().poses()
    }

    /// Momentum of the block `block`, kg m/s.
    pub fn momentum(&self, block: usize) -> DVec3 {
        let blocks = self.sim.coupled().unwrap().blocks();
        blocks.mass(block) * self.velocity(block)
    }

    pub fn velocity(&self, block: usize) -> DVec3 {
        self.sim.coupled().unwrap().blocks().poses()[block].velocity
    }

    pub fn centre(&self, block: usize) -> DVec3 {
        self.sim.coupled().unwrap().blocks().poses()[block].centre
    }

    pub fn cell_load(&self, block: usize) -> FluidLoad {
        self.sim.coupled().unwrap().cell_load()[block]
    }
}
