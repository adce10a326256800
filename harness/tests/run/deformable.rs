//! `riprap run` on deformable blocks, dry and in a fluid: stresses in files and tables, restarts, refusals.

use crate::fixture::{folder, last, restarted};
use kit::{assert_contains, assert_relative};
use std::fs;

/// A deformable cube on a rigid one on a floor, and a bar that hangs.
const DRY: &str = r#"
title = "deformable"
[rock]
mass_damping = 500
[[materials]]
name = "rock"
density = 2500
normal_stiffness = 1e9
friction = 30
youngs_modulus = 1e9
[[solids]]
kind = "box"
name = "floor"
min = [-3, -3, -1]
max = [3, 3, 0]
[[blocks]]
name = "rigid"
kind = "box"
size = [1, 1, 1]
position = [0, 0, 0.5]
[[blocks]]
name = "soft"
kind = "box"
size = [1, 1, 1]
position = [0, 0, 1.5]
deformable = true
[[blocks]]
name = "bar"
kind = "box"
size = [1, 1, 2]
position = [2, 0, 4]
deformable = true
fixed_points = [{ point = [0, 0, 1] }]
[run]
duration = 0.05
[output]
every = 0.02
[[output.histories]]
quantities = ["strain_energy", "max_von_mises", "energy_error"]
every = 0.01
[[probes]]
name = "soft"
kind = "block"
block = "soft"
every = 0.01
[[probes]]
name = "rigid"
kind = "block"
block = "rigid"
every = 0.01
[[probes]]
name = "bar"
kind = "block"
block = "bar"
every = 0.01
"#;

/// A cube on rollers in water at rest between walls, 8 cells across.
const WET: &str = r#"
title = "submerged"
[domain]
size = [0.16, 0.16, 0.16]
cell = 0.01
[fluid]
viscosity = 1e-3
[numerics]
velocity_scale = 0.1
[boundaries]
x_min = { kind = "wall" }
x_max = { kind = "wall" }
y_min = { kind = "wall" }
y_max = { kind = "wall" }
z_min = { kind = "wall" }
z_max = { kind = "wall" }
[rock]
mass_damping = 2000
[[materials]]
name = "rock"
density = 2650
normal_stiffness = 1e7
friction = 35
youngs_modulus = 1e7
[[blocks]]
name = "cube"
kind = "box"
size = [0.08, 0.08, 0.08]
position = [0.08, 0.08, 0.083]
deformable = true
fixed_points = [
    { point = [0, 0, -0.04] },
    { point = [0.04, 0, -0.04], axes = ["y", "z"] },
    { point = [0, 0.04, -0.04], axes = ["z"] },
]
[run]
steps = 12
[output]
every = 0.01
[[probes]]
name = "cube"
kind = "block"
block = "cube"
every = 0.005
"#;

#[test]
fn stresses_are_in_files_and_tables_and_survive_a_restart() {
    let files = ["checkpoint.riprap", "soft.csv", "bar.csv", "history.csv"];
    let folder = folder("deformable_dry");
    restarted(&folder, DRY, 41, &files);
    let out = folder.join("whole");
    let weight = 2500.0 * 9.81;
    let soft = last(&out.join("soft.csv"), "stress_zz");
    assert_relative(soft, -0.5 * weight, 1e-3);
    let mises = last(&out.join("soft.csv"), "von_mises");
    assert_relative(mises, 0.5 * weight, 1e-3);
    let bar = last(&out.join("bar.csv"), "stress_zz");
    assert_relative(bar, weight, 1e-3);
    let support = last(&out.join("bar.csv"), "support_z");
    assert_relative(support, 2.0 * weight, 1e-3);
    // σ²/2E over the volume.
    let energy = last(&out.join("history.csv"), "strain_energy");
    let exact = (0.25 + 2.0) * weight * weight / 2e9;
    assert_relative(energy, exact, 2e-3);
    assert_relative(
        last(&out.join("history.csv"), "max_von_mises"),
        weight,
        1e-3,
    );
    assert!(last(&out.join("history.csv"), "energy_error").abs() < 0.01);
    let rigid = fs::read_to_string(out.join("rigid.csv")).unwrap();
    assert!(
        !rigid.contains("stress") && !rigid.contains("support"),
        "{rigid}"
    );

    let files = fs::read_dir(&out)
        .unwrap()
        .map(|entry| entry.unwrap().path());
    let vtu = files
        .filter(|path| path.extension().is_some_and(|e| e == "vtu"))
        .max()
        .unwrap();
    let text = String::from_utf8_lossy(&fs::read(vtu).unwrap()).into_owned();
    assert_contains(
        &text,
        &[
            "\"stress\" NumberOfComponents=\"6\"",
            "\"von_mises\"",
            "\"strain_energy\"",
        ],
    );
}

#[test]
fn a_cube_in_water_bears_its_weight_less_its_buoyancy() {
    let files = ["cube.csv", "checkpoint.riprap"];
    let folder = folder("deformable_wet");
    restarted(&folder, WET, 5, &files);
    let out = folder.join("whole/cube.csv");
    // (ρ − ρ_w) g h/2, from the sample points: the water at rest adds only rounding of its loads.
    let exact = -(2650.0 - 1000.0) * 9.81 * 0.04;
    let stress = last(&out, "stress_zz");
    assert_relative(stress, exact, 0.02);
    let support = last(&out, "support_z");
    let weight = (2650.0 - 1000.0) * 9.81 * 0.08f64.powi(3);
    assert_relative(support, weight, 0.02);
}
