//! Scenes of validation cases, and a running scene.
//!
//! Lattice scenes have a cell of 1 m, a step of 1 s and a fluid of 1 kg/m³, so that SI and lattice units are the same. Scenes of
//! free water are plane.

use super::{
    CaseContext, Trial,
    context::{SUBMISSION, WARM_UP},
    record::describe,
};
use kit::clock::{Spent, Stopwatch};
use riprap::{
    coupling::FluidLoad,
    formula::Formula,
    geometry::Pose,
    lattice::Lattice,
    output::Array,
    scene::{Block, BlockShape, Boundary, Field, Motion, Rotation, Scene, Scheme},
    simulation::{Simulation, Totals},
    sph::{SphSolver, Water},
    units::Units,
};
use std::{path::Path, time::Instant};

/// A periodic tank without gravity, blocks or flow.
pub fn scene(cells: [u32; 3], tau: f64) -> anyhow::Result<Scene> {
    let [x, y, z] = cells;
    let nu = (tau - 0.5) / 3.0;
    // Nothing is in contact: the stiffness only has to allow blocks the time step of the fluid.
    let text = format!(
        r#"
        domain = {{ size = [{x}, {y}, {z}], cell = 1 }}
        fluid = {{ density = 1, viscosity = {nu:e} }}
        numerics = {{ time_step = 1 }}
        rock = {{ gravity = [0, 0, 0] }}
        run = {{ steps = 1 }}
        [[materials]]
        name = "rock"
        density = 1
        normal_stiffness = 1e-3
        friction = 30
        "#
    );
    Ok(Scene::from_toml(&text, Path::new("."), "tank")?)
}

/// Closes the tank with walls.
pub fn close(scene: &mut Scene) {
    let wall = || Boundary::Wall {
        velocity: [0.0; 3],
        roughness: 0.0,
    };
    let faces = &mut scene.boundaries;
    (faces.x_min, faces.x_max) = (wall(), wall());
    (faces.y_min, faces.y_max) = (wall(), wall());
    (faces.z_min, faces.z_max) = (wall(), wall());
}

/// Three numbers as formulas.
pub fn numbers(values: [f64; 3]) -> [Formula; 3] {
    values.map(Formula::number)
}

/// A block at rest.
pub fn block(shape: BlockShape, position: [f64; 3], motion: Motion) -> Block {
    Block {
        name: None,
        shape,
        position,
        rotation: Rotation::default(),
        motion,
        velocity: numbers([0.0; 3]),
        spin: numbers([0.0; 3]),
        material: None,
        deformable: false,
        initial_stress: [0.0; 6],
        fixed_points: Vec::new(),
        point_loads: Vec::new(),
        acceleration: None,
        guide: None,
        repeat: Vec::new(),
    }
}

/// The `n`th of a sequence of rotations that cover all rotations evenly: multiples of irrational numbers.
pub fn turn(n: u32) -> Rotation {
    // Powers of the inverse of the plastic number.
    let [a, b, c] = [0.819_172_513, 0.671_043_607, 0.549_700_478]
        .map(|step: f64| (0.5 + step * f64::from(n)).fract());
    let z = 2.0 * a - 1.0;
    let (sin, cos) = (std::f64::consts::TAU * b).sin_cos();
    let r = (1.0 - z * z).sqrt();
    Rotation {
        axis: [r * cos, r * sin, z],
        angle: 360.0 * c,
    }
}

/// Gravity, m/s².
pub const GRAVITY: f64 = 9.81;

/// A plane tank of `size` (m), open above, with water; `more` holds further TOML tables.
pub fn pool(size: [f64; 2], spacing: f64, water: [f64; 2], more: &str) -> anyhow::Result<Scene> {
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

/// Sets the SPH scheme of the water.
pub fn choose(scene: &mut Scene, scheme: Scheme) {
    if let Some(particles) = &mut scene.particles {
        particles.scheme = scheme;
    }
}

/// A running scene, with the time spent on it.
///
/// Its methods return an error if the device is lost or silent, and those that run steps if the flow leaves the range of
/// the method.
#[derive(Debug)]
pub struct Tank<'a> {
    context: &'a CaseContext,
    /// The simulation.
    pub simulation: Simulation,
    seconds: f64,
    stepping: Spent,
}

impl<'a> Tank<'a> {
    /// Creates the simulation of a scene on the device.
    pub fn fill(context: &'a CaseContext, scene: &Scene) -> anyhow::Result<Self> {
        scene.check()?;
        let made = Simulation::new(&context.device, &context.queue, scene);
        Ok(Self {
            context,
            simulation: context.drive("the kernels", made)??,
            seconds: 0.0,
            stepping: Spent::default(),
        })
    }

    /// The lattice of the fluid.
    pub fn lattice(&self) -> &Lattice {
        self.simulation.lattice().expect("a tank with a lattice")
    }

    /// The solver of free water.
    pub fn particles(&self) -> &SphSolver {
        self.simulation.particles().expect("a tank of free water")
    }

    /// Units of the lattice.
    pub fn units(&self) -> &Units {
        self.simulation.units().expect("a tank with a lattice")
    }

    /// Runs steps of the lattice.
    pub fn advance(&mut self, steps: u64) -> anyhow::Result<()> {
        let begin = Instant::now();
        let cells = self.lattice().grid().cell_count() as u64;
        let most = (SUBMISSION / cells).max(1);
        let end = self.simulation.step() + steps;
        while self.simulation.step() < end {
            let warm = self.simulation.step() >= WARM_UP;
            let some = if warm { most } else { WARM_UP };
            self.submit(some.min(end - self.simulation.step()), warm)?;
        }
        self.seconds += begin.elapsed().as_secs_f64();
        Ok(())
    }

    /// Runs free water to the first step that ends at the time `until` (s) or later.
    pub fn advance_to(&mut self, until: f64) -> anyhow::Result<()> {
        let begin = Instant::now();
        while self.simulation.time() < until * (1.0 - 1e-9) {
            self.submit(1, self.simulation.step() > 0)?;
        }
        self.seconds += begin.elapsed().as_secs_f64();
        Ok(())
    }

    /// Runs steps in one submission; if `warm`, their time counts.
    fn submit(&mut self, steps: u64, warm: bool) -> anyhow::Result<()> {
        let watch = Stopwatch::start();
        let done = self.simulation.advance(steps);
        self.context.drive("a validation case", done)??;
        if warm {
            self.stepping += watch.spent();
        }
        Ok(())
    }

    /// Load on a block at the last exchange.
    pub fn load(&self, block: usize) -> FluidLoad {
        match (self.simulation.coupled(), self.simulation.rock()) {
            (Some(coupled), _) => coupled.cell_load()[block],
            (None, Some(rock)) => rock.external_load()[block],
            (None, None) => FluidLoad::default(),
        }
    }

    /// Pose of a block.
    pub fn pose(&self, block: usize) -> Pose {
        let rock = self.simulation.rock().expect("a tank with blocks");
        rock.blocks().poses()[block]
    }

    /// Largest y⁺ half a cell from a block.
    pub fn y_plus(&mut self) -> anyhow::Result<Option<f64>> {
        let looked = self.simulation.wall_units();
        let found = self
            .context
            .drive("reading cells beside blocks", looked)??;
        Ok(found.blocks.map(|cell| cell.y_plus))
    }

    /// Sums over the fluid, including the fluid inside blocks.
    pub fn totals(&mut self) -> anyhow::Result<Totals> {
        let totals = self.simulation.totals();
        Ok(self.context.drive("reading sums", totals)??)
    }

    /// Fields in single cells, given by their indices in an array over the domain with x fastest.
    pub fn read(&mut self, fields: &[Field], cells: &[u32]) -> anyhow::Result<Vec<Array>> {
        let read = self.simulation.read(fields, cells);
        Ok(self.context.drive("reading cells", read)??)
    }

    /// Current state of the free water.
    pub fn water(&mut self) -> anyhow::Result<Water> {
        let water = self.simulation.water();
        Ok(self.context.drive("reading particles", water)??)
    }

    /// Setup and cost of the run so far; `what` describes the content of the tank.
    pub fn trial(&self, what: &str) -> Trial {
        let (how, cells) = match self.simulation.particles() {
            Some(particles) => {
                let setup = particles.setup();
                let how = format!(
                    "Δx {:.4} m, h {} Δx, c₀ {:.1} m/s",
                    setup.spacing, setup.smoothing, setup.sound_speed
                );
                (how, particles.counts().fluid.into())
            }
            None => {
                let lattice = self.lattice();
                let cells = lattice.grid().cell_count() as u64;
                (describe(lattice.setup()), cells)
            }
        };
        Trial {
            setup: format!("{what}, {how}"),
            cells,
            steps: self.simulation.fluid_steps(),
            seconds: self.seconds,
            stepping: self.stepping,
        }
    }
}
