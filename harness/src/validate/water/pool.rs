//! Scenes of free water in a plane, in SI.

use super::super::{
    Stand, Trial,
    stopwatch::{Spent, Stopwatch},
};
use riprap::{
    coupling::{FluidLoad, Rock},
    geometry::Pose,
    scene::{Scene, Scheme},
    simulation::Simulation,
    sph::{SphSolver, Water},
};
use std::{path::Path, time::Instant};

/// Gravity, m/s².
pub const GRAVITY: f64 = 9.81;

/// A tank of `size` (m; in a plane, open above) with water; `more` are further tables.
///
/// # Errors
/// If the text is no scene.
pub fn scene(size: [f64; 2], spacing: f64, water: [f64; 2], more: &str) -> anyhow::Result<Scene> {
    let [length, height] = size;
    let [reach, depth] = water;
    let text = format!(
        r#"
        domain = {{ size = [{length}, 1, {height}] }}
        fluid = {{ acceleration = [0, 0, -{GRAVITY}] }}
        rock = {{ gravity = [0, 0, -{GRAVITY}] }}
        run = {{ steps = 1 }}
        [particles]
        spacing = {spacing}
        plane = true
        [boundaries]
        x_min = {{ kind = "wall" }}
        x_max = {{ kind = "wall" }}
        z_min = {{ kind = "wall" }}
        z_max = {{ kind = "open" }}
        [[water]]
        kind = "box"
        size = [{reach}, 1, {depth}]
        position = [{}, 0.5, {}]
        [[materials]]
        name = "rock"
        density = 1000
        normal_stiffness = 1e7
        friction = 30
        {more}
        "#,
        0.5 * reach,
        0.5 * depth
    );
    let scene = Scene::from_toml(&text, Path::new("."), "pool")?;
    scene.check()?;
    Ok(scene)
}

/// Chooses the equations of the water.
pub fn choose(scene: &mut Scene, scheme: Scheme) {
    if let Some(particles) = &mut scene.particles {
        particles.scheme = scheme;
    }
}

/// A scene that runs, with the time that it took.
#[derive(Debug)]
pub struct Pool<'a> {
    stand: &'a Stand,
    /// What runs.
    pub simulation: Simulation,
    seconds: f64,
    stepping: Spent,
}

impl<'a> Pool<'a> {
    /// Puts the scene on the device.
    ///
    /// # Errors
    /// What the scene or the device lack.
    pub fn fill(stand: &'a Stand, scene: &Scene) -> anyhow::Result<Self> {
        let made = Simulation::new(&stand.device, &stand.queue, scene);
        Ok(Self {
            stand,
            simulation: stand.drive("the kernels", made)??,
            seconds: 0.0,
            stepping: Spent::default(),
        })
    }

    /// Runs to the first step that ends at the time `until` (s) or later.
    ///
    /// # Errors
    /// If the water leaves the range of the method, or the device is lost or silent.
    pub fn advance(&mut self, until: f64) -> anyhow::Result<()> {
        let begin = Instant::now();
        while self.simulation.time() < until * (1.0 - 1e-9) {
            let first = self.simulation.step() == 0;
            let watch = Stopwatch::start();
            let done = self.simulation.advance(1);
            self.stand.drive("free water", done)??;
            if !first {
                watch.stop(&mut self.stepping);
            }
        }
        self.seconds += begin.elapsed().as_secs_f64();
        Ok(())
    }

    /// The water as it is.
    ///
    /// # Errors
    /// If the device is lost or silent.
    pub fn water(&mut self) -> anyhow::Result<Water> {
        let water = self.simulation.water();
        Ok(self.stand.drive("reading particles", water)??)
    }

    /// The solver of the water.
    pub fn particles(&self) -> &SphSolver {
        self.simulation.particles().expect("a pool has water")
    }

    fn rock(&self) -> &Rock {
        self.simulation.rock().expect("free water has a rock")
    }

    /// Load on a block at the last exchange.
    pub fn external_load(&self, block: usize) -> FluidLoad {
        self.rock().external_load()[block]
    }

    /// Where a block is.
    pub fn pose(&self, block: usize) -> Pose {
        self.rock().blocks().poses()[block]
    }

    /// What has been run so far; `what` says what is in the pool.
    pub fn trial(&self, what: &str) -> Trial {
        let particles = self.particles();
        let setup = particles.setup();
        Trial {
            setup: format!(
                "{what}, Δx {:.4} m, h {} Δx, c₀ {:.1} m/s",
                setup.spacing, setup.smoothing, setup.sound_speed
            ),
            cells: particles.counts().fluid.into(),
            steps: particles.steps(),
            seconds: self.seconds,
            stepping: self.stepping,
        }
    }
}
