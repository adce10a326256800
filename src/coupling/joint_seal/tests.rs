use super::*;
use crate::{geometry::Polyhedron, rock::Period};
use glam::DQuat;
use std::f64::consts::PI;

fn at(x: f64, y: f64, z: f64) -> Pose {
    let centre = DVec3::new(x, y, z);
    Pose::at_rest(centre, DQuat::IDENTITY)
}

fn cuboid(x: f64, y: f64, z: f64) -> Arc<Shape> {
    Arc::new(Polyhedron::cuboid(DVec3::new(x, y, z)).unwrap().into())
}

fn tank() -> Setup {
    let mut setup = Setup::tank(DVec3::new(40.0, 40.0, 20.0), 0.1, 10.0);
    setup.origin = DVec3::new(-20.0, -20.0, -0.6);
    setup.gravity = DVec3::Z * -10.0;
    setup
}

/// The loads of joints on all blocks, for hydrostatic water with 10 kPa/m below the level `level` (m).
fn loads(
    shapes: Vec<Arc<Shape>>,
    poses: &[Pose],
    periods: Option<Periods>,
    level: impl Fn(DVec3) -> f64,
) -> Vec<Load> {
    let setup = tank();
    let requested = vec![true; shapes.len()];
    let seal = JointSeal::new(shapes, periods, &setup, &requested);
    let sealed = seal.find_joints(poses, &vec![true; poses.len()]);
    let pressure = |x: &DVec3| (1e4 * (level(*x) - x.z)).max(0.0);
    let pressures: Vec<f64> = sealed.rim_places().iter().map(pressure).collect();
    let mut loads = vec![Load::default(); poses.len()];
    seal.add_loads(sealed, &pressures, poses, &mut loads);
    loads
}

/// A dam on its base: uplift between two levels, its moment, and none in a gap with room for water.
#[test]
fn uplift_falls_linearly_from_heel_to_toe() {
    let shapes = vec![cuboid(4.0, 1.0, 3.0), cuboid(20.0, 3.0, 1.0)];
    let heights = KernelDeficit::new(&tank()).heights;
    for gap in [0.0, 0.04, 0.12, 0.25] {
        let higher = heights.iter().filter(|height| **height > gap).count();
        let fraction = higher as f64 / heights.len() as f64;
        let poses = [at(0.0, 0.0, 1.5 + gap), at(0.0, 0.0, -0.5)];
        // 30 kPa at the heel and none at a dry toe.
        for (down, mean) in [(1.0, 20e3), (0.0, 15e3)] {
            let found = loads(shapes.clone(), &poses, None, |x: DVec3| {
                3.0 + (down - 3.0) * (0.25 * x.x + 0.5).clamp(0.0, 1.0)
            });
            let uplift = 4.0 * (mean - 1e4 * gap) * fraction;
            assert!(
                (found[0].force - DVec3::Z * uplift).length() < 0.05 * uplift.max(1.0),
                "{} {uplift}",
                found[0].force
            );
            // ∫ p x dx about the middle.
            let torque = 2.0 * (30e3 - mean) * 16.0 / 12.0 * fraction;
            let torque_found = found[0].torque();
            assert!(
                (torque_found.y.abs() - torque).abs() < 0.1 * torque.max(1.0),
                "{torque_found}"
            );
        }
    }
}

/// A dam of two blocks on a floor of two, all as wide as the period: only heel and toe are rims, also with a gap below a
/// spacing.
#[test]
fn joints_that_continue_across_the_period_have_no_rim() {
    let periods = Periods {
        period: Period {
            origin: DVec3::ZERO,
            size: DVec3::new(f64::INFINITY, 1.0, f64::INFINITY),
        },
        filled: vec![[false; 3]; 4],
    };
    let shapes = vec![
        cuboid(2.0, 1.0, 3.0),
        cuboid(2.0, 1.0, 3.0),
        cuboid(10.0, 1.0, 1.0),
        cuboid(10.0, 1.0, 1.0),
    ];
    for gap in [0.0, 0.01] {
        // The blocks have different offsets along the period.
        let poses = [
            at(-1.0, 0.5, 1.5 + gap),
            at(1.0, 2.0, 1.5 + gap),
            at(-5.0, 0.3, -0.5),
            at(5.0, 0.5, -0.5),
        ];
        let level = |x: DVec3| {
            // Water on both sides; any rim inside the dam or its floor would be dry.
            let inside = x.x.abs() < 2.0;
            if inside { -9.0 } else { 3.0 }
        };
        let found = loads(shapes.clone(), &poses, Some(periods.clone()), level);
        let both = found[0].force + found[1].force;
        assert!((both.z / 12e4 - 1.0).abs() < 0.05, "{gap}: {both}");
        assert!(both.x.abs() < 1e-6 * both.z, "{gap}: {both}");
    }
}

/// A block on a floor longer than the period has the uplift of still water, and no other force, wherever the period ends.
#[test]
fn a_floor_longer_than_the_period_has_no_end_under_a_block() {
    let shapes = vec![cuboid(2.0, 1.0, 2.0), cuboid(30.0, 3.0, 1.0)];
    let periods = Periods {
        period: Period {
            origin: DVec3::ZERO,
            size: DVec3::new(10.0, f64::INFINITY, f64::INFINITY),
        },
        filled: vec![[false; 3], [true, false, false]],
    };
    for x in [5.0, 9.5, 10.0, 30.3] {
        let poses = [at(x, 0.0, 1.0), at(5.0, 0.0, -0.5)];
        let found = loads(shapes.clone(), &poses, Some(periods.clone()), |_| 3.0);
        let load = (found[0].force - DVec3::Z * 6e4).length();
        assert!(load < 0.05 * 6e4, "{x}: {}", found[0].force);
        assert!(
            found[0].force.x.abs() < 1e-6 * 6e4,
            "{x}: {}",
            found[0].force
        );
    }
}

/// Buoyancy of every block inside a mass of 5 × 5 × 5 blocks, also of the inner ones, which have no rim.
#[test]
fn pressure_propagates_through_the_joints_of_a_mass() {
    let (mut poses, mut inside) = (Vec::new(), Vec::new());
    for n in 0..125 {
        let place = [n / 25, n / 5 % 5, n % 5];
        let [x, y, z] = place.map(f64::from);
        poses.push(at(x, y, 2.0 + z));
        inside.push(place.iter().all(|k| (1..4).contains(k)));
    }
    let found = loads(vec![cuboid(1.0, 1.0, 1.0); 125], &poses, None, |_| 15.0);
    let buoyancy = DVec3::Z * 1e4;
    for (load, _) in found.iter().zip(&inside).filter(|(_, inside)| **inside) {
        assert!((load.force - buoyancy).length() < 1.0, "{}", load.force);
        assert!(load.torque().length() < 1.0, "{}", load.torque());
    }
}

/// Three columns on a floor between water and a dry side: joints between blocks with dry rims stay dry.
#[test]
fn pressure_does_not_propagate_to_blocks_with_dry_rims() {
    let column = || cuboid(2.0, 2.0, 3.0);
    let shapes = vec![column(), column(), column(), cuboid(20.0, 1.8, 1.0)];
    let poses = [
        at(-2.0, 0.0, 1.5),
        at(0.0, 0.0, 1.5),
        at(2.0, 0.0, 1.5),
        at(0.0, 0.0, -0.5),
    ];
    let level = |x: DVec3| if x.x < -2.5 { 3.0 } else { -9.0 };
    let found = loads(shapes, &poses, None, level);
    assert!(found[0].force.z > 1e4, "{}", found[0].force);
    assert!(found[2].force.x.abs() < 1e-9, "{}", found[2].force);
}

/// A slope above the water, and one that the water line crosses.
#[test]
fn dry_joints_have_no_pressure() {
    let shapes = vec![cuboid(2.0, 1.0, 1.0), cuboid(20.0, 3.0, 1.0)];
    let poses = [at(0.0, 0.0, 0.5), at(0.0, 0.0, -0.5)];
    let dry = loads(shapes.clone(), &poses, None, |_| -3.0);
    assert_eq!(dry, [Load::default(); 2]);
    // A slope of 30°; the water line crosses the middle of the joint.
    let rotation = DQuat::from_rotation_y(PI / 6.0);
    let poses = poses.map(|pose| {
        let centre = rotation * pose.centre;
        Pose::at_rest(centre, rotation)
    });
    let half = loads(shapes, &poses, None, |_| 0.0);
    // The lower side receives a surplus next to the floor, at half a metre of depth.
    let lateral = 5e3 * KernelDeficit::new(&tank()).edge_loss(0.0);
    let expected = rotation * DVec3::new(-lateral, 0.0, 2.5e3);
    assert!(
        (half[0].force - expected).length() < 25.0,
        "{}",
        half[0].force
    );
}

#[test]
fn forces_of_a_half_covered_joint_are_opposite_and_reduced_by_flush_edges() {
    let shapes = vec![cuboid(1.0, 1.0, 1.0), cuboid(1.0, 1.0, 1.0)];
    let poses = [at(0.0, 0.0, 1.0), at(0.5, 0.0, 0.0)];
    let found = loads(shapes, &poses, None, |_| 1.5);
    // Two edges are flush; beyond the other two, one of the blocks extends.
    let loss = KernelDeficit::new(&tank()).edge_loss(0.0);
    let normal = 1e4 * (0.5 - 2.0 * 0.5 * loss);
    // The sides next to the joint receive a surplus, which the lateral force balances.
    let expected = DVec3::new(-2.0 * 1e4 * loss, 0.0, normal);
    assert!(
        (found[0].force - expected).length() < 1.0,
        "{}",
        found[0].force
    );
    assert!(
        (found[1].force + expected).length() < 1.0,
        "{}",
        found[1].force
    );
}
