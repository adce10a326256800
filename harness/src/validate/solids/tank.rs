//! Blocks in a tank whose cell is 1 m, step 1 s and fluid 1 kg/m³: SI and lattice units are the same.

use super::super::{
    Stand, Trial,
    record::describe,
    stopwatch::{Spent, Stopwatch, WARM_UP},
};
use riprap::{
    coupling::FluidLoad,
    formula::Formula,
    geometry::Pose,
    lattice::Lattice,
    output::Array,
    scene::{Block, BlockShape, Boundary, Field, Motion, Rotation, Scene},
    simulation::{Simulation, Totals},
    units::Units,
};
use std::{path::Path, time::Instant};

/// Cell updates in one submission: under a second on a CPU, several milliseconds on a GPU.
const SUBMISSION: u64 = 20_000_000;

/// A periodic tank without gravity, blocks or flow.
pub fn scene(cells: [u32; 3], tau: f64) -> anyhow::Result<Scene> {
    let [x, y, z] = cells;
    let nu = (tau - 0.5) / 3.0;
    // Nothing touches: the stiffness only has to let blocks take the fluid's steps.
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
    let wall = || Boundary::Wall { velocity: [0.0; 3] };
    let faces = &mut scene.boundaries;
    (faces.x_min, faces.x_max) = (wall(), wall());
    (faces.y_min, faces.y_max) = (wall(), wall());
    (faces.z_min, faces.z_max) = (wall(), wall());
}

/// Three numbers where formulas could be.
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

/// The `n`th of a sequence of turns that fill all turns evenly: multiples of irrational numbers.
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

/// A scene that runs, with the time that it took.
#[derive(Debug)]
pub struct Tank<'a> {
    stand: &'a Stand,
    /// What runs.
    pub simulation: Simulation,
    seconds: f64,
    stepping: Spent,
}

impl<'a> Tank<'a> {
    /// The lattice of the fluid.
    pub fn lattice(&self) -> &Lattice {
        self.simulation.lattice().expect("a tank has a lattice")
    }

    /// Its units.
    pub fn units(&self) -> &Units {
        self.simulation.units().expect("a tank has a lattice")
    }

    /// Puts the scene on the device.
    ///
    /// # Errors
    /// What the scene or the device lack.
    pub fn fill(stand: &'a Stand, scene: &Scene) -> anyhow::Result<Self> {
        scene.check()?;
        let made = Simulation::new(&stand.device, &stand.queue, scene);
        Ok(Self {
            stand,
            simulation: stand.drive("the kernels", made)??,
            seconds: 0.0,
            stepping: Spent::default(),
        })
    }

    /// Runs steps.
    ///
    /// # Errors
    /// If the flow leaves the range of the method, or the device is lost or silent.
    pub fn advance(&mut self, steps: u64) -> anyhow::Result<()> {
        let begin = Instant::now();
        let cells = self.lattice().grid().cell_count() as u64;
        let most = (SUBMISSION / cells).max(1);
        let end = self.simulation.step() + steps;
        while self.simulation.step() < end {
            let warm = self.simulation.step() >= WARM_UP;
            let some = if warm { most } else { WARM_UP };
            let some = some.min(end - self.simulation.step());
            let watch = Stopwatch::start();
            let done = self.simulation.advance(some);
            self.stand.drive("blocks in a fluid", done)??;
            if warm {
                watch.stop(&mut self.stepping);
            }
        }
        self.seconds += begin.elapsed().as_secs_f64();
        Ok(())
    }

    /// Load on a block at the last exchange.
    pub fn external_load(&self, block: usize) -> FluidLoad {
        let coupled = self.simulation.coupled();
        coupled.map_or_else(FluidLoad::default, |coupled| coupled.cell_load()[block])
    }

    /// Where a block is.
    ///
    /// # Errors
    /// If there is none.
    pub fn pose(&self, block: usize) -> anyhow::Result<Pose> {
        let poses = self.simulation.coupled().map(|c| c.blocks().poses());
        poses
            .and_then(|poses| poses.get(block).copied())
            .ok_or_else(|| anyhow::anyhow!("the scene has no block {block}"))
    }

    /// Largest y⁺ half a cell from a block.
    ///
    /// # Errors
    /// If the device is lost or silent.
    pub fn y_plus(&mut self) -> anyhow::Result<Option<f64>> {
        let looked = self.simulation.wall_units();
        let found = self.stand.drive("reading cells beside blocks", looked)??;
        Ok(found.blocks.map(|cell| cell.y_plus))
    }

    /// Sums over the fluid, that inside blocks too.
    ///
    /// # Errors
    /// If the device is lost or silent.
    pub fn totals(&mut self) -> anyhow::Result<Totals> {
        let totals = self.simulation.totals();
        Ok(self.stand.drive("reading sums", totals)??)
    }

    /// Fields in single cells, places in an array over the domain with x fastest.
    ///
    /// # Errors
    /// If a cell is outside, or the device is lost or silent.
    pub fn read(&mut self, fields: &[Field], cells: &[u32]) -> anyhow::Result<Vec<Array>> {
        let read = self.simulation.read(fields, cells);
        Ok(self.stand.drive("reading cells", read)??)
    }

    /// What has been run so far; `what` says what is in the tank.
    pub fn trial(&self, what: &str) -> Trial {
        let lattice = self.lattice();
        Trial {
            setup: format!("{what}, {}", describe(lattice.setup())),
            cells: lattice.grid().cell_count() as u64,
            steps: self.simulation.step(),
            seconds: self.seconds,
            stepping: self.stepping,
        }
    }
}
