//! What particles carry badly is told.

use crate::{scene, tank};
use riprap::bodies::Blocks;
use riprap::particles::{advise, particle_setup};
use riprap::scene::Scene;
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
