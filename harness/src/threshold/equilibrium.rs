//! Limit equilibrium of a block under the mean loads of a trial: the value at which a factor of safety is one, if the loads of
//! the flow grow with the square of the value.

use crate::run::{Rock, SceneRun, fluid_wrench};
use glam::DVec3;
use riprap::safety::Supports;
use serde::Serialize;
use std::fmt;

/// Parts of a trial whose means give the statistical error.
const BATCHES: usize = 5;
/// Largest square of the factor on the value that is tried.
const LARGEST: f64 = 1e4;

/// Force (N) and torque about the centroid (N m).
type Wrench = [DVec3; 2];

/// Loads on the watched blocks during a trial.
#[derive(Debug)]
pub struct Loads {
    /// The blocks at the start of the trial: a block that lifts for a moment loses contacts.
    blocks: Vec<Block>,
    /// Loads of the blocks at each sample.
    samples: Vec<Vec<Wrench>>,
}

/// Result of block theory for the first block to fail.
#[derive(Clone, Debug, Serialize)]
pub struct Equilibrium {
    /// Its name.
    pub block: String,
    /// How it fails: by sliding, uplift or toppling.
    pub mode: &'static str,
    /// The value at which that factor of safety is one.
    pub value: f64,
    /// Statistical error of the value, from the means over fifths of the time; `None` if a block stands under one of them.
    pub error: Option<f64>,
    /// Value of the trial that gave the loads.
    pub loads_at: f64,
    /// Number of samples used: those of the second half of the trial.
    pub samples: usize,
}

impl Loads {
    /// Loads of the blocks with the numbers `watched`, in their present state in a fluid of the `density` (kg/m³).
    pub fn new(watched: impl Iterator<Item = usize>, rock: &Rock<'_>, density: f64) -> Self {
        Self {
            blocks: watched
                .map(|block| Block::new(rock, block, density))
                .collect(),
            samples: Vec::new(),
        }
    }

    /// Samples the present loads.
    pub fn look(&mut self, run: &SceneRun) {
        if let Some(rock) = run.rock() {
            let loads = self
                .blocks
                .iter()
                .map(|block| fluid_wrench(&rock, block.number));
            self.samples.push(loads.collect());
        }
    }

    /// The block that fails at the lowest value; `None` if all stand at a hundred times `value`, or if `value` is zero.
    pub fn equilibrium(&self, value: f64) -> Option<Equilibrium> {
        if value == 0.0 {
            return None;
        }
        let late = &self.samples[self.samples.len() / 2..];
        let each = self.blocks.iter().enumerate();
        let failing = each.filter_map(|(n, block)| {
            let (square, mode) = block.fails(mean(late, n)?)?;
            Some((n, block, square, mode))
        });
        let (n, block, square, mode) = failing.min_by(|a, b| a.2.total_cmp(&b.2))?;
        let batches = late.chunks_exact((late.len() / BATCHES).max(1));
        let means = batches.map(|batch| Some(block.fails(mean(batch, n)?)?.0.sqrt()));
        let means: Option<Vec<f64>> = means.collect();
        Some(Equilibrium {
            block: block.name.clone(),
            mode,
            value: value * square.sqrt(),
            error: means.and_then(|means| Some(value.abs() * mean_and_error(&means)?[1])),
            loads_at: value,
            samples: late.len(),
        })
    }
}

/// A block in still water.
#[derive(Debug)]
struct Block {
    number: usize,
    name: String,
    supports: Supports,
    buoyancy: DVec3,
}

impl Block {
    fn new(rock: &Rock<'_>, number: usize, density: f64) -> Self {
        let volume = rock.setup.blocks[number].shape.volume();
        Self {
            number,
            name: rock.blocks.name(number).into(),
            supports: Supports::of(rock.setup, rock.blocks, number),
            buoyancy: -density * volume * rock.blocks.gravity(),
        }
    }

    /// Least factor of safety and its name, if the loads of the flow are `times` those in `loads`.
    fn factor(&self, [force, torque]: Wrench, times: f64) -> (f64, &'static str) {
        let force = self.buoyancy + times * (force - self.buoyancy);
        let wrench = [force, times * torque];
        let found = self.supports.under(wrench);
        let uplift = (found.uplift, "uplift");
        // A block that is lifted slides and topples too; without contacts neither factor is known.
        if uplift.0 < 1.0 {
            return uplift;
        }
        let others = [
            (found.sliding.factor, "sliding"),
            (found.toppling, "toppling"),
        ];
        let known = others.into_iter().filter(|(factor, _)| !factor.is_nan());
        known.fold(
            uplift,
            |least, other| if other.0 < least.0 { other } else { least },
        )
    }

    /// Factor on the loads of the flow at which the block fails, and the mode of failure; `None` if it stands under much larger
    /// loads.
    fn fails(&self, loads: Wrench) -> Option<(f64, &'static str)> {
        let mut low = 0.0;
        let mut high = 1e-4;
        while self.factor(loads, high).0 >= 1.0 {
            low = high;
            high *= 1.1;
            if high > LARGEST {
                return None;
            }
        }
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            match self.factor(loads, middle).0 < 1.0 {
                true => high = middle,
                false => low = middle,
            }
        }
        let (factor, mode) = self.factor(loads, high);
        (factor < 1.0).then_some((high, mode))
    }
}

/// Mean loads of the `n`th block; `None` without samples.
fn mean(samples: &[Vec<Wrench>], n: usize) -> Option<Wrench> {
    let sum = |part: usize| samples.iter().map(|all| all[n][part]).sum::<DVec3>();
    let count = samples.len() as f64;
    (count > 0.0).then(|| [sum(0) / count, sum(1) / count])
}

/// Mean of values, and its standard error; `None` for a single value.
pub(crate) fn mean_and_error(values: &[f64]) -> Option<[f64; 2]> {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (values.len() > 1).then(|| [mean, (squares / (count * (count - 1.0))).sqrt()])
}

impl fmt::Display for Equilibrium {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} fails by {} at {:.4}",
            self.block, self.mode, self.value
        )?;
        if let Some(error) = self.error {
            write!(f, " ± {error:.1e}")?;
        }
        write!(
            f,
            " in limit equilibrium, under the mean loads at {}",
            self.loads_at
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kit::assert_near;
    use riprap::{
        rock::Blocks,
        scene::{Scene, build::block_setup},
    };
    use std::path::Path;

    /// A cube of 0.1 m and 2700 kg/m³ on a plane with a friction angle of 30°, in water.
    fn cube() -> Block {
        let text = r#"
            rock = { gravity = [0, 0, -10] }
            materials = [{ name = "rock", density = 2700, normal_stiffness = 1e9, friction = 30 }]
            solids = [{ kind = "box", name = "plane", min = [-1, -1, -1], max = [1, 1, 0] }]
            blocks = [{ kind = "box", name = "cube", size = [0.1, 0.1, 0.1], position = [0, 0, 0.05] }]
            run = { steps = 1 }
        "#;
        let scene = Scene::from_toml(text, Path::new("."), "cube").unwrap();
        let setup = block_setup(&scene).unwrap().setup;
        let blocks = Blocks::new(setup.clone()).unwrap();
        Block {
            number: 0,
            name: "cube".into(),
            supports: Supports::of(&setup, &blocks, 0),
            buoyancy: DVec3::Z * 10.0,
        }
    }

    #[test]
    fn a_cube_slides_tips_or_floats_up_where_it_should() {
        let cube = cube();
        let fails = |x: f64, z: f64, torque: f64| {
            let force = cube.buoyancy + DVec3::new(x, 0.0, z);
            cube.fails([force, DVec3::Y * torque]).unwrap()
        };
        // 17 N press on the plane: t x = (17 − t z) tan 30°.
        let tan = 30f64.to_radians().tan();
        let (times, mode) = fails(2.0, 1.0, 0.0);
        assert_eq!(mode, "sliding");
        assert_near(times, 17.0 * tan / (2.0 + tan), 1e-6);
        let (times, mode) = fails(0.0, 2.0, 0.0);
        assert_eq!(mode, "uplift");
        assert_near(times, 8.5, 1e-6);
        // 17 N with a lever of 0.05 m about the edge hold it.
        let (times, mode) = fails(0.0, 0.0, 0.5);
        assert_eq!(mode, "toppling");
        assert_near(times, 1.7, 1e-6);
        assert!(cube.fails([cube.buoyancy, DVec3::ZERO]).is_none());
    }

    #[test]
    fn the_value_goes_with_the_root_of_the_loads() {
        let cube = cube();
        let load = |x: f64| vec![[cube.buoyancy + DVec3::X * x, DVec3::ZERO]];
        let early = (0..10).map(|_| load(100.0));
        let late = (0..10).map(|n| load(2.0 + 0.1 * f64::from(n % 2)));
        let loads = Loads {
            samples: early.chain(late).collect(),
            blocks: vec![cube],
        };
        let found = loads.equilibrium(3.0).unwrap();
        assert_eq!((found.mode, found.samples), ("sliding", 10));
        let square = 17.0 * 30f64.to_radians().tan() / 2.05;
        assert_near(found.value, 3.0 * square.sqrt(), 1e-5);
        assert!(found.error.unwrap() < 1e-9);
    }
}
