//! Runs of free water: their output, compared with the state of the water.

use crate::fixture::{self, args, column, folder, go};
use kit::{assert_contains, assert_near, assert_relative, scene::STILL_WATER};
use riprap_harness::{
    render::Picture,
    run::{Args, run},
};
use std::{fs, path::Path, sync::atomic::AtomicBool};

const MEASURED: &str = r#"
    [output]
    every = 0.01
    fields = ["velocity", "pressure", "density"]
    [[output.histories]]
    quantities = ["mass", "kinetic_energy", "potential_energy", "max_speed"]
    every = 0.005
    [[probes]]
    name = "level"
    kind = "gauge"
    at = [0.5, 0.5]
    [[probes]]
    name = "bed"
    kind = "point"
    at = [0.5, 0.5, 0]
    fields = ["pressure", "velocity"]
    [[probes]]
    name = "edge"
    kind = "run_up"
    min = [0, 0, 0]
    max = [1.2, 1, 1.2]
    direction = "+x"
    [[probes]]
    name = "column"
    kind = "line"
    from = [0.5, 0.5, 0.1]
    to = [0.5, 0.5, 0.5]
    count = 3
    fields = ["pressure", "density"]
    [[probes]]
    name = "left"
    kind = "box"
    min = [0, 0, 0]
    max = [0.6, 1, 1.2]
    fields = ["velocity", "pressure"]
    [[probes]]
    name = "dry"
    kind = "gauge"
    at = [0.5, 0.5]
    [[views]]
    name = "tank"
    size = [320, 240]
    direction = [0, 1, 0]
    animation = false
    strip = 2
"#;

fn last(folder: &Path, table: &str, column: &str) -> f64 {
    fixture::last(&folder.join(table), column)
}

#[test]
fn still_water_is_measured_where_it_is() {
    let folder = folder("water_still");
    let args = args(&folder, &format!("{STILL_WATER}{MEASURED}"), "out");
    let summary = go(&args);
    let out = folder.join("out");
    assert!(summary.complete && summary.rocks.is_none());
    let pool = summary.pool.unwrap();
    // 12 × 8 of water; four layers at both sides and below, up to four above the domain.
    assert_eq!((pool.particles, pool.escaped), (96, 0));
    assert_eq!(pool.shell, 2 * 4 * 20 + 4 * 12);
    assert!(pool.max_mach < 0.01, "{}", pool.max_mach);
    assert_near(last(&out, "level.csv", "level"), 0.8, 0.01);
    let bottom = 1000.0 * 9.81 * 0.8;
    let pressure = last(&out, "bed.csv", "pressure");
    assert_relative(pressure, bottom, 0.03);
    assert_near(last(&out, "edge.csv", "x"), 1.15, 0.01);
    let [places, pressures] = ["z", "pressure"].map(|name| column(&out.join("column.csv"), name));
    assert_eq!(places, [0.1, 0.3, 0.5]);
    for (z, pressure) in places.iter().zip(&pressures) {
        let still = 1000.0 * 9.81 * (0.8 - z);
        assert!((pressure - still).abs() < 0.03 * bottom, "{z}: {pressure}");
    }
    // Half of the particles: the upper layers with the lowest pressure.
    assert_near(last(&out, "left.csv", "volume"), 0.48, 1e-9);
    let [mean, least, most] =
        ["mean", "min", "max"].map(|what| last(&out, "left.csv", &format!("pressure_{what}")));
    assert!((mean / bottom - 0.5).abs() < 0.03 && least < 0.15 * bottom && most > 0.85 * bottom);
    assert!(last(&out, "left.csv", "velocity_y_max").abs() < 1e-6);
    assert_near(last(&out, "history.csv", "mass"), 960.0, 1e-9);
    // At rest, apart from the initial particle lattice next to walls.
    assert!(last(&out, "history.csv", "kinetic_energy") < 1e-4 * 960.0 * 9.81 * 0.4);
    let cloud = fs::read(out.join("water_000000.vtp")).unwrap();
    let text = String::from_utf8_lossy(&cloud);
    let parts = [
        "NumberOfPoints=\"96\"",
        "velocity",
        "pressure",
        "density",
        "id",
    ];
    assert_contains(text, &parts);
    let picture = Picture::load(&out.join("tank_000000.png")).unwrap();
    let blue = picture
        .rgba
        .chunks(4)
        .filter(|p| p[2] > p[0].saturating_add(40));
    assert!(blue.count() > 1000);
    assert!(out.join("tank_strip.png").is_file() && out.join("water.pvd").is_file());
    // A single time makes no curve.
    assert!(!out.join("level.png").exists());
}

/// A probe that is always dry has no curve.
#[test]
fn levels_and_run_up_are_drawn_over_time() {
    let folder = folder("water_curves");
    let text = format!(
        "{STILL_WATER}
    [[probes]]
    name = \"level\"
    kind = \"gauge\"
    at = [0.5, 0.5]
    every = 0.01
    [[probes]]
    name = \"edge\"
    kind = \"run_up\"
    min = [0, 0, 0]
    max = [1.2, 1, 1.2]
    direction = \"+x\"
    every = 0.01
    [[probes]]
    name = \"beyond\"
    kind = \"gauge\"
    at = [1.1, 0.5]
    every = 0.01
    [[probes]]
    name = \"tank\"
    kind = \"box\"
    min = [0, 0, 0]
    max = [0.6, 1, 1.2]
    every = 0.01
    [[views]]
    name = \"tank\"
    size = [320, 240]
    every = 0.05
"
    )
    .replace("size = [1.2, 1, 0.8]", "size = [0.4, 1, 0.8]")
    .replace("position = [0.6, 0.5, 0.4]", "position = [0.2, 0.5, 0.4]")
    .replace("steps = 12", "duration = 0.1");
    let summary = go(&args(&folder, &text, "out"));
    let out = folder.join("out");
    for (name, height) in [("level.png", 230), ("edge.png", 2 * 230)] {
        let picture = Picture::load(&out.join(name)).unwrap();
        assert!(picture.width == 1400 && picture.height > height, "{name}");
        assert!(summary.files.contains(&out.join(name)), "{name}");
    }
    assert!(!out.join("beyond.png").exists());
    // As documented for dry gauges.
    let dry = fs::read_to_string(out.join("beyond.csv")).unwrap();
    assert!(dry.lines().count() > 5 && dry.lines().skip(1).all(|row| row.ends_with(",NaN")));
    let told = summary.warnings.join("\n");
    assert!(told.contains("tank.png is not drawn"), "{told}");
}

#[test]
fn a_restart_goes_on_to_the_same_bits() {
    let folder = folder("water_restart");
    let whole = args(&folder, &format!("{STILL_WATER}{MEASURED}"), "whole");
    let energies = go(&whole).water_energies.unwrap();
    // At rest no work is done, to a thousandth of that which the weight could do.
    let scale = 1e-3 * 960.0 * 9.81 * 0.4;
    assert_eq!((energies.bodies, energies.left), (0.0, 0.0));
    assert!(energies.pressed.abs() < scale && energies.dissipated.abs() < scale);
    let part = Args {
        out: Some(folder.join("part")),
        steps: Some(5),
        ..whole.clone()
    };
    let checkpoint = go(&part).checkpoint.unwrap();
    let rest = go(&Args {
        steps: None,
        restart: Some(checkpoint.clone()),
        ..part
    });
    assert_eq!(rest.water_energies, Some(energies));
    for file in ["water_000012.vtp", "bed.csv"] {
        let [a, b] = ["whole", "part"].map(|run| fs::read(folder.join(run).join(file)).unwrap());
        // The table of the part also has the row of its own end.
        let tail = |bytes: &[u8]| bytes[bytes.len() - 60..].to_vec();
        assert_eq!(tail(&a), tail(&b), "{file}");
    }
    // The same water in a longer tank is another scene.
    let longer = STILL_WATER.replace("size = [1.2, 1, 1.2]", "size = [1.3, 1, 1.2]");
    let other = Args {
        restart: Some(checkpoint),
        ..args(&folder, &longer, "other")
    };
    let refused = run(&other, &AtomicBool::new(false)).unwrap_err();
    assert_contains(
        format!("{refused:#}"),
        &["restart", "[1.2, 1, 1.2] m", "[1.3, 1, 1.2] m"],
    );
}

#[test]
fn what_leaves_through_an_open_face_is_counted() {
    let folder = folder("water_open");
    // A sheet of water that leaves at the side.
    let text = STILL_WATER
        .replace("x_max = { kind = \"wall\" }", "x_max = { kind = \"open\" }")
        .replace(
            "size = [1.2, 1, 0.8]",
            "size = [0.4, 1, 0.8]\nvelocity = [10, 0, 0]",
        )
        .replace("position = [0.6, 0.5, 0.4]", "position = [0.8, 0.5, 0.4]")
        .replace("steps = 12", "duration = 0.08");
    let summary = go(&args(&folder, &text, "out"));
    let pool = summary.pool.unwrap();
    assert_eq!(pool.particles, 32);
    // It travels 0.8 m, and all of it was within 0.6 m of the face.
    assert!(pool.escaped >= 30, "{}", pool.escaped);
    assert!(summary.to_string().contains("have left the domain"));
    // 40 kg per particle, moving at 10 m/s.
    let taken = summary.water_energies.unwrap().left / (10.0 * f64::from(pool.escaped));
    assert_relative(taken, 0.5 * 100.0 + 9.81 * 0.4, 0.1);
}

#[test]
fn a_block_falls_into_water_and_its_books_close() {
    let folder = folder("water_block");
    let text = format!(
        "{STILL_WATER}
    [output]
    every = 0.02
    [[output.histories]]
    quantities = [\"block_kinetic_energy\", \"energy_error\", \"kinetic_energy\"]
    [[materials]]
    name = \"rock\"
    density = 2500
    normal_stiffness = 1e7
    friction = 30
    [[blocks]]
    name = \"stone\"
    kind = \"box\"
    size = [0.4, 1, 0.4]
    position = [0.6, 0.5, 1.0]
    velocity = [0, 0, -1]
    [[probes]]
    name = \"path\"
    kind = \"block\"
    block = \"stone\"
    every = 0.01
"
    )
    .replace("steps = 12", "duration = 0.15")
    .replace("size = [1.2, 1, 1.2]", "size = [1.2, 1, 2]");
    let whole = args(&folder, &text, "out");
    let summary = go(&whole);
    let out = folder.join("out");
    let rocks = summary.rocks.unwrap();
    assert_eq!(rocks.blocks, 1);
    // The energy taken from the block by its loads equals that given to the water, but for averaging two loads over time.
    let energies = summary.water_energies.unwrap();
    let given = -rocks.ledger.loads;
    assert!(given > 100.0, "{given} J");
    assert_near(energies.blocks, given, 1e-3 * given);
    assert!(energies.unmatched.abs() < 0.05 * given, "{energies}");
    assert!(energies.dissipated > 0.0, "{energies}");
    let part = Args {
        out: Some(folder.join("part")),
        steps: Some(4),
        ..whole
    };
    let restart = go(&part).checkpoint;
    let rest = go(&Args {
        steps: None,
        restart,
        ..part
    });
    assert_eq!(rest.water_energies, Some(energies));
    assert!(rocks.energy_error.abs() < 1e-3, "{}", rocks.energy_error);
    let height = last(&out, "path.csv", "position_z");
    // In the air it would be at 1 − 0.15 − ½ g t² = 0.74 m.
    assert!(height > 0.745 && height < 0.95, "{height}");
    assert!(out.join("blocks.pvd").is_file());
}

/// A block that slides into water under its own weight, with the joint to the slope open to the water at its foot and to
/// the air at its heel: the energy that blocks lose is gained and dissipated by the water, and none is created in the joint.
#[test]
fn energies_of_water_and_blocks_close_together() {
    let folder = folder("water_energies");
    let text = r#"
    title = "slide"
    [domain]
    origin = [-3, 0, 0]
    size = [6, 1, 2.5]
    [fluid]
    acceleration = [0, 0, -9.81]
    [particles]
    spacing = 0.1
    smoothing = 1.5
    plane = true
    largest_speed = 6
    [boundaries]
    x_min = { kind = "wall" }
    x_max = { kind = "wall" }
    z_min = { kind = "wall" }
    z_max = { kind = "open" }
    [[water]]
    kind = "box"
    size = [6, 1, 1]
    position = [0, 0.5, 0.5]
    [[materials]]
    name = "rock"
    density = 2500
    normal_stiffness = 2e7
    friction = 5
    [[blocks]]
    name = "slope"
    kind = "vertices"
    vertices = [[0, 0, 0], [-3, 0, 0], [-3, 0, 1.74], [0, 1, 0], [-3, 1, 0], [-3, 1, 1.74]]
    motion = "fixed"
    [[blocks]]
    name = "wedge"
    kind = "vertices"
    vertices = [
        [-1.70, 0, 0.99], [-1.70, 0, 1.57], [-2.70, 0, 1.57], [-1.70, 1, 0.99], [-1.70, 1, 1.57], [-2.70, 1, 1.57],
    ]
    [run]
    duration = 1
    [output]
    every = 1
    [[output.histories]]
    quantities = ["kinetic_energy", "potential_energy", "outside_work", "energy_error"]
    every = 0.05
"#;
    let summary = go(&args(&folder, text, "out"));
    let columns = ["kinetic_energy", "potential_energy", "outside_work"];
    let [kinetic, potential, work] =
        columns.map(|name| column(&folder.join("out/history.csv"), name));
    let start = kinetic[0] + potential[0];
    let lost = -work.last().unwrap();
    assert!(lost > 500.0, "{lost} J");
    let gained = |n: usize| kinetic[n] + potential[n] - start;
    for (n, given) in work.iter().map(|work| -work).enumerate() {
        let gained = gained(n);
        assert!(gained < given + 0.01 * lost, "{n}: {gained} {given}");
    }
    assert_eq!(summary.pool.unwrap().escaped, 0);
    let energies = summary.water_energies.unwrap();
    assert_near(energies.blocks, lost, 1e-3 * lost);
    assert!(energies.unmatched.abs() < 0.02 * lost, "{energies}");
    assert!(energies.dissipated > 0.0, "{energies}");
    let kept = gained(work.len() - 1) + energies.compression + energies.dissipated;
    assert_near(kept, lost, 0.03 * lost);
}

/// It exchanges with the water more often than the speed of sound requires, or its own waves would throw it up.
#[test]
fn a_block_of_cork_floats() {
    let folder = folder("water_cork");
    let text = format!(
        "{STILL_WATER}
    [[materials]]
    name = \"cork\"
    density = 100
    normal_stiffness = 1e6
    friction = 30
    [[blocks]]
    name = \"float\"
    kind = \"box\"
    size = [0.4, 1, 0.2]
    position = [0.6, 0.5, 0.9]
    [[probes]]
    name = \"path\"
    kind = \"block\"
    block = \"float\"
    every = 0.05
"
    )
    .replace("steps = 12", "duration = 2");
    let summary = go(&args(&folder, &text, "out"));
    let times = column(&folder.join("out/path.csv"), "time");
    assert_eq!(times.len(), 41);
    for (n, time) in times.iter().enumerate() {
        assert_near(*time, 0.05 * n as f64, 1e-9);
    }
    let fastest = summary.rocks.unwrap().max_speed_seen;
    assert!(fastest < 0.8, "{fastest} m/s");
    // Its draft is a fifth of a spacing; the surface is known to one spacing.
    let height = last(&folder.join("out"), "path.csv", "position_z");
    assert_near(height, 0.88, 0.1);
}

#[test]
fn water_that_is_too_fast_or_lost_is_told() {
    let folder = folder("water_fast");
    let text = STILL_WATER
        .replace("plane = true", "plane = true\n    largest_speed = 1")
        .replace(
            "position = [0.6, 0.5, 0.4]",
            "position = [0.6, 0.5, 0.4]\n    velocity = [3, 0, 0]",
        );
    let summary = go(&args(&folder, &text, "out"));
    let told = |words: &str| summary.warnings.iter().any(|w| w.contains(words));
    let pool = summary.pool.unwrap();
    assert!(pool.max_mach > 0.2);
    assert!(told("water reached"), "{:?}", summary.warnings);
    // The water runs up the wall and out of the tank: one particle is more than a hundredth.
    assert!(pool.escaped > 0);
    assert!(told("left the domain"), "{:?}", summary.warnings);
}
