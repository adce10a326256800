//! The kernels of blocks, particles and the broadphase in the languages of drivers.

use super::translate::translate;
use glam::DVec3;
use riprap::{
    gpu::link::{Program, SOURCES},
    lattice::{Grid, Setup as Fluid, SolidWeight, single_cells},
    psm::{
        CellMapping, Forms, combine_parts, reduce_blocks, reduce_faces, reduce_tiles, sum_faces,
        voxelise, voxelise_edges,
    },
    sph::{self, CellGrid, EquationOfState, KERNELS, NeighbourSearch, Setup, Side},
};
use std::collections::HashMap;

/// Translates a kernel with the value 1 for each required constant.
fn plain(program: &Program, entry: &str) {
    let linked = program
        .link()
        .unwrap_or_else(|error| panic!("{entry}: {error}"));
    let overrides = linked.module.overrides.iter();
    let numbers: HashMap<_, _> = overrides
        .filter(|(_, o)| o.init.is_none())
        .filter_map(|(_, o)| Some((o.name.clone()?, 1.0)))
        .collect();
    translate(&linked, entry, &numbers, false);
}

const SEARCH: [&str; 4] = ["bin_count", "bin_scatter", "scan_sum", "scan_spread"];

const EXACT: SolidWeight = SolidWeight::Exact;
const STANDARD: SolidWeight = SolidWeight::Standard;

const SPHERES: Forms = Forms {
    spheres: true,
    polyhedra: false,
};
const POLYHEDRA: Forms = Forms {
    spheres: false,
    polyhedra: true,
};

fn blocks(grid: &Grid) -> Vec<(&'static str, Program)> {
    vec![
        (
            "voxelise",
            voxelise(grid, CellMapping::Serial, Forms::ALL, EXACT),
        ),
        (
            "voxelise",
            voxelise(grid, CellMapping::Parallel, Forms::ALL, STANDARD),
        ),
        (
            "voxelise",
            voxelise(grid, CellMapping::Serial, SPHERES, EXACT),
        ),
        (
            "voxelise",
            voxelise(grid, CellMapping::Serial, POLYHEDRA, STANDARD),
        ),
        ("voxelise_edges", voxelise_edges(grid, Forms::ALL, EXACT)),
        ("voxelise_edges", voxelise_edges(grid, Forms::ALL, STANDARD)),
        ("voxelise_edges", voxelise_edges(grid, SPHERES, EXACT)),
        ("voxelise_edges", voxelise_edges(grid, POLYHEDRA, EXACT)),
        ("combine_parts", combine_parts(grid, CellMapping::Serial)),
        ("combine_parts", combine_parts(grid, CellMapping::Parallel)),
        ("reduce_tiles", reduce_tiles(grid, CellMapping::Serial)),
        ("reduce_tiles", reduce_tiles(grid, CellMapping::Parallel)),
        ("reduce_faces", reduce_faces(grid, CellMapping::Serial)),
        ("reduce_faces", reduce_faces(grid, CellMapping::Parallel)),
        ("sum_faces", sum_faces()),
        ("reduce_blocks", reduce_blocks()),
    ]
}

fn grid() -> Grid {
    Grid {
        cells: [8; 3],
        elements: [8, 8, 4],
        lanes: 2,
        lane_axis: 2,
        brick: [4; 3],
    }
}

#[test]
fn kernels_of_blocks() {
    for (entry, program) in blocks(&grid()) {
        plain(&program, entry);
    }
}

#[test]
fn kernels_of_particles_in_all_variants() {
    for periodic in [false, true] {
        for state in [EquationOfState::Linear, EquationOfState::Tait] {
            for neighbours in [NeighbourSearch::Cells, NeighbourSearch::Lists] {
                let mut setup = Setup::tank(DVec3::splat(2.0), 0.1, 10.0);
                (setup.equation_of_state, setup.neighbours) = (state, neighbours);
                // For one equation of state only, to cover both variants.
                setup.laminar_viscosity = match state {
                    EquationOfState::Linear => 0.0,
                    EquationOfState::Tait => 0.01,
                };
                if periodic {
                    setup.faces[0] = [Side::Periodic; 2];
                }
                let frame = CellGrid::new(&setup).unwrap();
                for kernel in KERNELS {
                    plain(&sph::program(&setup, &frame, kernel), kernel);
                }
            }
        }
    }
}

#[test]
fn kernels_of_the_search_for_pairs() {
    for kernel in SEARCH {
        plain(&Program::new(kernel), kernel);
    }
    for found in ["found_count", "found_write"] {
        plain(&Program::new("pairs").slot("found", found), "pairs");
    }
}

#[test]
fn the_kernel_that_gathers() {
    let fluid = Fluid::periodic([4; 3], 0.1);
    plain(&single_cells(&fluid, 1, "gather"), "gather");
}

/// Finds kernels that no test translates.
#[test]
fn every_file_with_an_entry_point_is_translated() {
    let single = super::single_cells::SINGLE.iter().map(|(file, ..)| *file);
    let known: Vec<&str> = blocks(&grid())
        .iter()
        .map(|(entry, _)| *entry)
        .chain(KERNELS)
        .chain(SEARCH)
        .chain(["pairs", "gather", "collide_stream"])
        .chain(single)
        .collect();
    for (name, text) in SOURCES {
        assert!(!text.contains("@compute") || known.contains(name), "{name}");
    }
}
