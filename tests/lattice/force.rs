//! A body force that changes between two steps.

use kit::{Rig, assert_contains, assert_near, assert_relative};
use riprap::lattice::{Face, Force, Observer, Setup, State, Storage, SurfaceCell};

/// Populations carry momentum without half of the force of the coming step; the momentum that is read includes it.
#[test]
fn momentum_is_what_each_force_has_put_in() {
    let rig = Rig::new();
    let mut setup = Setup::periodic([5, 4, 3], 0.05);
    setup.force = Force::Constant([1e-5, 0.0, 0.0]);
    let mut lattice = rig.start(setup, &State::rest(60), true);
    rig.run(&mut lattice, 10);
    lattice.set_force(&rig.queue, [0.0, -2e-5, 0.0]).unwrap();
    rig.run(&mut lattice, 20);
    let mut observer = Observer::new(&rig.device, &lattice).unwrap();
    let sums = rig
        .wait(observer.sums(&rig.device, &rig.queue, &mut lattice))
        .unwrap();
    let expected = [60.0 * 9.5e-5, 60.0 * -41e-5, 0.0];
    for (found, expected) in sums.momentum.into_iter().zip(expected) {
        assert_near(found, expected, 1e-6);
    }
    assert_eq!(lattice.setup().force, Force::Constant([0.0, -2e-5, 0.0]));
    let bad = lattice.set_force(&rig.queue, [f64::NAN, 0.0, 0.0]);
    assert_contains(bad.unwrap_err(), &["force", "NaN"]);
    let mut forceless = rig.start(Setup::periodic([3, 3, 3], 0.05), &State::rest(27), true);
    let none = forceless.set_force(&rig.queue, [0.0; 3]);
    assert_contains(none.unwrap_err(), &["force", "the same in all cells"]);
}

/// In a laminar channel in which a step of the force changes the velocity by 1e-4 of it, less than the last digit of 16 bits.
#[test]
fn sixteen_bits_keep_a_force_that_drives_a_smooth_flow_slowly() {
    let rig = Rig::new();
    let momentum = |storage| {
        let mut setup = Setup::periodic([4, 4, 24], 0.01);
        setup.faces[2] = [const { Face::Wall([0.0; 3]) }; 2];
        setup.force = Force::Constant([1e-5, 0.0, 0.0]);
        setup.storage = storage;
        assert!(setup.spread_lanes(4));
        let mut lattice = rig.start(setup, &State::rest(4 * 4 * 24), true);
        rig.run(&mut lattice, 12_000);
        let mut observer = Observer::new(&rig.device, &lattice).unwrap();
        let sums = observer.sums(&rig.device, &rig.queue, &mut lattice);
        rig.wait(sums).unwrap().momentum[0]
    };
    let kept = momentum(Storage::F16) / momentum(Storage::F32);
    assert!((0.99..1.01).contains(&kept), "{kept}");
}

/// What a closed box 5 × 4 × 3 cells wide with a velocity face gains in one step.
fn gained_through_a_velocity_face(surface: Vec<SurfaceCell>) -> f64 {
    let rig = Rig::new();
    let mut setup = Setup::periodic([5, 4, 3], 0.05);
    setup.faces = [const { [const { Face::Wall([0.0; 3]) }; 2] }; 3];
    setup.faces[0][0] = Face::Velocity(vec![[0.01, 0.0, 0.0]; 12]);
    setup.surface = surface;
    let mut lattice = rig.start(setup, &State::rest(60), true);
    rig.run(&mut lattice, 1);
    let mut observer = Observer::new(&rig.device, &lattice).unwrap();
    let sums = observer.sums(&rig.device, &rig.queue, &mut lattice);
    rig.wait(sums).unwrap().excess
}

/// At edges with walls too: a closed box gains the mass that its velocity face feeds.
#[test]
fn the_flow_through_a_velocity_face_between_walls_is_exact() {
    let gained = gained_through_a_velocity_face(Vec::new());
    // ρ u A, ρ = 1/(1 − u) in the cells at the face.
    assert_relative(gained, 0.12 / 0.99, 1e-4);
}

#[test]
fn the_flow_through_a_velocity_face_passes_the_open_part_of_cells_with_solid() {
    let layer = (0..20).map(|cell| SurfaceCell {
        cell,
        fraction: 0.5,
    });
    let gained = gained_through_a_velocity_face(layer.collect());
    assert_relative(gained, 0.08 / 0.99 + 0.02 / 0.995, 1e-4);
}
