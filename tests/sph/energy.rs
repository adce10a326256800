//! Energy balance of the water.

use crate::tank::{Tank, lattice, resting, walls};
use glam::DVec3;
use kit::{assert_near, assert_relative};
use riprap::{
    geometry::Pose,
    sph::{Body, EquationOfState, ExternalWork, Setup, Side, Totals},
};

/// The compression energy against a numerical integral of p/ρ², with both equations of state.
#[test]
fn energy_of_compression_is_the_work_of_pressure() {
    for state in [EquationOfState::Linear, EquationOfState::Tait] {
        let mut setup = Setup::tank(DVec3::ONE, 0.1, 40.0);
        setup.equation_of_state = state;
        for end in [-0.02, 1e-4, 0.03] {
            let count = 2000;
            let step = end / f64::from(count);
            let work = (0..count).map(|n| {
                let excess = (f64::from(n) + 0.5) * step;
                let density = setup.density * (1.0 + excess);
                setup.pressure(excess) / density.powi(2) * setup.density * step
            });
            let (work, found) = (work.sum::<f64>(), setup.compression(end));
            assert!((found / work - 1.0).abs() < 1e-6, "{end}: {found} {work}");
        }
    }
}

/// A drop leaves through an open face.
#[test]
fn an_escaped_particle_takes_its_energy_along() {
    let spacing = 0.05;
    let mut setup = Setup::tank(DVec3::new(0.5, spacing, 0.6), spacing, 44.0);
    setup.plane = true;
    setup.faces[2][1] = Side::Open;
    setup.bodies = vec![walls(&setup)];
    let mut positions = lattice(&setup, [0; 3], [10, 1, 2]);
    positions.push(DVec3::new(0.25, 0.5 * spacing, 0.58));
    let mut tank = Tank::new(
        setup.clone(),
        vec![resting(DVec3::ZERO)],
        &positions,
        |_| 0.0,
    );
    // The drop falls from rest and does not escape.
    tank.advance(2e-3);
    assert_eq!(tank.water().escaped, Totals::default());
    let mut velocities = vec![DVec3::ZERO; positions.len()];
    velocities[positions.len() - 1] = DVec3::Z * 2.0;
    let pressures = vec![0.0; positions.len()];
    let mut tank = Tank::moving(
        setup.clone(),
        vec![resting(DVec3::ZERO)],
        &positions,
        &velocities,
        &pressures,
    );
    let before = tank.water();
    tank.advance(0.02);
    let after = tank.water();
    assert_eq!((before.len(), after.len()), (21, 20));
    // ½ m v² and the potential energy at the initial height are conserved.
    let expected = setup.particle_mass() * (0.5 * 4.0 + 9.81 * 0.58);
    assert_eq!(after.escaped.mass, setup.particle_mass());
    let found = after.escaped.energy();
    assert_relative(found, expected, 1e-3);
}

/// Water falls along a periodic axis, four periods far.
#[test]
fn gravity_works_on_water_that_crosses_a_periodic_boundary() {
    let spacing = 0.05;
    let mut setup = Setup::tank(DVec3::new(0.5, spacing, 0.6), spacing, 44.0);
    setup.plane = true;
    setup.gravity = DVec3::X * -4.0;
    setup.faces[0] = [Side::Periodic; 2];
    setup.faces[2][1] = Side::Open;
    setup.bodies = vec![walls(&setup)];
    let positions = lattice(&setup, [0, 0, 6], [4, 1, 9]);
    let mut tank = Tank::new(
        setup.clone(),
        vec![resting(DVec3::ZERO)],
        &positions,
        |_| 0.0,
    );
    let first = Totals::of(&setup, &tank.water());
    for _ in 0..50 {
        tank.advance(0.02);
    }
    let last = Totals::of(&setup, &tank.water());
    let work = tank.particles.work().gravity;
    assert_relative(
        last.kinetic_energy,
        12.0 * setup.particle_mass() * 8.0,
        1e-3,
    );
    assert_relative(last.energy() - first.energy(), work, 5e-3);
}

/// Works, and energies at the start and the end, of water 12 particles deep at a plate that moves into it by 0.1 m and back
/// along a cosine, for `fraction` of the period.
fn plate_work(fraction: f64, lossless: bool) -> (ExternalWork, [Totals; 2], f64) {
    let spacing = 0.05;
    let mut setup = Setup::tank(DVec3::new(2.0, 1.0, 1.0), spacing, 40.0);
    setup.plane = true;
    setup.faces[2][1] = Side::Open;
    if lossless {
        (setup.artificial_viscosity, setup.density_diffusion) = (0.0, 0.0);
    }
    let mut plate = Body {
        moves: true,
        loaded: true,
        accelerates: true,
        ..Default::default()
    };
    // Four layers behind the face x = 0.5.
    plate.boundary = lattice(&setup, [6, 0, 0], [10, 1, 20]);
    for x in &mut plate.boundary {
        x.y = 0.0;
    }
    setup.bodies = vec![walls(&setup), plate];
    let positions = lattice(&setup, [10, 0, 0], [40, 1, 12]);
    let hydrostatic = |x: DVec3| 9810.0 * (0.6 - x.z).max(0.0);
    let at = |time: f64| {
        let rate = std::f64::consts::PI;
        Pose {
            centre: DVec3::new(0.05 * (1.0 - (rate * time).cos()), 0.5, 0.0),
            velocity: DVec3::X * 0.05 * rate * (rate * time).sin(),
            ..resting(DVec3::ZERO)
        }
    };
    let mut tank = Tank::new(
        setup.clone(),
        vec![resting(DVec3::ZERO), at(0.0)],
        &positions,
        hydrostatic,
    );
    let first = Totals::of(&setup, &tank.water());
    let step = 2e-3;
    let steps = (2.0 * fraction / step).round() as u32;
    // Minus the load on the plate times its displacement.
    let mut work = 0.0;
    for n in 0..steps {
        let time = f64::from(n) * step;
        let centre = at(time);
        let next = at(time + step);
        let velocity = (next.centre - centre.centre) / step;
        tank.poses[1] = Pose { velocity, ..centre };
        let done = tank.advance(step);
        work -= done.loads[1].force.x * (next.centre.x - centre.centre.x);
    }
    let last = Totals::of(&setup, &tank.water());
    (tank.particles.work(), [first, last], work)
}

/// The water gains the work of the plate and of the boundary particles in the corners. Without viscosity and diffusion only
/// the time integration dissipates energy.
#[test]
fn the_water_gains_the_work_of_a_plate() {
    for (fraction, lossless) in [(0.5, true), (0.5, false), (1.0, true), (1.0, false)] {
        let (works, [first, last], work) = plate_work(fraction, lossless);
        assert_near(works.bodies, work, 1e-6 * work.abs());
        assert_eq!(works.penalty, 0.0);
        let gained = last.energy() - first.energy();
        let dissipated = works.bodies + works.boundary - gained;
        // ρ g V²/2 (1/(L − s) − 1/L) for a slow displacement; here the water also sloshes.
        let lifted = 0.5 * 9810.0 * 0.81 * (1.0 / 1.4 - 1.0 / 1.5);
        println!(
            "{fraction} {lossless}: {works:?}, gained {gained:.3}, dissipated {dissipated:.3}, lifted {lifted:.3}"
        );
        if fraction == 0.5 {
            assert!(
                gained > lifted && gained < 1.15 * lifted,
                "{gained} {lifted}"
            );
            assert!(works.boundary.abs() < 0.08 * gained, "{works:?}");
        }
        let limit = 1e-3 * lifted;
        if lossless {
            assert!(dissipated.abs() < limit, "{dissipated}");
        } else {
            let bounds = -limit..0.05 * lifted;
            assert!(bounds.contains(&dissipated), "{dissipated}");
        }
    }
}
