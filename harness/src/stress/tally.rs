//! Energy of fluid and blocks, which cannot grow without forces.

use super::Cell;
use crate::validate::tank::Tank;
use anyhow::Context;
use glam::DVec3;

/// Totals of fluid and blocks, in the units of the tank.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    /// Mass of the fluid.
    pub mass: f64,
    /// Momentum of fluid and blocks.
    pub momentum: DVec3,
    /// Σ |m v| of the blocks, which they can exchange.
    pub carried: f64,
    /// Kinetic energy of fluid and blocks, without rotation.
    pub kinetic: f64,
    /// Largest speed of the fluid.
    pub flow_speed: f64,
    /// Largest speed of a block.
    pub block_speed: f64,
}

impl Tally {
    /// Totals of a tank whose fluid has the density 1 and whose free blocks have `ratio`.
    ///
    /// The water inside a block moves with the block and is no load on it, so it counts once, in the fluid.
    pub fn of(tank: &mut Tank<'_>, ratio: f64) -> anyhow::Result<Self> {
        let totals = tank.totals()?;
        let coupled = tank.simulation.coupled();
        let blocks = coupled.context("the tank has no blocks")?.blocks();
        let mut tally = Self {
            mass: totals.mass,
            momentum: DVec3::from(totals.momentum),
            kinetic: totals.kinetic_energy,
            flow_speed: totals.max_speed,
            ..Self::default()
        };
        for (block, pose) in blocks.poses().iter().enumerate() {
            let speed = pose.velocity.length();
            tally.block_speed = tally.block_speed.max(speed);
            if !blocks.moves(block) {
                continue;
            }
            let mass = blocks.mass(block) * (1.0 - 1.0 / ratio);
            tally.momentum += mass * pose.velocity;
            tally.carried += mass.abs() * speed;
            tally.kinetic += 0.5 * mass * speed * speed;
        }
        Ok(tally)
    }
}

/// Largest values during a run.
#[derive(Clone, Copy, Debug, Default)]
pub struct Peaks {
    /// Kinetic energy over that at the start.
    pub energy: f64,
    /// Largest speed of a block.
    pub block_speed: f64,
    /// Largest speed of the fluid.
    pub flow_speed: f64,
}

impl Peaks {
    /// Runs `steps` steps in `looks` equal parts and records the step in `cell`; `ratio` as for [`Tally::of`].
    pub fn of(
        tank: &mut Tank<'_>,
        ratio: f64,
        [steps, looks]: [u64; 2],
        cell: &mut Cell,
    ) -> anyhow::Result<Self> {
        let start = Tally::of(tank, ratio)?;
        let mut peaks = Self::default();
        for _ in 0..looks {
            let done = tank.advance(steps / looks);
            cell.steps = tank.simulation.step();
            done?;
            let now = Tally::of(tank, ratio)?;
            peaks.energy = peaks.energy.max(now.kinetic / start.kinetic);
            peaks.block_speed = peaks.block_speed.max(now.block_speed);
            peaks.flow_speed = peaks.flow_speed.max(now.flow_speed);
        }
        Ok(peaks)
    }
}
