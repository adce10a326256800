//! Collision and streaming with given solid fractions.

use crate::fixture::Subject;
use kit::Rig;
use kit::twin::of_setup::{limit, noise, walled};
use kit::twin::{
    Solid,
    lattice::{C, Q},
    statistics::moments,
};
use riprap::{
    gpu::kernel::submit_pass,
    lattice::{
        Collision, Equilibrium, Face, Force, Setup, SolidOperator, SolidWeight, Statistic,
        Statistics, Storage, SurfaceCell, WallModel,
    },
};

/// Compares with the twin after 1, 2 and 5 steps, and the statistics of the states before three of these. Forces are sums over the
/// populations of a cell, whose weights add up to 1, and have the rounding of the populations. The twin of 16 bits continues from the
/// populations of the lattice each time: a rounding is up to 1e-3 of a population.
fn assert_equal_to_twin(name: &str, setup: &Setup) {
    let mut subject = Subject::new(setup);
    let bricks = subject.some_bricks();
    subject.fill(&bricks);
    let mut sampling = Sampling::new(&mut subject);
    for steps in [1, 1, 3] {
        subject.rig.run(&mut subject.lattice, steps - 1);
        subject.twin.run(steps - 1);
        if let Some(sampling) = &mut sampling {
            sampling.record(&mut subject);
        }
        subject.rig.run(&mut subject.lattice, 1);
        let forces = subject.force_error(&bricks);
        subject.twin.step();
        let populations = subject.population_error();
        let step = subject.lattice.step();
        println!("{name}, step {step}: populations {populations:e}, forces {forces:e}");
        assert!(
            populations < limit(setup),
            "{name}, step {step}: {populations:e}"
        );
        assert!(
            forces < limit(setup),
            "{name}, step {step}: forces {forces:e}"
        );
        if setup.storage == Storage::F16 {
            subject.set_twin();
        }
    }
    if let Some(sampling) = sampling {
        sampling.assert_equal(name, &subject);
    }
}

/// Statistics of a lattice, and the samples of its twin.
struct Sampling {
    statistics: Statistics,
    samples: Vec<Vec<[f32; 4]>>,
}

impl Sampling {
    /// `None` if the device has too few bindings.
    fn new(subject: &mut Subject) -> Option<Self> {
        Some(Self {
            statistics: Statistics::new(&subject.rig.device, &mut subject.lattice).ok()?,
            samples: Vec::new(),
        })
    }

    /// Samples the present state. The momentum in the middle of a step is the mean of that before and after the collision.
    fn record(&mut self, subject: &mut Subject) {
        let (device, twin) = (&subject.rig.device, &subject.twin);
        let recorded = submit_pass(device, &subject.rig.queue, |pass| {
            self.statistics.record(device, &mut subject.lattice, pass)
        });
        recorded.unwrap();
        let momentum =
            |f: &[f64; Q], a: usize| (0..Q).map(|q| f[q] * f64::from(C[q][a])).sum::<f64>();
        let sample = |(cell, after): (usize, &[f64; Q])| {
            if twin.domain.solid[cell] {
                return [0.0; 4];
            }
            let (before, rho) = (&twin.f[cell], twin.macroscopic(cell).0);
            let u = [0, 1, 2].map(|a| (momentum(before, a) + momentum(after, a)) / (2.0 * rho));
            [rho - 1.0, u[0], u[1], u[2]].map(|value| value as f32)
        };
        let collided = twin.collided();
        self.samples
            .push(collided.iter().enumerate().map(sample).collect());
    }

    fn assert_equal(mut self, name: &str, subject: &Subject) {
        let (rig, lattice) = (&subject.rig, &subject.lattice);
        let velocity = (0..3).map(Statistic::Velocity);
        let means = std::iter::once(Statistic::Excess).chain(velocity);
        let stress = (0..6).map(Statistic::ReynoldsStress);
        let products = std::iter::once(Statistic::ExcessVariance).chain(stress);
        for (k, of) in means.chain(products).enumerate() {
            let read = self
                .statistics
                .read(&rig.device, &rig.queue, lattice, of, None);
            for (cell, found) in rig.wait(read).unwrap().into_iter().enumerate() {
                let own: Vec<_> = self.samples.iter().map(|sample| sample[cell]).collect();
                let (mean, product) = moments(&own);
                let expected = if k < 4 { mean[k] } else { product[k - 4] };
                assert!(
                    (f64::from(found) - expected).abs() < limit(&subject.setup),
                    "{name}, {of:?}, cell {cell}: {found}, not {expected}"
                );
            }
        }
    }
}

/// Odd and prime sizes; z is divisible by the lanes, and some bricks extend over the border.
fn box_of(nu: f64, operator: SolidOperator) -> Setup {
    let mut setup = Setup::periodic([5, 7, 4], nu);
    setup.solid_operator = Some(operator);
    setup.brick = [4, 4, 2];
    setup
}

#[test]
fn operators_collisions_and_equilibria() {
    use {Collision::*, Equilibrium::*, SolidOperator::*};
    let all = [
        (Holdych, Hermite, Product, Some(0.1)),
        (Holdych, Suga, Product, None),
        (Holdych, Bgk, SecondOrder, None),
        (Noble, Hermite, SecondOrder, Some(0.125)),
        (Superposition, Bgk, Product, None),
        (Noble, Suga, SecondOrder, None),
    ];
    for (operator, collision, equilibrium, lambda) in all {
        let mut setup = box_of(0.015, operator);
        (setup.collision, setup.equilibrium) = (collision, equilibrium);
        setup.solid_lambda = lambda;
        setup.force = Force::Constant([1e-3, -2e-3, 5e-4]);
        assert_equal_to_twin(
            &format!("{operator:?} {collision:?} {equilibrium:?}"),
            &setup,
        );
    }
}

/// From almost no viscosity to more than is useful, and with the weight of the paper.
#[test]
fn weights_at_any_viscosity() {
    for nu in [1e-6, 0.01, 0.5] {
        for weight in [SolidWeight::Standard, SolidWeight::Exact] {
            let mut setup = box_of(nu, SolidOperator::Holdych);
            setup.solid_weight = Some(weight);
            assert_equal_to_twin(&format!("{weight:?}, ν = {nu}"), &setup);
        }
    }
    let mut setup = box_of(0.01, SolidOperator::Holdych);
    setup.joint_aperture = Some(0.3);
    assert_equal_to_twin("joints of an aperture", &setup);
    let mut setup = box_of(0.01, SolidOperator::Noble);
    setup.solid_weight = Some(SolidWeight::Exact);
    let refused = riprap::lattice::Lattice::new(&Rig::new().device, setup);
    let error = refused.unwrap_err().to_string();
    assert!(error.contains("solid_weight"), "{error}");
}

/// (1/s − ½)(τ − ½) = Λ would yield less than the floor at this viscosity; the second setup has one Λ for all cells.
#[test]
fn odd_rates_beside_blocks_have_a_floor_and_one_magic_rate_has_none() {
    let mut setup = box_of(0.004, SolidOperator::Holdych);
    for (nu, wall, solid) in [
        (0.004, 1.12, 0.96),
        (1e-6, 1.59988, 1.19994),
        (0.02, 0.8, 0.8),
    ] {
        setup.nu = nu;
        let floors = setup.odd_rate_floors();
        assert!((floors[0] - wall).abs() < 1e-12 && (floors[1] - solid).abs() < 1e-12);
        assert!(setup.odd_rate(0.1) < 0.95 * solid);
        assert_equal_to_twin("default floors", &setup);
    }
    setup.odd_rate_floor = Some(0.7);
    assert_equal_to_twin("given floor", &setup);
    setup.lambda = Some(0.02);
    assert_equal_to_twin("one rate", &setup);
}

#[test]
fn layouts_with_walls_beside_blocks_and_everything_on() {
    let cases = [
        (Storage::F32, (1, 2), 2, [4, 4, 2], SolidOperator::Noble),
        (
            Storage::F32,
            (4, 2),
            5,
            [16, 2, 2],
            SolidOperator::Superposition,
        ),
        (Storage::F32, (4, 1), 2, [8, 4, 1], SolidOperator::Holdych),
        (Storage::F16, (2, 1), 3, [4, 2, 4], SolidOperator::Holdych),
        (Storage::F16, (4, 2), 2, [8, 4, 1], SolidOperator::Holdych),
    ];
    // All buffers except the populations take up to seven bindings, of the 10 that SwiftShader has.
    let most = Rig::new()
        .device
        .limits()
        .max_storage_buffers_per_shader_stage
        - 7;
    for (n, (storage, (lanes, axis), bindings, brick, operator)) in cases.into_iter().enumerate() {
        let mut setup = walled(lanes, storage);
        (setup.bindings, setup.brick) = (Some(bindings.min(most)), brick);
        setup.lane_axis = axis;
        setup.solid_operator = Some(operator);
        setup.wale = Some(0.5);
        setup.force = match n % 2 {
            0 => Force::Constant([0.0, -1e-3, 5e-4]),
            _ => Force::Field(
                (0..6 * 5 * 7)
                    .map(|n| [0, 1, 2].map(|a| 1e-3 * noise(3 * n + a) as f32))
                    .collect(),
            ),
        };
        let name = format!(
            "{storage:?}, {lanes} lanes along {axis}, {:?} bindings, {operator:?}",
            setup.bindings
        );
        assert_equal_to_twin(&name, &setup);
    }
}

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
        // From no contribution of the law of the wall to its full contribution.
        for nu in [3e-3, 2e-5, 1e-6] {
            let mut setup = Setup::periodic(cells.map(|n| n as u32), nu);
            (setup.storage, setup.lanes, setup.lane_axis, setup.brick) =
                (storage, lanes, axis, brick);
            setup.solid_operator = Some(SolidOperator::Holdych);
            setup.wale = Some(0.5);
            setup.wall_model = Some(WallModel::Reichardt);
            setup.sloping_faces = storage == Storage::F32;
            setup.force = Force::Constant([1e-5, 0.0, 3e-4]);
            let mut subject = Subject::new(&setup);
            let bricks: Vec<u32> = (0..subject.lattice.grid().bricks().iter().product()).collect();
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
    assert!(found.area as usize > expected.len(), "{name}");
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
