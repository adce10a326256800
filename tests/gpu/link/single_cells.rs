//! The kernels at walls and faces, at the start and for output.

use super::specialise::{LAYOUTS, bindings_of, forces, names, specialise, variants};
use riprap::lattice::{Equilibrium, Face, Setup, SolidOperator, WallModel, single_cells};

/// Files, entry points and buffers of the kernels for single cells, without flags and force.
pub const SINGLE: &[(&str, &[&str], &[&str])] = &[
    ("links", &["reflect"], &["cell_pass", "links"]),
    (
        "moving_wall",
        &["move_wall"],
        &["cell_pass", "moving_cells", "wall_velocity"],
    ),
    (
        "synthetic_turbulence",
        &["feed_turbulence"],
        &[
            "cell_pass",
            "moving_cells",
            "wall_velocity",
            "turbulent_cells",
            "turbulent_face",
            "mean_velocity",
            "travelled",
        ],
    ),
    (
        "wall_model",
        &["wall_model", "near_wall", "wall_edges", "near_edges"],
        &[
            "cell_pass",
            "wall_cells",
            "wall_links",
            "wall_stress",
            "near_wall_viscosity",
            "velocity_before_0",
        ],
    ),
    (
        "mark_blocks",
        &["mark_blocks"],
        &["wall_cells", "wall_blocks", "psm_slots", "psm_planes_0"],
    ),
    (
        "block_friction",
        &[
            "forget_outer_cells",
            "list_outer_cells",
            "find_faces",
            "block_friction",
            "clear_viscosity",
            "list_block_faces",
        ],
        &[
            "bricks",
            "face_codes",
            "outer_cells",
            "psm_slots",
            "psm_planes_0",
            "near_wall_viscosity",
            "velocity_before_0",
            "face_counts",
            "found_faces",
        ],
    ),
    (
        "sloping_friction",
        &[
            "find_slopes",
            "slope_law",
            "sloping_slip",
            "sloping_friction",
            "clear_above_slopes",
        ],
        &[
            "bricks",
            "face_codes",
            "outer_cells",
            "slopes",
            "psm_slots",
            "psm_planes_0",
            "near_wall_viscosity",
            "velocity_before_0",
            "cell_pass",
        ],
    ),
    (
        "surface_friction",
        &[
            "surface_law",
            "surface_shares",
            "surface_viscosity",
            "surface_slip",
            "surface_friction",
        ],
        &[
            "wall_cells",
            "slopes",
            "share_places",
            "surface_fractions",
            "all_slip_sums",
            "near_cells",
            "near_wall_viscosity",
            "velocity_before_0",
            "cell_pass",
        ],
    ),
    (
        "pressure_face",
        &["hold_pressure"],
        &["cell_pass", "open_faces", "face_cells"],
    ),
    (
        "outflow",
        &["apply_outflow", "store_outflow"],
        &["cell_pass", "open_faces", "face_cells", "outflow_state"],
    ),
    (
        "exchange",
        &["take_out", "bring_in"],
        &["cell_pass", "direction", "canonical"],
    ),
    (
        "initialise",
        &["initialise"],
        &[
            "cell_pass",
            "density",
            "velocity_x",
            "velocity_y",
            "velocity_z",
        ],
    ),
    (
        "macroscopic",
        &["macroscopic"],
        &[
            "cell_pass",
            "density_out",
            "velocity_x_out",
            "velocity_y_out",
            "velocity_z_out",
        ],
    ),
    (
        "velocity_psm",
        &["velocity_psm"],
        &[
            "bricks",
            "psm_planes_0",
            "density",
            "velocity_x_out",
            "velocity_y_out",
            "velocity_z_out",
        ],
    ),
    (
        "velocity_restored",
        &["velocity_restored"],
        &[
            "restored_cells",
            "restored_velocity",
            "velocity_x_out",
            "velocity_y_out",
            "velocity_z_out",
        ],
    ),
    (
        "sums",
        &["sum_cells"],
        &[
            "density",
            "velocity_x",
            "velocity_y",
            "velocity_z",
            "partial_sums",
        ],
    ),
    (
        "statistics",
        &[
            "begin_statistics",
            "add_observed",
            "merge_block",
            "write_statistic",
        ],
        &[
            "cell_pass",
            "density",
            "velocity_x",
            "velocity_y",
            "velocity_z",
            "statistics_0",
            "statistics_pass",
            "derived",
        ],
    ),
    (
        "derive",
        &["derive"],
        &["velocity_x", "velocity_y", "velocity_z", "derived"],
    ),
];
const QUANTITIES: [&str; 3] = [
    "quantity_q_criterion",
    "quantity_vorticity",
    "quantity_eddy_viscosity",
];

#[test]
fn kernels_for_single_cells_in_all_variants() {
    for variant in variants(&[SINGLE.len(), 4, 2, 2, 3, 3]) {
        let [kernel, layout, equilibrium, walls, force, quantity] = variant[..] else {
            unreachable!()
        };
        let (file, entries, wanted) = SINGLE[kernel];
        let mut setup = Setup::periodic([4; 3], 0.1);
        (setup.storage, setup.lanes, setup.wide) = LAYOUTS[layout];
        setup.equilibrium = [Equilibrium::Product, Equilibrium::SecondOrder][equilibrium];
        setup.wale = Some(0.5);
        if walls == 1 {
            setup.faces[0] = [Face::FreeSlip, Face::FreeSlip];
        }
        setup.force = forces()[force].clone();
        setup.wall_model = Some([WallModel::WernerWengle, WallModel::Reichardt][equilibrium]);
        setup.solid_operator = (quantity == 1).then_some(SolidOperator::Holdych);
        let count = bindings_of(&variant);
        let program = single_cells(&setup, count, file)
            .slot("quantity", QUANTITIES[quantity])
            .slot("sample", ["sample_observed", "sample_populations"][walls]);
        let linked = program
            .link()
            .unwrap_or_else(|error| panic!("{file} {setup:?} {count}: {error}"));
        for entry in entries {
            let (found, populations) = names(&linked, entry);
            for name in wanted {
                assert!(
                    found.contains(*name) || entries.len() > 1,
                    "{entry}: {name}"
                );
            }
            for name in &found {
                let known = wanted.contains(&name.as_str())
                    || name == "flags" && (walls == 1 || quantity == 1)
                    || name == "uniform_force" && force == 1
                    || name == "force_field_0" && force == 2
                    || name == "wall_blocks" && quantity == 1;
                assert!(known, "{entry} binds {name}");
            }
            assert!([0, count as usize].contains(&populations), "{entry}");
            specialise(&linked, entry, &setup, force == 1);
        }
    }
}
