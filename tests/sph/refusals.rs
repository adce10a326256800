//! Errors of the solver for invalid input.

use crate::tank::resting;
use glam::{DMat3, DVec3};
use riprap::{
    geometry::Pose,
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

#[test]
fn invalid_parameters_are_refused_by_name() {
    const NAN: f64 = f64::NAN;
    let refused = |place: &str, change: &dyn Fn(&mut Setup)| {
        let mut setup = tank();
        change(&mut setup);
        let error = solver(setup, MIDDLE, DVec3::ZERO, 0.0).unwrap_err();
        let message = error.to_string();
        assert!(
            message.starts_with(&format!("{place}: ")),
            "{place}: {message}"
        );
    };
    assert!(solver(tank(), MIDDLE, DVec3::ZERO, 0.0).is_ok());
    for bad in [NAN, -1.0, f64::INFINITY, 1e300] {
        refused("artificial_viscosity", &|s| {
            s.artificial_viscosity = bad;
        });
        refused("density_diffusion", &|s| s.density_diffusion = bad);
        refused("laminar_viscosity", &|s| s.laminar_viscosity = bad);
        refused("scheme.viscosity", &|s| {
            s.scheme = Scheme::Mueller { viscosity: bad };
        });
    }
    for bad in [NAN, 0.0, -1.0, 1.5, f64::INFINITY] {
        refused("courant", &|s| s.courant = bad);
    }
    refused("bodies[0].boundary[1]", &|s| {
        s.bodies[0].boundary.push(DVec3::NAN);
    });
    refused("bodies[0].solids[0]", &|s| {
        s.bodies[0].solids = vec![Solid::Sphere {
            centre: DVec3::ZERO,
            radius: NAN,
        }];
    });
}

#[test]
fn invalid_particles_are_refused() {
    let (device, queue) = noop();
    let none = SphSolver::new(&device, &queue, tank(), &[], &[], &[]);
    let message = none.unwrap_err().to_string();
    assert!(
        message.starts_with("positions: there is no particle"),
        "{message}"
    );
    let message = |state: EquationOfState, at: DVec3, velocity: DVec3, pressure: f64| {
        let mut setup = tank();
        setup.equation_of_state = state;
        let result = solver(setup, at, velocity, pressure);
        result.map_err(|error| error.to_string()).err()
    };
    let still = DVec3::ZERO;
    for state in [EquationOfState::Linear, EquationOfState::Tait] {
        assert_eq!(message(state, MIDDLE, still, -1e4), None);
        // ρ₀ c₀² is 400 kPa; Tait's equation has minus a seventh of it at zero density.
        let message = message(state, MIDDLE, still, -5e5).unwrap();
        let least = match state {
            EquationOfState::Linear => "-4.000e5",
            EquationOfState::Tait => "-5.714e4",
        };
        assert!(
            message.contains("no density") && message.contains(least),
            "{message}"
        );
    }
    for (at, velocity) in [
        (DVec3::NAN, still),
        (MIDDLE, DVec3::NAN),
        (MIDDLE, DVec3::X * 1e300),
    ] {
        let message = message(EquationOfState::Linear, at, velocity, 0.0).unwrap();
        assert!(message.contains("particle 0"), "{message}");
    }
}

#[test]
fn invalid_exchanges_are_refused() {
    let (device, queue) = noop();
    let still = [DVec3::ZERO];
    let mut particles = SphSolver::new(&device, &queue, tank(), &[MIDDLE], &still, &[0.0]).unwrap();
    let good = resting(DVec3::ZERO);
    let mut begin = |poses: &[Pose], time: f64| {
        let begun = particles.begin(&queue, poses, time);
        begun.map_err(|error| error.to_string()).err()
    };
    for poses in [&[][..], &[good, good]] {
        let message = begin(poses, 0.01).unwrap();
        assert!(message.starts_with("poses: "), "{message}");
    }
    let (mut lost, mut flat) = (good, good);
    lost.velocity.y = f64::NAN;
    flat.deformation = DMat3::ZERO;
    for (pose, word) in [(lost, "not finite"), (flat, "determinant")] {
        let message = begin(&[pose], 0.01).unwrap();
        assert!(
            message.starts_with("poses[0]: ") && message.contains(word),
            "{message}"
        );
    }
    for time in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let message = begin(&[good], time).unwrap();
        assert!(message.starts_with("time: "), "{message}");
    }
    assert_eq!(begin(&[good], 0.01), None);
}
