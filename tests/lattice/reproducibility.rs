//! Bitwise equal results: of two runs, after a checkpoint, in every layout, from any workgroup.

use kit::Rig;
use riprap::{
    lattice::{
        Face, FaceCell, Force, Inside, Lattice, Populations, Setup, State, Storage,
        SyntheticTurbulence,
    },
    simulation::checkpoint::{Checkpoint, FluidState, LatticeState},
    wgpu,
};

/// WALE, force, walls, a turbulent inlet and an outflow: everything whose state persists from step to step.
fn setup() -> Setup {
    let mut setup = Setup::periodic([11, 7, 8], 1e-3);
    setup.wale = Some(0.5);
    setup.force = Force::Constant([1e-6, 0.0, 0.0]);
    setup.faces[0] = [
        Face::Velocity(vec![[0.03, 0.0, 0.0]; 56]),
        Face::Outflow { density: 1.0 },
    ];
    setup.turbulence[0][0] = Some(SyntheticTurbulence {
        intensity: 0.1,
        length: 2.0,
        seed: 3,
    });
    setup.faces[1] = [Face::Wall([0.0; 3]), Face::FreeSlip];
    setup.solid = (0..616)
        .map(|n| (4..6).contains(&(n % 11)) && (n / 11) % 7 < 3)
        .collect();
    setup
}

fn state() -> State {
    let mut state = State::rest(616);
    for n in 0..616 {
        state.velocity[0][n] = 0.03;
        state.velocity[2][n] = 0.01 * (0.1 * n as f32).sin();
    }
    state
}

fn run(rig: &Rig, setup: Setup, steps: usize) -> (Lattice, Populations) {
    let mut lattice = rig.start(setup, &state(), true);
    rig.run(&mut lattice, steps);
    let end = rig.populations(&mut lattice);
    (lattice, end)
}

/// Bits of the fluid cells; the content of solid cells is undefined.
fn bits(populations: &Populations) -> Vec<u32> {
    let solid = setup().solid;
    let cells = populations.values.iter().zip(solid.iter().cycle());
    let fluid = cells
        .filter(|(_, solid)| !**solid)
        .map(|(f, _)| f.to_bits());
    fluid
        .chain(populations.outflow_state.iter().map(|v| v.to_bits()))
        .chain(populations.travelled.iter().copied())
        .collect()
}

#[test]
fn a_run_repeats_to_the_bit() {
    let rig = Rig::new();
    for storage in [Storage::F32, Storage::F16] {
        let mut setup = setup();
        (setup.storage, setup.lanes) = (storage, 4);
        let first = run(&rig, setup.clone(), 101).1;
        assert_eq!(bits(&first), bits(&run(&rig, setup, 101).1));
    }
}

#[test]
fn lanes_bindings_bricks_and_workgroups_change_no_bit() {
    let rig = Rig::new();
    let reference = bits(&run(&rig, setup(), 51).1);
    let mut others = vec![setup(); 9];
    others[0].lanes = 4;
    others[1].bindings = Some(rig.most_bindings());
    others[2].brick = [64, 1, 1];
    others[3].brick = [32, 4, 2];
    others[4].brick = [4, 4, 8];
    others[5].brick = [4, 4, 2];
    (others[6].lanes, others[6].lane_axis) = (4, 1);
    others[7].row_alignment = 32;
    others[8].use_gpu_layout();
    for other in others {
        let what = format!(
            "{} lanes along {}, {:?} bindings, brick {:?}, rows of a multiple of {}",
            other.lanes, other.lane_axis, other.bindings, other.brick, other.row_alignment
        );
        assert!(bits(&run(&rig, other, 51).1) == reference, "{what}");
    }
}

#[test]
fn words_of_64_bits_change_no_bit() {
    let rig = Rig::new();
    if !rig.device.features().contains(wgpu::Features::SHADER_INT64) {
        eprintln!("this adapter has no 64-bit words: nothing to compare");
        return;
    }
    let field = Force::Field((0..616).map(|n| [1e-7 * n as f32, 0.0, 1e-6]).collect());
    for storage in [Storage::F32, Storage::F16] {
        let mut narrow = setup();
        (narrow.storage, narrow.lanes, narrow.force) = (storage, 4, field.clone());
        let mut wide = narrow.clone();
        wide.wide = true;
        let expected = bits(&run(&rig, narrow, 51).1);
        assert!(bits(&run(&rig, wide, 51).1) == expected, "{storage:?}");
    }
}

#[test]
fn words_that_the_device_has_not_are_refused() {
    let (device, _) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    let mut setup = Setup::periodic([4, 4, 4], 0.1);
    (setup.lanes, setup.wide) = (4, true);
    let error = Lattice::new(&device, setup).unwrap_err().to_string();
    assert!(error.contains("SHADER_INT64"), "{error}");
}

/// A checkpoint of a fluid, with velocities in two cells of a solid.
fn checkpoint(populations: Populations) -> Checkpoint {
    Checkpoint {
        step: populations.step,
        time_step: 1e-3,
        rock: None,
        fluid: Some(FluidState::Lattice(Box::new(LatticeState {
            cell: 1e-2,
            populations,
            inside: Inside {
                cells: vec![3, 17],
                velocity: vec![0.1, -0.2, 0.3, -0.4, 0.5, -0.6],
            },
            coupling: None,
            sampling: None,
            flow_control: None,
        }))),
    }
}

fn populations(checkpoint: &Checkpoint) -> &Populations {
    match &checkpoint.fluid {
        Some(FluidState::Lattice(state)) => &state.populations,
        _ => panic!("no fluid on a lattice"),
    }
}

#[test]
fn a_checkpoint_continues_to_the_bit_on_odd_and_even_steps() {
    let rig = Rig::new();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("lattice.riprap");
    for storage in [Storage::F32, Storage::F16] {
        for (stop, wale_interval) in [(50, 2), (51, 2), (51, 1)] {
            let mut setup = setup();
            setup.wale_interval = wale_interval;
            (setup.storage, setup.lanes) = (storage, if storage == Storage::F32 { 1 } else { 2 });
            let whole = run(&rig, setup.clone(), 100).1;
            let saved = checkpoint(run(&rig, setup.clone(), stop).1);
            saved.write(&file).unwrap();
            let read = Checkpoint::read(&file).unwrap();
            assert_eq!(read, saved);
            let mut lattice = Lattice::new(&rig.device, setup).unwrap();
            lattice
                .set_populations(&rig.device, &rig.queue, populations(&read))
                .unwrap();
            rig.run(&mut lattice, 100 - stop);
            let resumed = rig.populations(&mut lattice);
            assert_eq!(resumed.step, 100);
            assert!(
                bits(&resumed) == bits(&whole),
                "{storage:?}, stopped at {stop}"
            );
        }
    }
}

#[test]
fn a_checkpoint_changes_lanes_and_bindings() {
    let rig = Rig::new();
    let whole = run(&rig, setup(), 60).1;
    let saved = run(&rig, setup(), 31).1;
    let mut other = setup();
    (other.lanes, other.bindings) = (4, Some(rig.most_bindings().min(9)));
    for axis in [1, 2] {
        other.lane_axis = axis;
        let mut lattice = Lattice::new(&rig.device, other.clone()).unwrap();
        lattice
            .set_populations(&rig.device, &rig.queue, &saved)
            .unwrap();
        rig.run(&mut lattice, 29);
        assert!(
            bits(&rig.populations(&mut lattice)) == bits(&whole),
            "axis {axis}"
        );
    }
}

#[test]
fn broken_checkpoints_are_refused() {
    let rig = Rig::new();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("lattice.riprap");
    let saved = checkpoint(run(&rig, setup(), 2).1);
    saved.write(&file).unwrap();
    let bytes = std::fs::read(&file).unwrap();
    let changed = |at: usize, to: u8| {
        let mut bytes = bytes.clone();
        bytes[at] = to;
        bytes
    };
    let middle = bytes.len() / 2;
    for (content, hint) in [
        (&bytes[..bytes.len() - 5], "cut short"),
        (&bytes[..40], "cut short"),
        (&bytes[..14], "cut short"),
        (&bytes[..3], "not a checkpoint"),
        (&changed(middle, !bytes[middle]), "damaged"),
        (&changed(17, 99), "version 99 of its format"),
        (&b"riprap state  4\n"[..], "version 4 of its format"),
        (&b"<VTKFile>"[..], "not a checkpoint"),
    ] {
        std::fs::write(&file, content).unwrap();
        let error = Checkpoint::read(&file).unwrap_err().to_string();
        assert!(error.contains(hint), "{error}");
    }
    let mut lattice = Lattice::new(&rig.device, Setup::periodic([4, 4, 4], 0.1)).unwrap();
    let error = lattice
        .set_populations(&rig.device, &rig.queue, populations(&saved))
        .unwrap_err();
    assert!(error.to_string().contains("[11, 7, 8]"), "{error}");
}

#[test]
fn an_odd_step_needs_the_eddy_viscosity_of_the_even_one() {
    let rig = Rig::new();
    let mut every_step = setup();
    every_step.wale_interval = 1;
    let mut lattice = Lattice::new(&rig.device, setup()).unwrap();
    let mut resume = |steps| {
        let saved = run(&rig, every_step.clone(), steps).1;
        lattice.set_populations(&rig.device, &rig.queue, &saved)
    };
    resume(2).unwrap();
    let error = resume(3).unwrap_err().to_string();
    assert!(error.contains("wale_interval"), "{error}");
}

/// A column of one cell with outlets on all sides: faces of a cell without an inner neighbour read the cell itself, one after the
/// other, so that a run repeats.
#[test]
fn faces_of_one_cell_take_turns() {
    let rig = Rig::new();
    for open in [
        Face::Outflow { density: 1.001 },
        Face::Pressure { density: 1.001 },
    ] {
        let mut setup = Setup::periodic([1, 1, 4], 0.02);
        setup.faces = std::array::from_fn(|_| [open.clone(), open.clone()]);
        let cells = 4;
        let mut state = State::rest(cells);
        for n in 0..cells {
            state.velocity[1][n] = 0.02 * (n as f32).sin();
        }
        let end = |lanes| {
            let mut setup = setup.clone();
            (setup.lanes, setup.brick) = (lanes, [4, 4, 2]);
            let mut lattice = rig.start(setup, &state, true);
            let geometry = lattice.geometry();
            let cells = geometry.pressure.iter().chain(&geometry.outflow);
            let alone = |cell: &&FaceCell| cell.inner == cell.cell;
            let turns: Vec<_> = cells.filter(alone).map(|cell| cell.turn).collect();
            assert!((1..=4).all(|turn| turns.contains(&turn)), "{turns:?}");
            let mut faces: Vec<_> = geometry.pressure.iter().chain(&geometry.outflow).collect();
            faces.sort_by_key(|cell| (cell.cell, cell.face));
            let twice =
                |pair: &[&FaceCell]| (pair[0].cell, pair[0].face) == (pair[1].cell, pair[1].face);
            assert!(!faces.windows(2).any(twice));
            rig.run(&mut lattice, 9);
            let end = rig.populations(&mut lattice);
            let values = end.values.iter().chain(&end.outflow_state);
            assert!(values.clone().all(|value| value.is_finite()));
            values.map(|value| value.to_bits()).collect::<Vec<_>>()
        };
        assert_eq!(end(1), end(1));
        assert_eq!(end(4), end(4));
    }
}
