//! The files of `kernels/`, by name.

/// Pairs of a file name and its text.
macro_rules! sources {
    ($($folder:literal: $($name:literal),* $(,)?);* $(;)?) => {
        &[$($(($name, include_str!(concat!("../../../kernels/", $folder, "/", $name, ".wgsl")))),*),*]
    };
}

/// All kernel files: name without folder and extension, and text.
pub const SOURCES: &[(&str, &str)] = sources! {
    "lattice":
        "neighbour_flags_stored", "neighbour_flags_none", "cell_force_constant", "cell_force_field",
        "cell_force_none", "cell_gradient", "cell_state", "cell_flags_stored", "cell_flags_none", "collide_stream",
        "derive", "eddy_none", "eddy_wale", "equilibrium_product", "equilibrium_second_order",
        "balanced_cell_force", "balanced_force_guo", "balanced_force_none", "exchange", "face_cells", "force_constant", "force_field", "force_none", "gather", "grid", "guard_none",
        "guard_on", "guo", "half", "incoming", "initialise", "velocity_restored", "velocity_psm", "store_velocity_none", "store_velocity", "lanes_1",
        "lanes_2", "lanes_4", "lattice", "link", "links", "mark_blocks", "macroscopic", "moments", "moving_cells", "moving_wall", "near_wall_none", "near_wall_viscosity",
        "odd_rates_bulk", "odd_rates_solids", "odd_rates_walls", "operator_holdych", "operator_noble", "operator_superposition",
        "outflow", "pressure_face", "quantity_eddy_viscosity", "quantity_q_criterion", "quantity_vorticity",
        "reals_direct", "reals_wide", "relax_bgk", "relax_hermite", "relax_suga", "psm_cells", "psm_none", "psm_surface", "sample_observed", "sample_populations", "sampling_none", "sampling_sums", "scalar_grid", "store_f16", "store_f32", "synthetic_turbulence",
        "statistics", "stream", "sum_sample", "sums", "surface_cells", "sloping_cell", "solid_weights", "sloping_exchange", "sloping_faces", "near_wall_bits", "sloping_friction", "surface_fraction", "surface_friction", "surface_none", "surface_stored", "velocity", "wale", "wale_every_second_step", "wale_every_step", "wall_blocks_marked", "wall_blocks_none", "wall_cells", "wall_law_reichardt", "wall_law_werner_wengle", "wall_model", "wall_rates", "weights", "block_friction", "block_friction_none", "block_friction_stored", "bricks_all", "bricks_listed", "law_of_the_wall", "mirror_free_slip", "mirror_none", "mixing_length", "psm_bricks", "psm_places",
        "weight_exact", "weight_standard", "word_f16_2", "word_f16_4", "word_f16_4_wide";
    "gpu":
        "bin_count", "bin_scatter", "invocation", "saturate", "scan_spread", "scan_sum";
    "broadphase":
        "boxes", "found_count", "found_write", "pairs";
    "psm":
        "angle", "axes", "sphere_none", "sphere_power", "sphere_quick", "sphere_fraction", "face_cell_load", "face_layer", "face_siblings", "face_sum_parallel", "face_sum_serial", "brick", "cell_load", "columns", "effective_surface", "effective_volume", "faces", "polyhedron_none", "polyhedron_quick",
        "polyhedron_fraction", "one_plane", "psm_planes", "reduce_blocks", "reduce_faces", "reduce_tiles", "combine_parts",
        "several_planes", "solid_cell", "sum_faces", "sum_of_all", "tables", "joint_gap", "joint_closure", "tile_sum_parallel",
        "tile_sum_serial", "workgroup_index", "voxelise", "voxelise_edges", "wrench";
    "sph":
        "accelerate", "advance_clock", "advect", "apply_penalty", "bodies", "body_load", "body_sums",
        "boundary_force", "boundary_neighbour_lists", "boundary_position", "boundary_pressure", "cell_grid",
        "cell_ranges_open", "cell_ranges_periodic", "check_capacity", "clock", "clock_atomic", "drag_laminar",
        "drag_none", "drift", "equation_of_state_linear", "equation_of_state_tait", "extrapolated_pressure",
        "fluid_neighbours_cells", "fluid_neighbours_lists", "list_fluid_neighbours", "mueller_accelerate",
        "mueller_density", "mueller_drift", "mueller_kernels", "mueller_load", "neighbour_list_layout",
        "neighbour_batch", "neighbour_lists", "neighbours_cells", "neighbours_lists", "penalty", "pressure_probes",
        "reduce_limits", "reduce_particle_limits", "sort_count", "sort_reorder", "sort_scatter",
        "sort_starts", "viscous_laminar", "viscous_none", "wall_velocity_no_slip", "wall_velocity_none",
        "wall_work", "wendland";
};

/// The text of the file `name`.
pub fn source(name: &str) -> Option<&'static str> {
    let found = SOURCES.iter().find(|(known, _)| *known == name);
    found.map(|(_, text)| *text)
}
