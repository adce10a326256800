//! Free water with blocks that fall, rest in closed joints and float restarts from a file bitwise.

use kit::Rig;
use riprap::simulation::{Simulation, checkpoint::Checkpoint};

/// A slab on the floor, whose joint has the pressure of the water at its rim; a stone on it; a falling and a driven block; an
/// obstacle.
const SCENE: &str = r#"
    [domain]
    size = [1.2, 0.1, 0.8]
    [fluid]
    acceleration = [0, 0, -9.81]
    [particles]
    spacing = 0.025
    plane = true
    [coupling]
    interval = 2
    [boundaries]
    x_min = { kind = "wall" }
    x_max = { kind = "wall" }
    z_min = { kind = "wall" }
    z_max = { kind = "open" }
    [[water]]
    kind = "box"
    size = [1.2, 0.1, 0.4]
    position = [0.6, 0.05, 0.2]
    [[solids]]
    kind = "box"
    min = [1.0, 0, 0]
    max = [1.2, 0.1, 0.1]
    [[materials]]
    name = "rock"
    density = 2650
    normal_stiffness = 1e7
    friction = 35
    damping = 0.2
    [[blocks]]
    name = "slab"
    kind = "box"
    size = [0.3, 0.1, 0.1]
    position = [0.4, 0.05, 0.05]
    [[blocks]]
    name = "stone"
    kind = "box"
    size = [0.1, 0.1, 0.1]
    position = [0.38, 0.05, 0.1501]
    [[blocks]]
    name = "falling"
    kind = "box"
    size = [0.1, 0.1, 0.1]
    position = [0.75, 0.05, 0.52]
    rotation = { axis = [0, 1, 0], angle = 20 }
    [[blocks]]
    name = "piston"
    kind = "box"
    size = [0.1, 0.1, 0.5]
    position = [0.06, 0.05, 0.26]
    motion = "driven"
    velocity = ["0.1*sin(20*t)", 0, 0]
    [run]
    duration = 1
"#;

/// Total number of steps; before the cut there is an odd number of exchanges.
const STEPS: u64 = 17;
const CUT: u64 = 6;

fn pool(rig: &Rig) -> Simulation {
    let scene = kit::scene::read(SCENE).unwrap();
    rig.simulation(&scene).unwrap()
}

fn state(rig: &Rig, pool: &mut Simulation) -> Checkpoint {
    rig.wait(pool.checkpoint()).unwrap()
}

#[test]
fn blocks_in_free_water_go_on_from_a_file_to_the_same_bits() {
    let rig = Rig::new();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("water.state");
    let mut whole = pool(&rig);
    let start = state(&rig, &mut whole);
    rig.wait(whole.advance(CUT)).unwrap();
    state(&rig, &mut whole).write(&file).unwrap();
    rig.wait(whole.advance(STEPS - CUT)).unwrap();
    let expected = state(&rig, &mut whole);
    // Everything is created anew, as in another process.
    let rig = Rig::new();
    let mut rest = pool(&rig);
    rest.restore(&Checkpoint::read(&file).unwrap()).unwrap();
    rig.wait(rest.advance(STEPS - CUT)).unwrap();
    let found = state(&rig, &mut rest);
    assert!(found == expected, "the states differ");
    // The state has changed: water and blocks moved, the stone has a contact, and the joint is known.
    assert!(expected != start && expected.rock != start.rock);
    assert!(
        whole.rock().unwrap().blocks().contacts().count() > 0,
        "nothing touches"
    );
}
