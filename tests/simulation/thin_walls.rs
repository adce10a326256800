//! Free water on one side of a driven wall at rest.

use kit::Rig;

/// The part of the water beyond a wall of `thickness` spacings after 0.4 s.
fn beyond(rig: &Rig, thickness: f64) -> f64 {
    let width = 0.02 * thickness;
    let scene = format!(
        r#"
        domain.size = [1, 0.1, 0.6]
        fluid.acceleration = [0, 0, -9.81]
        particles = {{ spacing = 0.02, plane = true }}
        run.duration = 0.4
        [boundaries]
        x_min.kind = "wall"
        x_max.kind = "wall"
        z_min.kind = "wall"
        z_max.kind = "open"
        [[materials]]
        name = "rock"
        density = 2500
        normal_stiffness = 1e7
        friction = 20
        [[blocks]]
        kind = "box"
        size = [{width}, 0.1, 0.5]
        position = [{}, 0.05, 0.25]
        motion = "driven"
        [[water]]
        kind = "box"
        size = [0.5, 0.1, 0.4]
        position = [0.25, 0.05, 0.2]
        "#,
        0.5 + 0.5 * width
    );
    let mut simulation = rig.simulation(&kit::scene::read(&scene).unwrap()).unwrap();
    let steps = 0.4 / simulation.time_step();
    rig.wait(simulation.advance(steps as u64)).unwrap();
    let water = rig.wait(simulation.water()).unwrap();
    let through = water.positions.iter().filter(|at| at.x > 0.5 + width);
    through.count() as f64 / water.len() as f64
}

/// A driven wall of three spacings holds water, thinner ones leak.
#[test]
fn thin_driven_walls_leak() {
    let rig = Rig::new();
    let [one, two, three] = [1.0, 2.0, 3.0].map(|thickness| beyond(&rig, thickness));
    println!("{one} {two} {three}");
    assert!(
        one > two && two > 0.0 && three == 0.0,
        "{one} {two} {three}"
    );
}
