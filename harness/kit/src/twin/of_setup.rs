//! The f64 twin of a setup, and random states for both.

use crate::Rig;
use crate::twin::{self, Twin};
use riprap::lattice::{
    Collision, Equilibrium, Face, Force, Lattice, Populations, Setup, SolidOperator, SolidWeight,
    Storage, WallModel,
};

/// A number in (−1, 1) that depends on `n` alone.
pub fn noise(n: usize) -> f64 {
    let mut x = (n as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x1234_5678;
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((x >> 11) as f64) / (1u64 << 52) as f64 - 1.0
}

fn twin_operator(operator: SolidOperator) -> twin::SolidOperator {
    match operator {
        SolidOperator::Holdych => twin::SolidOperator::Holdych,
        SolidOperator::Noble => twin::SolidOperator::Noble,
        SolidOperator::Superposition => twin::SolidOperator::Superposition,
    }
}

/// The twin of a setup; panics for pressure and outflow faces, which it does not support.
pub fn twin_of(setup: &Setup) -> Twin {
    let faces = [0, 1, 2, 3, 4, 5].map(|n| match &setup.faces[n / 2][n % 2] {
        Face::Periodic => twin::Face::Periodic,
        Face::Wall(velocity) => twin::Face::Wall(*velocity),
        Face::FreeSlip => twin::Face::FreeSlip,
        Face::Velocity(table) => twin::Face::Velocity(twin::Profile::Table(
            table.iter().map(|u| u.map(f64::from)).collect(),
        )),
        other => panic!("no twin of {other:?}"),
    });
    let mut domain = twin::Domain::new(setup.cells.map(|n| n as usize), faces);
    if !setup.solid.is_empty() {
        domain.solid.clone_from(&setup.solid);
    }
    let mut config = twin::Config::new(setup.tau());
    config.equilibrium = match setup.equilibrium {
        Equilibrium::Product => twin::Equilibrium::Product,
        Equilibrium::SecondOrder => twin::Equilibrium::Order2,
    };
    config.operator = match setup.collision {
        Collision::Bgk => twin::Operator::Bgk,
        Collision::Suga => twin::Operator::Suga,
        Collision::Hermite => twin::Operator::Hermite,
    };
    config.c_w = setup.wale;
    config.wale_interval = setup.wale_interval.into();
    config.lambda_everywhere = setup.lambda;
    if let Some(floor) = setup.odd_rate_floor {
        config.floors = [floor; 2];
    }
    if let Some(lambda) = setup.wall_lambda {
        config.lambda_wall = lambda;
    }
    config.lambda_solid = setup.solid_lambda;
    config.solid_weight = match setup.weight() {
        SolidWeight::Exact => twin::SolidWeight::Exact,
        SolidWeight::Standard => twin::SolidWeight::Standard,
    };
    if let Some(aperture) = setup.joint_aperture {
        let operator = setup.solid_operator.unwrap_or(SolidOperator::Holdych);
        config.joint_weights = twin::joint::weights(&config, twin_operator(operator), aperture);
    }
    let mut at_rest = vec![twin::Solid::default(); domain.cell_count()];
    for surface in &setup.surface {
        let cell = surface.cell as usize;
        at_rest[cell].fraction = surface.fraction.into();
        at_rest[cell].beside = true;
        for (axis, step) in (0..3).flat_map(|axis| [(axis, -1), (axis, 1)]) {
            if let Some(neighbour) = domain.fluid_neighbour(cell, axis, step) {
                at_rest[neighbour].beside = true;
            }
        }
    }
    let mut twin = Twin::new(domain, config);
    twin.wall_model = setup.wall_model.map(|law| twin::WallModel {
        law: match law {
            WallModel::WernerWengle => twin::WallLaw::WernerWengle,
            WallModel::Reichardt => twin::WallLaw::Reichardt,
        },
        roughness: setup.wall_roughness,
        solid_roughness: setup.solid_roughness.clone(),
        on_blocks: setup.has_block_friction(),
        on_slopes: setup.has_sloping_friction(),
        on_surfaces: setup.has_surface_friction(),
        surface: at_rest.iter().map(|solid| solid.fraction).collect(),
    });
    let blocks = |operator| (twin_operator(operator), at_rest);
    twin.blocks = setup.operator().map(blocks);
    twin.force = match &setup.force {
        Force::None => twin::Force::Uniform([0.0; 3]),
        Force::Constant(force) => twin::Force::Uniform(*force),
        Force::Field(field) => twin::Force::Field(field.iter().map(|f| f.map(f64::from)).collect()),
    };
    twin
}

/// Populations of order 0.025 w_i as in the golden trajectory, exactly the same in f32 and f64, with their own velocity.
pub fn random_populations(twin: &mut Twin) -> Populations {
    let n = twin.domain.cell_count();
    let mut values = vec![0f32; 27 * n];
    for cell in (0..n).filter(|&cell| !twin.domain.solid[cell]) {
        for q in 0..27 {
            let value = (0.025 * twin::lattice::W[q] * noise(27 * cell + q)) as f32;
            values[q * n + cell] = value;
            twin.f[cell][q] = f64::from(value);
        }
    }
    let u = twin.velocity();
    let velocity = (0..3)
        .flat_map(|a| u.iter().map(move |u| u[a] as f32))
        .collect();
    let cells = twin.domain.cells.map(|n| n as u32);
    Populations {
        step: 0,
        cells,
        values,
        velocity,
        eddy_viscosity: Vec::new(),
        near_wall: Vec::new(),
        travelled: Vec::new(),
        outflow_state: Vec::new(),
    }
}

/// Fills the populations of a lattice with NaN.
pub fn poison(rig: &Rig, lattice: &Lattice) {
    for buffer in lattice.population_buffers() {
        let nan = vec![0x7fc0_7fc0_u32; buffer.size() as usize / 4];
        rig.queue
            .write_buffer(buffer, 0, bytemuck::cast_slice(&nan));
    }
}

/// Tolerance for rounding in f32 and half precision. The rows of `suga` have unit weight, so that the rounding of the rest
/// population affects corner populations, whose weight is 64 times smaller.
pub fn limit(setup: &Setup) -> f64 {
    match (setup.storage, setup.collision) {
        (Storage::F16, _) => 2e-3,
        (Storage::F32, Collision::Suga) => 2e-6,
        (Storage::F32, _) => 1e-6,
    }
}

/// Storage, lanes and their axis: each precision, with the fewest lanes and with four.
pub fn layouts() -> [(Storage, u32, usize); 7] {
    [
        (Storage::F32, 1, 2),
        (Storage::F32, 4, 1),
        (Storage::F32, 4, 2),
        (Storage::F16, 2, 1),
        (Storage::F16, 2, 2),
        (Storage::F16, 4, 1),
        (Storage::F16, 4, 2),
    ]
}

/// Walls of every kind, corners where they meet, and a solid with an edge.
pub fn walled(lanes: u32, storage: Storage) -> Setup {
    let mut setup = Setup::periodic([6, 5, 7], 0.02);
    (setup.lanes, setup.storage) = (lanes, storage);
    let inlet = (0..5 * 7).map(|n| [198, 0, 99].map(|of| 0.01 * noise(of + n) as f32));
    setup.faces = [
        [Face::Velocity(inlet.collect()), Face::FreeSlip],
        [Face::Wall([0.0; 3]), Face::Wall([0.04, 0.0, -0.02])],
        [Face::FreeSlip, Face::Wall([0.0; 3])],
    ];
    setup.solid = (0..6 * 5 * 7)
        .map(|n| [n % 6, (n / 6) % 5, n / 30])
        .map(|[x, y, z]| {
            let block = (2..4).contains(&x) && y < 2 && (2..6).contains(&z);
            let bed = x < 2 && y < 2 && z < 3;
            let under_the_lid = x == 4 && y == 4 && z < 2;
            block || bed || under_the_lid
        })
        .collect();
    setup
}
