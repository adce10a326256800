//! Statistics over time: tables next to those of probes, also over restarts, and runs that end when means have converged.

use crate::fixture::{args, column, folder, go, last, restarted, riprap, said};
use kit::assert_contains;
use riprap_harness::run::run;
use std::{fs, sync::atomic::AtomicBool};

/// A stream past a fixed block with an inlet that oscillates with a period of 0.1 s; the time step is 1 ms.
const SCENE: &str = r#"
    domain = { size = [0.16, 0.08, 0.08], cell = 0.01 }
    fluid = { viscosity = 1e-3, density = 1000 }
    numerics.time_step = 1e-3
    run.steps = 400
    [boundaries]
    x_min = { kind = "velocity", velocity = ["0.5 + 0.2*sin(20*pi*t)", 0, 0] }
    x_max = { kind = "pressure" }
    y_min = { kind = "free_slip" }
    y_max = { kind = "free_slip" }
    [[materials]]
    name = "rock"
    density = 2650
    normal_stiffness = 1e6
    friction = 30
    [[blocks]]
    name = "sill"
    kind = "box"
    size = [0.02, 0.02, 0.02]
    position = [0.08, 0.04, 0.04]
    motion = "fixed"
    [statistics]
    from = 0.05
    [output]
    every = 0.2
    fields = ["velocity", "mean_velocity", "reynolds_stress", "pressure_rms"]
    slices = [{ name = "k", axis = "z", field = "turbulent_kinetic_energy", every = 0.2 }]
    [[probes]]
    name = "inflow"
    kind = "point"
    at = [0.03, 0.04, 0.04]
    every = 0.002
    [[probes]]
    name = "across"
    kind = "line"
    from = [0.12, 0.005, 0.04]
    to = [0.12, 0.075, 0.04]
    count = 8
    every = 0.002
    [[probes]]
    name = "sill"
    kind = "block"
    block = "sill"
    faces = true
    every = 0.01
"#;

#[test]
fn tables_of_means_spectra_and_correlations() {
    let folder = folder("statistics");
    let files = [
        "inflow_statistics.csv",
        "inflow_spectrum.csv",
        "across_statistics.csv",
        "across_correlation.csv",
        "sill_statistics.csv",
        "sill_faces_statistics.csv",
        "fields_000400.vti",
        "k_000400.png",
    ];
    let summary = restarted(&folder, SCENE, 131, &files);
    let of = |file: &str| folder.join("whole").join(file);
    let written = |file: &str| summary.files.contains(&of(file));
    for picture in [
        "inflow_spectrum.png",
        "across_statistics.png",
        "across_correlation.png",
    ] {
        assert!(written(picture) && of(picture).exists(), "{picture}");
    }
    assert!(!of("k_000000.png").exists(), "before the first sample");

    // The mean is that of the rows from 0.05 s on.
    let times = column(&of("inflow.csv"), "time");
    let speeds = column(&of("inflow.csv"), "velocity_x");
    let counted = times
        .iter()
        .zip(&speeds)
        .filter(|(time, _)| **time > 0.0499);
    let counted: Vec<f64> = counted.map(|(_, speed)| *speed).collect();
    let mean = counted.iter().sum::<f64>() / counted.len() as f64;
    let table = of("inflow_statistics.csv");
    assert_eq!(last(&table, "samples"), counted.len() as f64);
    assert!((last(&table, "velocity_x_mean") - mean).abs() < 1e-12);
    assert!((mean - 0.5).abs() < 0.05, "{mean}");
    assert!((last(&table, "velocity_x_rms") - 0.2 / 2.0_f64.sqrt()).abs() < 0.02);
    // Batches are shorter than the period, so that their means differ little.
    assert!((0.01..0.15).contains(&last(&table, "velocity_x_error")));
    // 10 Hz.
    let densities = column(&of("inflow_spectrum.csv"), "velocity_x");
    let most = densities.iter().copied().fold(0.0, f64::max);
    let peak = densities.iter().position(|density| *density == most);
    let frequency = column(&of("inflow_spectrum.csv"), "frequency")[peak.unwrap()];
    assert!((frequency - 10.0).abs() < 8.0, "{frequency}");
    let itself = column(&of("across_correlation.csv"), "velocity_x")[0];
    assert!((itself - 1.0).abs() < 1e-12, "{itself}");
    assert_eq!(column(&of("across_statistics.csv"), "s").len(), 8);
    // A face that looks upstream: its index is a coordinate.
    assert_eq!(
        column(&of("sill_faces_statistics.csv"), "face"),
        [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]
    );
    assert!(last(&of("sill_statistics.csv"), "fluid_force_x_mean") > 0.0);
    let fields = fs::read(of("fields_000400.vti")).unwrap();
    let tensor = "Name=\"reynolds_stress\" NumberOfComponents=\"6\"";
    assert_contains(String::from_utf8_lossy(&fields), &[tensor]);
}

#[test]
fn a_run_ends_when_its_means_are_known() {
    let folder = folder("until_error");
    let often = SCENE.replace("every = 0.002", "every = 0.001");
    let mut args = args(&folder, &often, "out");
    args.until_error = Some("20%".parse().unwrap());
    args.error_of = vec!["inflow.velocity".into()];
    let summary = go(&args);
    assert!(summary.complete && summary.steps < 400, "{summary}");
    assert_contains(&summary, &["statistical error of means", "inflow.velocity"]);
    let converged = summary.statistics.unwrap();
    assert!(converged.reached && converged.error.unwrap() <= 0.2);
    // The output is complete.
    assert!(fs::read_dir(folder.join("out")).unwrap().count() > 10);

    args.until_error = Some("0.001".parse().unwrap());
    let summary = go(&args);
    assert_eq!((summary.complete, summary.steps), (true, 400));
    assert!(!summary.statistics.as_ref().unwrap().reached);
    assert_contains(&summary, &["times as many samples"]);

    args.error_of = vec!["inflow.speed".into()];
    let error = run(&args, &AtomicBool::new(false)).unwrap_err().to_string();
    assert_contains(&error, &["--error-of", "inflow.speed", "inflow.velocity"]);
    for wrong in ["0", "-2%", "100%", "NaN", "much"] {
        let output = riprap(&folder, &["run", "scene.toml", "--until-error", wrong]);
        assert!(!output.status.success(), "{wrong}");
    }
    let plain = SCENE.replace("[statistics]\n    from = 0.05\n", "");
    let plain = plain.replace(
        "\"mean_velocity\", \"reynolds_stress\", \"pressure_rms\"",
        "\"pressure\"",
    );
    let plain = plain.replace("turbulent_kinetic_energy", "speed");
    fs::write(folder.join("scene.toml"), plain).unwrap();
    let output = riprap(&folder, &["run", "scene.toml", "--until-error", "2%"]);
    assert!(!output.status.success());
    assert_contains(said(&output), &["--until-error", "[statistics]"]);
}
