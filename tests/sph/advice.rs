//! Warnings about scenes that particles resolve poorly.

use crate::start::{DX, scene, tank};
use riprap::rock::Blocks;
use riprap::scene::build::block_setup;
use riprap::scene::{BlockShape, Scene};
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

#[test]
fn a_tank_ten_particles_deep_has_no_warning() {
    assert_eq!(warnings(&tank("").unwrap()), Vec::<String>::new());
}

#[test]
fn shallow_water_thin_blocks_and_narrow_gaps_give_warnings() {
    let thin = block("size = [0.5, 0.5, 0.15]\nposition = [1, 0.5, 0.8]");
    let found = warnings(&tank(&thin).unwrap());
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].contains("1 blocks, `b` the first, are thinner than the 2.00e-1 m"));
    // The ends of a prism in a planar scene are not checked.
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
    // 7 cm above the floor: less than two spacings.
    let low = block("size = [0.5, 0.5, 0.3]\nposition = [1, 0.5, 0.22]");
    let found = warnings(&tank(&low).unwrap());
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(
        found[0].contains("the narrowest of 7.00e-2 m between `b` and `wall_z_min`"),
        "{found:?}"
    );
    // A block on the floor leaves no gap.
    let on = block("size = [0.5, 0.5, 0.3]\nposition = [1, 0.5, 0.15]");
    assert_eq!(warnings(&tank(&on).unwrap()), Vec::<String>::new());
    let mut shallow = scene("", "").unwrap();
    shallow.water[0].shape = riprap::scene::BlockShape::Box {
        size: [2.0, 1.0, 0.2],
    };
    shallow.water[0].position[2] = 0.1;
    let found = warnings(&shallow);
    assert!(
        found[0].contains("the water is 4 particles deep"),
        "{found:?}"
    );
}

#[test]
fn different_gravity_of_blocks_and_water_gives_a_warning() {
    let mut scene = tank(&block("size = [0.5, 0.5, 0.3]\nposition = [1, 0.5, 0.8]")).unwrap();
    scene.rock.gravity = [0.0, 0.0, -1.62];
    let found = warnings(&scene);
    assert!(found[0].contains("fluid.acceleration") && found[0].contains("rock.gravity"));
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
    let found = warnings(&driven("\"8*t\"", 3.0));
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(
        found[0].contains("block `b` is driven at up to 8.000 m/s, Mach 0.27"),
        "{found:?}"
    );
    let faster = driven("\"40*t\"", 3.0);
    let blocks = block_setup(&faster).unwrap();
    let fault = particle_setup(&faster, &blocks).unwrap_err().to_string();
    assert!(
        fault.contains("block b: is driven at up to 40.000 m/s") && fault.contains("30.000 m/s"),
        "{fault}"
    );
    // From 0.8 m over the floor: 4 m/s.
    let falls = block("size = [0.4, 0.4, 0.2]\nposition = [1, 0.5, 0.9]");
    assert_eq!(
        warnings(&scene("largest_speed = 3", &falls).unwrap()),
        Vec::<String>::new()
    );
    let found = warnings(&scene("largest_speed = 2\ndisorder = 0", &falls).unwrap());
    assert!(
        found[0].contains("block `b` may fall at up to 3.962 m/s"),
        "{found:?}"
    );
    let found = warnings(&scene("largest_speed = 1", "").unwrap());
    assert!(found[0].contains("5 % denser at its bottom"), "{found:?}");
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
    assert!((sound / expected - 1.0).abs() < 1e-4, "{sound} {expected}");
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
    assert!((depth - 10.0 * (2.0 * 9.81 * 0.5f64).sqrt()).abs() < 1e-9);
    let falls = block("size = [0.4, 0.4, 0.2]\nposition = [1, 0.5, 0.9]\nvelocity = [3, 0, 0]");
    let expected = 10.0 * (9.0 + 2.0 * 9.81 * 0.8f64).sqrt();
    let falls = sound(&tank(&falls).unwrap());
    assert!((falls - expected).abs() < 1e-9, "{falls}");
    // Water falls too.
    let jet = "[[water]]\nkind = \"box\"\nsize = [0.2, 0.2, 0.2]\nposition = [1, 0.5, 0.8]\nvelocity = [5, 0, 0]\n";
    let expected = 10.0 * (25.0 + 2.0 * 9.81 * 0.9f64).sqrt();
    let jet = sound(&tank(jet).unwrap());
    assert!((jet - expected).abs() < 1e-9, "{jet}");
    // Nothing moves, so the speed of sound is undetermined.
    let mut still = tank("").unwrap();
    still.fluid.acceleration = [0.0; 3].map(riprap::formula::Formula::from);
    let blocks = block_setup(&still).unwrap();
    let fault = particle_setup(&still, &blocks).unwrap_err().to_string();
    assert!(
        fault.contains("particles.largest_speed: nothing flows"),
        "{fault}"
    );
}

#[test]
fn a_mass_error_of_the_particles_gives_a_warning() {
    let mut rough = tank("").unwrap();
    let size = [2.0, 1.0, 0.5 - 0.3 * DX];
    rough.water[0].shape = riprap::scene::BlockShape::Box { size };
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

#[test]
fn water_without_support_gives_a_warning() {
    let mut endless = tank("").unwrap();
    endless.boundaries.z_min = riprap::scene::Boundary::Periodic;
    endless.boundaries.z_max = riprap::scene::Boundary::Periodic;
    let found = warnings(&endless);
    assert!(
        found.iter().any(|w| w.contains("the water falls for ever")),
        "{found:?}"
    );
}
