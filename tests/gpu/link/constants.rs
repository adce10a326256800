//! Constants of kernels: all are set, and none is unused.

use super::single_cells::SINGLE;
use glam::DVec3;
use riprap::{
    Error,
    gpu::{
        kernel::Kernel,
        link::{Linked, Program},
    },
    lattice::{
        self, BrickKind, Collision, Force, Grid, SolidOperator, SurfaceCell, collide_stream,
        single_cells,
    },
    psm,
    sph::{self, CellGrid, KERNELS, NeighbourSearch, Scheme, Side},
    wgpu,
};

const FALL: &str = "// A kernel.
override GRAVITY_Z: f32;
@group(0) @binding(0) var<storage, read_write> speeds: array<f32>;
@compute @workgroup_size(1)
fn fall() { speeds[0] += GRAVITY_Z; }
";

#[test]
fn misspelt_and_missing_constants_are_refused_by_name() {
    let (device, _) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    let linked = Program::new("fall").text("fall", FALL).link().unwrap();
    let refused = |constants: &[(&str, f64)]| match Kernel::new(&device, &linked, "fall", constants)
        .unwrap_err()
    {
        Error::Binding { binding, .. } => binding,
        other => panic!("{other}"),
    };
    assert_eq!(
        refused(&[("GRAVITY_Y", 1.0), ("GRAVITY_Z", 1.0)]),
        "GRAVITY_Y"
    );
    assert_eq!(refused(&[]), "GRAVITY_Z");
    assert_eq!(refused(&[("GRAVITY_Z", f64::INFINITY)]), "GRAVITY_Z");
    Kernel::new(&device, &linked, "fall", &[("GRAVITY_Z", -9.81)]).unwrap();
}

/// Each name in a family's table of constants is declared by a kernel of the family, so that none is unused.
fn check_family(family: &[(&str, f64)], kernels: impl IntoIterator<Item = Linked>) {
    let kernels: Vec<Linked> = kernels.into_iter().collect();
    for (name, _) in family {
        let used = kernels.iter().any(|linked| linked.declares(name));
        assert!(used, "no kernel declares {name}");
    }
}

#[test]
fn constants_of_the_lattice() {
    let mut setup = lattice::Setup::periodic([4; 3], 0.1);
    setup.collision = Collision::Hermite;
    setup.solid_operator = Some(SolidOperator::Holdych);
    setup.wale = Some(0.5);
    setup.force = Force::Constant([1e-6; 3]);
    setup.surface = vec![SurfaceCell {
        cell: 0,
        fraction: 0.5,
    }];
    let streams = [
        BrickKind::All,
        BrickKind::Plain,
        BrickKind::Flagged,
        BrickKind::Psm,
    ]
    .map(|reach| collide_stream(&setup, 1, reach));
    let cells = SINGLE.iter().map(|(file, ..)| {
        single_cells(&setup, 1, file)
            .slot("quantity", "quantity_eddy_viscosity")
            .slot("sample", "sample_populations")
    });
    let grid = Grid::new(&setup).unwrap();
    let linked = streams.into_iter().chain(cells);
    check_family(
        &lattice::constants(&setup, &grid, false),
        linked.map(|program| program.link().unwrap()),
    );
}

#[test]
fn constants_of_blocks() {
    let grid = Grid {
        cells: [8; 3],
        elements: [8; 3],
        lanes: 1,
        lane_axis: 2,
        brick: [4; 3],
    };
    let linked = psm::combine_parts(&grid, psm::CellMapping::Serial)
        .link()
        .unwrap();
    check_family(&psm::constants(&grid), [linked]);
}

#[test]
fn constants_of_particles() {
    let mut setup = sph::Setup::tank(DVec3::splat(2.0), 0.1, 10.0);
    setup.faces[0] = [Side::Periodic; 2];
    setup.neighbours = NeighbourSearch::Lists;
    for scheme in [Scheme::Delta, Scheme::Mueller { viscosity: 0.01 }] {
        setup.scheme = scheme;
        let grid = CellGrid::new(&setup).unwrap();
        let linked = KERNELS.map(|kernel| {
            let program = sph::program(&setup, &grid, kernel);
            program.link().unwrap()
        });
        check_family(&sph::constants(&setup, &grid), linked);
    }
}
