//! The variants of the kernel that are measured, and the groups in which they run.

use riprap::{
    lattice::{
        Collision, Equilibrium, Face, Force, Grid, Memory, Setup, Storage, WallModel, memory,
    },
    wgpu,
};

/// The plain step, with which the others are compared: f32, Hermite MRT, nothing else.
pub const PLAIN: &str = "mrt";
/// Walls on two sides, without slip and with a wall model.
pub const TWO_WALLS: &str = "mrt, WALE, two walls";
/// See [`TWO_WALLS`].
pub const WALL_MODEL: &str = "mrt, WALE, wall model";
/// With WALE, and statistics over time of every fifth state.
pub const STATISTICS: &str = "mrt, WALE, statistics";
/// Streaming without collision.
pub const STREAM_ONLY: &str = "stream only";

/// A named setup.
#[derive(Clone)]
pub struct Variant {
    /// Name of the variant.
    pub name: &'static str,
    /// Its setup.
    pub setup: Setup,
    /// Bytes and bindings.
    pub memory: Memory,
}

/// Variants of one layout, measured in turns; the first only streams, the second is plain.
pub struct Group {
    /// Cells per axis.
    pub grid: u32,
    /// Streaming, plain, then the others.
    pub variants: Vec<Variant>,
}

type Change = fn(&mut Setup);

/// Changes to the plain step.
const MAIN: [(&str, Change); 9] = [
    ("bgk", |s| s.collision = Collision::Bgk),
    ("mrt, force", |s| s.force = FORCE),
    ("mrt, WALE", |s| s.wale = Some(0.5)),
    (STATISTICS, |s| s.wale = Some(0.5)),
    ("mrt, guard", |s| s.max_speed = 0.3),
    ("mrt, walls", |s| s.faces = walls()),
    ("all of these", |s| {
        (s.force, s.wale, s.max_speed, s.faces) = (FORCE, Some(0.5), 0.3, walls());
    }),
    (TWO_WALLS, |s| {
        (s.wale, s.faces[2]) = (Some(0.5), walls()[2].clone());
    }),
    (WALL_MODEL, |s| {
        (s.wale, s.faces[2]) = (Some(0.5), walls()[2].clone());
        s.wall_model = Some(WallModel::WernerWengle);
    }),
];

/// Further changes, in the adapter's preferred layout only.
const REST: [(&str, Change); 11] = [
    ("mrt, second-order equilibrium", |s| {
        s.equilibrium = Equilibrium::SecondOrder;
    }),
    ("Suga's mrt", |s| {
        (s.collision, s.equilibrium) = (Collision::Suga, Equilibrium::SecondOrder);
    }),
    ("mrt, words of 32 bits", |s| s.wide = false),
    ("mrt, 1 binding", |s| s.bindings = Some(1)),
    ("mrt, 2 bindings", |s| s.bindings = Some(2)),
    ("mrt, 7 bindings", |s| s.bindings = Some(7)),
    ("mrt, 27 bindings", |s| s.bindings = Some(27)),
    ("mrt, bricks 16 × 2 × 2", |s| s.brick = [16, 2, 2]),
    ("mrt, bricks 32 × 2 × 1", |s| s.brick = [32, 2, 1]),
    ("mrt, bricks 64 × 1 × 1", |s| s.brick = [64, 1, 1]),
    ("mrt, bricks 128 × 1 × 1", |s| s.brick = [128, 1, 1]),
];

/// A weak force: its value does not affect the time.
const FORCE: Force = Force::Constant([1e-6, 0.0, 0.0]);

fn walls() -> [[Face; 2]; 3] {
    let wall = || Face::Wall([0.0; 3]);
    [[wall(), wall()], [wall(), wall()], [wall(), wall()]]
}

/// The groups on a grid; a variant that the adapter cannot hold is reported and left out.
pub fn groups(
    grid: u32,
    software: bool,
    quick: bool,
    budget: u64,
    device: &wgpu::Device,
) -> Vec<Group> {
    // The adapter's preferred layout first, then those for comparison.
    let (f32, f16) = (Storage::F32, Storage::F16);
    let mut layouts = [(f32, 4), (f16, 4), (f32, 1), (f16, 2)];
    if !software {
        layouts.rotate_left(2);
    }
    let limits = device.limits();
    let mut all = Vec::new();
    for (rank, (storage, lanes)) in layouts.into_iter().enumerate() {
        let wanted: Vec<_> = match (rank, quick) {
            (0, true) => MAIN.to_vec(),
            (0, false) => MAIN.into_iter().chain(REST).collect(),
            (1, _) => MAIN[..3].to_vec(),
            (_, true) => continue,
            (_, false) => Vec::new(),
        };
        let make = |name, change: Change| {
            let mut setup = plain(grid, storage, lanes, software, device);
            change(&mut setup);
            let memory = Grid::new(&setup).and_then(|g| memory(&setup, &g, &limits));
            match memory {
                Ok(memory) => Some(Variant {
                    name,
                    setup,
                    memory,
                }),
                Err(error) => {
                    println!("{name}, {storage:?}, {lanes} lanes: left out, {error}");
                    None
                }
            }
        };
        let (Some(stream), Some(plain)) = (make(STREAM_ONLY, |_| {}), make(PLAIN, |_| {})) else {
            continue;
        };
        let others = wanted
            .into_iter()
            .filter_map(|(name, change)| make(name, change));
        all.extend(split(grid, [stream, plain], others.collect(), budget));
    }
    all
}

/// The setup of the plain step in a layout.
pub fn plain(
    grid: u32,
    storage: Storage,
    lanes: u32,
    software: bool,
    device: &wgpu::Device,
) -> Setup {
    let mut setup = Setup::periodic([grid; 3], 0.01);
    (setup.storage, setup.lanes, setup.max_speed) = (storage, lanes, 0.0);
    match software {
        true => setup.use_cpu_layout(device.features()),
        false => setup.use_gpu_layout(),
    }
    setup
}

/// Groups as many variants as memory holds, each group with the two variants that it is compared with.
fn split(grid: u32, base: [Variant; 2], others: Vec<Variant>, budget: u64) -> Vec<Group> {
    let bytes = |v: &Variant| v.memory.populations + v.memory.others;
    // The copies need two buffers as long as the populations.
    let fixed = base.iter().map(bytes).sum::<u64>() + 2 * base[0].memory.populations;
    let new = || Group {
        grid,
        variants: base.to_vec(),
    };
    if fixed > budget {
        println!(
            "{grid}³, {:?}: left out, takes {:.1} GiB of the {:.1} allowed; use --memory",
            base[0].setup.storage,
            fixed as f64 / 2f64.powi(30),
            budget as f64 / 2f64.powi(30)
        );
        return Vec::new();
    }
    let mut groups = vec![new()];
    let mut taken = fixed;
    for variant in others {
        let more = bytes(&variant);
        if fixed + more > budget {
            println!("{}: left out, memory; use --memory", variant.name);
            continue;
        }
        if taken + more > budget {
            groups.push(new());
            taken = fixed;
        }
        taken += more;
        if let Some(group) = groups.last_mut() {
            group.variants.push(variant);
        }
    }
    groups
}
