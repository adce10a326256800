//! The law of the wall at faces of blocks and at exact surfaces, in the collision of partially saturated cells.

use crate::fixture::Subject;
use kit::twin::{Solid, of_setup::limit};
use riprap::lattice::{Face, Force, Setup, SolidOperator, Storage, SurfaceCell, WallModel};

/// Asserts that a restart is bitwise equal; `fill` sets the solids.
fn assert_restarts(subject: &mut Subject, fill: impl Fn(&mut Subject)) {
    let state = subject.rig.populations(&mut subject.lattice);
    let mut again = Subject::new(&subject.setup);
    fill(&mut again);
    let (device, queue) = (&again.rig.device, &again.rig.queue);
    again
        .lattice
        .set_populations(device, queue, &state)
        .unwrap();
    let ends = [subject, &mut again].map(|subject| {
        subject.rig.run(&mut subject.lattice, 3);
        subject.rig.populations(&mut subject.lattice)
    });
    assert!(ends[0] == ends[1], "{:?}", again.setup.storage);
}

/// The wall model is not applied at walls near blocks.
#[test]
fn a_wall_model_beside_blocks() {
    for (storage, lanes, axis, brick) in [
        (Storage::F32, 1, 2, [4, 4, 2]),
        (Storage::F32, 4, 1, [8, 4, 1]),
        (Storage::F16, 2, 2, [4, 2, 4]),
    ] {
        let mut setup = Setup::periodic([13, 12, 11], 1e-6);
        (setup.storage, setup.lanes, setup.lane_axis, setup.brick) = (storage, lanes, axis, brick);
        setup.solid_operator = Some(SolidOperator::Holdych);
        setup.wale = Some(0.5);
        setup.wall_model = Some(WallModel::WernerWengle);
        setup.faces[2] = [Face::Wall([0.0; 3]), Face::Wall([0.0; 3])];
        let mut subject = Subject::new(&setup);
        let mut bricks = subject.some_bricks();
        bricks.truncate(bricks.len() / 8);
        subject.fill(&bricks);
        for steps in [1, 1, 3] {
            subject.rig.run(&mut subject.lattice, steps);
            subject.twin.run(steps);
            let error = subject.population_error();
            println!("{storage:?}, {lanes} lanes: {error:e}");
            assert!(
                error < limit(&setup),
                "{storage:?}, {lanes} lanes: {error:e}"
            );
        }
        // The walls with blocks near them are those of the previous step.
        assert_restarts(&mut subject, |again| again.fill(&bricks));
        let (device, queue) = (&subject.rig.device, &subject.rig.queue);
        let walls = subject
            .rig
            .wait(subject.lattice.wall_stresses(device, queue))
            .unwrap();
        let modelled = walls.iter().filter(|wall| wall.share > 0.0).count();
        assert!(
            0 < modelled && modelled < walls.len(),
            "{modelled} of {}",
            walls.len()
        );
    }
}

/// A moving plate, with a step on it and a face that is slightly inclined to the grid, starting at the fraction `first` of a
/// cell; a hole in it, where no brick is listed, has edges.
fn plate([nx, ny]: [usize; 2], first: f64, cell: usize) -> Solid {
    let (x, y) = (cell % nx, cell / nx % ny);
    let step = usize::from((5..8).contains(&x));
    let fraction = match y {
        2..6 => 1.0,
        6 if step == 1 => 1.0,
        6 => first + x as f64 / 256.0,
        _ => 0.0,
    };
    Solid {
        fraction,
        shares: fraction,
        velocity: [0.0078125, 0.0, -0.001953125].map(|v| v * f64::from(u8::from(fraction > 0.0))),
        deep: y == 4,
        beside: y == 1 || (y == 7 && step == 1),
        ..Solid::default()
    }
}

#[test]
fn friction_of_blocks() {
    let brick_of = [[4, 4, 2], [8, 4, 1], [4, 2, 4]];
    let layouts = [
        (Storage::F32, 1, 2),
        (Storage::F32, 4, 1),
        (Storage::F16, 2, 2),
    ];
    for (n, (storage, lanes, axis)) in layouts.into_iter().enumerate() {
        // From no contribution of the law of the wall to its full contribution.
        for (nu, first) in [(3e-3, 0.4375), (2e-5, 0.9375), (1e-6, 0.4375)] {
            let mut setup = Setup::periodic([13, 16, 12], nu);
            setup.faces[2] = [Face::Wall([0.0; 3]), Face::FreeSlip];
            (setup.storage, setup.lanes, setup.lane_axis) = (storage, lanes, axis);
            setup.brick = brick_of[n];
            setup.solid_operator = Some([SolidOperator::Holdych, SolidOperator::Noble][n % 2]);
            setup.wale = Some(0.5);
            setup.wall_model = Some([WallModel::WernerWengle, WallModel::Reichardt][n % 2]);
            setup.force = Force::Constant([1e-5, 0.0, 3e-4]);
            let mut subject = Subject::new(&setup);
            let bricks = subject.some_bricks();
            subject.fill_with(&bricks, |cell| plate([13, 16], first, cell));
            for steps in [1, 1, 3] {
                subject.rig.run(&mut subject.lattice, steps);
                subject.twin.run(steps - 1);
                let forces = subject.force_error(&bricks);
                subject.twin.step();
                let populations = subject.population_error();
                let name = format!("{storage:?}, {lanes} lanes, nu {nu}, step {steps}");
                println!("{name}: populations {populations:e}, forces {forces:e}");
                assert!(populations.max(forces) < limit(&setup), "{name}");
                assert_equal_faces(&name, &subject);
            }
            if nu == 1e-6 {
                assert_restarts(&mut subject, |again| {
                    again.fill_with(&bricks, |cell| plate([13, 16], first, cell));
                });
            }
        }
    }
}

/// A moving slab whose upper face rises along x and, less, along z, up to its edges.
fn slab([nx, ny, nz]: [usize; 3], slope: f64, cell: usize) -> Solid {
    let at = [cell % nx, cell / nx % ny, cell / nx / ny];
    let fraction = |[x, y, z]: [usize; 3]| match y {
        0 | 1 => 0.0,
        _ => {
            let rise = slope * (0.4375 * x as f64 + 0.1875 * z as f64);
            (5.3125 + rise - y as f64).clamp(0.0, 1.0)
        }
    };
    let own = fraction(at);
    let holds_solid = |(axis, step): (usize, usize)| {
        let mut other = at;
        other[axis] = (at[axis] + step) % [nx, ny, nz][axis];
        fraction(other) > 0.0
    };
    let mut neighbours = [nx, ny, nz]
        .into_iter()
        .enumerate()
        .flat_map(|(axis, n)| [(axis, 1), (axis, n - 1)]);
    Solid {
        fraction: own,
        shares: own,
        velocity: [0.0078125, 0.001953125, -0.00390625].map(|v| v * f64::from(u8::from(own > 0.0))),
        beside: own == 0.0 && neighbours.any(holds_solid),
        ..Solid::default()
    }
}

#[test]
fn friction_of_sloping_faces() {
    let cells = [12, 28, 10];
    let layouts = [
        (Storage::F32, 1, 2, [4, 4, 2]),
        (Storage::F32, 4, 1, [8, 4, 1]),
        (Storage::F16, 2, 2, [4, 2, 4]),
    ];
    for (storage, lanes, axis, brick) in layouts {
        // From no contribution of the law of the wall to its full contribution, between free-slip faces or not.
        for (nu, sides) in [(3e-3, &[][..]), (2e-5, &[0, 2]), (1e-6, &[0])] {
            let mut setup = Setup::periodic(cells.map(|n| n as u32), nu);
            (setup.storage, setup.lanes, setup.lane_axis, setup.brick) =
                (storage, lanes, axis, brick);
            for &side in sides {
                setup.faces[side] = [Face::FreeSlip, Face::FreeSlip];
            }
            setup.solid_operator = Some(SolidOperator::Holdych);
            setup.wale = Some(0.5);
            setup.wall_model = Some(WallModel::Reichardt);
            setup.sloping_faces = storage == Storage::F32;
            setup.force = Force::Constant([1e-5, 0.0, 3e-4]);
            let mut subject = Subject::new(&setup);
            let bricks = subject.all_bricks();
            subject.fill_with(&bricks, |cell| slab(cells, 1.0, cell));
            for steps in [1, 1, 3] {
                subject.rig.run(&mut subject.lattice, steps);
                subject.twin.run(steps - 1);
                let forces = subject.force_error(&bricks);
                subject.twin.step();
                let populations = subject.population_error();
                let name = format!("{storage:?}, {lanes} lanes, nu {nu}, step {steps}");
                println!("{name}: populations {populations:e}, forces {forces:e}");
                assert!(populations.max(forces) < limit(&setup), "{name}");
                let sloping = subject.twin.sloping_faces().len();
                assert!(
                    sloping > 40 || storage == Storage::F16,
                    "{name}: {sloping} faces"
                );
                assert_equal_faces(&name, &subject);
            }
            if nu == 1e-6 {
                assert_restarts(&mut subject, |again| {
                    again.fill_with(&bricks, |cell| slab(cells, 1.0, cell));
                });
            }
        }
    }
}

/// A bed at rest whose surface rises along x and, less, along z, up to its edges.
fn bed(cells: [usize; 3], slope: f64) -> impl Iterator<Item = f64> {
    let [nx, ny, nz] = cells;
    (0..nx * ny * nz).map(move |cell| match cell / nx % ny {
        0 => 1.0,
        _ => slab(cells, slope, cell)
            .fraction
            .max(f64::from(u8::from(cell / nx % ny < 3))),
    })
}

/// A moving bar near that bed, over some of its columns.
fn bar([nx, ny, nz]: [usize; 3], cell: usize) -> Solid {
    let at = [cell % nx, cell / nx % ny, cell / nx / ny];
    let holds = |[x, y, z]: [usize; 3]| (4..7).contains(&x) && (13..15).contains(&y) && z < 5;
    let beside = (0..3).any(|axis| {
        [1, [nx, ny, nz][axis] - 1].into_iter().any(|step| {
            let mut other = at;
            other[axis] = (at[axis] + step) % [nx, ny, nz][axis];
            holds(other)
        })
    });
    let own = f64::from(u8::from(holds(at)));
    Solid {
        fraction: own,
        shares: own,
        velocity: [0.0078125, 0.0, -0.00390625].map(|v| v * own),
        beside: own == 0.0 && beside,
        ..Solid::default()
    }
}

#[test]
fn friction_of_exact_surfaces() {
    let cells = [12, 28, 10];
    let layouts = [
        (Storage::F32, 1, 2, [4, 4, 2]),
        (Storage::F32, 4, 1, [8, 4, 1]),
        (Storage::F16, 2, 2, [4, 2, 4]),
    ];
    for (n, (storage, lanes, axis, brick)) in layouts.into_iter().enumerate() {
        // The second bed is nearly along the grid.
        for (nu, with_block, slope, sides) in [
            (3e-3, true, 1.0, &[][..]),
            (2e-5, false, 0.125, &[0, 2]),
            (1e-6, true, 1.0, &[0]),
        ] {
            let mut setup = Setup::periodic(cells.map(|n| n as u32), nu);
            (setup.storage, setup.lanes, setup.lane_axis, setup.brick) =
                (storage, lanes, axis, brick);
            for &side in sides {
                setup.faces[side] = [Face::FreeSlip, Face::FreeSlip];
            }
            // Without the guard ten storage buffers are enough.
            setup.max_speed = 0.0;
            setup.faces[1] = [Face::Wall([0.0; 3]), Face::FreeSlip];
            setup.solid = bed(cells, slope).map(|e| e == 1.0).collect();
            setup.solid_roughness = (0..setup.solid.len())
                .map(|cell| 0.25 * (cell % 3) as f32)
                .collect();
            let cut = |(cell, fraction): (usize, f64)| SurfaceCell {
                cell: cell as u32,
                fraction: fraction as f32,
            };
            let partial = bed(cells, slope).enumerate().filter(|(_, e)| e % 1.0 > 0.0);
            setup.surface = partial.map(cut).collect();
            setup.solid_operator = with_block.then_some(SolidOperator::Holdych);
            setup.wale = Some(0.5);
            setup.wall_model = Some([WallModel::WernerWengle, WallModel::Reichardt][n % 2]);
            setup.force = Force::Constant([1e-5, 0.0, 3e-4]);
            let mut subject = Subject::new(&setup);
            let bricks = subject.some_bricks();
            let put = |subject: &mut Subject| {
                let at_rest = subject.twin.wall_model.clone().unwrap().surface;
                let (_, solids) = subject.twin.blocks.clone().unwrap();
                subject.fill_with(&bricks, |cell| bar(cells, cell));
                let (_, found) = subject.twin.blocks.as_mut().unwrap();
                for (cell, solid) in found.iter_mut().enumerate() {
                    if solid.shares == 0.0 {
                        solid.fraction = at_rest[cell];
                        solid.beside |= solids[cell].beside;
                    }
                }
            };
            if with_block {
                put(&mut subject);
            }
            let name = format!("{storage:?}, {lanes} lanes, nu {nu}, free slip {sides:?}");
            for steps in [1, 1, 3] {
                subject.rig.run(&mut subject.lattice, steps);
                subject.twin.run(steps);
                let error = subject.population_error();
                println!("{name}, step {steps}: {error:e}");
                assert!(error < limit(&setup), "{name}, step {steps}: {error:e}");
                let expected = subject.twin.surface_faces();
                assert!(
                    expected.len() > 40 || storage == Storage::F16,
                    "{name}: {} faces",
                    expected.len()
                );
            }
            if nu == 1e-6 {
                assert_restarts(&mut subject, put);
            }
        }
    }
}

/// Asserts that the lattice lists the same faces as its twin.
fn assert_equal_faces(name: &str, subject: &Subject) {
    let mut expected = subject.twin.block_faces();
    expected.extend(subject.twin.sloping_faces());
    expected.sort_by_key(|(cell, ..)| *cell);
    let (device, queue) = (&subject.rig.device, &subject.rig.queue);
    let found = subject.lattice.block_faces(device, queue);
    let found = subject.rig.wait(found).unwrap();
    assert_eq!(found.faces.len(), expected.len(), "{name}");
    if subject.setup.storage == Storage::F16 {
        assert!(expected.is_empty() && found.area == 0, "{name}");
        return;
    }
    assert!(expected.len() > 20, "{name}: {} faces", expected.len());
    assert!(found.area as usize >= expected.len(), "{name}");
    let grid = subject.lattice.grid();
    for (face, (cell, stress, share)) in found.faces.iter().zip(expected) {
        assert_eq!(grid.index(grid.padded_cell(face.cell)), cell, "{name}");
        assert!((f64::from(face.share) - share).abs() < 1e-3, "{name}");
        let size = stress.iter().map(|s| s * s).sum::<f64>().sqrt();
        for (found, expected) in face.stress.iter().zip(stress) {
            assert!((f64::from(*found) - expected).abs() < 1e-3 * size, "{name}");
        }
    }
}
