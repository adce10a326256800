//! A hundred blocks that fill three tenths of a periodic box, for a long time: conservation, repeatability, and growth of memory.

use super::{Cell, Map, Outcome, Sink, tally::Tally};
use crate::validate::{
    CaseContext, fields,
    tank::{self, Tank, block, numbers, turn},
};
use riprap::scene::{BlockShape, Motion, Scene};
use std::time::Instant;

/// The map.
pub const MAP: Map = Map {
    name: "long",
    title: "Blocks fill 0.3 of a periodic box, τ = 0.55, density 2.65",
    x: "step",
    y: "",
    short: "27 blocks in 30³ cells, 400 steps",
    full: "100 blocks in 50 × 50 × 40 cells, 10 000 steps",
    run,
};

const FRACTION: f64 = 0.3;
const RATIO: f64 = 2.65;
/// Speed of the stream and of the blocks, cells per step: Mach 0.1 in all.
const SPEED: f64 = 0.03;
/// Distance from a block to the next, cells.
const SPACING: u32 = 10;
/// Limit on the momentum lost over that carried by the blocks; the same as for three blocks over 300 steps.
const MOMENTUM: f64 = 1e-2;
/// Limit on the drift of the mass: round-off of f32 in random directions.
const MASS: f64 = 1e-6;
/// Limit on the growth of the process in the second half, while nothing is added to the run.
const GROWTH: f64 = 0.05;

fn scene(rows: [u32; 3]) -> anyhow::Result<Scene> {
    let mut scene = tank::scene(rows.map(|n| n * SPACING), 0.55)?;
    scene.numerics.velocity_scale = Some(2.0 * SPEED);
    scene.initial.velocity = numbers([0.0, 0.0, SPEED]);
    scene.materials[0].density = RATIO;
    // Blocks that collide corner first at twice their speed penetrate by 2 % of their edge.
    scene.materials[0].normal_stiffness = 10.0;
    scene.rock.corner_area = 0.25;
    let edge = f64::from(SPACING) * FRACTION.cbrt();
    let [nx, ny, nz] = rows;
    for n in 0..nx * ny * nz {
        let at = [n % nx, n / nx % ny, n / (nx * ny)];
        let shape = BlockShape::Box { size: [edge; 3] };
        let place = at.map(|k| f64::from(SPACING) * (f64::from(k) + 0.5));
        let mut cube = block(shape, place, Motion::Free);
        cube.velocity = numbers([0, 1, 2].map(|a| SPEED * fields::noise(3 * n + a)));
        // Rotated by so little that neighbours do not touch at the start.
        cube.rotation = turn(n);
        cube.rotation.angle = 10.0 * fields::noise(n);
        scene.blocks.push(cube);
    }
    Ok(scene)
}

fn run(context: &CaseContext, sink: &mut Sink) -> anyhow::Result<()> {
    let (rows, parts, steps) = match context.full {
        true => ([5, 5, 4], 10, 1000),
        false => ([3; 3], 4, 100),
    };
    let scene = scene(rows)?;
    let mut tank = Tank::fill(context, &scene)?;
    let before = Tally::of(&mut tank, RATIO)?;
    // Pools of the driver and of the allocator fill in the first half: what grows afterwards grows without end.
    let mut warm = (None, 0);
    for part in 1..=parts {
        let begin = Instant::now();
        if let Err(error) = tank.advance(steps - 1) {
            let mut cell = cell(&tank, "run", begin);
            cell.end(Err(error))?;
            return sink.add(cell);
        }
        let sizes = (resident(), buffers(&tank));
        let first = Tally::of(&mut tank, RATIO)?;
        tank.advance(1)?;
        let now = Tally::of(&mut tank, RATIO)?;
        // The populations reflected by cells inside blocks alternate with a period of two steps.
        let drift = 0.5 * (first.momentum + now.momentum) - before.momentum;
        let lost = drift.length() / before.carried.max(now.carried);
        let mass = (now.mass / before.mass - 1.0).abs();
        let energy = now.kinetic / before.kinetic;
        let mut report = |name: &str, value: f64, limit: f64, detail: String| {
            sink.add(judged(cell(&tank, name, begin), value, limit, detail))
        };
        let text = format!("{drift} of {}", before.momentum);
        report("momentum lost / carried by blocks", lost, MOMENTUM, text)?;
        report("drift of the mass", mass, MASS, String::new())?;
        report("energy / that of the start", energy, 1.0, String::new())?;
        if 2 * part <= parts {
            warm = sizes;
        }
        let (process, device) = warm;
        if let (Some(from), Some(to)) = (process, sizes.0) {
            let growth = to as f64 / from as f64 - 1.0;
            let text = format!("{from} to {to} bytes");
            report("growth of the process", growth, GROWTH, text)?;
        }
        let growth = sizes.1 as f64 / device as f64 - 1.0;
        let text = format!("{device} to {} bytes of the blocks on the device", sizes.1);
        // Buffers grow by half as blocks reach more bricks, at most to all bricks.
        report("growth of the buffers", growth, 0.5, text)?;
    }
    repeats(context, &scene, steps, sink)
}

fn cell(tank: &Tank<'_>, name: &str, begin: Instant) -> Cell {
    let steps = tank.simulation.step();
    Cell {
        steps,
        warned: super::warned(tank.simulation.advice()),
        seconds: begin.elapsed().as_secs_f64(),
        ..Cell::new(MAP.name, "", name.into(), steps.to_string(), "as named")
    }
}

fn judged(cell: Cell, value: f64, limit: f64, detail: String) -> Cell {
    Cell {
        // NaN exceeds any limit.
        outcome: if value <= limit {
            Outcome::Ended
        } else {
            Outcome::OverLimit
        },
        value: Some(value),
        detail,
        ..cell
    }
}

/// Runs the first part twice more and compares the states.
fn repeats(
    context: &CaseContext,
    scene: &Scene,
    steps: u64,
    sink: &mut Sink,
) -> anyhow::Result<()> {
    let begin = Instant::now();
    let once = || -> anyhow::Result<_> {
        let mut tank = Tank::fill(context, scene)?;
        tank.advance(steps)?;
        // Everything that the next steps depend on.
        let state = context.drive("the state", tank.simulation.checkpoint())??;
        let mut bytes = Vec::new();
        state.write_to(&mut bytes)?;
        let name = "bytes that differ in a second run";
        Ok((bytes, cell(&tank, name, begin)))
    };
    let ((first, _), (second, cell)) = (once()?, once()?);
    let differ = super::bytes_that_differ(&first, &second) as f64;
    sink.add(judged(cell, differ, 0.0, format!("of {}", first.len())))
}

/// Bytes that blocks take on the device.
fn buffers(tank: &Tank<'_>) -> u64 {
    let lattice = tank.lattice();
    let saturation: u64 = lattice.psm_planes().map(|(_, buffer)| buffer.size()).sum();
    let blocks = tank
        .simulation
        .coupled()
        .map_or(0, |c| c.solid_cells().bytes());
    saturation + blocks
}

/// Resident memory of the process, bytes, if the system reports it.
fn resident() -> Option<u64> {
    resident_of(&std::fs::read_to_string("/proc/self/status").ok()?)
}

fn resident_of(status: &str) -> Option<u64> {
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1024 * kib)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_fill_what_they_should_and_start_apart() {
        for rows in [[3; 3], [5, 5, 4]] {
            let scene = scene(rows).unwrap();
            scene.check().unwrap();
            let count: u32 = rows.iter().product();
            assert_eq!(scene.blocks.len() as u32, count);
            let cells: u32 = scene.cells().iter().product();
            let BlockShape::Box { size } = &scene.blocks[0].shape else {
                unreachable!()
            };
            let share = f64::from(count) * size[0].powi(3) / f64::from(cells);
            assert!((share - FRACTION).abs() < 1e-12);
        }
    }

    #[test]
    fn the_size_of_a_process_is_read_from_its_status() {
        let status = "Name:\triprap\nVmPeak:\t  900 kB\nVmRSS:\t   512 kB\n";
        assert_eq!(resident_of(status), Some(512 * 1024));
        assert_eq!(resident_of("Name:\triprap\n"), None);
    }
}
