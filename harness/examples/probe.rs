//! probe
use riprap::{kernel::Kernel, lattice::*, wgpu};
use riprap_harness::gpu;
use std::time::{Duration, Instant};
fn cpu() -> f64 {
    let s = std::fs::read_to_string("/proc/self/stat").unwrap();
    let f: Vec<&str> = s.rsplit(')').next().unwrap().split_whitespace().collect();
    (f[11].parse::<f64>().unwrap() + f[12].parse::<f64>().unwrap()) / 100.0
}
fn main() {
    let adapter = gpu::pick(std::env::args().nth(1).as_deref()).unwrap();
    println!("{}", gpu::describe(&adapter.get_info()));
    let (device, queue) = gpu::open(&adapter, wgpu::Features::empty(), adapter.limits()).unwrap();
    let n: u32 = std::env::args().nth(2).map_or(64, |s| s.parse().unwrap());
    for (name, lanes, storage, wale, guard, brick, force, collision, nb) in [
        (
            "mrt guo",
            1,
            Storage::F32,
            false,
            0.0,
            [64, 1, 1],
            true,
            Collision::Hermite,
            27,
        ),
        (
            "mrt guo",
            4,
            Storage::F32,
            false,
            0.0,
            [64, 1, 1],
            true,
            Collision::Hermite,
            27,
        ),
        (
            "mrt guo",
            4,
            Storage::F32,
            false,
            0.0,
            [32, 2, 1],
            true,
            Collision::Hermite,
            27,
        ),
        (
            "mrt guo",
            4,
            Storage::F32,
            false,
            0.0,
            [64, 1, 1],
            true,
            Collision::Hermite,
            2,
        ),
        (
            "mrt guo",
            4,
            Storage::F32,
            false,
            0.0,
            [64, 1, 1],
            true,
            Collision::Hermite,
            7,
        ),
        (
            "mrt",
            4,
            Storage::F32,
            false,
            0.0,
            [64, 1, 1],
            false,
            Collision::Hermite,
            2,
        ),
        (
            "bgk",
            4,
            Storage::F32,
            false,
            0.0,
            [64, 1, 1],
            false,
            Collision::Bgk,
            2,
        ),
        (
            "mrt guard",
            4,
            Storage::F32,
            false,
            0.3,
            [64, 1, 1],
            false,
            Collision::Hermite,
            2,
        ),
        (
            "mrt f16",
            2,
            Storage::F16,
            false,
            0.0,
            [64, 1, 1],
            false,
            Collision::Hermite,
            2,
        ),
        (
            "mrt f16",
            4,
            Storage::F16,
            false,
            0.0,
            [64, 1, 1],
            false,
            Collision::Hermite,
            2,
        ),
        (
            "mrt wale",
            4,
            Storage::F32,
            true,
            0.0,
            [64, 1, 1],
            false,
            Collision::Hermite,
            2,
        ),
    ] {
        let mut setup = Setup::periodic([n; 3], 0.01);
        setup.lanes = lanes;
        setup.storage = storage;
        setup.wale = wale.then_some(0.5);
        setup.max_speed = guard;
        setup.brick = brick;
        setup.collision = collision;
        if force {
            setup.force = Force::Constant([1e-6, 0., 0.]);
        }
        let grid = Grid::new(&setup).unwrap();
        let program = collide_stream(
            &setup,
            nb,
            Reach {
                listed: false,
                flagged: false,
            },
        );
        let linked = match program.link() {
            Ok(l) => l,
            Err(e) => {
                println!("{e}");
                std::process::exit(1)
            }
        };
        let groups: u32 = grid.bricks().iter().product();
        let kernels: Vec<_> = [false, true]
            .map(|odd| {
                let mut c = constants(&setup, &grid, odd);
                c.push(("BRICKS", groups.into()));
                c.push(("GUARD_COUNTS", 1.0));
                Kernel::new(&device, &linked, "collide_stream", &c).unwrap()
            })
            .into();
        let each = 27u32.div_ceil(nb);
        let bytes =
            u64::from(grid.element_count() * lanes) * if storage == Storage::F32 { 4 } else { 2 };
        let mk = |b: u64| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: b,
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let bufs: Vec<_> = (0..27u32.div_ceil(each))
            .map(|_| mk(bytes * u64::from(each)))
            .collect();
        // nonzero start
        for b in &bufs {
            let data: Vec<u32> = (0..b.size() / 4)
                .map(|i| {
                    if storage == Storage::F32 {
                        (((i * 2654435761) % 1000) as f32 * 1e-7).to_bits()
                    } else {
                        0x3c003c01
                    }
                })
                .collect();
            queue.write_buffer(b, 0, bytemuck_cast(&data));
        }
        let names: Vec<String> = (0..bufs.len())
            .map(|i| format!("populations_{i}"))
            .collect();
        let v = [
            mk(u64::from(grid.element_count() * lanes) * 12),
            mk(u64::from(grid.element_count() * lanes) * 12),
        ];
        let g = mk(16);
        queue.write_buffer(
            &g,
            0,
            &[
                0, 0, 0, 0, 0, 0, 0, 0, 255, 255, 255, 255, 255, 255, 255, 255,
            ],
        );
        let binds: Vec<_> = [0, 1]
            .map(|o| {
                let mut l: Vec<(&str, &wgpu::Buffer)> =
                    names.iter().map(|s| s.as_str()).zip(&bufs).collect();
                l.push(("velocity_before", &v[o]));
                l.push(("velocity_after", &v[1 - o]));
                l.push(("guard_state", &g));
                kernels[o].bind(&device, &l).unwrap()
            })
            .into();
        let run = |steps: usize| {
            let mut e = device.create_command_encoder(&Default::default());
            for s in 0..steps {
                let mut p = e.begin_compute_pass(&Default::default());
                kernels[s % 2].record(&mut p, &binds[s % 2], groups);
            }
            queue.submit([e.finish()]);
            device
                .poll(wgpu::PollType::Wait {
                    submission_index: None,
                    timeout: Some(Duration::from_secs(100)),
                })
                .unwrap();
        };
        run(2);
        let mut best = 0f64;
        let mut cpus = 0.;
        let steps = (20_000_000 / (n * n * n)).max(2) as usize & !1;
        for _ in 0..3 {
            let (c, t) = (cpu(), Instant::now());
            run(steps);
            let (dc, dt) = (cpu() - c, t.elapsed().as_secs_f64());
            let m = (n * n * n) as f64 * steps as f64 * 2.0 / dc / 1e6;
            if m > best {
                best = m;
                cpus = (n * n * n) as f64 * steps as f64 / dt / 1e6;
            }
        }
        println!(
            "{name:10} lanes {lanes} {storage:?} {brick:?} nb {nb} groups {groups}: {best:.1} MLUPS (cpu), wall {cpus:.1}"
        );
    }
}
fn bytemuck_cast(v: &[u32]) -> &[u8] {
    riprap_bytes(v)
}
fn riprap_bytes(v: &[u32]) -> &[u8] {
    bytemuck::cast_slice(v)
}
