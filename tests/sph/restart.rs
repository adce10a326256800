//! A restart is bit-identical.

use crate::tank::{lattice, resting, walls};
use glam::DVec3;
use kit::Rig;
use riprap::sph::{NeighbourSearch, Setup, Side, SphSolver};

/// Neighbour lists are rebuilt after a particle has escaped, and not a second time after a restart.
#[test]
fn a_restart_after_an_escape_sorts_as_often() {
    let spacing = 0.05;
    let mut setup = Setup::tank(DVec3::new(0.5, spacing, 0.6), spacing, 44.0);
    setup.plane = true;
    setup.neighbours = NeighbourSearch::Lists;
    setup.faces[2][1] = Side::Open;
    setup.bodies = vec![walls(&setup)];
    let mut positions = lattice(&setup, [0; 3], [10, 1, 8]);
    let mut velocities = vec![DVec3::ZERO; positions.len()];
    // A drop that escapes, slow enough for lists to be valid for several steps.
    positions.push(DVec3::new(0.25, 0.5 * spacing, 0.599));
    velocities.push(DVec3::Z);
    let pressure = |x: &DVec3| 9810.0 * (0.4 - x.z).max(0.0);
    let pressures: Vec<f64> = positions.iter().map(pressure).collect();
    let rig = Rig::new();
    let (device, queue) = (&rig.device, &rig.queue);
    let start = || {
        let setup = setup.clone();
        SphSolver::new(device, queue, setup, &positions, &velocities, &pressures).unwrap()
    };
    let poses = [resting(DVec3::ZERO)];
    let advance = |particles: &mut SphSolver| {
        let done = particles.advance(device, queue, &poses, 5e-3);
        let done = rig.wait(done).unwrap();
        let all = rig.wait(particles.particles(device, queue)).unwrap();
        (done, all)
    };
    let mut whole = start();
    let (_, saved) = advance(&mut whole);
    assert_eq!(whole.escaped(), 1);
    let state = whole.state();
    whole.force_sort();
    let (done, uncut) = advance(&mut whole);
    assert!(done.steps > 2, "{done:?}");
    let mut other = start();
    other.restore(queue, &saved, &state).unwrap();
    let (redone, restarted) = advance(&mut other);
    assert_eq!(redone.sorts, done.sorts);
    assert!(restarted == uncut);
}
