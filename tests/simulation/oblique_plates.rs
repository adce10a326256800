//! The wall model between two plates at 45° to the grid, eight cells apart.

use glam::DVec3;
use kit::{Rig, assert_near};
use riprap::scene::Scene;

/// A plate driven along x at a speed, m/s, and one at rest, in a stream of 1 m/s that is slower between them; with `turned`, the
/// stream and both plates after half a turn about x.
fn plates(driven: f64, slower: f64, turned: bool) -> Scene {
    let (sign, [a, b]) = match turned {
        false => (1, [[0.221, 0.419], [0.419, 0.221]]),
        true => (-1, [[0.419, 0.221], [0.221, 0.419]]),
    };
    let plate = |[y, z]: [f64; 2], motion: &str| {
        format!(
            "[[blocks]]\nkind = \"box\"\nsize = [0.30, 0.36, 0.12]\nposition = [0.16, {y}, {z}]\n\
             rotation = {{ axis = [1, 0, 0], angle = 45 }}\n{motion}\n"
        )
    };
    let keys = format!(
        r#"
        domain = {{ size = [0.32, 0.64, 0.64], cell = 0.02 }}
        fluid.viscosity = 1e-6
        numerics = {{ eddy_viscosity = "wale", wall_model = "werner_wengle", time_step = 0.001 }}
        initial.velocity = ["1 + {slower} * min({sign} * (z - y) * 0.7071 + 0.03, 0)", 0, 0]
        run.steps = 60
        [[materials]]
        name = "rock"
        density = 2500
        normal_stiffness = 1e8
        friction = 30
        {}
        {}
        "#,
        plate(
            a,
            &format!("motion = \"driven\"\nvelocity = [\"{driven}\", 0, 0]")
        ),
        plate(b, "motion = \"fixed\""),
    );
    kit::scene::read(&keys).unwrap()
}

/// The momentum of the fluid after 60 steps, and the sum of the stresses over the areas.
fn after_60_steps(rig: &Rig, scene: &Scene) -> [DVec3; 2] {
    let mut simulation = rig.simulation(scene).unwrap();
    rig.wait(simulation.advance(60)).unwrap();
    let momentum = rig.wait(simulation.totals()).unwrap().momentum;
    let frictions = rig.wait(simulation.wall_friction()).unwrap();
    let walls = frictions.walls.iter();
    let stress = walls.map(|wall| wall.area * DVec3::from(wall.stress));
    [momentum.into(), stress.sum()]
}

/// The plate that moves with the stream has no friction, and leaves the eddy viscosity of the other one.
#[test]
fn runs_have_the_same_bits() {
    let rig = Rig::new();
    let scene = plates(1.0, 0.0, false);
    let first = after_60_steps(&rig, &scene);
    for _ in 0..3 {
        assert_eq!(after_60_steps(&rig, &scene), first);
    }
}

/// At 45° two axes are as near to the normal.
#[test]
fn friction_is_the_same_after_half_a_turn() {
    let rig = Rig::new();
    let [[_, one], [_, other]] =
        [false, true].map(|turned| after_60_steps(&rig, &plates(0.8, 5.0, turned)));
    println!("{one} and {other} N");
    assert_near(other.x / one.x, 1.0, 1e-3);
}
