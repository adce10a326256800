//! Boxes of fluid with blocks in them, in lattice units: cell, step and density are 1. Several of them step in turns, so that
//! load on the machine affects all of them alike.

use crate::{
    bench::{Bench, median},
    gpu,
};
use kit::clock::{Clock, PATIENCE};
use riprap::{
    lattice::Lattice,
    scene::{Motion, Probe, ProbePlace, Scene, Sleep},
    simulation::Simulation,
};
use std::{path::Path, time::Instant};

/// Speed of fluid and blocks: a cell in fifty steps.
const SPEED: f64 = 0.02;
/// Edge of the blocks of a stack, cells.
const BRICK: u32 = 3;
/// Gap between blocks of a stack without weight, cells.
const APART: f64 = 0.01;

/// A scene, and its simulation once it is made.
pub struct World {
    pub scene: Scene,
    pub simulation: Option<Simulation>,
}

impl World {
    /// A periodic box of n³ cells whose fluid moves in every cell: at rest, denormal numbers would slow a CPU down.
    pub fn empty(n: u32) -> riprap::Result<Self> {
        Self::of(n, SPEED, "", String::new())
    }

    /// The same with spheres, moving or fixed.
    pub fn spheres(n: u32, across: f64, places: &[[f64; 3]], moving: bool) -> riprap::Result<Self> {
        let mut blocks = String::new();
        for (k, place) in places.iter().enumerate() {
            let motion = match moving {
                true => {
                    // All in the same direction, so that they do not collide, with slightly different velocities.
                    let aside = 1e-4 * (k % 7) as f64;
                    format!("velocity = [{aside:e}, {SPEED:e}, 0]")
                }
                false => "motion = \"fixed\"".into(),
            };
            blocks += &format!(
                "[[blocks]]\nkind = \"sphere\"\nradius = {}\nposition = {place:?}\n{motion}\n",
                0.5 * across
            );
        }
        Self::of(n, SPEED, "rock = { gravity = [0, 0, 0] }", blocks)
    }

    /// The same with spheres moved by the fluid.
    pub fn free_spheres(n: u32, across: f64, places: &[[f64; 3]]) -> riprap::Result<Self> {
        let mut world = Self::spheres(n, across, places, true)?;
        for block in &mut world.scene.blocks {
            block.motion = Motion::Free;
        }
        Ok(world)
    }

    /// A fixed sphere at `place`, with a probe that requests the loads on its faces.
    pub fn with_face_loads(n: u32, across: f64, place: [f64; 3]) -> riprap::Result<Self> {
        let mut world = Self::spheres(n, across, &[place], false)?;
        let name = String::from("sphere");
        world.scene.blocks[0].name = Some(name.clone());
        world.scene.probes.push(Probe {
            name: name.clone(),
            place: ProbePlace::Block {
                block: name,
                faces: true,
                safety: false,
            },
            fields: Vec::new(),
            every: None,
        });
        Ok(world)
    }

    /// A free sphere at `place`, so heavy that it falls asleep at once and the fluid does not wake it.
    pub fn asleep(n: u32, across: f64, place: [f64; 3]) -> riprap::Result<Self> {
        let mut world = Self::spheres(n, across, &[place], false)?;
        world.scene.blocks[0].motion = Motion::Free;
        world.scene.materials[0].density = 1e9;
        world.scene.rock.sleep = Some(Sleep {
            speed: 1e-3,
            time: 1.0,
        });
        Ok(world)
    }

    /// Whether no block is awake.
    pub fn sleeps(&self) -> bool {
        let coupled = self.simulation.as_ref().and_then(Simulation::coupled);
        coupled.is_some_and(|coupled| {
            let blocks = coupled.blocks();
            let mut all = blocks.asleep().enumerate();
            all.all(|(block, asleep)| asleep || !blocks.moves(block))
        })
    }

    /// Stacks of four cubes on a floor; without weight they float, so close together that the flow hardly differs. The fluid is
    /// slow: at its usual speed it would throw them against each other.
    pub fn stacks(n: u32, weight: bool) -> riprap::Result<Self> {
        let gap = if weight { 0.0 } else { APART };
        let (edge, pitch) = (f64::from(BRICK), f64::from(BRICK + 1));
        let row = (n / (BRICK + 1)).min(16);
        let gravity = if weight { -1e-4 } else { 0.0 };
        let mut blocks = String::new();
        for k in 0..4u32 {
            for j in 0..row {
                for i in 0..row {
                    let at = [i, j].map(|i| pitch * (f64::from(i) + 0.5));
                    let z = edge * (f64::from(k) + 0.5) + gap * f64::from(k + 1);
                    blocks += &format!(
                        "[[blocks]]\nkind = \"box\"\nsize = [{edge}, {edge}, {edge}]\nposition = [{}, {}, {z}]\n",
                        at[0], at[1]
                    );
                }
            }
        }
        let rock = format!(
            "rock = {{ gravity = [0, 0, {gravity:e}], corner_area = 0.25 }}\ncoupling = {{ lubrication = false }}"
        );
        let floor = "[boundaries]\nz_min = { kind = \"wall\" }\nz_max = { kind = \"wall\" }\n";
        Self::of(n, 0.05 * SPEED, &rock, format!("{floor}{blocks}"))
    }

    fn of(n: u32, speed: f64, rock: &str, tables: String) -> riprap::Result<Self> {
        let text = format!(
            r#"
            domain = {{ size = [{n}, {n}, {n}], cell = 1 }}
            fluid = {{ density = 1, viscosity = 0.03 }}
            numerics = {{ time_step = 1 }}
            run = {{ steps = 1 }}
            initial = {{ velocity = ["{speed}*sin(2*pi*y/{n})", "{speed}*sin(2*pi*z/{n})", "{speed}*sin(2*pi*x/{n})"] }}
            {rock}
            [[materials]]
            name = "rock"
            density = 2
            normal_stiffness = 0.1
            friction = 30
            {tables}
            "#
        );
        Ok(Self {
            scene: Scene::from_toml(&text, Path::new("."), "bench")?,
            simulation: None,
        })
    }

    /// Cells of the bricks that blocks reach.
    pub fn touched_cells(&self) -> f64 {
        let simulation = self.simulation.as_ref();
        let Some(coupled) = simulation.and_then(Simulation::coupled) else {
            return 0.0;
        };
        let grid = simulation.and_then(Simulation::lattice).map(Lattice::grid);
        grid.map_or(0.0, |grid| {
            let all: u32 = grid.bricks().iter().product();
            let bricks = coupled.solid_cells().bricks().len();
            grid.cell_count() as f64 * bricks as f64 / f64::from(all)
        })
    }

    /// Contacts, and sub-steps of the blocks per step.
    pub fn contacts(&self) -> (f64, f64) {
        let coupled = self.simulation.as_ref().and_then(Simulation::coupled);
        coupled.map_or((0.0, 0.0), |coupled| {
            let blocks = coupled.blocks();
            let sub_steps = (1.0 / blocks.time_step()).ceil();
            (blocks.contacts().count() as f64, sub_steps)
        })
    }
}

/// Positions of spheres that fill `share` of a box of n³ cells, on a lattice that does not match the cells.
pub fn crowd(n: u32, across: f64, share: f64) -> Vec<[f64; 3]> {
    let edge = f64::from(n);
    let volume = std::f64::consts::PI / 6.0 * across.powi(3);
    let count = (share * edge.powi(3) / volume).round() as usize;
    let mut rows = [1usize; 3];
    while rows.iter().product::<usize>() < count {
        let least = (0..3).min_by_key(|&axis| rows[axis]).unwrap_or(0);
        rows[least] += 1;
    }
    let place = |k: usize| {
        let at = [k % rows[0], k / rows[0] % rows[1], k / (rows[0] * rows[1])];
        std::array::from_fn(|axis| edge * (at[axis] as f64 + 0.5) / rows[axis] as f64 + 0.3)
    };
    (0..count).map(place).collect()
}

/// Measurement of worlds in turns.
pub struct InterleavedRuns {
    pub clock: Clock,
    pub rounds: usize,
    /// Duration of a turn, s.
    long: f64,
}

/// Seconds per step of each world in each round.
pub struct Times(Vec<Vec<f64>>);

impl Times {
    /// The median of one world.
    pub fn median(&self, world: usize) -> f64 {
        median(self.0[world].clone())
    }

    /// Median of the ratios of two worlds in the same round.
    pub fn ratio(&self, world: usize, base: usize) -> f64 {
        let pairs = self.0[world].iter().zip(&self.0[base]);
        median(pairs.map(|(a, b)| a / b).collect())
    }
}

impl InterleavedRuns {
    pub fn new(bench: &Bench<'_>, rounds: usize, long: f64) -> Self {
        Self {
            clock: bench.clock(),
            rounds,
            long,
        }
    }

    /// Seconds of `work`, on the time base of the speeds.
    pub fn time(&self, work: impl FnOnce() -> anyhow::Result<()>) -> anyhow::Result<f64> {
        Ok(self.clock.basis(self.clock.time(work)?))
    }

    /// Creates the simulations of the worlds and steps them in turns.
    pub fn measure(&self, worlds: &mut [World]) -> anyhow::Result<Times> {
        let (device, queue) = (&self.clock.device, &self.clock.queue);
        let mut steps = Vec::new();
        for world in worlds.iter_mut() {
            let made = Simulation::new(device, queue, &world.scene);
            let made = gpu::drive(device, PATIENCE, "the kernels", made)??;
            world.simulation = Some(made);
            // The first steps compile, and blocks find their tiles.
            self.steps(world, 4)?;
            let begin = Instant::now();
            self.steps(world, 2)?;
            let seconds = begin.elapsed().as_secs_f64() / 2.0;
            steps.push(((self.long / seconds) as u64).clamp(2, 200));
        }
        // The same number for all, so that the cost of a submission has the same share in each.
        let steps = steps.into_iter().min().unwrap_or(2);
        let mut times = vec![Vec::new(); worlds.len()];
        for _ in 0..self.rounds {
            for (world, times) in worlds.iter_mut().zip(&mut times) {
                let spent = self.time(|| self.steps(world, steps))?;
                times.push(spent / steps as f64);
            }
        }
        Ok(Times(times))
    }

    /// Seconds per step on the host, without the wait for the device, and on the device; zero without timestamps.
    pub fn host_and_device(&self, world: &mut World, steps: u64) -> anyhow::Result<[f64; 2]> {
        let (device, queue) = (&self.clock.device, &self.clock.queue);
        let made = Simulation::new(device, queue, &world.scene);
        let made = gpu::drive(device, PATIENCE, "the kernels", made)??;
        world.simulation = Some(made);
        self.steps(world, 4)?;
        if let Some(simulation) = &mut world.simulation {
            simulation.time_phases();
        }
        self.steps(world, steps)?;
        let phases = world.simulation.as_ref().map(Simulation::phases);
        let mut found = [0.0; 2];
        for phase in phases.unwrap_or_default() {
            match phase.name.as_str() {
                "readback wait" => {}
                "place blocks" | "broadphase" | "contact" | "integrate" | "loads on blocks" => {
                    found[0] += phase.seconds / steps as f64;
                }
                _ => found[1] += phase.seconds / steps as f64,
            }
        }
        Ok(found)
    }

    fn steps(&self, world: &mut World, steps: u64) -> anyhow::Result<()> {
        if let Some(simulation) = &mut world.simulation {
            let done = simulation.advance(steps);
            gpu::drive(&self.clock.device, PATIENCE, "blocks in a fluid", done)??;
        }
        Ok(())
    }
}
