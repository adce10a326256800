//! Water at rest.

use crate::tank::{Tank, lattice, resting, walls};
use glam::DVec3;
use riprap::sph::{NeighbourSearch, Setup, Side};

#[test]
fn a_still_tank_stays_still() {
    let (depth, n) = (1.0, 20);
    let spacing = depth / f64::from(n);
    let mut setup = Setup::tank(DVec3::new(1.0, spacing, 1.5), spacing, 10.0 * 4.43);
    setup.plane = true;
    setup.neighbours = NeighbourSearch::Lists;
    setup.faces[2][1] = Side::Open;
    setup.bodies = vec![walls(&setup)];
    let water = lattice(&setup, [0, 0, 0], [20, 1, n]);
    let hydrostatic = |x: DVec3| 1000.0 * 9.81 * (depth - x.z);
    let mut tank = Tank::new(setup, vec![resting(DVec3::ZERO)], &water, hydrostatic);
    let scale = (9.81f64 * depth).sqrt();
    // The initial error is damped after a few wave passages.
    tank.advance(10.0 * depth / scale);
    let water = tank.water();
    let (mut error, mut norm, mut speed) = (0.0, 0.0, 0.0);
    for n in 0..water.len() {
        let exact = hydrostatic(water.positions[n]);
        error += (water.pressures[n] - exact).powi(2);
        norm += exact * exact;
        speed += f64::from(water.velocities[n].length_squared());
    }
    let rms = (speed / water.len() as f64).sqrt() / scale;
    let error = f64::sqrt(error / norm);
    println!("L2(p) {error:.4}, u_rms {rms:.2e} of the speed of waves");
    assert!(error < 0.02 && rms < 0.002, "{error} {rms}");
    assert_eq!(water.len(), 400);
    // Probes in the water, while neighbour lists are valid for several exchanges, and above it.
    let at = |z: f64| DVec3::new(0.51, 0.5 * spacing, z);
    tank.set_probes(&[at(0.31), at(0.7), at(1.3)]);
    let mut sorts = 0;
    for _ in 0..12 {
        let done = tank.advance(2e-3);
        sorts += done.sorts;
        for (z, found) in [0.31, 0.7].into_iter().zip(&done.pressures) {
            let exact = hydrostatic(at(z));
            assert!((found / exact - 1.0).abs() < 0.03, "{found} {exact}");
        }
        assert_eq!(done.pressures[2], 0.0);
    }
    assert!(sorts < 6, "{sorts}");
}

#[test]
fn the_largest_speed_is_that_of_all_steps() {
    let spacing = 0.1;
    let mut setup = Setup::tank(DVec3::new(1.0, spacing, 2.0), spacing, 40.0);
    setup.plane = true;
    setup.bodies = vec![walls(&setup)];
    let drop = [DVec3::new(0.5, 0.5 * spacing, 1.5)];
    let mut tank = Tank::new(setup, vec![resting(DVec3::ZERO)], &drop, |_| 0.0);
    tank.advance(0.2);
    let fallen = f64::from(tank.water().velocities[0].length());
    assert!((fallen - 9.81 * 0.2).abs() < 1e-3);
    assert!((tank.particles.max_speed() - fallen).abs() < 1e-5);
    // It bounces off the floor.
    tank.advance(2.0);
    let now = f64::from(tank.water().velocities[0].length());
    let fastest = tank.particles.max_speed();
    assert!(now < 0.8 * fastest && fastest > 4.0, "{now} {fastest}");
}
