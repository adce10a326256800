//! Pressure sensors on walls: water at rest has the pressure of its depth, in corners too, and a patch over the face of a block
//! receives the impulse that pushes the block.

use kit::{Rig, assert_contains, assert_relative};
use riprap::simulation::Simulation;

const TANK: &str = r#"
    [fluid]
    acceleration = [0, 0, -9.81]
    [boundaries]
    x_min = { kind = "wall" }
    x_max = { kind = "wall" }
    z_min = { kind = "wall" }
    z_max = { kind = "open" }
    [run]
    duration = 1
    [output]
    every = 0.01
"#;

fn pool(rig: &Rig, rest: &str) -> Simulation {
    let scene = kit::scene::read(&format!("{TANK}{rest}")).unwrap();
    rig.simulation(&scene).unwrap()
}

/// A plane tank, and its material.
const SMALL: &str = r#"
    [domain]
    size = [0.6, 0.1, 0.6]
    [particles]
    spacing = 0.02
    plane = true
    [[materials]]
    name = "rock"
    density = 2650
    normal_stiffness = 1e9
    friction = 30
"#;

fn sensor(name: &str, [x, z]: [f64; 2], normal: &str, size: f64) -> String {
    format!(
        "[[probes]]\nname = \"{name}\"\nkind = \"sensor\"\nat = [{x}, 0.05, {z}]\nnormal = \"{normal}\"\nsize = {size}\n"
    )
}

#[test]
fn water_at_rest_presses_by_its_depth() {
    let rig = Rig::new();
    let water = "[[water]]\nkind = \"box\"\nsize = [0.6, 0.1, 0.4]\nposition = [0.3, 0.05, 0.2]\n";
    let sensors = [
        sensor("wall", [0.0, 0.2], "+x", 0.08),
        sensor("corner", [0.59, 0.0], "+z", 0.02),
        sensor("over_the_edge", [0.0, 0.0], "+x", 0.08),
        sensor("dry", [0.0, 0.55], "+x", 0.04),
    ];
    let mut pool = pool(&rig, &format!("{SMALL}{water}{}", sensors.concat()));
    rig.wait(pool.advance(40)).unwrap();
    let pressure = |name: &str| pool.sensor(name).unwrap().pressure;
    for (name, depth) in [("wall", 0.2), ("corner", 0.4), ("over_the_edge", 0.38)] {
        assert_relative(pressure(name), 9810.0 * depth, 0.05);
        let impulse = pool.sensor(name).unwrap().impulse / pool.time();
        assert_relative(impulse, 9810.0 * depth, 0.05);
    }
    assert_eq!(pressure("dry"), 0.0);
    assert_eq!(pool.sensor("none"), None);
}

/// Solids reduce the part of the kernel that water can cover as walls of the domain do.
#[test]
fn a_modelled_bed_is_as_good_as_a_wall() {
    let rig = Rig::new();
    let bodies = r#"
        [[solids]]
        kind = "box"
        min = [0, 0, 0]
        max = [0.6, 0.1, 0.1]
        [[blocks]]
        name = "wall"
        kind = "box"
        size = [0.1, 0.1, 0.5]
        position = [0.55, 0.05, 0.35]
        motion = "fixed"
        [[water]]
        kind = "box"
        size = [0.5, 0.1, 0.4]
        position = [0.25, 0.05, 0.3]
    "#;
    let sensors = [
        sensor("domain", [0.0, 0.11], "+x", 0.02),
        sensor("block", [0.5, 0.11], "-x", 0.02),
    ];
    let mut pool = pool(&rig, &format!("{SMALL}{bodies}{}", sensors.concat()));
    rig.wait(pool.advance(40)).unwrap();
    for name in ["domain", "block"] {
        assert_relative(pool.sensor(name).unwrap().pressure, 9810.0 * 0.39, 0.05);
    }
}

const DAM: &str = r#"
    [domain]
    size = [1.2, 0.1, 0.8]
    [particles]
    spacing = 0.02
    plane = true
    [[water]]
    kind = "box"
    size = [0.4, 0.1, 0.4]
    position = [0.2, 0.05, 0.2]
    [[materials]]
    name = "rock"
    density = 2650
    normal_stiffness = 1e9
    friction = 30
    [[blocks]]
    name = "wall"
    kind = "box"
    size = [0.1, 0.1, 0.8]
    position = [1.05, 0.05, 0.4]
    motion = "fixed"
    [[probes]]
    name = "wall"
    kind = "block"
    block = "wall"
    every = 0.01
    [[probes]]
    name = "patch"
    kind = "sensor"
    at = [1.0, 0.05, 0.4]
    normal = "-x"
    size = 0.8
    every = 0.01
"#;

#[test]
fn a_patch_over_a_face_feels_what_pushes_its_block() {
    let rig = Rig::new();
    let mut pool = pool(&rig, DAM);
    let (mut pushed, mut cut) = (0.0, None);
    while pool.time() < 0.8 {
        rig.wait(pool.advance(1)).unwrap();
        pushed += pool.rock().unwrap().external_load()[0].flow.force.x * pool.time_step();
        if cut.is_none() && pool.time() > 0.5 {
            cut = Some((pool.step(), rig.wait(pool.checkpoint()).unwrap()));
        }
    }
    let load = pool.sensor("patch").unwrap();
    let patch = load.impulse * 0.8 * 0.1;
    assert!(pushed > 1.0, "nothing has struck: {pushed}");
    assert_relative(patch, pushed, 0.1);
    // A restart from the intermediate state gives the same bits.
    let (step, state) = cut.unwrap();
    let last = pool.step();
    let mut again = self::pool(&rig, DAM);
    again.restore(&state).unwrap();
    rig.wait(again.advance(last - step)).unwrap();
    assert_eq!(again.sensor("patch"), Some(load));
    // A scene without the sensor is another one.
    let (without, _) = DAM.split_once("[[probes]]\n    name = \"patch\"").unwrap();
    let mut without = self::pool(&rig, without);
    let refused = without.restore(&state).unwrap_err().to_string();
    assert_contains(&refused, &["1 pressure sensors and the scene 0"]);
}
