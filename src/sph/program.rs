//! Kernel files and constants of the solver.

use super::{CellGrid, EquationOfState, NeighbourSearch, Scheme, Setup};
use crate::gpu::link::Program;
use std::f64::consts::PI;

/// Largest number of storage buffers of a kernel: `mueller_accelerate` with lists.
pub const MAX_STORAGE_BUFFERS: u32 = 8;

/// Frequency of a particle on the penalty spring relative to c₀/Δx: half of the stability limit. The damping ratio is
/// one half.
const PENALTY_FREQUENCY: f64 = 0.5;

/// The same with boundary particles, where the penalty force only repels water that has passed between them: it
/// accelerates this water from the depth of a spacing to 2 % of the speed of sound.
const WEAK_PENALTY_FREQUENCY: f64 = 0.1;

/// The kernels of a step. Each is the entry point of the file with its name.
pub const KERNELS: [&str; 22] = [
    "sort_count",
    "sort_starts",
    "sort_scatter",
    "sort_reorder",
    "boundary_position",
    "boundary_pressure",
    "neighbour_lists",
    "boundary_neighbour_lists",
    "check_capacity",
    "accelerate",
    "apply_penalty",
    "boundary_force",
    "body_load",
    "pressure_probes",
    "drift",
    "mueller_density",
    "mueller_accelerate",
    "mueller_load",
    "mueller_drift",
    "reduce_particle_limits",
    "reduce_limits",
    "advance_clock",
];

/// The kernels of [`KERNELS`] that a setup runs.
pub fn kernels_of(setup: &Setup) -> impl Iterator<Item = &'static str> {
    let delta = matches!(setup.scheme, Scheme::Delta);
    let lists = setup.neighbours == NeighbourSearch::Lists;
    KERNELS.into_iter().filter(move |kernel| match *kernel {
        "neighbour_lists" | "check_capacity" => lists,
        "boundary_neighbour_lists" => delta && lists,
        "accelerate" | "drift" | "apply_penalty" | "body_load" | "boundary_position"
        | "boundary_pressure" | "boundary_force" => delta,
        other => !(delta && other.starts_with("mueller_")),
    })
}

/// The program of a kernel. Slots that the kernel does not use have no effect.
pub fn program(setup: &Setup, grid: &CellGrid, kernel: &str) -> Program {
    let periodic = grid.period.iter().any(|period| *period > 0);
    let viscous = setup.laminar_viscosity > 0.0;
    let if_viscous = |some, none| if viscous { some } else { none };
    Program::new(kernel)
        .slot("viscous", if_viscous("viscous_laminar", "viscous_none"))
        .slot(
            "wall_velocity",
            if_viscous("wall_velocity_no_slip", "wall_velocity_none"),
        )
        .slot("drag", if_viscous("drag_laminar", "drag_none"))
        .slot(
            "cell_ranges",
            if periodic {
                "cell_ranges_periodic"
            } else {
                "cell_ranges_open"
            },
        )
        .slot(
            "neighbours",
            match setup.neighbours {
                NeighbourSearch::Cells => "neighbours_cells",
                NeighbourSearch::Lists => "neighbours_lists",
            },
        )
        .slot(
            "fluid_neighbours",
            match setup.neighbours {
                NeighbourSearch::Cells => "fluid_neighbours_cells",
                NeighbourSearch::Lists => "fluid_neighbours_lists",
            },
        )
        .slot(
            "equation_of_state",
            match setup.equation_of_state {
                EquationOfState::Linear => "equation_of_state_linear",
                EquationOfState::Tait => "equation_of_state_tait",
            },
        )
}

/// Fraction of [`open_weight`] above which a boundary particle is on an open face: half of it is the most in a joint.
const OPEN: f64 = 0.55;

/// Sum of the kernel function over the water at a boundary particle in the first layer of a plane wall, spacings to the power of minus
/// the dimension.
fn open_weight(setup: &Setup) -> f64 {
    let (kernel, spacing) = (setup.kernel(), setup.spacing);
    let reach = (2.0 * setup.smoothing).ceil() as i32;
    let (across, cell) = match setup.plane {
        true => (0..=0, spacing.powi(2)),
        false => (-reach..=reach, spacing.powi(3)),
    };
    let row = |y: i32, z: i32| -> f64 {
        let distance = |x: i32| spacing * f64::from(x * x + y * y + z * z).sqrt();
        (-reach..=reach).map(|x| kernel.at(distance(x))).sum()
    };
    let layer = |z: i32| -> f64 { across.clone().map(|y| row(y, z)).sum() };
    cell * (1..=reach).map(layer).sum::<f64>()
}

/// The constants of all kernels.
pub fn constants(setup: &Setup, grid: &CellGrid) -> Vec<(&'static str, f64)> {
    let h = setup.smoothing;
    let scale = if setup.plane {
        7.0 / (4.0 * PI * h.powi(2))
    } else {
        21.0 / (16.0 * PI * h.powi(3))
    };
    let support = 2.0 * h;
    // Poly6, spiky and Laplacian: see mueller_kernels.wgsl.
    let mueller = if setup.plane {
        [
            4.0 / (PI * support.powi(8)),
            30.0 / (PI * support.powi(5)),
            40.0 / (PI * support.powi(5)),
        ]
    } else {
        [
            315.0 / (64.0 * PI * support.powi(9)),
            45.0 / (PI * support.powi(6)),
            45.0 / (PI * support.powi(6)),
        ]
    };
    let viscosity = match setup.scheme {
        Scheme::Delta => setup.laminar_viscosity,
        Scheme::Mueller { viscosity } => viscosity,
    } * grid.unit_time()
        / setup.spacing.powi(2);
    let stiffness = match setup.scheme {
        Scheme::Delta => WEAK_PENALTY_FREQUENCY,
        Scheme::Mueller { .. } => PENALTY_FREQUENCY,
    };
    let gravity = grid.acceleration(setup.gravity);
    let [from, to] = grid.kept;
    vec![
        ("EDGE_X", grid.edge[0].into()),
        ("EDGE_Y", grid.edge[1].into()),
        ("EDGE_Z", grid.edge[2].into()),
        ("CELLS_X", grid.cells[0].into()),
        ("CELLS_Y", grid.cells[1].into()),
        ("CELLS_Z", grid.cells[2].into()),
        ("PERIOD_X", grid.period[0].into()),
        ("PERIOD_Y", grid.period[1].into()),
        ("PERIOD_Z", grid.period[2].into()),
        ("QUANTUM", 1.0 / grid.quanta),
        ("SUPPORT_SQUARED", support * support),
        (
            "NEIGHBOURS_PER_BATCH",
            if setup.batched_neighbours { 4.0 } else { 1.0 },
        ),
        ("LIST_SQUARED", (support + grid.skin).powi(2)),
        // Without a skin every step sorts.
        ("SKIN", if grid.skin > 0.0 { grid.skin } else { -1.0 }),
        ("SMOOTHING", h),
        ("REACH", support),
        ("POLY6", mueller[0]),
        ("SPIKY", mueller[1]),
        ("LAPLACIAN", mueller[2]),
        ("VISCOSITY", viscosity),
        ("PENALTY_STIFFNESS", stiffness.powi(2)),
        ("PENALTY_DAMPING", PENALTY_FREQUENCY),
        ("DEFORMS", f64::from(u8::from(setup.deforms()))),
        ("OPEN_WEIGHT", OPEN * open_weight(setup)),
        ("KERNEL_SCALE", scale),
        ("GRAVITY_X", gravity.x),
        ("GRAVITY_Y", gravity.y),
        ("GRAVITY_Z", gravity.z),
        ("ARTIFICIAL_VISCOSITY", setup.artificial_viscosity),
        ("DENSITY_DIFFUSION", setup.density_diffusion),
        ("COURANT", setup.courant),
        ("KEPT_FROM_X", from[0].into()),
        ("KEPT_FROM_Y", from[1].into()),
        ("KEPT_FROM_Z", from[2].into()),
        ("KEPT_TO_X", to[0].into()),
        ("KEPT_TO_Y", to[1].into()),
        ("KEPT_TO_Z", to[2].into()),
    ]
}
