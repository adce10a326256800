//! Errors of the solver for invalid input.

use crate::tank::resting;
use glam::{DMat3, DVec3};
use riprap::{
    sph::{Body, EquationOfState, Scheme, Setup, Solid, SphSolver},
    wgpu,
};

/// A device that does nothing: invalid input never reaches it.
fn noop() -> (wgpu::Device, wgpu::Queue) {
    wgpu::Device::noop(&wgpu::DeviceDescriptor::default())
}

/// A solver for a particle in a tank with a body.
fn solver(setup: Setup, at: DVec3, velocity: DVec3, pressure: f64) -> riprap::Result<SphSolver> {
    let (device, queue) = noop();
    SphSolver::new(&device, &queue, setup, &[at], &[velocity], &[pressure])
}

fn tank() -> Setup {
    let mut setup = Setup::tank(DVec3::ONE, 0.1, 20.0);
    setup.bodies = vec![Body {
        boundary: vec![DVec3::ZERO],
        loaded: true,
        ..Body::default()
    }];
    setup
}

const MIDDLE: DVec3 = DVec3::splat(0.5);

/// The message of the solver when it refuses, in one line.
fn refusal(setup: Setup, at: DVec3, velocity: DVec3, pressure: f64) -> String {
    let refused = solver(setup, at, velocity, pressure);
    refused
        .map(|_| ())
        .expect_err("it must be refused")
        .to_string()
        + "\n"
}

#[test]
fn invalid_parameters_are_refused_by_name() {
    assert!(solver(tank(), MIDDLE, DVec3::ZERO, 0.0).is_ok());
    let mut told = String::new();
    let mut refuse = |change: &dyn Fn(&mut Setup)| {
        let mut setup = tank();
        change(&mut setup);
        told += &refusal(setup, MIDDLE, DVec3::ZERO, 0.0);
    };
    for bad in [f64::NAN, -1.0, f64::INFINITY, 1e300] {
        refuse(&|s| s.artificial_viscosity = bad);
        refuse(&|s| s.density_diffusion = bad);
        refuse(&|s| s.laminar_viscosity = bad);
        refuse(&|s| s.scheme = Scheme::Mueller { viscosity: bad });
    }
    for bad in [f64::NAN, 0.0, -1.0, 1.5, f64::INFINITY] {
        refuse(&|s| s.courant = bad);
    }
    refuse(&|s| s.bodies[0].boundary.push(DVec3::NAN));
    refuse(&|s| {
        s.bodies[0].solids = vec![Solid::Sphere {
            centre: DVec3::ZERO,
            radius: f64::NAN,
        }];
    });
    insta::assert_snapshot!(told);
}

#[test]
fn invalid_particles_are_refused() {
    let (device, queue) = noop();
    let none = SphSolver::new(&device, &queue, tank(), &[], &[], &[]);
    let mut told = none.unwrap_err().to_string() + "\n";
    let still = DVec3::ZERO;
    for state in [EquationOfState::Linear, EquationOfState::Tait] {
        let mut setup = tank();
        setup.equation_of_state = state;
        assert!(solver(setup.clone(), MIDDLE, still, -1e4).is_ok());
        // ρ₀ c₀² is 400 kPa; Tait's equation has minus a seventh of it at zero density.
        told += &refusal(setup, MIDDLE, still, -5e5);
    }
    for (at, velocity) in [
        (DVec3::NAN, still),
        (MIDDLE, DVec3::NAN),
        (MIDDLE, DVec3::X * 1e300),
    ] {
        told += &refusal(tank(), at, velocity, 0.0);
    }
    insta::assert_snapshot!(told);
}

#[test]
fn invalid_exchanges_are_refused() {
    let (device, queue) = noop();
    let still = [DVec3::ZERO];
    let particles = SphSolver::new(&device, &queue, tank(), &[MIDDLE], &still, &[0.0]);
    let mut particles = particles.unwrap();
    let good = resting(DVec3::ZERO);
    let (mut lost, mut flat) = (good, good);
    lost.velocity.y = f64::NAN;
    flat.deformation = DMat3::ZERO;
    let mut told = String::new();
    for (poses, time) in [
        (&[][..], 0.01),
        (&[good, good], 0.01),
        (&[lost], 0.01),
        (&[flat], 0.01),
        (&[good], 0.0),
        (&[good], -1.0),
        (&[good], f64::NAN),
        (&[good], f64::INFINITY),
    ] {
        let begun = particles.begin(&queue, poses, time);
        told += &(begun.map(|_| ()).unwrap_err().to_string() + "\n");
    }
    assert!(particles.begin(&queue, &[good], 0.01).is_ok());
    insta::assert_snapshot!(told);
}
