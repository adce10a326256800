//! Warnings about scenes that particles resolve poorly.

use crate::start::{DX, scene, tank};
use kit::{assert_contains, assert_near, assert_relative};
use riprap::rock::Blocks;
use riprap::scene::build::block_setup;
use riprap::scene::{BlockShape, Boundary, Scene};
use riprap::{coupling::particle_advice, scene::build::particle_setup};

fn warnings(scene: &Scene) -> Vec<String> {
    let blocks = block_setup(scene).unwrap();
    let (setup, start) = particle_setup(scene, &blocks).unwrap();
    let mut timed = blocks.setup.clone();
    timed.time_step.get_or_insert(1e-5);
    let state = Blocks::new(timed).unwrap();
    let advice = particle_advice(scene, &blocks, &state, &setup, &start.positions);
    let advice = pollster::block_on(advice).unwrap();
    advice.iter().map(ToString::to_string).collect()
}

fn block(keys: &str) -> String {
    format!("[[blocks]]\nname = \"b\"\nkind = \"box\"\n{keys}\n")
}

/// Warnings about the tank with further tables.
fn tank_with(more: &str) -> Vec<String> {
    warnings(&tank(more).unwrap())
}

/// No warning for a tank ten particles deep, nor for a block on the floor.
#[test]
fn what_is_resolved_has_no_warning() {
    assert_eq!(tank_with(""), Vec::<String>::new());
    let on = block("size = [0.5, 0.5, 0.3]\nposition = [1, 0.5, 0.15]");
    assert_eq!(tank_with(&on), Vec::<String>::new());
}

/// Rubber of the density of the water is excited by its pressure; granite is not, nor is a rigid block.
#[test]
fn soft_light_blocks_give_a_warning() {
    let excited = |modulus: f64, deformable: bool| {
        let material = format!(
            "[[materials]]\nname = \"m\"\ndensity = 1000\nnormal_stiffness = 1e7\nfriction = 30\n\
             youngs_modulus = {modulus:e}\npoissons_ratio = 0.2\n"
        );
        let keys = format!(
            "size = [0.5, 0.5, 0.3]\nposition = [1, 0.5, 0.8]\nmaterial = \"m\"\ndeformable = {deformable}"
        );
        let warnings = tank_with(&(material + &block(&keys)));
        warnings.iter().any(|warning| warning.contains("excite"))
    };
    assert!(excited(1e5, true));
    assert!(!excited(1e10, true));
    assert!(!excited(1e5, false));
}

#[test]
fn shallow_water_thin_blocks_and_narrow_gaps_give_warnings() {
    let mut told = Vec::new();
    told.extend(tank_with(&block(
        "size = [0.5, 0.5, 0.15]\nposition = [1, 0.5, 0.8]",
    )));
    // 7 cm above the floor: less than two spacings.
    told.extend(tank_with(&block(
        "size = [0.5, 0.5, 0.3]\nposition = [1, 0.5, 0.22]",
    )));
    let mut shallow = tank("").unwrap();
    shallow.water[0].shape = BlockShape::Box {
        size: [2.0, 1.0, 0.2],
    };
    shallow.water[0].position[2] = 0.1;
    told.extend(warnings(&shallow));
    // Gravity of the blocks alone.
    let mut moon = tank(&block("size = [0.5, 0.5, 0.3]\nposition = [1, 0.5, 0.8]")).unwrap();
    moon.rock.gravity = [0.0, 0.0, -1.62];
    told.extend(warnings(&moon));
    let mut endless = tank("").unwrap();
    endless.boundaries.z_min = Boundary::Periodic;
    endless.boundaries.z_max = Boundary::Periodic;
    told.extend(warnings(&endless));
    insta::assert_snapshot!(told.join("\n"));
}

/// Water that starts at another distance than half a spacing from a wall sloshes.
#[test]
fn tanks_of_whole_spacings_hold_water_at_rest() {
    for (length, words) in [
        (2.0, None),
        (2.02, Some("2.0000 or 2.0500 m")),
        (2.03, Some("2.0000 or 2.0500 m")),
    ] {
        let mut tank = scene("", "").unwrap();
        tank.domain.size[0] = length;
        tank.water[0].shape = BlockShape::Box {
            size: [length, 1.0, 0.5],
        };
        tank.water[0].position[0] = 0.5 * length;
        let found = warnings(&tank);
        let found: Vec<_> = found
            .iter()
            .filter(|w| w.contains("domain.size[0]"))
            .collect();
        match words {
            Some(words) => assert_contains(found[0], &[words]),
            None => assert!(found.is_empty(), "{found:?}"),
        }
    }
}

/// So does water before the face of a fixed block at such a distance.
#[test]
fn faces_of_fixed_blocks_are_whole_spacings_from_the_corner() {
    for (x, motion, count) in [(1.0, "fixed", 0), (1.02, "fixed", 1), (1.02, "free", 0)] {
        let cube = block(&format!(
            "size = [0.3, 0.3, 0.3]\nposition = [{x}, 0.5, 0.15]\nmotion = \"{motion}\""
        ));
        let found = warnings(&tank(&cube).unwrap());
        let found: Vec<_> = found.iter().filter(|w| w.contains("circulates")).collect();
        assert_eq!(found.len(), count, "{x}, {motion}: {found:?}");
        if count > 0 {
            assert_contains(found[0], &["has a face at x = ", "0.8500 or 0.9000 m"]);
        }
    }
}

/// The ends of a prism in a planar scene are not checked.
#[test]
fn prisms_in_a_planar_scene_may_be_as_thin_as_it() {
    for (height, count) in [(0.3, 0), (0.15, 1)] {
        let prism = block(&format!(
            "size = [0.5, 0.1, {height}]\nposition = [1, 0.05, 0.8]"
        ));
        let mut plane = tank(&prism).unwrap();
        plane.domain.size[1] = 0.1;
        plane.water[0].shape = BlockShape::Box {
            size: [2.0, 0.1, 0.5],
        };
        plane.water[0].position[1] = 0.05;
        plane.particles.as_mut().unwrap().plane = true;
        let found = warnings(&plane);
        assert_eq!(found.len(), count, "{found:?}");
    }
}

/// A thin wall has water on both sides, a thin slab on the floor on one.
#[test]
fn thin_walls_between_waters_give_a_warning() {
    for (thickness, motion, count) in [
        (0.1, "fixed", 1),
        (0.1, "driven", 1),
        (0.3, "fixed", 0),
        (0.3, "driven", 0),
    ] {
        let wall = block(&format!(
            "size = [{thickness}, 1, 1]\nposition = [1, 0.5, 0.5]\nmotion = \"{motion}\""
        ));
        let found = tank_with(&wall);
        let found = found.iter().filter(|w| w.contains("thinner")).count();
        assert_eq!(found, count, "{thickness} {motion}");
    }
    let slab = block("size = [2, 1, 0.1]\nposition = [1, 0.5, 0.05]\nmotion = \"fixed\"");
    let found = tank_with(&slab);
    assert!(found.iter().all(|w| !w.contains("thinner")), "{found:?}");
}

/// A sensor belongs on a wall or a fixed block, where water reaches all of its patch.
#[test]
fn sensors_that_measure_no_wall_are_named() {
    let dam = "size = [0.5, 1, 0.5]\nposition = [1, 0.5, 0.25]";
    for (motion, at, size, words) in [
        ("fixed", "[0.75, 0.5, 0.25]", 0.1, ""),
        ("fixed", "[0.75, 0.5, 0]", 0.1, "50 % of the patch"),
        ("fixed", "[0.5, 0.5, 0.25]", 0.1, "not on a wall"),
        ("free", "[0.75, 0.5, 0.25]", 0.1, "not on a wall"),
    ] {
        let found = tank_with(&format!(
            "{}motion = \"{motion}\"\n[[probes]]\nname = \"s\"\nkind = \"sensor\"\nat = {at}\nnormal = \"-x\"\nsize = {size}\n",
            block(dam)
        ));
        let found = found.into_iter().find(|w| w.contains("probes[0]"));
        match words {
            "" => assert_eq!(found, None),
            words => assert_contains(found.unwrap(), &[words]),
        }
    }
}

/// A driven block in the tank with the largest expected speed.
fn driven(velocity: &str, largest_speed: f64) -> Scene {
    let keys = format!(
        "size = [0.2, 1.0, 0.6]\nposition = [0.1, 0.5, 0.3]\nmotion = \"driven\"\nvelocity = [{velocity}, 0, 0]"
    );
    scene(&format!("largest_speed = {largest_speed}"), &block(&keys)).unwrap()
}

#[test]
fn fast_blocks_give_a_warning_and_supersonic_ones_an_error() {
    assert_eq!(warnings(&driven("2", 3.0)), Vec::<String>::new());
    // From 0.8 m over the floor: 4 m/s.
    let falls = block("size = [0.4, 0.4, 0.2]\nposition = [1, 0.5, 0.9]");
    let slow = scene("largest_speed = 3", &falls).unwrap();
    assert_eq!(warnings(&slow), Vec::<String>::new());
    let mut told = warnings(&driven("\"8*t\"", 3.0));
    told.extend(warnings(
        &scene("largest_speed = 2\ndisorder = 0", &falls).unwrap(),
    ));
    told.extend(warnings(&scene("largest_speed = 1", "").unwrap()));
    let faster = driven("\"40*t\"", 3.0);
    let blocks = block_setup(&faster).unwrap();
    told.push(particle_setup(&faster, &blocks).unwrap_err().to_string());
    insta::assert_snapshot!(told.join("\n"));
}

#[test]
fn speeds_are_sampled_to_the_end_of_the_run() {
    // Steps of ten times 0.7 · 2 · 0.05 m over 30 m/s: 43 of them are a second.
    let mut steps = driven("\"8*t\"", 3.0);
    (steps.run.duration, steps.run.steps) = (None, Some(43));
    let found = warnings(&steps);
    assert!(
        found.len() == 1 && found[0].contains("is driven at up to 8.0"),
        "{found:?}"
    );
    // The speed of sound is 300 t and the step 0.7 m over it; a thousand steps end at t.
    let mut usual = driven("\"30*t\"", 3.0);
    usual.particles.as_mut().unwrap().largest_speed = None;
    (usual.run.duration, usual.run.steps) = (None, Some(1000));
    let blocks = block_setup(&usual).unwrap();
    let sound = particle_setup(&usual, &blocks).unwrap().0.sound_speed;
    let expected = 300.0 * (1000.0 * 0.7 / 300.0f64).sqrt();
    assert_relative(sound, expected, 1e-4);
    // A thousand oscillations per second.
    let found = warnings(&driven("\"8*sin(6283.185307179586*t)\"", 3.0));
    assert!(
        found.len() == 1 && found[0].contains("b` is driven at up to"),
        "{found:?}"
    );
}

#[test]
fn the_speed_of_sound_follows_from_the_fall_to_the_bottom_of_the_water() {
    let sound = |scene: &Scene| {
        let blocks = block_setup(scene).unwrap();
        particle_setup(scene, &blocks).unwrap().0.sound_speed
    };
    let depth = sound(&tank("").unwrap());
    assert_near(depth, 10.0 * (2.0 * 9.81 * 0.5f64).sqrt(), 1e-9);
    let falls = block("size = [0.4, 0.4, 0.2]\nposition = [1, 0.5, 0.9]\nvelocity = [3, 0, 0]");
    let expected = 10.0 * (9.0 + 2.0 * 9.81 * 0.8f64).sqrt();
    let falls = sound(&tank(&falls).unwrap());
    assert_near(falls, expected, 1e-9);
    // Water falls too.
    let jet = "[[water]]\nkind = \"box\"\nsize = [0.2, 0.2, 0.2]\nposition = [1, 0.5, 0.8]\nvelocity = [5, 0, 0]\n";
    let expected = 10.0 * (25.0 + 2.0 * 9.81 * 0.9f64).sqrt();
    let jet = sound(&tank(jet).unwrap());
    assert_near(jet, expected, 1e-9);
    // Nothing moves, so the speed of sound is undetermined.
    let mut still = tank("").unwrap();
    still.fluid.acceleration = [0.0; 3].map(riprap::formula::Formula::from);
    let blocks = block_setup(&still).unwrap();
    let fault = particle_setup(&still, &blocks).unwrap_err().to_string();
    assert_contains(&fault, &["particles.largest_speed: nothing flows"]);
}

#[test]
fn a_mass_error_of_the_particles_gives_a_warning() {
    let mut rough = tank("").unwrap();
    let size = [2.0, 1.0, 0.5 - 0.3 * DX];
    rough.water[0].shape = BlockShape::Box { size };
    rough.water[0].position[2] = 0.5 * size[2];
    let found = warnings(&rough);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(
        found[0].contains("are 1000.0000 kg of water, and its bodies hold 970.0000 kg"),
        "{found:?}"
    );
}

/// A bed with the slope 0.2 rises through shallow water to its surface: the prism above holds ½·1.25·0.25 m² by 1 m of
/// water, 156 kg. Its bounding box meets that of the bed, and particles keep a tenth of a spacing from the bed.
#[test]
fn a_mass_error_above_a_sloping_bed_gives_a_warning() {
    let bed = |offset: f64| {
        let keys = format!(
            "[[blocks]]\nname = \"bed\"\nkind = \"vertices\"\nmotion = \"fixed\"\nvertices = [[0, 0, 0], [2, 0, 0], \
             [2, 0, 0.4], [0, 1, 0], [2, 1, 0], [2, 1, 0.4]]\nposition = [0, 0, {offset}]\n"
        );
        let mut flume = tank(&keys).unwrap();
        let size = [2.0, 1.0, 0.25];
        flume.water[0].shape = BlockShape::Box { size };
        flume.water[0].position[2] = 0.125;
        warnings(&flume)
    };
    let found = bed(0.0);
    let missed = found.iter().find(|w| w.contains("kg of water"));
    let missed = missed.expect("a warning");
    let words: Vec<f64> = missed
        .split_whitespace()
        .filter_map(|word| word.parse().ok())
        .collect();
    // Sampled to 1e-3 of the 500 kg without the bed.
    assert!((words[1] - 156.25).abs() < 0.5, "{missed}");
    assert!(words[0] < 0.99 * words[1], "{missed}");
}

#[test]
fn probes_inside_blocks_give_warnings() {
    let probes = "[[probes]]\nname = \"g\"\nkind = \"gauge\"\nat = [1, 0.5]\n\
                  [[probes]]\nname = \"p\"\nkind = \"point\"\nfields = [\"pressure\"]\nat = [1, 0.5, 0.1]\n\
                  [[probes]]\nname = \"q\"\nkind = \"point\"\nfields = [\"pressure\"]\nat = [0.4, 0.5, 0.1]\n\
                  [[probes]]\nname = \"r\"\nkind = \"sensor\"\nnormal = \"-x\"\nat = [0.75, 0.5, 0.1]\n\
                  [[probes]]\nname = \"s\"\nkind = \"sensor\"\nnormal = \"+x\"\nat = [0.75, 0.5, 0.1]\n";
    let pile = |height: f64| {
        let keys = format!(
            "size = [0.5, 1.0, {height}]\nposition = [1, 0.5, {}]\nmotion = \"fixed\"",
            0.5 * height
        );
        warnings(&tank(&format!("{}{probes}", block(&keys))).unwrap())
    };
    let found = pile(0.7);
    assert_eq!(found.len(), 3, "{found:?}");
    assert!(found[2].contains("`s` is inside block `b`"), "{found:?}");
    assert!(found[0].contains("`g` is inside block `b`"), "{found:?}");
    assert!(found[1].contains("`p` is inside block `b`"), "{found:?}");
    // The water column above a low block is open.
    let found = pile(0.3);
    assert_eq!(found.len(), 2, "{found:?}");
}
