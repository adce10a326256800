//! The sort and the sums of free water on every adapter, each alone: a cube of water, open on all sides, whose particles have
//! been displaced from a lattice. `benches/particles.rs` measures whole steps.

mod common;

use common::{Adapter, on_adapters};
use criterion::Throughput;
use glam::DVec3;
use kit::{Random, subject::Subject, tank::lattice};
use riprap::{
    Error,
    gpu::kernel::Kernel,
    sph::{
        CellGrid, Clock, CountingSort, NeighbourSearch, Particle, Setup, Side, constants, program,
    },
    wgpu::{self, util::DeviceExt},
};

/// Particles along an edge.
const EDGE: u32 = 40;
/// Capacity of a neighbour list, larger than any number of neighbours.
const CAPACITY: u32 = 512;

fn main() -> Result<(), Error> {
    on_adapters("million particles a second", |adapter| {
        for neighbours in [NeighbourSearch::Cells, NeighbourSearch::Lists] {
            bench(adapter, neighbours)?;
        }
        Ok(())
    })
}

fn bench(adapter: &mut Adapter<'_>, neighbours: NeighbourSearch) -> Result<(), Error> {
    let (device, queue) = (adapter.device.clone(), adapter.queue.clone());
    let mut setup = Setup::tank(DVec3::ONE, 1.0 / f64::from(EDGE), 45.0);
    setup.faces = [[Side::Open; 2]; 3];
    setup.neighbours = neighbours;
    let grid = CellGrid::new(&setup)?;
    let mut noise = Random(5);
    let particles: Vec<Particle> = (0..)
        .zip(lattice(&setup, [0; 3], [EDGE as i32; 3]))
        .map(|(id, x)| Particle {
            at: grid.quantise(x + 0.2 * setup.spacing * noise.vector()),
            id,
            velocity: (0.01 * noise.vector()).as_vec3().to_array(),
            excess: 1e-3,
        })
        .collect();
    let count = particles.len() as u32;
    let buffer = |contents: &[u8]| {
        device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::UNIFORM,
        })
    };
    let room = |words: u64| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 4 * words,
            usage: wgpu::BufferUsages::STORAGE,
            mapped_at_creation: false,
        })
    };
    // Stale: every step sorts and rebuilds the lists.
    let clock = buffer(bytemuck::bytes_of(&Clock {
        step: 0.1,
        remaining: 1e6,
        stale: 1,
        ..Clock::default()
    }));
    let sort = CountingSort::new(&device, &setup, &grid)?;
    let sorted = sort.buffers(&device, &grid, &clock, count)?;
    queue.write_buffer(&sorted.unsorted, 0, bytemuck::cast_slice(&particles));
    let mut encoder = device.create_command_encoder(&Default::default());
    sort.record(&mut encoder, &sorted);
    queue.submit([encoder.finish()]);
    let work = Throughput::Elements(count.into());
    let name = format!("{neighbours:?}");
    if neighbours == NeighbourSearch::Cells {
        adapter.turns(
            "sort",
            "counting",
            (1, work.clone()),
            Subject::Encoding(Box::new(|encoder| {
                sort.record(encoder, &sorted);
            })),
        );
    }
    let cells = grid.cell_count() + 2;
    let groups = count.div_ceil(64);
    let nobody = Particle {
        at: [-1; 3],
        ..Particle::default()
    };
    let buffers = [
        ("particles", sorted.sorted.clone()),
        ("starts", sorted.starts.clone()),
        ("boundary", buffer(bytemuck::bytes_of(&nobody))),
        ("boundary_starts", room(cells)),
        ("clock", clock.clone()),
        ("new_velocities", room(4 * u64::from(count))),
        ("moved", room(8 * u64::from(count))),
        ("wall_work", room(3 * u64::from(count))),
        ("range", buffer(bytemuck::cast_slice(&[0, count]))),
    ];
    let lists = room(u64::from(64 * groups * CAPACITY));
    let counts = room(2 * u64::from(count));
    let lists = [
        ("neighbour_list", &lists),
        ("neighbour_list_out", &lists),
        ("neighbour_counts", &counts),
        ("neighbour_counts_out", &counts),
    ];
    let own = buffers.iter().map(|(name, buffer)| (*name, buffer));
    let named: Vec<_> = own.chain(lists).collect();
    let constants = constants(&setup, &grid);
    // The order matters: each kernel reads the results of those before it.
    for kernel in ["neighbour_lists", "accelerate", "drift"] {
        let has_lists = neighbours == NeighbourSearch::Lists;
        if kernel == "neighbour_lists" && !has_lists {
            continue;
        }
        let linked = program(&setup, &grid, kernel).link()?;
        let mut numbers = linked.constants_of(&constants);
        if has_lists {
            numbers.push(("CAPACITY", CAPACITY.into()));
        }
        let bound = Kernel::new(&device, &linked, kernel, &numbers)?;
        let bind = bound.bind(&device, &named)?;
        let subject = Subject::Recording(Box::new(|pass| bound.record(pass, &bind, groups)));
        adapter.turns(kernel, &name, (1, work.clone()), subject);
    }
    Ok(())
}
