//! The lattice and its coupling to blocks in the summary of a run.

use super::{recorder::RunLog, scene_run::SceneRun, throughput::Throughput};
use riprap::{
    Result,
    coupling::Exchanges,
    lattice::{bytes_per_cell, bytes_per_step},
    scene::HIGH_MACH,
    simulation::Simulation,
};
use serde::Serialize;
use std::fmt;

/// Relative difference of the bulk velocity from the prescribed one at the end of a run that needs no warning.
const BULK_TOLERANCE: f64 = 0.02;

/// Cells, kernel and speed of a run.
#[derive(Clone, Debug, Default, Serialize)]
pub struct LatticeSummary {
    /// Cells along x, y, z.
    pub cells: [u32; 3],
    /// Cells that are not solid.
    pub fluid_cells: u64,
    /// Edge of a cell, m.
    pub cell: f64,
    /// Relaxation time, in time steps.
    pub tau: f64,
    /// Collision operator, storage and lanes of the kernel.
    pub kernel: String,
    /// Million updates of fluid cells per second, without output.
    pub mlups: f64,
    /// Copy bandwidth of the device, read and written bytes per second.
    pub bandwidth: f64,
    /// Bytes that a step moves per fluid cell away from walls.
    #[serde(rename = "bytes_a_cell")]
    pub bytes_per_cell: u64,
    /// Bytes that a step moves in all.
    #[serde(rename = "bytes_a_step")]
    pub bytes_per_step: u64,
    /// Fraction of that bandwidth that the steps use.
    pub bandwidth_share: f64,
    /// Largest observed Mach number of the lattice.
    pub max_mach: f64,
}

impl LatticeSummary {
    /// The properties of the lattice of `run` before the first step, if it has one.
    pub fn of(run: &SceneRun) -> Result<Option<Self>> {
        let Some((lattice, units)) = run.lattice() else {
            return Ok(None);
        };
        let setup = lattice.setup();
        Ok(Some(Self {
            cells: run.scene().cells(),
            fluid_cells: lattice.geometry().fluid_cells,
            cell: units.cell,
            tau: setup.tau(),
            kernel: format!(
                "{:?} {:?} {:?} lanes {}{}",
                setup.collision,
                setup.equilibrium,
                setup.storage,
                setup.lanes,
                if setup.wale.is_some() { " Wale" } else { "" }
            ),
            bandwidth: run.bandwidth()?,
            bytes_per_cell: bytes_per_cell(setup),
            bytes_per_step: bytes_per_step(setup, lattice.grid(), lattice.geometry()),
            ..Self::default()
        }))
    }

    /// Adds the speed of the steps so far, once kernels are compiled.
    pub fn at_speed(&self, throughput: &Throughput) -> Self {
        let warm = throughput.warm();
        let rate = warm.rate(warm.steps);
        Self {
            mlups: rate * self.fluid_cells as f64 / 1e6,
            bandwidth_share: rate * self.bytes_per_step as f64 / self.bandwidth,
            ..self.clone()
        }
    }

    /// A warning if the fluid became faster than the time step is for.
    pub fn warning(&self, run: &SceneRun, log: &RunLog) -> Option<String> {
        let (mach, fastest) = (self.max_mach, log.max_speed);
        let numerics = &run.scene().numerics;
        let (key, remedy) = if numerics.time_step.is_some() {
            let shorter = run.time_step() * HIGH_MACH / mach;
            ("time_step", format!("time_step ≤ {shorter:.3e} s"))
        } else {
            ("velocity_scale", format!("velocity_scale = {fastest:.3e}"))
        };
        (mach > HIGH_MACH).then(|| {
            format!(
                "numerics.{key}: the largest speed of the fluid, {fastest:.3e} m/s, has the Mach number {mach:.3} on the lattice, \
                 above {HIGH_MACH}: errors of compressibility near {:.1} %; use {remedy}",
                100.0 * mach * mach,
            )
        })
    }

    /// A warning if the bulk velocity is not the prescribed one.
    pub fn flow_warning(run: &mut SceneRun) -> Option<String> {
        let (axis, prescribed) = run.scene().fluid.kept_velocity()?;
        // If the device is lost, the run has already reported the error.
        let found = run.totals().ok()?.bulk_velocity;
        ((found - prescribed).abs() > BULK_TOLERANCE * prescribed.abs()).then(|| {
            format!(
                "fluid.bulk_velocity: the mean velocity along {} is {found:.4e} m/s at the end instead of {prescribed} m/s; results \
                 are those of a flow that still changes: run longer, or start from initial.velocity",
                ["x", "y", "z"][axis]
            )
        })
    }

    /// The summary at the end of `run`.
    pub fn finished(&self, run: &SceneRun, log: &RunLog, throughput: &Throughput) -> Self {
        let units = run.simulation.units();
        // Other processes may have kept the device busy during the first measurement.
        let again = run.bandwidth().unwrap_or_default();
        let found = Self {
            bandwidth: self.bandwidth.max(again),
            max_mach: units.map_or(0.0, |units| units.mach(log.max_speed)),
            ..self.clone()
        };
        found.at_speed(throughput)
    }
}

impl fmt::Display for LatticeSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "  {:.1} MLUPS, {:.0} % of the {:.1} GB/s that the device copies; largest Mach number {:.3}",
            self.mlups,
            100.0 * self.bandwidth_share,
            self.bandwidth / 1e9,
            self.max_mach
        )
    }
}

/// Work of the coupling of a run, and work that it skipped.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Coupling {
    /// Blocks in the fluid; the others are its solids.
    pub in_fluid: usize,
    /// Convex parts of blocks in lanes of bricks at the end.
    pub tiles: usize,
    /// Bricks of the lattice that blocks reach at the end.
    pub saturated_bricks: usize,
    /// Bricks without walls that no block reaches.
    pub plain_bricks: usize,
    /// Bricks with walls or solids that no block reaches.
    pub mixed_bricks: usize,
    /// Tiles whose solid fractions were computed, all steps together.
    pub tiles_computed: u64,
    /// Lanes of bricks whose saturation was computed, all steps together.
    pub lanes_computed: u64,
    /// Number of searches for the tiles of blocks.
    pub searches: u64,
    /// Number of steps whose loads were read back.
    pub readings: u64,
    /// Steps of this run whose loads were not needed.
    pub readings_skipped: u64,
    /// Bytes of the blocks on the device, without the saturation of their bricks.
    pub bytes: u64,
}

impl Coupling {
    /// The coupling of `simulation`, if it has blocks, after `steps` of this run.
    pub fn of(simulation: &Simulation, steps: u64) -> Option<Self> {
        let coupled = simulation.coupled()?;
        let cells = coupled.solid_cells();
        let geometry = simulation.lattice()?.geometry();
        let solid_bricks = cells.bricks();
        let others = |list: &[u32]| {
            let reached = |brick: &&u32| solid_bricks.binary_search(brick).is_err();
            list.iter().filter(reached).count()
        };
        let Exchanges {
            readings,
            cells: work,
        } = coupled.exchanges();
        Some(Self {
            in_fluid: coupled.in_fluid(),
            tiles: cells.tiles(),
            saturated_bricks: solid_bricks.len(),
            plain_bricks: others(&geometry.plain),
            mixed_bricks: others(&geometry.mixed) + others(&geometry.surface),
            tiles_computed: work.tiles,
            lanes_computed: work.lanes,
            searches: work.searches,
            readings,
            readings_skipped: steps.saturating_sub(readings),
            bytes: cells.bytes(),
        })
    }

    /// The numbers of bricks by kind, in words.
    pub fn kinds(&self) -> String {
        format!(
            "{} tiles in {} bricks with blocks, {} mixed and {} plain ones without",
            self.tiles, self.saturated_bricks, self.mixed_bricks, self.plain_bricks
        )
    }
}

impl fmt::Display for Coupling {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let steps = (self.readings + self.readings_skipped).max(1) as f64;
        write!(
            f,
            "  {} blocks in the fluid: {}; a step computed {:.1} tiles and {:.1} lanes of bricks anew, in {} \
             searches; {} loads read back, {} steps without",
            self.in_fluid,
            self.kinds(),
            self.tiles_computed as f64 / steps,
            self.lanes_computed as f64 / steps,
            self.searches,
            self.readings,
            self.readings_skipped
        )
    }
}
