//! What the lattice cannot carry, and what it carries badly.

use riprap::Result;
use riprap::scene::{Advice, Scene};
use riprap::units::Units;

use crate::{read, refused};

/// A lid-driven layer: lid speed (m/s), viscosity (m²/s), numerics.
fn layer(lid: f64, viscosity: f64, numerics: &str) -> (Scene, Units) {
    let scene = read(&format!(
        "[domain]\nsize = [0.01, 0.01, 0.01]\ncell = 1e-3\n[fluid]\nviscosity = {viscosity}\n\
         [run]\nsteps = 1\n[boundaries]\nz_min = {{ kind = \"wall\" }}\n\
         z_max = {{ kind = \"wall\", velocity = [{lid}, 0, 0] }}\n[numerics]\n{numerics}\n"
    ))
    .unwrap();
    let units = Units::of(&scene).unwrap();
    (scene, units)
}

fn advise(lid: f64, viscosity: f64, numerics: &str) -> Result<Advice> {
    let (scene, units) = layer(lid, viscosity, numerics);
    scene.advise(&units)
}

#[track_caller]
fn warned(advice: Result<Advice>, parts: &[&str]) {
    let advice = advice.unwrap();
    assert_eq!(advice.len(), 1, "{advice:?}");
    let words = advice[0].to_string();
    for part in parts {
        assert!(words.contains(part), "`{part}` is not in: {words}");
    }
}

#[test]
fn a_sound_scene_needs_no_advice() {
    assert_eq!(advise(0.01, 1e-5, "").unwrap(), []);
}

#[test]
fn mach_numbers_are_bounded() {
    // Ma = √3 U Δt/Δx = 0.3464; a tenth of it is reached at Δt = 2.887e-3 s.
    refused(
        advise(0.02, 1e-6, "time_step = 1e-2"),
        &["numerics.time_step", "0.346", "time_step ≤ 2.887e-3 s"],
    );
    refused(
        advise(0.02, 1e-6, "mach = 0.31"),
        &["numerics.mach", "mach = 0.1"],
    );
    warned(
        advise(0.02, 1e-6, "mach = 0.2"),
        &["numerics.mach", "4.0 %", "time_step ≤"],
    );
    // The bound itself is within it, whatever the time step that follows from it is rounded to.
    for lid in [0.02, 0.093, 0.186] {
        warned(advise(lid, 1e-5, "mach = 0.3"), &["numerics.mach", "9.0 %"]);
    }
    // A velocity scale that is too low does not hide the speed of the lid.
    refused(
        advise(0.02, 1e-6, "velocity_scale = 0.002"),
        &["1.000", "0.02 m/s"],
    );
}

#[test]
fn relaxation_times_are_bounded() {
    // τ − ½ = 3νΔt/Δx² = 3; 1 at a third of the step.
    warned(
        advise(1e-6, 1e-4, "time_step = 1e-2"),
        &["3.500", "time_step ≤ 3.333e-3 s"],
    );
    refused(
        advise(1e-6, 1e-12, "time_step = 1e-2"),
        &["fluid.viscosity", "viscosity ≥ 3.333e-11 m²/s", "cell ≤"],
    );
    // τ − ½ = 3e-24, and 1e-6 at a step that is longer by as much: sound takes it.
    refused(
        advise(1e-6, 1e-5, "time_step = 1e-25"),
        &["fluid.viscosity", "3.000e-24", "use time_step ≥ 3.333e-8 s"],
    );
    refused(
        advise(1e-6, 1e8, "time_step = 1e-2"),
        &[
            "numerics.time_step",
            "3.000e12",
            "no flow",
            "time_step ≤ 3.33",
        ],
    );
}

#[test]
fn suga_is_refused_where_it_is_unstable() {
    refused(
        advise(1e-3, 1e-5, "collision = \"suga\"\ntime_step = 1e-2"),
        &[
            "numerics.collision",
            "0.8",
            "hermite",
            "time_step ≤ 1.967e-3 s",
        ],
    );
    refused(
        advise(1e-3, 1e-8, "collision = \"suga\"\ntime_step = 1e-2"),
        &["hermite", "time_step ≥ 1.333e-2 s", "cell ≤ 7.500e-4 m"],
    );
    assert_eq!(
        advise(1e-3, 1e-6, "collision = \"suga\"\ntime_step = 1e-2").unwrap(),
        []
    );
}

#[test]
fn coarse_cells_are_warned_of_without_an_eddy_viscosity() {
    // U Δx/ν = 100; 30 at 0.3 mm.
    warned(
        advise(0.1, 1e-6, ""),
        &["domain.cell", "100.0", "cell ≤ 3.000e-4 m", "wale"],
    );
    assert_eq!(advise(0.1, 1e-6, "eddy_viscosity = \"wale\"").unwrap(), []);
}

#[test]
fn bgk_is_warned_of_at_low_viscosity() {
    // τ − ½ = √3 Ma ν/(U Δx) = 0.00866.
    warned(
        advise(0.01, 5e-7, "collision = \"bgk\""),
        &[
            "numerics.collision",
            "0.50866",
            "hermite",
            "cell ≤ 8.660e-4 m",
        ],
    );
}

#[test]
fn water_that_its_own_weight_compresses_is_warned_of() {
    // 9.81 m/s² over 0.16 m at 2.5 mm and 0.82 ms: 3 g H Δt²/Δx² = 0.506; 5 % at a step shorter by √(0.506/0.05).
    let tank = |step: f64| {
        let scene = read(&format!(
            "[domain]\nsize = [0.1, 0.1, 0.16]\ncell = 2.5e-3\n[run]\nsteps = 1\n\
             [fluid]\nviscosity = 6e-5\nacceleration = [0, 0, -9.81]\n\
             [boundaries]\nz_min = {{ kind = \"wall\" }}\nz_max = {{ kind = \"wall\" }}\n\
             [numerics]\ntime_step = {step}\n"
        ))
        .unwrap();
        scene.advise(&Units::of(&scene).unwrap())
    };
    warned(
        tank(8.2e-4),
        &["fluid.acceleration", "50.7 %", "time_step ≤ 2.576e-4 s"],
    );
    assert_eq!(tank(2.5e-4).unwrap(), []);
}

#[test]
fn water_that_given_pressures_compress_is_warned_of() {
    // c² = Δx²/(3 Δt²) = 3.33e-5 m²/s² at 1 mm and 0.1 s: 0.01 Pa is 0.3 of ρ c², and 5 % at a step shorter by √6.
    let duct = |pressure: f64, initial: &str| {
        let scene = read(&format!(
            "[domain]\nsize = [0.02, 0.01, 0.01]\ncell = 1e-3\n[run]\nsteps = 1\n\
             [fluid]\nviscosity = 1e-6\n[initial]\n{initial}\n[boundaries]\n\
             x_min = {{ kind = \"pressure\", pressure = {pressure} }}\nx_max = {{ kind = \"pressure\" }}\n\
             [numerics]\ntime_step = 0.1\nvelocity_scale = 1e-4\n"
        ))
        .unwrap();
        let units = Units::of(&scene).unwrap();
        (scene.advise(&units), scene.compression(&units).unwrap())
    };
    let (advice, compression) = duct(0.01, "");
    warned(
        advice,
        &[
            "boundaries",
            "30.0 %",
            "half of that",
            "time_step ≤ 4.082e-2 s",
        ],
    );
    assert!((compression - 0.3).abs() < 1e-9, "{compression}");
    assert_eq!(duct(1e-3, "").0.unwrap(), []);
    let waves = "pressure = \"0.005*sin(100*pi*x)\"";
    warned(duct(0.0, waves).0, &["initial.pressure", "time_step ≤"]);
    warned(duct(0.01, waves).0, &["boundaries"]);
}
