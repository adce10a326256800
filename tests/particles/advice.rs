//! What particles carry badly is told.

use crate::{DX, scene, tank};
use riprap::bodies::Blocks;
use riprap::particles::{advise, particle_setup};
use riprap::scene::{BlockShape, Scene};
use riprap::simulation::block_setup;

fn warnings(scene: &Scene) -> Vec<String> {
    let blocks = block_setup(scene).unwrap();
    let (setup, start) = particle_setup(scene, &blocks).unwrap();
    let mut timed = blocks.setup.clone();
    timed.time_step.get_or_insert(1e-5);
    let state = Blocks::new(timed).unwrap();
    let advice = advise(scene, &blocks, &state, &setup, &start.positions);
    let advice = pollster::block_on(advice).unwrap();
    advice.iter().map(ToString::to_string).collect()
}

fn block(keys: &str) -> String {
    format!("[[blocks]]\nname = \"b\"\nkind = \"box\"\n{keys}\n")
}

#[test]
fn a_tank_ten_particles_deep_has_no_fault() {
    assert_eq!(warnings(&tank("").unwrap()), Vec::<String>::new());
}

#[test]
fn shallow_water_thin_blocks_and_narrow_gaps_are_told() {
    let thin = block("size = [0.5, 0.5, 0.15]\nposition = [1, 0.5, 0.8]");
    let found = warnings(&tank(&thin).unwrap());
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].contains("1 blocks, `b` the first, are thinner than the 2.00e-1 m"));
    // The ends of a prism in a plane, half as far apart as its sides, are no sides.
    for (height, faults) in [(0.3, 0), (0.15, 1)] {
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
        assert_eq!(found.len(), faults, "{found:?}");
    }
    // 7 cm above the floor: less than two spacings.
    let low = block("size = [0.5, 0.5, 0.3]\nposition = [1, 0.5, 0.22]");
    let found = warnings(&tank(&low).unwrap());
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(
        found[0].contains("the narrowest of 7.00e-2 m between `b` and `wall_z_min`"),
        "{found:?}"
    );
    // One that stands on the floor leaves none.
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
fn blocks_and_water_that_fall_differently_are_told() {
    let mut scene = tank(&block("size = [0.5, 0.5, 0.3]\nposition = [1, 0.5, 0.8]")).unwrap();
    scene.rock.gravity = [0.0, 0.0, -1.62];
    let found = warnings(&scene);
    assert!(found[0].contains("fluid.acceleration") && found[0].contains("rock.gravity"));
}

/// A driven block in the tank, and the largest speed that is expected.
fn driven(velocity: &str, largest_speed: f64) -> Scene {
    let keys = format!(
        "size = [0.2, 1.0, 0.6]\nposition = [0.1, 0.5, 0.3]\nmotion = \"driven\"\nvelocity = [{velocity}, 0, 0]"
    );
    scene(&format!("largest_speed = {largest_speed}"), &block(&keys)).unwrap()
}

#[test]
fn blocks_faster_than_expected_are_told_and_those_faster_than_sound_refused() {
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
fn runs_of_steps_and_fast_swings_are_looked_at_to_their_end() {
    // Steps of ten times 0.7 · 2 · 0.05 m over 30 m/s: 43 of them are a second.
    let mut steps = driven("\"8*t\"", 3.0);
    (steps.run.duration, steps.run.steps) = (None, Some(43));
    let found = warnings(&steps);
    assert!(
        found.len() == 1 && found[0].contains("is driven at up to 8.0"),
        "{found:?}"
    );
    // 300 t is the speed of sound, and 0.7 m over it the step, where a thousand of them end at t.
    let mut usual = driven("\"30*t\"", 3.0);
    usual.particles.as_mut().unwrap().largest_speed = None;
    (usual.run.duration, usual.run.steps) = (None, Some(1000));
    let blocks = block_setup(&usual).unwrap();
    let sound = particle_setup(&usual, &blocks).unwrap().0.sound_speed;
    let expected = 300.0 * (1000.0 * 0.7 / 300.0f64).sqrt();
    assert!((sound / expected - 1.0).abs() < 1e-4, "{sound} {expected}");
    // A thousand swings a second.
    let found = warnings(&driven("\"8*sin(6283.185307179586*t)\"", 3.0));
    assert!(
        found.len() == 1 && found[0].contains("b` is driven at up to"),
        "{found:?}"
    );
}

#[test]
fn the_speed_of_sound_is_that_of_what_falls_to_the_bottom_of_the_water() {
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
    // So does water.
    let jet = "[[water]]\nkind = \"box\"\nsize = [0.2, 0.2, 0.2]\nposition = [1, 0.5, 0.8]\nvelocity = [5, 0, 0]\n";
    let expected = 10.0 * (25.0 + 2.0 * 9.81 * 0.9f64).sqrt();
    let jet = sound(&tank(jet).unwrap());
    assert!((jet - expected).abs() < 1e-9, "{jet}");
    // Nothing moves, so nothing is known.
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
fn water_that_particles_miss_is_told() {
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

#[test]
fn probes_inside_blocks_are_told() {
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
    // Water stands over a low one.
    let found = pile(0.3);
    assert_eq!(found.len(), 2, "{found:?}");
}

#[test]
fn water_that_falls_for_ever_is_told() {
    let mut endless = tank("").unwrap();
    endless.boundaries.z_min = riprap::scene::Boundary::Periodic;
    endless.boundaries.z_max = riprap::scene::Boundary::Periodic;
    let found = warnings(&endless);
    assert!(
        found.iter().any(|w| w.contains("the water falls for ever")),
        "{found:?}"
    );
}
