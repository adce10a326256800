//! The whole table: storage × kind of step × grid size, each row within a time budget.

use super::{
    Bench, copy_bandwidth,
    fluid::{plain, storage as name_of},
    solids::{crowd, unit_frame},
};
use glam::{DQuat, DVec3};
use kit::{clock::Clock, gpu, subject::Subject};
use riprap::{
    Error, Result,
    geometry::{Pose, Shape},
    gpu::{kernel::submit_pass, readback::Readback},
    lattice::{
        Grid, Lattice, Memory, Setup, SolidOperator, State, Storage, bytes_per_cell, memory,
    },
    psm::{SolidBlock, SolidCells},
    wgpu,
};
use serde::Serialize;
use std::{fmt, sync::Arc, time::Duration, time::Instant};

/// Extent of the table.
#[derive(Clone, Copy, Debug)]
pub struct Extent {
    /// Cells per axis.
    pub grids: &'static [u32],
    /// Seconds that a row may take, including the creation of the lattice.
    pub row: f64,
    /// Seconds that the whole table may take.
    pub whole: f64,
}

impl Extent {
    /// The whole table.
    pub const ALL: Self = Self {
        grids: &[128, 192, 256, 384, 512],
        row: 15.0,
        whole: 480.0,
    };
}

/// Largest number of bytes copied to measure the copy bandwidth.
const COPIED: u64 = 256 << 20;
/// Duration of the timed steps, s.
const LONG: f64 = 1.5;
/// Largest number of steps per row.
const MOST: u32 = 500;
/// Silence of a device after which it counts as hung.
const PATIENCE: Duration = Duration::from_secs(120);
/// Cells across the spheres of the coupled rows, which fill a tenth of the volume.
const ACROSS: f64 = 16.0;

/// Kind of step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// Collide and stream.
    Plain,
    /// With eddy viscosity.
    Wale,
    /// With moving spheres in a tenth of the volume, whose loads the host reads in every step.
    Coupled,
}

/// A row of the table.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Kind of record: `table`.
    pub part: &'static str,
    /// Kind of step.
    pub kind: Kind,
    /// Cells per axis.
    pub grid: u32,
    /// Storage of the populations.
    pub storage: &'static str,
    /// Million cells per second: by CPU time on a software adapter, by GPU time elsewhere, in coupled rows by wall time.
    pub mlups: Option<f64>,
    /// Bytes of populations per second, at that speed.
    pub bandwidth: Option<f64>,
    /// That bandwidth over the copy bandwidth of the device, read and written.
    pub share_of_copy: Option<f64>,
    /// Steps that were timed.
    pub steps: u32,
    /// Seconds that the row took.
    pub seconds: f64,
    /// Why the row was left out, if it was.
    pub left_out: Option<String>,
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let head = format!(
            "{:<8} {:>5} {:>5}³",
            format!("{:?}", self.kind),
            self.storage,
            self.grid
        );
        match (&self.left_out, self.mlups, self.bandwidth) {
            (Some(why), ..) => write!(f, "{head} | left out: {why}"),
            (None, Some(mlups), Some(bandwidth)) => write!(
                f,
                "{head} | {mlups:>9.1} {:>9.1} {:>7.1}% {:>6} {:>7.1}",
                bandwidth / 1e9,
                100.0 * self.share_of_copy.unwrap_or_default(),
                self.steps,
                self.seconds
            ),
            _ => write!(f, "{head} | not measured"),
        }
    }
}

/// Measures all rows and prints them as they are done.
pub fn measure(bench: &Bench<'_>, budget: Option<u64>, extent: Extent) -> Result<Vec<Row>> {
    let copied = copy_bandwidth(bench.device, bench.queue, COPIED)?;
    println!(
        "\nthe device copies {:.1} GB/s\nkind     store   grid |     MLUPS      GB/s of copies  steps       s",
        copied / 1e9
    );
    let mut clock = bench.clock();
    let mut rows: Vec<Row> = Vec::new();
    let whole = Instant::now();
    for storage in [Storage::F32, Storage::F16] {
        for kind in [Kind::Plain, Kind::Wale, Kind::Coupled] {
            for &grid in extent.grids {
                let mut row = Row {
                    part: "table",
                    kind,
                    grid,
                    storage: name_of(storage),
                    mlups: None,
                    bandwidth: None,
                    share_of_copy: None,
                    steps: 0,
                    seconds: 0.0,
                    left_out: None,
                };
                let begin = Instant::now();
                let setup = setup(grid, storage, kind, bench);
                let held = holds(&setup, bench.device, budget);
                let over = whole.elapsed().as_secs_f64() > extent.whole - extent.row;
                row.left_out = held
                    .err()
                    .or_else(|| too_long(&rows, &row, extent.row))
                    .or_else(|| {
                        over.then(|| format!("the {:.0} s of the table are over", extent.whole))
                    });
                if row.left_out.is_none() {
                    match run(&mut clock, setup.clone(), kind) {
                        Ok((spent, steps)) => {
                            let speed = f64::from(grid).powi(3) / spent;
                            row.mlups = Some(speed / 1e6);
                            let bandwidth = speed * bytes_per_cell(&setup) as f64;
                            row.bandwidth = Some(bandwidth);
                            row.share_of_copy = Some(bandwidth / copied);
                            row.steps = steps;
                        }
                        Err(error @ (Error::Device(_) | Error::Limit { .. })) => {
                            row.left_out = Some(error.to_string());
                        }
                        Err(error) => return Err(error),
                    }
                }
                row.seconds = begin.elapsed().as_secs_f64();
                println!("{row}");
                rows.push(row);
            }
        }
    }
    Ok(rows)
}

fn setup(grid: u32, storage: Storage, kind: Kind, bench: &Bench<'_>) -> Setup {
    let software = bench.machine.software;
    let lanes = match (software, storage) {
        (true, _) => 4,
        (false, Storage::F32) => 1,
        (false, Storage::F16) => 2,
    };
    let mut setup = plain(grid, storage, lanes, software, bench.device);
    match kind {
        Kind::Plain => {}
        Kind::Wale => setup.wale = Some(0.5),
        Kind::Coupled => setup.solid_operator = Some(SolidOperator::Holdych),
    }
    if !software {
        // The bricks depend on the features of the setup.
        setup.use_gpu_layout();
    }
    setup
}

/// Whether the lattice fits the adapter's limits and the memory budget.
fn holds(setup: &Setup, device: &wgpu::Device, budget: Option<u64>) -> Result<(), String> {
    let limits = device.limits();
    let need = Grid::new(setup).and_then(|grid| memory(setup, &grid, &limits));
    let Memory {
        populations,
        others,
        ..
    } = need.map_err(|error| error.to_string())?;
    let gib = |bytes: u64| bytes as f64 / 2f64.powi(30);
    match budget {
        Some(most) if populations + others > most => Err(format!(
            "takes {:.1} GiB of the {:.1} allowed; use --memory",
            gib(populations + others),
            gib(most)
        )),
        _ => Ok(()),
    }
}

/// Whether the row would take too long, scaled from the previous row by the number of cells.
fn too_long(rows: &[Row], row: &Row, budget: f64) -> Option<String> {
    let alike = |other: &&Row| other.kind == row.kind && other.storage == row.storage;
    let last = rows.iter().rev().find(alike)?;
    if last.left_out.is_some() {
        return Some(format!("{}³ was", last.grid));
    }
    let cells = |grid: u32| f64::from(grid).powi(3);
    // An upper bound: costs that do not grow with the cells are scaled too.
    let seconds = (last.seconds - LONG).max(0.0) * cells(row.grid) / cells(last.grid) + LONG;
    (seconds > budget).then(|| format!("would take {seconds:.0} s of the {budget:.0} of a row"))
}

/// Seconds per step, and number of timed steps.
fn run(clock: &mut Clock, setup: Setup, kind: Kind) -> Result<(f64, u32)> {
    let (device, queue) = (clock.device.clone(), clock.queue.clone());
    let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let validity = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let made = make(&device, &queue, setup);
    let refused = gpu::drive(&device, PATIENCE, "the memory", async {
        let validity = validity.pop().await;
        validity.or(memory.pop().await)
    })?;
    let lattice = made?;
    if let Some(error) = refused {
        return Err(Error::Device(format!("out of memory: {error}")));
    }
    if kind == Kind::Coupled {
        return coupled(clock, lattice);
    }
    let mut subject = Subject::Steps(Box::new(lattice));
    clock.run(&mut subject, 2)?;
    let steps = number(clock.run(&mut subject, 2)?.spent.wall);
    Ok((clock.run(&mut subject, steps)?.basis, steps))
}

/// Steps that fill the time; an even number, since a lattice steps in pairs.
fn number(seconds: f64) -> u32 {
    ((LONG / seconds) as u32).clamp(2, MOST).next_multiple_of(2)
}

fn make(device: &wgpu::Device, queue: &wgpu::Queue, setup: Setup) -> Result<Lattice> {
    let grid = Grid::new(&setup)?;
    let mut state = State::rest(grid.cell_count());
    // A simple flow in every cell: at rest, denormal numbers would slow a CPU down.
    for (n, (u, v)) in state.velocity[0]
        .iter_mut()
        .zip(&mut state.excess)
        .enumerate()
    {
        (*u, *v) = (0.02 + 1e-3 * (n % 7) as f32, 1e-4 * (n % 5) as f32);
    }
    for n in 0..2 {
        for (k, u) in state.velocity[1 + n].iter_mut().enumerate() {
            *u = 1e-3 * (k % (9 + n)) as f32;
        }
    }
    let mut lattice = Lattice::new(device, setup)?;
    lattice.start(device, queue, &state, true)?;
    Ok(lattice)
}

/// The loop of a caller that moves bodies: poses in, a step, loads out.
fn coupled(clock: &mut Clock, mut lattice: Lattice) -> Result<(f64, u32)> {
    let (device, queue) = (clock.device.clone(), clock.queue.clone());
    let cells = lattice.grid().cells[0];
    let places = crowd(cells, ACROSS, 0.1);
    let shape: Arc<Shape> = Arc::new(Shape::sphere(0.5 * ACROSS)?);
    let submerged = places.iter().map(|_| SolidBlock::new(shape.clone()));
    let mut immersed = SolidCells::new(&device, &lattice, unit_frame(), submerged.collect())?;
    let velocity = DVec3::new(0.0, 0.02, 0.0);
    let (mut step, mut readback) = (0.0, Readback::default());
    let mut steps = |count: u32| -> Result<()> {
        for _ in 0..count {
            step += 1.0;
            let pose = |place: &[f64; 3]| {
                let centre = DVec3::from(*place) + step * velocity;
                Pose::rigid(centre, DQuat::IDENTITY, velocity, DVec3::ZERO)
            };
            let poses: Vec<_> = places.iter().map(pose).collect();
            immersed.place(&device, &queue, &mut lattice, &poses)?;
            submit_pass(&device, &queue, |pass| {
                immersed.record_cells(pass);
                lattice.record_psm(pass);
                immersed.record_loads(pass);
            });
            submit_pass(&device, &queue, |pass| lattice.record_rest(pass));
            let (sums, count) = (immersed.wrenches(), immersed.wrench_count());
            let read = readback.read(&device, &queue, sums, count);
            let read: Vec<f32> = gpu::drive(&device, PATIENCE, "the loads", read)??;
            immersed.loads(&read)?;
        }
        Ok(())
    };
    steps(2)?;
    let count = number(0.5 * clock.time(|| steps(2))?.wall);
    let spent = clock.time(|| steps(count))?;
    Ok((clock.basis(spent) / f64::from(count), count))
}
