//! The wall model where the pressure balances gravity along the wall.

use crate::probed_at_end;
use kit::Rig;

/// Largest upward and downward velocity in a stream along x past a vertical or steep surface at small y.
fn vertical_velocities(surface: &str, y_min: &str, gravity: f64) -> [f64; 2] {
    let rig = Rig::new();
    let scene = kit::scene::read(&format!(
        r#"
        domain = {{ size = [0.4, 1.0, 0.6], cell = 0.05 }}
        fluid = {{ viscosity = 1e-5, acceleration = [0, 0, {}] }}
        numerics = {{ eddy_viscosity = "wale", wall_model = "werner_wengle", velocity_scale = 1.5 }}
        initial.velocity = [1, 0, 0]
        run.duration = 0.4
        [boundaries]
        y_min = {{ kind = "{y_min}" }}
        y_max = {{ kind = "free_slip" }}
        z_min = {{ kind = "free_slip" }}
        z_max = {{ kind = "free_slip" }}
        [[materials]]
        name = "rock"
        density = 2000
        normal_stiffness = 1e8
        friction = 30
        [[probes]]
        name = "water"
        kind = "box"
        min = [0, 0.25, 0]
        max = [0.4, 1, 0.6]
        fields = ["velocity"]
        {surface}
        "#,
        -gravity
    ))
    .unwrap();
    let found = probed_at_end(&rig, &scene);
    // The stream is that of the model.
    assert!(found["velocity_x_mean"] > 0.95);
    [found["velocity_z_max"], found["velocity_z_min"]]
}

#[test]
fn gravity_drives_no_current_along_a_wall_with_a_wall_model() {
    let solid = |keys: &str| format!("[[solids]]\n{keys}");
    let block = |keys: &str| format!("[[blocks]]\nmotion = \"fixed\"\nkind = \"box\"\n{keys}");
    for (surface, y_min) in [
        (String::new(), "wall"),
        (
            solid("kind = \"box\"\nmin = [0, 0, 0]\nmax = [0.4, 0.2, 0.6]"),
            "free_slip",
        ),
        (
            solid(
                "kind = \"half_space\"\npoint = [0, 0.2, 0]\nnormal = [0, 1, 0]\nsurface = \"exact\"",
            ),
            "free_slip",
        ),
        (
            solid(
                "kind = \"half_space\"\npoint = [0, 0.24, 0]\nnormal = [0, 3, 1]\nsurface = \"exact\"",
            ),
            "free_slip",
        ),
        (
            block("size = [2, 0.2, 3]\nposition = [0.2, 0.1, 0.3]"),
            "free_slip",
        ),
        (
            block("size = [2, 0.2, 3]\nposition = [0.2, 0.115, 0.3]"),
            "free_slip",
        ),
        (
            block(
                "size = [2, 1, 3]\nposition = [0.2, -0.33, 0.3]\nrotation = { axis = [1, 0, 0], angle = 18 }",
            ),
            "free_slip",
        ),
    ] {
        let [with, without] =
            [9.81, 0.0].map(|gravity| vertical_velocities(&surface, y_min, gravity));
        println!("{surface}\n{with:?} {without:?}");
        for (with, without) in with.into_iter().zip(without) {
            assert!(
                (with - without).abs() < 1e-3,
                "{with} m/s, {without} m/s without gravity: {surface}"
            );
        }
    }
}
