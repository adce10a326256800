//! What is no water is refused, by name.

use crate::tank::resting;
use glam::{DMat3, DVec3};
use riprap::{
    bodies::Pose,
    particles::{Body, Particles, Scheme, Setup, Solid, StateEquation},
    wgpu,
};

/// A device that does nothing: what is refused never reaches one.
fn nothing() -> (wgpu::Device, wgpu::Queue) {
    wgpu::Device::noop(&wgpu::DeviceDescriptor::default())
}

/// A particle in a box beside a body.
fn made(setup: Setup, at: DVec3, velocity: DVec3, pressure: f64) -> riprap::Result<Particles> {
    let (device, queue) = nothing();
    Particles::new(&device, &queue, setup, &[at], &[velocity], &[pressure])
}

fn tank() -> Setup {
    let mut setup = Setup::tank(DVec3::ONE, 0.1, 20.0);
    setup.bodies = vec![Body {
        shell: vec![DVec3::ZERO],
        loaded: true,
        ..Body::default()
    }];
    setup
}

const MIDDLE: DVec3 = DVec3::splat(0.5);

#[test]
fn numbers_that_cannot_be_are_refused_by_name() {
    const NAN: f64 = f64::NAN;
    let refused = |place: &str, change: &dyn Fn(&mut Setup)| {
        let mut setup = tank();
        change(&mut setup);
        let told = made(setup, MIDDLE, DVec3::ZERO, 0.0).unwrap_err();
        let told = told.to_string();
        assert!(told.starts_with(&format!("{place}: ")), "{place}: {told}");
    };
    assert!(made(tank(), MIDDLE, DVec3::ZERO, 0.0).is_ok());
    for bad in [NAN, -1.0, f64::INFINITY, 1e300] {
        refused("particles.artificial_viscosity", &|s| {
            s.artificial_viscosity = bad;
        });
        refused("particles.density_diffusion", &|s| {
            s.density_diffusion = bad
        });
        refused("fluid.viscosity", &|s| s.laminar_viscosity = bad);
        refused("particles.scheme.viscosity", &|s| {
            s.scheme = Scheme::Mueller { viscosity: bad };
        });
    }
    for bad in [NAN, 0.0, -1.0, 1.5, f64::INFINITY] {
        refused("particles.courant", &|s| s.courant = bad);
    }
    refused("bodies[0].shell[1]", &|s| {
        s.bodies[0].shell.push(DVec3::NAN);
    });
    refused("bodies[0].solids[0]", &|s| {
        s.bodies[0].solids = vec![Solid::Sphere {
            centre: DVec3::ZERO,
            radius: NAN,
        }];
    });
}

#[test]
fn water_that_is_none_is_refused() {
    let (device, queue) = nothing();
    let none = Particles::new(&device, &queue, tank(), &[], &[], &[]);
    let told = none.unwrap_err().to_string();
    assert!(told.starts_with("water: there is no particle"), "{told}");
    let told = |state: StateEquation, at: DVec3, velocity: DVec3, pressure: f64| {
        let mut setup = tank();
        setup.state = state;
        let made = made(setup, at, velocity, pressure);
        made.map_err(|error| error.to_string()).err()
    };
    let still = DVec3::ZERO;
    for state in [StateEquation::Linear, StateEquation::Tait] {
        assert_eq!(told(state, MIDDLE, still, -1e4), None);
        // ρ₀ c₀² is 400 kPa, a seventh of it what Tait's equation has at no density.
        let told = told(state, MIDDLE, still, -5e5).unwrap();
        let least = match state {
            StateEquation::Linear => "-4.000e5",
            StateEquation::Tait => "-5.714e4",
        };
        assert!(
            told.contains("no density") && told.contains(least),
            "{told}"
        );
    }
    for (at, velocity) in [
        (DVec3::NAN, still),
        (MIDDLE, DVec3::NAN),
        (MIDDLE, DVec3::X * 1e300),
    ] {
        let told = told(StateEquation::Linear, at, velocity, 0.0).unwrap();
        assert!(told.contains("particle 0"), "{told}");
    }
}

#[test]
fn exchanges_that_cannot_be_are_refused() {
    let (device, queue) = nothing();
    let still = [DVec3::ZERO];
    let mut particles = Particles::new(&device, &queue, tank(), &[MIDDLE], &still, &[0.0]).unwrap();
    let good = resting(DVec3::ZERO);
    let mut begin = |poses: &[Pose], time: f64| {
        let begun = particles.begin(&queue, poses, time);
        begun.map_err(|error| error.to_string()).err()
    };
    for poses in [&[][..], &[good, good]] {
        let told = begin(poses, 0.01).unwrap();
        assert!(told.starts_with("poses: "), "{told}");
    }
    let (mut lost, mut flat) = (good, good);
    lost.velocity.y = f64::NAN;
    flat.deformation = DMat3::ZERO;
    for (pose, word) in [(lost, "not finite"), (flat, "determinant")] {
        let told = begin(&[pose], 0.01).unwrap();
        assert!(
            told.starts_with("poses[0]: ") && told.contains(word),
            "{told}"
        );
    }
    for time in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let told = begin(&[good], time).unwrap();
        assert!(told.starts_with("time: "), "{told}");
    }
    assert_eq!(begin(&[good], 0.01), None);
}
