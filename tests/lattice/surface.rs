//! Cells that solids at rest fill partially: compared with the f64 twin, and the position of planes along the grid.

use super::kernels::assert_equal_to_twin;
use kit::{
    Rig, assert_contains, assert_near,
    twin::of_setup::{layouts, noise, walled},
};
use riprap::{
    lattice::{
        Collision, Face, Force, Grid, Lattice, Setup, SolidOperator, State, SurfaceCell, memory,
    },
    wgpu,
};

/// A bump on walls of every kind, with its surface in the fluid cells next to its solid ones.
fn bumpy(lanes: u32, storage: riprap::lattice::Storage) -> Setup {
    let mut setup = walled(lanes, storage);
    let beside = |cell: usize| {
        let [x, y, z] = [cell % 6, cell / 6 % 5, cell / 30];
        (3..6).contains(&x) && y < 3 && (1..7).contains(&z)
    };
    setup.surface = (0..6 * 5 * 7)
        .filter(|&cell| !setup.solid[cell] && beside(cell))
        .map(|cell| SurfaceCell {
            cell: cell as u32,
            fraction: (0.5 + 0.499 * noise(cell)) as f32,
        })
        .collect();
    setup
}

#[test]
fn cells_that_are_filled_in_part_are_those_of_the_twin() {
    let operators = [
        None,
        Some(SolidOperator::Holdych),
        Some(SolidOperator::Noble),
    ];
    for (n, (storage, lanes, axis)) in layouts().into_iter().enumerate() {
        let mut setup = bumpy(lanes, storage);
        setup.lane_axis = axis;
        setup.solid_operator = operators[n % 3];
        setup.wale = Some(0.5);
        setup.force = Force::Constant([0.0, -1e-3, 5e-4]);
        let name = format!(
            "{storage:?} {lanes} along {axis}, {:?}",
            setup.solid_operator
        );
        assert_equal_to_twin(&name, &setup);
    }
}

#[test]
fn collisions_in_a_periodic_box() {
    for collision in [Collision::Bgk, Collision::Hermite, Collision::Suga] {
        let mut setup = Setup::periodic([5, 7, 4], 0.015);
        setup.collision = collision;
        if collision == Collision::Suga {
            // Suga's operator keeps its published rates.
            setup.solid_lambda = None;
        }
        setup.surface = (0..140)
            .filter(|cell| cell % 3 == 0)
            .map(|cell| SurfaceCell {
                cell,
                fraction: (0.5 + 0.499 * noise(cell as usize)) as f32,
            })
            .collect();
        assert_equal_to_twin(&format!("{collision:?}"), &setup);
    }
}

/// Poiseuille flow between planes that cut their cells, on 8 cells: compared by the velocity in the middle.
#[test]
fn planes_along_the_grid_lie_where_they_should() {
    let rig = Rig::new();
    let push = 1e-6;
    for nu in [0.03, 0.2] {
        for offset in [0.1f32, 0.3, 0.5, 0.9] {
            let mut setup = Setup::periodic([3, 4, 12], nu);
            setup.faces[2] = [Face::Wall([0.0; 3]), Face::Wall([0.0; 3])];
            setup.force = Force::Constant([push, 0.0, 0.0]);
            let layer = |z: u32| 12 * z..12 * (z + 1);
            let solid = |z: u32| !(2..=10).contains(&z);
            setup.solid = (0..144).map(|cell| solid(cell / 12)).collect();
            let cells =
                |z: u32, fraction: f32| layer(z).map(move |cell| SurfaceCell { cell, fraction });
            setup.surface = cells(2, offset).chain(cells(10, 1.0 - offset)).collect();
            let mut lattice = rig.start(setup, &State::rest(144), true);
            rig.run(
                &mut lattice,
                (8.0 * 64.0 / (9.87 * nu)).max(1000.0) as usize,
            );
            let mut middle = 0.0;
            for _ in 0..4 {
                rig.run(&mut lattice, 1);
                middle += 0.25 * f64::from(rig.state(&mut lattice).velocity[0][12 * 6 + 5]);
            }
            let from_centre = 6.5 - (6.0 + f64::from(offset));
            let apparent = (8.0 * nu * middle / push + 4.0 * from_centre * from_centre).sqrt();
            assert_near(0.5 * (8.0 - apparent), 0.0, 0.03);
        }
    }
}

#[test]
fn what_a_surface_takes_is_counted() {
    let limits = wgpu::Limits::default();
    let mut setup = Setup::periodic([32, 4, 4], 0.1);
    let of = |setup: &Setup| memory(setup, &Grid::new(setup).unwrap(), &limits).unwrap();
    let before = of(&setup);
    let cell = 16;
    setup.surface = vec![SurfaceCell {
        cell,
        fraction: 0.5,
    }];
    let after = of(&setup);
    // Eight bricks of 16 × 2 × 2 elements; the cell and its six neighbours lie in four of them. Elements have flags as well.
    assert_eq!(after.others - before.others, 4 * (8 + 4 * 64 + 512));
}

#[test]
fn what_is_no_surface_is_refused() {
    let rig = Rig::new();
    let refused = |cells: &[(u32, f32)], part: &str| {
        let mut setup = Setup::periodic([3, 3, 3], 0.1);
        setup.solid = (0..27).map(|cell| cell == 4).collect();
        let cells = cells.iter();
        setup.surface = cells
            .map(|&(cell, fraction)| SurfaceCell { cell, fraction })
            .collect();
        let error = Lattice::new(&rig.device, setup).unwrap_err();
        assert_contains(error, &["surface", part]);
    };
    refused(&[(27, 0.5)], "cell 27 is not in the domain");
    refused(&[(3, 0.5), (3, 0.5)], "each cell once");
    refused(&[(3, 1.0)], "cell 3 is not filled in part");
    refused(&[(3, f32::NAN)], "cell 3 is not filled in part");
    refused(&[(4, 0.5)], "cell 4 is solid");
}
