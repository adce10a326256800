//! Steps of several worlds in turns.

use super::world::World;
use crate::{bench::report::Machine, gpu};
use cpu_time::ProcessTime;
use riprap::{simulation::Simulation, wgpu};
use std::time::{Duration, Instant};

/// A hanging driver is given up after this.
const PATIENCE: Duration = Duration::from_secs(300);

/// How turns are taken.
pub struct Turns {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    /// Cores of a software adapter: CPU time over them is what counts there.
    cores: Option<f64>,
    pub rounds: usize,
    long: f64,
}

/// Seconds of a step of each world in each round.
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

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

impl Turns {
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        machine: &Machine,
        rounds: usize,
        long: f64,
    ) -> Self {
        Self {
            device: device.clone(),
            queue: queue.clone(),
            cores: machine.software.then_some(machine.cores as f64),
            rounds,
            long,
        }
    }

    /// Seconds of `work`.
    ///
    /// # Errors
    /// Those of `work`.
    pub fn time(&self, work: impl FnOnce() -> anyhow::Result<()>) -> anyhow::Result<f64> {
        let (cpu, wall) = (ProcessTime::now(), Instant::now());
        work()?;
        Ok(match self.cores {
            Some(cores) => cpu.elapsed().as_secs_f64() / cores,
            None => wall.elapsed().as_secs_f64(),
        })
    }

    /// Makes the worlds and steps them in turns.
    ///
    /// # Errors
    /// If the device fails.
    pub fn measure(&self, worlds: &mut [World]) -> anyhow::Result<Times> {
        let mut steps = Vec::new();
        for world in worlds.iter_mut() {
            let made = Simulation::new(&self.device, &self.queue, &world.scene);
            let made = gpu::drive(&self.device, PATIENCE, "the kernels", made)??;
            world.simulation = Some(made);
            // The first ones compile, and blocks find their tiles.
            self.steps(world, 4)?;
            let begin = Instant::now();
            self.steps(world, 2)?;
            let seconds = begin.elapsed().as_secs_f64() / 2.0;
            steps.push(((self.long / seconds) as u64).clamp(2, 200));
        }
        // The same number for all: what a submission costs is then the same part of each.
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

    fn steps(&self, world: &mut World, steps: u64) -> anyhow::Result<()> {
        if let Some(simulation) = &mut world.simulation {
            let done = simulation.advance(steps);
            gpu::drive(&self.device, PATIENCE, "blocks in a fluid", done)??;
        }
        Ok(())
    }

    /// Waits until the device has done what was submitted.
    ///
    /// # Errors
    /// If it does not.
    pub fn wait(&self) -> anyhow::Result<()> {
        self.device.poll(wgpu::PollType::Wait {
            submission_index: None,
            timeout: Some(PATIENCE),
        })?;
        Ok(())
    }
}
