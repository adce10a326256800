//! Which files and numbers make the kernels of particles.

use super::{Frame, Neighbours, Scheme, Setup, StateEquation};
use crate::link::Program;
use std::f64::consts::PI;

/// Storage buffers of the kernel that has the most of them, `mueller_move` with lists.
pub const MOST_BINDINGS: u32 = 8;

/// Frequency of a particle on the spring of a wall, over that of sound across a spacing: half of what limits the
/// step; it is damped to half of its critical damping.
const PENALTY: f64 = 0.5;

/// The same where walls have shells, and only what is in between their particles is to come out: at 2 % of the speed of
/// sound from a spacing's depth.
const KEEP_OUT: f64 = 0.1;

/// The kernels of a step, each an entry point of the file of its name.
pub const KERNELS: [&str; 22] = [
    "sort_count",
    "sort_keep",
    "sort_list",
    "sort_order",
    "shell_place",
    "shell_pressure",
    "neighbours",
    "shell_neighbours",
    "admit",
    "accelerate",
    "keep_out",
    "shell_force",
    "body_load",
    "pressure_at",
    "drift",
    "mueller_density",
    "mueller_move",
    "mueller_load",
    "mueller_drift",
    "least_of_water",
    "least",
    "tick",
];

/// The program of a kernel: slots that it does not have are passed over.
pub fn program(setup: &Setup, frame: &Frame, kernel: &str) -> Program {
    let periodic = frame.period.iter().any(|period| *period > 0);
    let viscous = setup.laminar_viscosity > 0.0;
    let where_viscous = |some, none| if viscous { some } else { none };
    Program::new(kernel)
        .slot(
            "friction",
            where_viscous("friction_laminar", "friction_none"),
        )
        .slot("cling", where_viscous("cling_walls", "cling_none"))
        .slot("drag", where_viscous("drag_laminar", "drag_none"))
        .slot(
            "runs",
            if periodic {
                "runs_periodic"
            } else {
                "runs_open"
            },
        )
        .slot(
            "around",
            match setup.neighbours {
                Neighbours::Cells => "around_cells",
                Neighbours::Lists => "around_lists",
            },
        )
        .slot(
            "around_water",
            match setup.neighbours {
                Neighbours::Cells => "water_cells",
                Neighbours::Lists => "water_lists",
            },
        )
        .slot(
            "state",
            match setup.state {
                StateEquation::Linear => "state_linear",
                StateEquation::Tait => "state_tait",
            },
        )
}

/// The numbers that they take.
pub fn constants(setup: &Setup, frame: &Frame) -> Vec<(&'static str, f64)> {
    let h = setup.smoothing;
    let scale = match setup.plane {
        true => 7.0 / (4.0 * PI * h.powi(2)),
        false => 21.0 / (16.0 * PI * h.powi(3)),
    };
    let reach = 2.0 * h;
    // Poly6, spiky and Laplacian: see the kernels.
    let mueller = match setup.plane {
        true => [
            4.0 / (PI * reach.powi(8)),
            30.0 / (PI * reach.powi(5)),
            40.0 / (PI * reach.powi(5)),
        ],
        false => [
            315.0 / (64.0 * PI * reach.powi(9)),
            45.0 / (PI * reach.powi(6)),
            45.0 / (PI * reach.powi(6)),
        ],
    };
    let viscosity = match setup.scheme {
        Scheme::Delta => setup.laminar_viscosity,
        Scheme::Mueller { viscosity } => viscosity,
    } * frame.unit_time()
        / setup.spacing.powi(2);
    let stiffness = match setup.scheme {
        Scheme::Delta => KEEP_OUT,
        Scheme::Mueller { .. } => PENALTY,
    };
    let gravity = frame.acceleration(setup.gravity);
    let [from, to] = frame.kept;
    vec![
        ("EDGE_X", frame.edge[0].into()),
        ("EDGE_Y", frame.edge[1].into()),
        ("EDGE_Z", frame.edge[2].into()),
        ("CELLS_X", frame.cells[0].into()),
        ("CELLS_Y", frame.cells[1].into()),
        ("CELLS_Z", frame.cells[2].into()),
        ("PERIOD_X", frame.period[0].into()),
        ("PERIOD_Y", frame.period[1].into()),
        ("PERIOD_Z", frame.period[2].into()),
        ("QUANTUM", 1.0 / frame.quanta),
        ("SUPPORT_SQUARED", reach * reach),
        ("LIST_SQUARED", (reach + frame.skin).powi(2)),
        // Without lists, or with those that reach no farther, each step sorts.
        ("SKIN", if frame.skin > 0.0 { frame.skin } else { -1.0 }),
        ("SMOOTHING", h),
        ("REACH", reach),
        ("POLY6", mueller[0]),
        ("SPIKY", mueller[1]),
        ("LAPLACIAN", mueller[2]),
        ("VISCOSITY", viscosity),
        ("PENALTY_STIFFNESS", stiffness.powi(2)),
        ("PENALTY_DAMPING", PENALTY),
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
