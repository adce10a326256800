//! Blocks in the fluid on every adapter: solid fractions, the fluid step with each operator, and the sums of loads.

mod common;

use common::{Adapter, on_adapters};
use criterion::Throughput;
use glam::{DQuat, DVec3};
use kit::subject::{Subject, sheared_noise};
use riprap::{
    Error,
    geometry::{HalfSpace, Polyhedron, Pose, Shape},
    gpu::Processor,
    gpu::kernel::{Kernel, submit_pass},
    lattice::{Grid, Lattice, SolidOperator},
    psm::{
        CellMapping, Frame, Motion, PLANES, SolidBlock, SolidCells, Tile, WRENCH, constants,
        reduce_blocks, reduce_tiles,
    },
    units::Units,
    wgpu::{self, util::DeviceExt},
};
use std::sync::Arc;

/// Cells per axis.
const N: u32 = 64;
/// Blocks along an axis: they reach nearly all bricks.
const BLOCKS: u32 = 4;
/// Approximate number of cells across a block.
const ACROSS: f64 = 10.0;

const OPERATORS: [(&str, SolidOperator); 3] = [
    ("holdych", SolidOperator::Holdych),
    ("noble", SolidOperator::Noble),
    ("superposition", SolidOperator::Superposition),
];

fn main() -> Result<(), Error> {
    let units = "million cells of tiles (voxelise, loads, reduce_faces, reduce_tiles), of the grid (psm), or numbers \
        (reduce_blocks) a second";
    on_adapters(units, |adapter| {
        let shapes = [
            ("spheres", Arc::new(Shape::sphere(0.5 * ACROSS)?)),
            (
                "boxes",
                polyhedron(Polyhedron::cuboid(DVec3::splat(0.8 * ACROSS))?),
            ),
            ("80 faces", polyhedron(round(80)?)),
        ];
        for (name, shape) in &shapes {
            voxelise(adapter, name, shape)?;
        }
        for (name, operator) in OPERATORS {
            let world = World::new(adapter, operator, &shapes[1].1)?;
            let work = Throughput::Elements(2 * u64::from(N).pow(3));
            println!(
                "{} of {} bricks",
                world.cells.bricks().len(),
                world.bricks()
            );
            adapter.turns(
                "psm",
                name,
                (2, work),
                Subject::Steps(Box::new(world.lattice)),
            );
        }
        loads(adapter, &shapes[1].1)?;
        sums(adapter)
    })
}

fn polyhedron(shape: Polyhedron) -> Arc<Shape> {
    Arc::new(shape.into())
}

/// A polyhedron of `faces` faces around a sphere, with normals on a spiral (Saff & Kuijlaars 1997).
fn round(faces: u32) -> Result<Polyhedron, Error> {
    let normals = (0..faces).map(|n| {
        let z = 1.0 - (2.0 * f64::from(n) + 1.0) / f64::from(faces);
        let angle = f64::from(n) * std::f64::consts::PI * (3.0 - 5f64.sqrt());
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * angle.cos(), r * angle.sin(), z)
    });
    let faces: Vec<_> = normals
        .map(|normal| HalfSpace {
            normal,
            distance: 0.5 * ACROSS,
        })
        .collect();
    Ok(Polyhedron::from_half_spaces(&faces)?.0)
}

/// Rotated blocks of one shape in a cubic array, in a flow.
struct World {
    device: wgpu::Device,
    queue: wgpu::Queue,
    lattice: Lattice,
    cells: SolidCells,
    turn: u32,
}

impl World {
    fn new(
        adapter: &Adapter<'_>,
        operator: SolidOperator,
        shape: &Arc<Shape>,
    ) -> Result<Self, Error> {
        let (device, queue) = (adapter.device.clone(), adapter.queue.clone());
        let mut setup = adapter.setup(N);
        setup.solid_operator = Some(operator);
        if adapter.processor == Processor::Gpu {
            // The choice of bricks depends on the operator.
            setup.use_gpu_layout();
        }
        let state = sheared_noise(&setup)?;
        let mut lattice = Lattice::new(&device, setup)?;
        lattice.start(&device, &queue, &state, true)?;
        let frame = Frame {
            origin: DVec3::ZERO,
            units: Units {
                cell: 1.0,
                time_step: 1.0,
                density: 1.0,
            },
        };
        let block = SolidBlock {
            faces: true,
            ..SolidBlock::new(shape.clone())
        };
        let blocks = vec![block; BLOCKS.pow(3) as usize];
        let mut world = Self {
            cells: SolidCells::new(&device, &lattice, frame, blocks)?,
            device,
            queue,
            lattice,
            turn: 0,
        };
        world.place()?;
        submit_pass(&world.device, &world.queue, |pass| {
            world.cells.record_cells(pass);
            world.lattice.record_psm(pass);
            world.lattice.record_rest(pass);
        });
        Ok(world)
    }

    /// Moves all blocks back and forth, so little that their tiles stay the same.
    fn place(&mut self) -> Result<(), Error> {
        self.turn += 1;
        let pitch = f64::from(N / BLOCKS);
        let shift = 0.01 * f64::from(self.turn % 2);
        let rotation = DQuat::from_rotation_x(0.5) * DQuat::from_rotation_z(0.3);
        let pose = |n: u32| {
            let at = [n % BLOCKS, n / BLOCKS % BLOCKS, n / BLOCKS / BLOCKS].map(f64::from);
            let centre = (DVec3::from(at) + 0.5) * pitch + shift;
            Pose::at_rest(centre, rotation)
        };
        let poses: Vec<_> = (0..BLOCKS.pow(3)).map(pose).collect();
        self.cells
            .place(&self.device, &self.queue, &mut self.lattice, &poses)
    }

    fn bricks(&self) -> u32 {
        self.lattice.grid().bricks().iter().product()
    }

    fn tile_cells(&self) -> u64 {
        workgroup(self.lattice.grid()) * self.cells.tiles() as u64
    }
}

fn workgroup(grid: &Grid) -> u64 {
    grid.brick.iter().map(|&n| u64::from(n)).product()
}

fn voxelise(adapter: &mut Adapter<'_>, name: &str, shape: &Arc<Shape>) -> Result<(), Error> {
    let mut world = World::new(adapter, SolidOperator::Holdych, shape)?;
    let work = Throughput::Elements(world.tile_cells());
    let record =
        |world: &mut World, pass: &mut wgpu::ComputePass<'_>| world.cells.record_cells(pass);
    adapter.prepared("voxelise", name, work, &mut world, World::place, record);
    Ok(())
}

/// The sums of the loads on blocks and on their faces, as in a step.
fn loads(adapter: &mut Adapter<'_>, shape: &Arc<Shape>) -> Result<(), Error> {
    let world = World::new(adapter, SolidOperator::Holdych, shape)?;
    let work = Throughput::Elements(world.tile_cells());
    let subject = Subject::Recording(Box::new(|pass| world.cells.record_loads(pass)));
    adapter.turns("loads", "tiles and blocks", (1, work.clone()), subject);
    let subject = Subject::Recording(Box::new(|pass| world.cells.record_faces(pass)));
    adapter.turns("reduce_faces", "boxes", (1, work), subject);
    Ok(())
}

/// Each of the two sums of loads alone, over blocks of 64 tiles in which half of the cells contain solid.
fn sums(adapter: &mut Adapter<'_>) -> Result<(), Error> {
    const OF_BLOCK: u32 = 64;
    let device = adapter.device.clone();
    let grid = Grid::new(&adapter.setup(N))?;
    let bricks: u32 = grid.bricks().iter().product();
    let (count, blocks) = (bricks, bricks / OF_BLOCK);
    let [bricks_x, bricks_y, _] = grid.bricks();
    let tile = |n: u32| {
        let brick = [
            n % bricks_x,
            n / bricks_x % bricks_y,
            n / bricks_x / bricks_y,
        ];
        Tile {
            cell: [0, 1, 2].map(|a| (brick[a] * grid.brick[a]) as i32),
            part: n / OF_BLOCK,
            block: n / OF_BLOCK,
            slot: n,
            lane: 0,
            inside: Tile::pack(grid.brick),
        }
    };
    let tiles: Vec<Tile> = (0..count).map(tile).collect();
    let first: Vec<u32> = (0..=blocks).map(|block| block * OF_BLOCK).collect();
    let cells = workgroup(&grid) as usize;
    let shares: Vec<f32> = (0..count as usize * cells)
        .map(|n| if n % 2 == 0 { 0.5 } else { 0.0 })
        .collect();
    let planes = vec![0.25f32; count as usize * cells * PLANES * grid.lanes as usize];
    let buffer = |contents: &[u8]| {
        device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents,
            usage: wgpu::BufferUsages::STORAGE,
        })
    };
    let empty = |words: u32| buffer(bytemuck::cast_slice(&vec![0u32; words as usize]));
    let buffers = [
        ("tiles", buffer(bytemuck::cast_slice(&tiles))),
        (
            "motions",
            buffer(bytemuck::cast_slice(&vec![
                Motion::default();
                blocks as usize
            ])),
        ),
        ("solid_fractions", buffer(bytemuck::cast_slice(&shares))),
        (
            "effective_fractions",
            buffer(bytemuck::cast_slice(&[&shares[..]; 2].concat())),
        ),
        ("psm_planes_0", buffer(bytemuck::cast_slice(&planes))),
        ("block_first", buffer(bytemuck::cast_slice(&first))),
        ("partials", empty(WRENCH as u32 * count)),
        ("wrenches", empty(WRENCH as u32 * blocks)),
    ];
    let named = buffers.each_ref().map(|(name, buffer)| (*name, buffer));
    for walk in [CellMapping::Serial, CellMapping::Parallel] {
        let linked = reduce_tiles(&grid, walk).link()?;
        let constants = linked.constants_of(&constants(&grid));
        let kernel = Kernel::new(&device, &linked, "reduce_tiles", &constants)?;
        let bind = kernel.bind(&device, &named)?;
        let record = |pass: &mut wgpu::ComputePass<'_>| {
            kernel.record(pass, &bind, walk.groups(blocks * OF_BLOCK));
        };
        let work = Throughput::Elements(u64::from(blocks * OF_BLOCK) * cells as u64);
        let subject = Subject::Recording(Box::new(record));
        adapter.turns("reduce_tiles", &format!("{walk:?}"), (1, work), subject);
    }
    let kernel = Kernel::new(&device, &reduce_blocks().link()?, "reduce_blocks", &[])?;
    let bind = kernel.bind(&device, &named)?;
    let subject = Subject::Recording(Box::new(|pass| kernel.record(pass, &bind, blocks)));
    let work = Throughput::Elements(WRENCH as u64 * u64::from(blocks * OF_BLOCK));
    adapter.turns("reduce_blocks", "64 tiles a block", (1, work), subject);
    Ok(())
}
