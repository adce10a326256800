//! Steps of free water on every adapter, or on the one whose name contains `$RIPRAP_ADAPTER`: a cube of water in a
//! tank, of some thousand to a million particles (`$RIPRAP_PARTICLES` names other numbers of them along an edge).
//!
//! Times are CPU time over the cores on software adapters, wall time on others. Pairs are those within the support,
//! each counted once for each of its two ends, as the kernels meet them.

#[allow(dead_code)] // The harness uses more of it than benches do.
#[path = "../harness/src/gpu.rs"]
mod gpu;

use cpu_time::ProcessTime;
use criterion::{BenchmarkId, Criterion, Throughput};
use glam::{DMat3, DVec3};
use riprap::{
    bodies::Pose,
    particles::{Body, Neighbours, Particles, Setup, Side},
    wgpu,
};
use std::time::{Duration, Instant};

/// Particles along an edge.
const EDGES: [u32; 2] = [20, 40];
/// Steps between two looks at the clock.
const STEPS: u32 = 4;

fn main() -> Result<(), riprap::Error> {
    let mut criterion = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_secs(2))
        .configure_from_args();
    let wanted = std::env::var("RIPRAP_ADAPTER").unwrap_or_default();
    let edges = std::env::var("RIPRAP_PARTICLES").unwrap_or_default();
    let edges: Vec<u32> = edges
        .split(',')
        .filter_map(|edge| edge.trim().parse().ok())
        .collect();
    let edges = if edges.is_empty() {
        EDGES.to_vec()
    } else {
        edges
    };
    let mut rows = Vec::new();
    for adapter in gpu::adapters() {
        let name = gpu::describe(&adapter.get_info());
        if name.to_lowercase().contains(&wanted.to_lowercase()) {
            for &edge in &edges {
                rows.push(bench(&mut criterion, &adapter, &name, edge)?);
            }
        }
    }
    criterion.final_summary();
    println!("\nFastest of the samples");
    for row in rows {
        println!("{row}");
    }
    Ok(())
}

fn bench(
    criterion: &mut Criterion,
    adapter: &wgpu::Adapter,
    name: &str,
    edge: u32,
) -> Result<String, riprap::Error> {
    let (device, queue) = gpu::open(adapter, wgpu::Features::empty(), adapter.limits())?;
    let software = gpu::is_software(&adapter.get_info());
    let (mut setup, positions) = tank(edge);
    if software {
        setup.neighbours = Neighbours::Lists;
    }
    let pressures: Vec<f64> = positions
        .iter()
        .map(|x| setup.density * 9.81 * (setup.size.z - x.z))
        .collect();
    let still = vec![DVec3::ZERO; positions.len()];
    let mut particles = Particles::new(
        &device,
        &queue,
        setup.clone(),
        &positions,
        &still,
        &pressures,
    )?;
    let pose = Pose {
        centre: DVec3::ZERO,
        deformation: DMat3::IDENTITY,
        velocity: DVec3::ZERO,
        deformation_rate: DMat3::ZERO,
    };
    let (water, walls) = pairs(&setup, &positions);
    let mut best = f64::INFINITY;
    let mut group = criterion.benchmark_group("particles");
    group.throughput(Throughput::Elements(
        positions.len() as u64 * u64::from(STEPS),
    ));
    group.bench_function(
        BenchmarkId::new(positions.len().to_string(), name),
        |bencher| {
            bencher.iter_custom(|iterations| {
                let mut total = 0.0;
                for _ in 0..iterations {
                    let (cpu, wall) = (ProcessTime::now(), Instant::now());
                    let time = particles.limit() * f64::from(STEPS) * 0.999;
                    let poses = [pose];
                    let done = particles.advance(&device, &queue, &poses, time);
                    let done = gpu::drive(&device, Duration::from_secs(300), "a step", done);
                    let steps = match done {
                        Ok(Ok(done)) => f64::from(done.steps),
                        Ok(Err(error)) | Err(error) => panic!("{name}: {error}"),
                    };
                    let cores = std::thread::available_parallelism().map_or(1, usize::from);
                    let spent = match software {
                        true => cpu.elapsed().as_secs_f64() / cores as f64,
                        false => wall.elapsed().as_secs_f64(),
                    };
                    best = best.min(spent / steps);
                    total += spent / steps * f64::from(STEPS);
                }
                Duration::from_secs_f64(total).max(Duration::from_nanos(1))
            });
        },
    );
    group.finish();
    // Momentum and continuity each meet all pairs, the pressure of walls theirs.
    let met = 2.0 * water + 3.0 * walls;
    Ok(format!(
        "{:>9} particles, {:>5.1} neighbours: {:>8.2} ms a step, {:>7.2} million particles/s, {:>9.1} million pairs/s on {name}",
        positions.len(),
        (water + walls) / positions.len() as f64,
        1e3 * best,
        positions.len() as f64 / best / 1e6,
        met / best / 1e6,
    ))
}

/// A cube of water, `edge` particles long, in a tank that it fills, open above.
fn tank(edge: u32) -> (Setup, Vec<DVec3>) {
    let spacing = 1.0 / f64::from(edge);
    let mut setup = Setup::tank(DVec3::ONE, spacing, 45.0);
    setup.faces[2][1] = Side::Open;
    let layers = setup.layers() as i32;
    let (mut shell, mut water) = (Vec::new(), Vec::new());
    let edge = edge as i32;
    for k in -layers..edge {
        for j in -layers..edge + layers {
            for i in -layers..edge + layers {
                let place = spacing * (DVec3::new(i.into(), j.into(), k.into()) + 0.5);
                let inside = [i, j, k].iter().all(|n| (0..edge).contains(n));
                if inside { &mut water } else { &mut shell }.push(place);
            }
        }
    }
    setup.bodies = vec![Body {
        shell,
        ..Body::default()
    }];
    (setup, water)
}

/// Pairs of water with water and of water with walls, of particles on the lattice, each for its end in the water.
fn pairs(setup: &Setup, positions: &[DVec3]) -> (f64, f64) {
    let reach = (2.0 * setup.smoothing).ceil() as i32;
    let mut offsets = Vec::new();
    for k in -reach..=reach {
        for j in -reach..=reach {
            for i in -reach..=reach {
                let r = DVec3::new(i.into(), j.into(), k.into());
                if r.length_squared() < 4.0 * setup.smoothing.powi(2) && (i, j, k) != (0, 0, 0) {
                    offsets.push(r * setup.spacing);
                }
            }
        }
    }
    let (mut water, mut walls) = (0.0, 0.0);
    for x in positions {
        for offset in &offsets {
            let y = *x + *offset;
            let inside = y.cmpge(DVec3::ZERO).all() && y.cmplt(setup.size).all();
            *if inside {
                &mut water
            } else if y.z < setup.size.z {
                &mut walls
            } else {
                continue;
            } += 1.0;
        }
    }
    (water, walls)
}
