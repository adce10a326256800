//! Row lengths that suit an adapter.

use riprap::{
    lattice::{Face, Grid, Setup, SolidOperator},
    wgpu,
};

/// Rows of 64, or of 32 if those leave fewer invocations outside of the grid; short grids have short rows.
#[test]
fn rows_for_cpus_leave_few_invocations_beyond_the_grid() {
    for (cells, wall, row) in [
        (1, false, 8),
        (17, false, 32),
        (32, false, 32),
        (32, true, 32),
        (96, false, 32),
        (96, true, 32),
        (97, false, 64),
        (128, false, 64),
        (128, true, 64),
        (144, true, 32),
    ] {
        let mut setup = Setup::periodic([cells, 3, 3], 0.01);
        if wall {
            setup.faces[0] = [Face::Wall([0.0; 3]), Face::Wall([0.0; 3])];
        }
        setup.use_cpu_layout(wgpu::Features::empty());
        assert_eq!(setup.brick[0], row, "{cells} cells, walls: {wall}");
        assert!(setup.brick.iter().product::<u32>() >= 32);
    }
}

/// Rows that are as long as few idle invocations allow, and of 32 with blocks in the fluid; each begins at a memory line.
#[test]
fn rows_for_gpus_are_long_and_aligned() {
    for (cells, blocks, brick) in [
        (5, false, [8, 8, 1]),
        (20, false, [32, 2, 1]),
        (96, false, [32, 2, 1]),
        (120, false, [128, 1, 1]),
        (192, false, [64, 1, 1]),
        (256, false, [128, 1, 1]),
        (256, true, [32, 2, 1]),
        (u32::MAX, false, [128, 1, 1]),
        (u32::MAX, true, [32, 2, 1]),
    ] {
        let mut setup = Setup::periodic([cells, 3, 3], 0.01);
        setup.solid_operator = blocks.then_some(SolidOperator::Holdych);
        setup.use_gpu_layout();
        assert_eq!(setup.brick, brick, "{cells} cells, blocks: {blocks}");
    }
    let mut setup = Setup::periodic([97, 3, 3], 0.01);
    setup.use_gpu_layout();
    assert_eq!(Grid::new(&setup).unwrap().elements, [97, 3, 3]);
    setup.faces[0] = [Face::Wall([0.0; 3]), Face::Wall([0.0; 3])];
    assert_eq!(Grid::new(&setup).unwrap().elements, [128, 3, 3]);
}
