//! Conversion between SI and lattice units.

use riprap::units::Units;

use crate::channel;

const UNITS: Units = Units {
    cell: 2e-3,
    time_step: 5e-5,
    density: 998.0,
};

#[test]
fn every_conversion_comes_back() {
    let u = UNITS;
    let value = 0.731;
    for (name, back) in [
        (
            "velocity",
            u.velocity_from_lattice(u.velocity_to_lattice(value)),
        ),
        (
            "pressure",
            u.pressure_from_lattice(u.pressure_to_lattice(value * 1e3)) / 1e3,
        ),
        (
            "density",
            u.density_from_lattice(u.density_to_lattice(value)),
        ),
        ("force", u.force_from_lattice(u.force_to_lattice(value))),
        ("torque", u.torque_from_lattice(u.torque_to_lattice(value))),
        (
            "acceleration",
            u.acceleration_from_lattice(u.acceleration_to_lattice(value)),
        ),
        (
            "viscosity",
            u.viscosity_from_lattice(u.viscosity_to_lattice(value)),
        ),
        ("rate", u.rate_from_lattice(u.rate_to_lattice(value))),
        ("time", u.time_from_lattice(u.time_to_lattice(value))),
    ] {
        assert!((back - value).abs() < 1e-12, "{name}: {back}");
    }
}

#[test]
fn conversions_have_the_dimensions_of_their_quantities() {
    let Units {
        cell: dx,
        time_step: dt,
        density: rho,
    } = UNITS;
    let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-13, "{a} {b}");
    close(UNITS.velocity_from_lattice(1.0), dx / dt);
    close(
        UNITS.pressure_from_lattice(1.003),
        rho / 3.0 * 0.003 * (dx / dt).powi(2),
    );
    close(UNITS.force_from_lattice(1.0), rho * dx.powi(4) / dt.powi(2));
    close(
        UNITS.torque_from_lattice(1.0),
        rho * dx.powi(5) / dt.powi(2),
    );
    close(UNITS.acceleration_from_lattice(1.0), dx / dt.powi(2));
    close(UNITS.viscosity_from_lattice(1.0), dx * dx / dt);
    // ν = c_s² (τ − ½) Δx²/Δt.
    close(
        UNITS.viscosity_from_lattice((UNITS.tau(1e-3) - 0.5) / 3.0),
        1e-3,
    );
    close(UNITS.mach(1.0), dt / dx * 3.0_f64.sqrt());
}

#[test]
fn the_time_step_follows_from_the_mach_number() {
    let lid = "[boundaries]\ny_min = { kind = \"wall\" }\n\
               y_max = { kind = \"wall\", velocity = [0.3, 0, 0.4] }\n";
    let scene = channel(lid).unwrap();
    let units = Units::of(&scene).unwrap();
    assert!((units.mach(0.5) - 0.1).abs() < 1e-12);
    let scene = channel(&format!(
        "[numerics]\nmach = 0.05\nvelocity_scale = 2\n{lid}"
    ))
    .unwrap();
    assert!((Units::of(&scene).unwrap().mach(2.0) - 0.05).abs() < 1e-12);
    let scene = channel("[numerics]\ntime_step = 1e-4\n").unwrap();
    assert_eq!(Units::of(&scene).unwrap().time_step, 1e-4);
}
