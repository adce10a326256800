//! Grids at the limits of devices: few and small bindings, many workgroups, too many cells, and very few.

use kit::{Rig, assert_near};
use riprap::{
    Error,
    lattice::{
        Face, Force, Grid, Lattice, Observer, Setup, SolidOperator, State, Storage, Sums, memory,
    },
    wgpu,
};

/// Limits that WebGPU guarantees everywhere: 8 storage buffers of 128 MiB per kernel.
fn promised() -> wgpu::Limits {
    let limits = wgpu::Limits::default();
    assert_eq!(limits.max_storage_buffers_per_shader_stage, 8);
    assert_eq!(limits.max_storage_buffer_binding_size, 128 << 20);
    limits
}

fn cells(setup: &Setup) -> usize {
    setup.cells.iter().map(|&n| n as usize).product()
}

/// A wave of 100 cells in density and velocity along x.
fn waves(setup: &Setup) -> State {
    let mut state = State::rest(cells(setup));
    let nx = setup.cells[0] as usize;
    for n in 0..state.excess.len() {
        let phase = std::f64::consts::TAU * ((n % nx) % 100) as f64 / 100.0;
        state.excess[n] = (0.01 * phase.cos()) as f32;
        state.velocity[0][n] = (0.03 * phase.sin()) as f32;
        state.velocity[1][n] = (0.02 * phase.cos()) as f32;
    }
    state
}

fn sums(rig: &Rig, lattice: &mut Lattice) -> Sums {
    let mut observer = Observer::new(&rig.device, lattice).unwrap();
    rig.wait(observer.sums(&rig.device, &rig.queue, lattice))
        .unwrap()
}

/// With all features that take bindings, two are left for the populations.
#[test]
fn eight_storage_buffers_give_the_same_bits_as_more() {
    let mut setup = Setup::periodic([9, 6, 8], 1e-3);
    setup.wale = Some(0.5);
    setup.force = Force::Field(vec![[1e-6, 0.0, 2e-6]; 432]);
    setup.faces[1] = [Face::Wall([0.0; 3]), Face::Wall([0.01, 0.0, 0.0])];
    let state = waves(&setup);
    let run = |limits, bindings| {
        let rig = Rig::with_limits(limits);
        let mut setup = setup.clone();
        setup.bindings = bindings;
        let mut lattice = rig.start(setup, &state, true);
        rig.run(&mut lattice, 21);
        let count = lattice.population_buffers().len();
        (count, rig.populations(&mut lattice))
    };
    let all = Rig::new();
    let (one, expected) = run(promised(), None);
    assert_eq!(one, 1);
    let (two, found) = run(promised(), Some(2));
    assert_eq!(two, 2);
    assert!(found == expected, "two bindings");
    // All features leave two of eight bindings, hence all but six of more.
    let most = (all.device.limits().max_storage_buffers_per_shader_stage - 6).min(27);
    let (_, found) = run(all.device.limits(), Some(most));
    assert!(found == expected, "{most} bindings");
    // More than the device has are refused, not reduced.
    let rig = Rig::with_limits(promised());
    setup.bindings = Some(3);
    let refused = Lattice::new(&rig.device, setup).unwrap_err();
    assert!(matches!(refused, Error::Limit { .. }), "{refused}");
}

/// 1.28 million cells are 138 MB of populations.
#[test]
fn populations_above_a_binding_of_128_mib_are_spread() {
    let setup = Setup::periodic([200, 80, 80], 1e-3);
    let state = waves(&setup);
    let run = |limits, bindings| {
        let rig = Rig::with_limits(limits);
        let mut setup = setup.clone();
        setup.bindings = bindings;
        let mut lattice = rig.start(setup, &state, true);
        rig.run(&mut lattice, 3);
        (lattice.population_buffers().len(), rig.state(&mut lattice))
    };
    let (count, expected) = run(promised(), None);
    assert_eq!(count, 2);
    let all = Rig::new();
    let (_, found) = run(all.device.limits(), Some(all.most_bindings()));
    assert!(found == expected);
}

/// Two planes of a field fit in a binding, then one.
#[test]
fn vectors_above_a_binding_are_spread() {
    let mut setup = Setup::periodic([20, 20, 8], 1e-3);
    (setup.storage, setup.lanes) = (Storage::F16, 2);
    setup.wale = Some(0.5);
    setup.force = Force::Field((0..3200).map(|n| [1e-9 * n as f32, 2e-6, 1e-6]).collect());
    setup.faces[1] = [Face::Wall([0.0; 3]), Face::Wall([0.0; 3])];
    let state = waves(&setup);
    let all = Rig::new().device.limits();
    let run = |limits| {
        let rig = Rig::with_limits(limits);
        let mut lattice = rig.start(setup.clone(), &state, true);
        rig.run(&mut lattice, 5);
        (lattice.bindings().vectors, rig.populations(&mut lattice))
    };
    let (one, expected) = run(all.clone());
    assert_eq!(one, 1);
    let plane = 4 * u64::from(Grid::new(&setup).unwrap().scalar_count());
    for (planes, bindings, buffers) in [(2, 2, 16), (1, 3, 26)] {
        if all.max_storage_buffers_per_shader_stage >= buffers {
            let (count, found) = run(wgpu::Limits {
                max_storage_buffer_binding_size: planes * plane,
                ..all.clone()
            });
            assert_eq!(count, bindings);
            assert!(found == expected, "{bindings} bindings");
        }
    }
}

/// Bindings of 2 GiB, as discrete adapters have them.
#[test]
fn blocks_in_512_cells_an_axis_fit_in_80_gigabytes() {
    let limits = |buffers| wgpu::Limits {
        max_storage_buffer_binding_size: (1 << 31) - 4,
        max_buffer_size: (1 << 31) - 4,
        max_storage_buffers_per_shader_stage: buffers,
        ..wgpu::Limits::default()
    };
    for (storage, lanes) in [(Storage::F32, 1), (Storage::F16, 2)] {
        let mut setup = Setup::periodic([512; 3], 1e-3);
        (setup.storage, setup.lanes) = (storage, lanes);
        setup.faces = [const { [Face::Wall([0.0; 3]), Face::Wall([0.0; 3])] }; 3];
        setup.wale = Some(0.325);
        setup.max_speed = 0.3;
        setup.solid_operator = Some(SolidOperator::Holdych);
        let grid = Grid::new(&setup).unwrap();
        assert!(memory(&setup, &grid, &limits(16)).is_ok());
        let found = memory(&setup, &grid, &limits(32)).unwrap();
        assert!(found.most_bindings <= 32 && found.largest_binding < 1 << 31);
        // Blocks may reach every cell.
        let cells: u64 = (0..3)
            .map(|a| u64::from(grid.bricks()[a] * grid.brick[a]))
            .product::<u64>()
            * u64::from(lanes);
        let planes = 4 * cells;
        assert!(planes * u64::from(9_u32.div_ceil(found.bindings.psm_planes)) < 1 << 31);
        assert!(found.populations + found.others + 9 * planes < 80_000_000_000);
    }
}

/// The message of [`Error::Limit`], after a check of its numbers.
pub fn limit(error: Error) -> String {
    match &error {
        Error::Limit { wants, has, .. } => assert!(wants > has, "{error}"),
        other => panic!("{other}"),
    }
    error.to_string()
}

#[test]
fn a_grid_that_the_device_does_not_hold_is_refused_with_numbers() {
    let rig = Rig::with_limits(promised());
    for walls in [false, true] {
        let mut setup = Setup::periodic([1000, 1000, 100], 1e-3);
        if walls {
            setup.faces[2] = [Face::Wall([0.0; 3]), Face::Wall([0.0; 3])];
        }
        let message = limit(Lattice::new(&rig.device, setup).unwrap_err());
        assert!(message.contains("cells"), "{message}");
        assert!(message.contains("134217728"), "{message}");
    }
    // More cells than a 32-bit index can address, on any device.
    let setup = Setup::periodic([2000, 2000, 2000], 1e-3);
    let message = limit(Lattice::new(&rig.device, setup).unwrap_err());
    assert!(message.contains("8000000000"), "{message}");
}

/// The number of cells named by the refusal fits.
#[test]
fn the_remedy_of_a_refused_grid_holds() {
    let kinds =
        [Storage::F32, Storage::F16].map(|storage| [None, Some(0.325)].map(|wale| (storage, wale)));
    for (storage, wale) in kinds.into_iter().flatten() {
        let of = |nx: u32| {
            let mut setup = Setup::periodic([nx, 100, 100], 1e-3);
            setup.wale = wale;
            setup.storage = storage;
            setup.lanes = if storage == Storage::F32 { 1 } else { 2 };
            let grid = Grid::new(&setup).unwrap();
            memory(&setup, &grid, &promised())
        };
        let message = limit(of(15_000).unwrap_err());
        let (_, after) = message.split_once("holds about ").unwrap();
        let count: u32 = after.split(' ').next().unwrap().parse().unwrap();
        assert!(of(count / 10_000).is_ok(), "{message}");
        assert!(of(count / 10_000 + 1).is_err(), "{message}");
    }
}

/// 67 188 workgroups in one row, while WebGPU guarantees 65 535. The waves are the same from the first to the last; the sums,
/// whose loops must be short on every driver, include every cell.
#[test]
fn more_workgroups_than_one_dimension_holds() {
    const NX: u32 = 4_300_000;
    let rig = Rig::new();
    let mut setup = Setup::periodic([NX, 1, 1], 0.01);
    setup.brick = [64, 1, 1];
    let state = waves(&setup);
    let mass: f64 = state.excess.iter().map(|&e| f64::from(e)).sum();
    let mut lattice = rig.start(setup, &state, true);
    rig.run(&mut lattice, 6);
    let end = rig.state(&mut lattice);
    let fields = [&end.excess, &end.velocity[0], &end.velocity[1]];
    for (field, start) in
        fields
            .into_iter()
            .zip([&state.excess, &state.velocity[0], &state.velocity[1]])
    {
        assert!(field.chunks(100).all(|wave| wave == &field[..100]));
        assert!(field[..100] != start[..100], "nothing has moved");
    }
    let sums = sums(&rig, &mut lattice);
    assert_eq!(sums.cells, f64::from(NX));
    // 1e-9 per cell: the rounding of 0.01 in single precision.
    assert_near(sums.excess, mass, 1e-9 * f64::from(NX));
}

/// A duct of one cell between slip walls: 4.56 million links, again more than 65 535 workgroups.
#[test]
fn more_links_than_one_dimension_holds() {
    const NX: u32 = 190_000;
    let rig = Rig::new();
    let mut setup = Setup::periodic([NX, 1, 1], 0.01);
    setup.faces[1] = [Face::FreeSlip, Face::FreeSlip];
    setup.faces[2] = [Face::FreeSlip, Face::FreeSlip];
    setup.brick = [64, 1, 1];
    let mut state = waves(&setup);
    state.velocity[1].fill(0.0);
    let mut lattice = rig.start(setup, &state, true);
    assert!(lattice.geometry().link_count() > 65_535 * 64);
    rig.run(&mut lattice, 5);
    let end = rig.state(&mut lattice);
    assert!(
        end.excess
            .chunks(100)
            .all(|wave| wave == &end.excess[..100])
    );
    assert!(end.velocity[1].iter().all(|v| v.abs() < 1e-7));
    assert_eq!(sums(&rig, &mut lattice).cells, f64::from(NX));
}

/// Compares the mass before and after 100 steps of noise, for every layout that fits the height.
fn keeps_its_mass(size: [u32; 3], walls: [bool; 3]) {
    let rig = Rig::new();
    for (storage, lanes) in [
        (Storage::F32, 1),
        (Storage::F32, 4),
        (Storage::F16, 2),
        (Storage::F16, 4),
    ] {
        let mut setup = Setup::periodic(size, 0.02);
        (setup.storage, setup.lanes) = (storage, lanes);
        for axis in 0..3 {
            if walls[axis] {
                setup.faces[axis] = [Face::Wall([0.0; 3]), Face::Wall([0.0; 3])];
            }
        }
        if !walls[2] && !size[2].is_multiple_of(lanes) {
            let refused = Lattice::new(&rig.device, setup).unwrap_err();
            assert!(refused.to_string().contains("lanes"), "{refused}");
            continue;
        }
        let mut state = State::rest(cells(&setup));
        for n in 0..state.excess.len() {
            state.excess[n] = 0.01 * (n as f32).sin();
            for (a, u) in state.velocity.iter_mut().enumerate() {
                u[n] = 0.03 * (n as f32 + a as f32).cos();
            }
        }
        let count = state.excess.len() as f64;
        let mut lattice = rig.start(setup, &state, true);
        let before = sums(&rig, &mut lattice);
        rig.run(&mut lattice, 101);
        let after = sums(&rig, &mut lattice);
        assert_eq!(after.cells, count);
        // Each step rounds 27 populations of about 0.003 to 2^-25 or, in 16 bits, 2^-12 of that. In 100 steps these random errors
        // add up to a tenth of the tolerance.
        let drift = match storage {
            Storage::F32 => 1e-7,
            Storage::F16 => 5e-4,
        };
        let kept = (after.excess - before.excess).abs();
        assert!(
            kept < drift * count,
            "{size:?} {storage:?} {lanes}: {before:?} {after:?}"
        );
        if walls == [false; 3] {
            for (after, before) in after.momentum.iter().zip(before.momentum) {
                let kept = (after - before).abs();
                assert!(kept < drift * count, "{size:?} {storage:?} {lanes}: {kept}");
            }
        }
    }
}

#[test]
fn grids_of_one_cell_keep_their_mass() {
    keeps_its_mass([1, 1, 1], [false; 3]);
    keeps_its_mass([1, 1, 4], [false; 3]);
    keeps_its_mass([1, 1, 1], [true; 3]);
    keeps_its_mass([1, 1, 4], [true, true, false]);
}

#[test]
fn odd_and_prime_grids_keep_their_mass() {
    keeps_its_mass([7, 11, 13], [false; 3]);
    keeps_its_mass([7, 11, 13], [true; 3]);
    keeps_its_mass([17, 3, 5], [false, true, false]);
    keeps_its_mass([2, 2, 2], [false; 3]);
}

/// A fluid cell between solids on all sides: fluid at rest there stays at rest bitwise.
#[test]
fn a_cell_between_solids_is_a_closed_box() {
    let rig = Rig::new();
    let mut setup = Setup::periodic([3, 3, 3], 0.02);
    setup.solid = (0..27).map(|n| n != 13).collect();
    let mut state = State::rest(27);
    state.excess[13] = 0.01;
    let mut lattice = rig.start(setup, &state, true);
    let before = sums(&rig, &mut lattice);
    rig.run(&mut lattice, 100);
    let after = sums(&rig, &mut lattice);
    assert_eq!(after.cells, 1.0);
    assert!((after.excess - 0.01).abs() < 1e-7, "{before:?} {after:?}");
    assert!(after.max_speed < 1e-7, "{after:?}");
}
