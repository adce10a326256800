//! Scenes of blocks that deform: what they make.

use glam::{DMat3, DVec3};
use riprap::{rock::Setup, scene::build::block_setup};

/// Blocks and a rock mass that deform.
pub const BAR: &str = r#"
[[materials]]
name = "rock"
density = 2700
normal_stiffness = 1e9
friction = 30
youngs_modulus = 2e10
[[materials]]
name = "hard"
density = 2700
normal_stiffness = 1e9
friction = 30
[[blocks]]
name = "bar"
kind = "vertices"
vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 4], [1, 0, 4], [0, 1, 4], [1, 1, 4]]
position = [0, 0, 1]
deformable = true
initial_stress = [1e5, -2e5, 3e5, 4e4, 5e4, 6e4]
fixed_points = [{ point = [0.5, 0.5, 4] }, { point = [1, 0.5, 4], axes = ["z", "x"] }]
point_loads = [{ point = [0.5, 0.5, 0], force = [0, "10*t", -5] }]
acceleration = ["sin(t)", 0, 0]
repeat = { count = 2, step = [3, 0, 0] }
[[blocks]]
name = "ball"
kind = "sphere"
radius = 0.5
position = [0, 5, 0]
point_loads = [{ point = [0.5, 0, 0], force = [0, 0, 1] }]
[[rock_masses]]
name = "mass"
kind = "box"
min = [10, 0, 0]
max = [12, 2, 2]
joints = [{ dip = 0, dip_direction = 0, spacing = 1, origin = [0, 0, 1] }]
deformable = true
fixed = [{ kind = "box", min = [10, 0, 0], max = [12, 2, 1] }]
[run]
duration = 1
"#;

fn setup(text: &str) -> Result<Setup, String> {
    let scene = crate::read(text).map_err(|error| error.to_string())?;
    let made = block_setup(&scene).map_err(|error| error.to_string())?;
    Ok(made.setup)
}

#[test]
fn keys_become_deformable_blocks_and_loads() {
    let setup = setup(BAR).unwrap();
    let elastic = setup.materials[0].elastic.unwrap();
    assert_eq!(
        (elastic.youngs_modulus, elastic.poissons_ratio),
        (2e10, 0.25)
    );
    assert_eq!(setup.materials[1].elastic, None);
    for bar in &setup.blocks[..2] {
        let deformable = bar.deformable.as_ref().unwrap();
        let stress = DMat3::from_cols(
            DVec3::new(1e5, 4e4, 6e4),
            DVec3::new(4e4, -2e5, 5e4),
            DVec3::new(6e4, 5e4, 3e5),
        );
        assert_eq!(deformable.initial_stress, stress);
        // From the centroid at (0.5, 0.5, 2).
        let [hinge, roller] = deformable.fixed_points[..] else {
            panic!("two points")
        };
        assert!((hinge.point - DVec3::Z * 2.0).length() < 1e-12);
        assert_eq!((hinge.axes, roller.axes), ([true; 3], [true, false, true]));
        assert!((bar.point_loads[0].point + DVec3::Z * 2.0).length() < 1e-12);
        assert_eq!(bar.point_loads[0].force[1].text(), "10*t");
        assert_eq!(bar.acceleration.as_ref().unwrap()[0].text(), "sin(t)");
    }
    assert!(setup.blocks[2].deformable.is_none());
    assert_eq!(setup.blocks[2].point_loads.len(), 1);
    // Of the two blocks of the mass one is fixed, and rigid.
    let mass: Vec<bool> = setup.blocks[3..]
        .iter()
        .map(|b| b.deformable.is_some())
        .collect();
    assert_eq!(
        mass.iter().filter(|deforms| **deforms).count(),
        1,
        "{mass:?}"
    );
    riprap::rock::Blocks::new(setup).unwrap();
}
