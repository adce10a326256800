//! Fields on cells and faces equal those that the scene prescribes.

use riprap::scene::{BodyForce, Face};

use crate::{changed, channel, read};

#[test]
fn centres_run_x_fastest() {
    let scene = changed("[domain]", "[domain]\norigin = [1, 0, 0]").unwrap();
    let close = |a: [f64; 3], b: [f64; 3]| (0..3).all(|n| (a[n] - b[n]).abs() < 1e-12);
    assert!(close(scene.centre([3, 0, 1]), [1.0035, 0.0005, 0.0015]));
    let all: Vec<_> = scene.domain.centres().collect();
    assert_eq!(all.len(), 800);
    assert_eq!(all[3 + 20 * (2 + 10)], scene.centre([3, 2, 1]));
}

#[test]
fn initial_fields_are_the_formulas_at_the_centres() {
    let scene =
        channel("[initial]\nvelocity = [\"x\", \"-y^2\", 0.5]\npressure = \"z\"\n").unwrap();
    let fields = scene.initial_fields().unwrap();
    for (n, [x, y, z]) in scene.domain.centres().enumerate() {
        assert_eq!(fields.velocity[0][n], x as f32);
        assert_eq!(fields.velocity[1][n], -(y * y) as f32);
        assert_eq!(fields.velocity[2][n], 0.5);
        assert_eq!(fields.pressure[n], z as f32);
    }
}

#[test]
fn hydrostatic_pressure_balances_what_is_not_periodic() {
    let walls = "y_min = { kind = \"wall\" }\ny_max = { kind = \"free_slip\" }\n";
    let text = crate::CHANNEL.replace("[fluid]", "[fluid]\nacceleration = [5, -9.81, 0]");
    let scene = read(&format!("{text}[boundaries]\n{walls}")).unwrap();
    assert_eq!(
        scene.force_field().unwrap(),
        BodyForce::Uniform([5.0, -9.81, 0.0])
    );
    let pressure = scene.initial_fields().unwrap().pressure;
    for (p, [_, y, _]) in pressure.iter().zip(scene.domain.centres()) {
        assert!((f64::from(*p) - 9810.0 * (0.01 - y)).abs() < 1e-4);
    }
    // A pressure face fixes the level: 7 Pa at its centre.
    let scene = read(&format!(
        "{text}[boundaries]\n{walls}x_min = {{ kind = \"free_slip\" }}\n\
         x_max = {{ kind = \"pressure\", pressure = 7 }}\n"
    ))
    .unwrap();
    let (zero, gradient) = scene.hydrostatic();
    assert_eq!(gradient, [5000.0, -9810.0, 0.0]);
    assert!((zero + 5000.0 * 0.02 - 9810.0 * 0.005 - 7.0).abs() < 1e-9);
    // Pressure does not balance a force that varies, nor one along periodic axes.
    let scene = changed("[fluid]", "[fluid]\nacceleration = [5, 0, 0]").unwrap();
    assert_eq!(scene.hydrostatic(), (0.0, [0.0; 3]));
}

#[test]
fn face_velocities_are_taken_on_the_face() {
    let scene = channel(
        "[boundaries]\nx_min = { kind = \"velocity\", velocity = [\"x + y\", \"z\", \"t\"] }\n\
         x_max = { kind = \"pressure\" }\n\
         y_min = { kind = \"wall\" }\ny_max = { kind = \"wall\", velocity = [0.5, 0, 0] }\n",
    )
    .unwrap();
    let inlet = scene.face_velocity(Face::XMin, 3.0).unwrap();
    assert_eq!(inlet.len(), 10 * 4);
    // Lower axis (y) fastest; x is 0 on the face, not half a cell inside.
    let [u, v, w] = inlet[2 + 10 * 3];
    assert!((u - 0.0025).abs() < 1e-15 && (v - 0.0035).abs() < 1e-15 && w == 3.0);
    assert_eq!(
        scene.face_velocity(Face::YMax, 0.0).unwrap(),
        [[0.5, 0.0, 0.0]; 80]
    );
    assert_eq!(
        scene.face_velocity(Face::XMax, 0.0).unwrap(),
        [[0.0; 3]; 40]
    );
    // Initially the fastest point of the inlet is its upper edge, which is slower than the lid.
    assert_eq!(scene.sampled_speed().unwrap(), 0.5);
}

#[test]
fn a_force_may_vary_in_space() {
    let scene = changed("[fluid]", "[fluid]\nacceleration = [\"y\", 0, 0]").unwrap();
    let BodyForce::Field([x, y, _]) = scene.force_field().unwrap() else {
        panic!("a formula makes a field");
    };
    assert_eq!(x[20], 0.0015);
    assert!(y.iter().all(|v| *v == 0.0));
}
