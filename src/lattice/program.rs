//! The WGSL files and constants of the kernels of a setup.

use super::{
    Bindings, Collision, Equilibrium, Face, Force, Grid, PsmAccess, Setup, SolidOperator,
    SolidWeight, Storage, WallModel, populations, psm_storage, spread,
};
use crate::gpu::link::Program;

/// The cells of a collide–stream kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BrickKind {
    /// All bricks, and all cells are plain fluid.
    All,
    /// Listed bricks of plain fluid.
    Plain,
    /// Listed bricks with the flags of each cell.
    Flagged,
    /// Listed bricks with flags and with cells that static solids fill in part.
    Surface,
    /// Listed bricks with flags and with the planes of partially saturated cells.
    Psm,
}

/// A kernel over elements, with the storage, lanes and bindings of the setup.
fn base(entry: &str, setup: &Setup, bindings: Bindings) -> Program {
    let workgroup: u32 = setup.brick.iter().product();
    let program = Program::new(entry)
        .text("workgroup", format!("const WORKGROUP = {workgroup}u;\n"))
        .slot("lanes", &format!("lanes_{}", setup.lanes))
        .text(
            "populations",
            populations::accessors(bindings.populations, setup),
        )
        .text(
            "velocities",
            spread::velocities(bindings.vectors, setup.wale_interval),
        )
        .text("forces", spread::forces(bindings.vectors, false))
        .text(
            "statistics_planes",
            spread::statistics(bindings.statistics, false),
        )
        .text(
            "psm_storage",
            psm_storage(bindings.psm_planes, PsmAccess::Elements),
        );
    let wide = setup.is_wide();
    let word = format!(
        "word_f16_{}{}",
        setup.lanes,
        if wide { "_wide" } else { "" }
    );
    let program = match setup.storage {
        Storage::F32 => program.slot("store", "store_f32"),
        Storage::F16 => program.slot("store", "store_f16").slot("word", &word),
    };
    let program = program.slot("reals", if wide { "reals_wide" } else { "reals_direct" });
    match setup.force {
        Force::None => program
            .slot("force", "force_none")
            .slot("balanced_force", "balanced_force_none"),
        Force::Constant(_) => program
            .slot("force", "guo")
            .slot("balanced_force", "balanced_force_guo")
            .slot("body_force", "force_constant"),
        Force::Field(_) => program
            .slot("force", "guo")
            .slot("balanced_force", "balanced_force_guo")
            .slot("body_force", "force_field"),
    }
}

/// The fused collision and streaming of a setup; with bindings for statistics over time it adds the state before the step to
/// these.
pub fn collide_stream(setup: &Setup, bindings: impl Into<Bindings>, kind: BrickKind) -> Program {
    let either = |condition, yes, no| if condition { yes } else { no };
    let with_solids = matches!(kind, BrickKind::Surface | BrickKind::Psm);
    let flagged = with_solids || kind == BrickKind::Flagged;
    let operator = setup
        .operator()
        .filter(|_| with_solids)
        .map(|operator| match operator {
            SolidOperator::Holdych => "operator_holdych",
            SolidOperator::Noble => "operator_noble",
            SolidOperator::Superposition => "operator_superposition",
        });
    let bindings = bindings.into();
    let program = base("collide_stream", setup, bindings);
    let program = match operator {
        Some(operator) => program
            .slot(
                "psm",
                either(kind == BrickKind::Psm, "psm_cells", "psm_surface"),
            )
            .slot(
                "surface",
                either(setup.surface.is_empty(), "surface_none", "surface_stored"),
            )
            .slot("operator", operator)
            .slot(
                "weight",
                match setup.weight() {
                    SolidWeight::Exact => "weight_exact",
                    SolidWeight::Standard => "weight_standard",
                },
            )
            .slot(
                "block_friction",
                either(
                    setup.has_block_friction(),
                    "block_friction_stored",
                    "block_friction_none",
                ),
            )
            .slot("odd_rates", "odd_rates_solids"),
        None => program.slot("psm", "psm_none").slot(
            "odd_rates",
            either(flagged, "odd_rates_walls", "odd_rates_bulk"),
        ),
    };
    program
        .slot(
            "bricks",
            either(kind == BrickKind::All, "bricks_all", "bricks_listed"),
        )
        .slot(
            "cell_flags",
            either(flagged, "cell_flags_stored", "cell_flags_none"),
        )
        .slot("equilibrium", equilibrium(setup.equilibrium))
        .slot(
            "relax",
            match setup.collision {
                Collision::Bgk => "relax_bgk",
                Collision::Hermite => "relax_hermite",
                Collision::Suga => "relax_suga",
            },
        )
        .slot(
            "eddy",
            either(setup.wale.is_some(), "eddy_wale", "eddy_none"),
        )
        .slot(
            "wale_interval",
            either(
                setup.wale_interval == 2,
                "wale_every_second_step",
                "wale_every_step",
            ),
        )
        .slot(
            "near_wall",
            either(
                setup.wall_model.is_some(),
                "near_wall_viscosity",
                "near_wall_none",
            ),
        )
        .slot(
            "store_velocity",
            either(
                setup.wale.is_some(),
                "store_velocity",
                "store_velocity_none",
            ),
        )
        .slot(
            "guard",
            either(setup.max_speed > 0.0, "guard_on", "guard_none"),
        )
        .slot(
            "sampling",
            either(bindings.statistics > 0, "sampling_sums", "sampling_none"),
        )
}

/// A kernel of a setup for single cells: at walls and faces, at the start, for output.
pub fn single_cells(setup: &Setup, bindings: impl Into<Bindings>, entry: &str) -> Program {
    let bindings = bindings.into();
    let flags = match setup.is_all_fluid() {
        true => "neighbour_flags_none",
        false => "neighbour_flags_stored",
    };
    let force = match setup.force {
        Force::None => "cell_force_none",
        Force::Constant(_) => "cell_force_constant",
        Force::Field(_) => "cell_force_field",
    };
    let law = match setup.wall_model {
        Some(WallModel::Reichardt) => "wall_law_reichardt",
        _ => "wall_law_werner_wengle",
    };
    Program::new(entry)
        .text(
            "scalars",
            populations::scalars(bindings.populations, setup.storage),
        )
        .text("cell_velocities", spread::cell_velocities(bindings.vectors))
        .slot("wall_law", law)
        .slot(
            "wall_blocks",
            match setup.solid_operator {
                Some(_) => "wall_blocks_marked",
                None => "wall_blocks_none",
            },
        )
        .slot(
            "mirror",
            // What leaves blocks at a free-slip face is reflected by the face after their friction.
            match entry == "surface_friction" && free_slip(setup) != 0 {
                true => "mirror_free_slip",
                false => "mirror_none",
            },
        )
        .text("forces", spread::forces(bindings.vectors, true))
        .text(
            "statistics_planes",
            spread::statistics(bindings.statistics, true),
        )
        .text(
            "psm_storage",
            psm_storage(bindings.psm_planes, PsmAccess::Cells),
        )
        .text(
            "psm_storage_written",
            psm_storage(bindings.psm_planes, PsmAccess::WrittenCells),
        )
        .slot("lanes", "lanes_1")
        .slot("reals", "reals_direct")
        .slot("neighbour_flags", flags)
        .slot("equilibrium", equilibrium(setup.equilibrium))
        .slot("cell_force", force)
}

/// The free-slip faces of the domain, one bit each for x−, x+, ….
fn free_slip(setup: &Setup) -> u32 {
    let faces = setup.faces.as_flattened().iter().enumerate();
    let free_slip = faces.filter(|(_, face)| **face == Face::FreeSlip);
    free_slip.fold(0, |bits, (n, _)| bits | 1 << n)
}

/// The file of an equilibrium.
pub fn equilibrium(kind: Equilibrium) -> &'static str {
    match kind {
        Equilibrium::Product => "equilibrium_product",
        Equilibrium::SecondOrder => "equilibrium_second_order",
    }
}

/// The constants of a setup for all of its kernels; `odd` is the parity of the step.
pub fn constants(setup: &Setup, grid: &Grid, odd: bool) -> Vec<(&'static str, f64)> {
    let everywhere = setup.lambda.map(|lambda| setup.odd_rate(lambda));
    let rates = setup.bulk_rates();
    let bulk = |rate| everywhere.unwrap_or(rate);
    let mut all = vec![
        ("NX", grid.elements[0].into()),
        ("NY", grid.elements[1].into()),
        ("NZ", grid.elements[2].into()),
        ("LANES_Y", grid.lanes_along(1).into()),
        ("LANES_Z", grid.lanes_along(2).into()),
        ("LANES_OF_ELEMENT", grid.lanes.into()),
        ("CELLS_X", grid.cells[0].into()),
        ("CELLS_Y", grid.cells[1].into()),
        ("CELLS_Z", grid.cells[2].into()),
        ("NO_WALLS", no_walls(setup).into()),
        ("BRICK_X", grid.brick[0].into()),
        ("BRICK_Y", grid.brick[1].into()),
        ("BRICK_Z", grid.brick[2].into()),
        ("SURFACE_PLANES", setup.surface_planes().into()),
        ("SLOPING", setup.has_sloping_friction().into()),
        ("FREE_SLIP", free_slip(setup).into()),
        ("ODD", f64::from(u8::from(odd))),
        ("GUARD_ODD", f64::from(u8::from(odd))),
        ("MAX_SPEED_SQUARED", setup.max_speed * setup.max_speed),
        ("TAU", setup.tau()),
        ("TAU_MINUS_HALF", 3.0 * setup.nu),
        ("VISCOSITY", setup.nu),
        ("S4", rates.s4),
        ("S10", bulk(rates.s10)),
        ("S13", bulk(rates.s13)),
        ("S16", rates.s16),
        ("S17", rates.s17),
        ("S18", rates.s18),
        ("S20", rates.s20),
        ("S23", bulk(rates.s23)),
        ("S26", bulk(rates.s26)),
    ];
    let [at_walls, at_blocks] = setup.odd_rates();
    let wall = |rate| at_walls.unwrap_or(rate);
    all.extend([
        ("W10", wall(rates.s10)),
        ("W13", wall(rates.s13)),
        ("W23", wall(rates.s23)),
        ("W26", wall(rates.s26)),
    ]);
    let balanced = setup
        .periodic_axes()
        .map(|periodic| f64::from(u8::from(!periodic)));
    all.extend([
        ("BALANCED_X", balanced[0]),
        ("BALANCED_Y", balanced[1]),
        ("BALANCED_Z", balanced[2]),
    ]);
    let near = |rate| at_blocks.unwrap_or(rate);
    all.extend([
        ("N10", near(rates.s10)),
        ("N13", near(rates.s13)),
        ("N23", near(rates.s23)),
        ("N26", near(rates.s26)),
    ]);
    let [joint, facing] = setup.joint_weights();
    all.extend([("JOINT_WEIGHT", joint), ("FACING_WEIGHT", facing)]);
    if let Some(constant) = setup.wale {
        all.push(("C_WALE", constant));
    }
    all
}

/// A bit for each face that is neither a wall at rest nor periodic: x−, x+, y−, ….
fn no_walls(setup: &Setup) -> u32 {
    let faces = setup.faces.iter().flatten().enumerate();
    let others =
        faces.filter(|(_, face)| !matches!(face, Face::Wall([0.0, 0.0, 0.0]) | Face::Periodic));
    others.map(|(n, _)| 1 << n).sum()
}
