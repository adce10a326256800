//! A planar flow stays planar under rounding errors of the bodies.

use crate::tank::{Tank, lattice, resting, walls};
use glam::{DMat3, DVec3};
use riprap::{
    geometry::Pose,
    sph::{Body, Setup, Side},
};

/// A plate moves into the water, offset and tilted by as much as rounding may reach in a long run. Particles outside the
/// plane would repel each other and leave it within a second.
#[test]
fn an_offset_body_keeps_the_water_in_the_plane() {
    let spacing = 0.05;
    let mut setup = Setup::tank(DVec3::new(1.0, 1.0, 0.8), spacing, 40.0);
    setup.plane = true;
    setup.faces[2][1] = Side::Open;
    let mut plate = Body {
        moves: true,
        loaded: true,
        accelerates: true,
        ..Default::default()
    };
    plate.boundary = lattice(&setup, [-4, 0, 0], [0, 1, 16]);
    for x in &mut plate.boundary {
        x.y = 0.0;
    }
    setup.bodies = vec![walls(&setup), plate];
    let positions = lattice(&setup, [1, 0, 0], [20, 1, 8]);
    let tilt = 1e-3;
    let mut off = Pose {
        centre: DVec3::new(0.0, 0.5 + 1e-3, 0.0),
        velocity: DVec3::new(0.3, 0.02, 0.0),
        ..resting(DVec3::ZERO)
    };
    off.deformation = DMat3::from_rotation_x(tilt) * off.deformation;
    off.deformation_rate = DMat3::from_cols(DVec3::ZERO, DVec3::Z * tilt, -DVec3::Y * tilt);
    let poses = vec![resting(DVec3::ZERO), off];
    let mut tank = Tank::new(setup, poses, &positions, |x: DVec3| {
        9810.0 * (0.4 - x.z).max(0.0)
    });
    let step = 2e-3;
    for _ in 0..150 {
        let load = tank.advance(step).loads[1];
        assert!(load.force.x != 0.0);
        assert_eq!(load.force.y, 0.0);
        assert_eq!([load.torque().x, load.torque().z], [0.0; 2]);
        let next = tank.poses[1].after(step);
        tank.poses[1] = next;
    }
    let water = tank.water();
    assert_eq!(water.len(), positions.len());
    assert!(water.velocities.iter().all(|v| v.y == 0.0));
    assert!(water.velocities.iter().any(|v| v.x > 0.1));
}
