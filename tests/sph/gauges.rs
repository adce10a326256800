//! Level, pressure and run-up of known particle positions.

use crate::start::DX;
use glam::{DVec3, Vec3};
use kit::{assert_near, assert_relative};
use riprap::scene::Field;
use riprap::{
    simulation::point_cloud,
    sph::{Interpolator, Setup, Side, Totals, Water},
};

/// A tank of 1 × 1 × 1 m with water below a height (m) that depends on (x, y).
fn water(height: impl Fn(f64, f64) -> f64) -> (Setup, Vec<DVec3>) {
    let setup = Setup::tank(DVec3::ONE, DX, 40.0);
    let at = |i: i32| (f64::from(i) + 0.5) * DX;
    let all = (0..20).flat_map(|k| (0..20).flat_map(move |j| (0..20).map(move |i| [i, j, k])));
    let all = all.map(|ijk| DVec3::from(ijk.map(at)));
    let there = all.filter(|x| x.z < height(x.x, x.y)).collect();
    (setup, there)
}

#[test]
fn the_level_of_still_water_is_the_top_of_its_uppermost_particles() {
    let (setup, positions) = water(|_, _| 0.5);
    let gauges = Interpolator::new(&setup, &positions);
    // In the middle, between particles, at a wall and in a corner.
    for at in [
        [0.525, 0.525],
        [0.5, 0.5],
        [0.0, 0.5],
        [0.0, 0.0],
        [0.51, 0.49],
    ] {
        let level = gauges.level(at).unwrap();
        assert!((level - 0.5).abs() < 0.1 * DX, "{at:?}: {level}");
    }
}

#[test]
fn drops_do_not_count_and_dry_ground_has_no_level() {
    let (setup, mut positions) = water(|x, _| if x < 0.5 { 0.3 } else { 0.0 });
    positions.push(DVec3::new(0.2, 0.5, 0.9));
    let gauges = Interpolator::new(&setup, &positions);
    let level = gauges.level([0.2, 0.5]).unwrap();
    assert_near(level, 0.3, 0.1 * DX);
    assert_eq!(gauges.level([0.9, 0.5]), None);
}

#[test]
fn the_level_follows_a_slope() {
    let (setup, positions) = water(|x, _| 0.3 + 0.2 * x);
    let gauges = Interpolator::new(&setup, &positions);
    for x in [0.3, 0.42, 0.55, 0.7] {
        let level = gauges.level([x, 0.5]).unwrap();
        // The lattice has steps of a spacing.
        assert!((level - 0.3 - 0.2 * x).abs() < 0.5 * DX, "{x}: {level}");
    }
}

#[test]
fn the_level_of_a_film_is_the_top_of_its_particles() {
    let (setup, positions) = water(|_, _| DX);
    let level = Interpolator::new(&setup, &positions)
        .level([0.5, 0.5])
        .unwrap();
    assert_near(level, DX, 1e-12);
}

#[test]
fn the_water_fraction_is_one_inside_and_a_half_at_the_surface() {
    let (setup, positions) = water(|_, _| 0.8);
    let gauges = Interpolator::new(&setup, &positions);
    let fraction = |z| gauges.water_fraction(DVec3::new(0.525, 0.525, z));
    assert_near(fraction(0.5), 1.0, 0.01);
    assert_near(fraction(0.8), 0.5, 0.01);
    assert_eq!(fraction(1.01), 0.0);
}

#[test]
fn the_pressure_of_still_water_is_exact_also_at_walls() {
    let (setup, positions) = water(|_, _| 0.5);
    let weight = setup.density * setup.gravity;
    let pressure = |x: DVec3| weight.dot(x - DVec3::Z * 0.5);
    let values: Vec<f64> = positions.iter().map(|x| pressure(*x)).collect();
    let gauges = Interpolator::new(&setup, &positions);
    for at in [
        [0.5, 0.5, 0.2],
        [0.0, 0.31, 0.1],
        [0.0, 0.0, 0.0],
        [0.5, 0.5, 0.45],
    ] {
        let at = DVec3::from(at);
        let mean = gauges.mean(at, &values, weight).unwrap();
        assert_relative(mean, pressure(at), 1e-9);
    }
    assert_eq!(
        gauges.mean(DVec3::new(0.5, 0.5, 0.9), &values, weight),
        None
    );
}

/// The mean over the water next to a wall is that half a spacing away and more.
#[test]
fn a_shear_flow_is_zero_at_its_wall() {
    let (setup, positions) = water(|_, _| 0.5);
    let velocities: Vec<f64> = positions.iter().map(|x| 3.0 * x.z).collect();
    let gauges = Interpolator::new(&setup, &positions);
    for z in [0.0, 0.025, 0.2] {
        let at = DVec3::new(0.5, 0.31, z);
        let found = gauges.mean(at, &velocities, DVec3::ZERO).unwrap();
        assert_near(found, 3.0 * z, 1e-3);
    }
}

#[test]
fn gauges_see_periodic_images() {
    let (mut setup, positions) = water(|_, _| 0.5);
    setup.faces[0] = [Side::Periodic; 2];
    let gauges = Interpolator::new(&setup, &positions);
    let [end, middle] = [0.0, 0.5].map(|x| gauges.water_fraction(DVec3::new(x, 0.525, 0.225)));
    assert_near(end, middle, 1e-12);
}

#[test]
fn run_up_ignores_drops() {
    let (setup, mut positions) = water(|x, _| if x < 0.6 { 0.3 } else { 0.0 });
    positions.push(DVec3::new(0.9, 0.5, 0.1));
    let gauges = Interpolator::new(&setup, &positions);
    let [low, high] = [DVec3::ZERO, DVec3::ONE];
    let front = gauges.farthest(low, high, DVec3::X).unwrap();
    assert_near(front.x, 0.575, 1e-12);
    let part = gauges
        .farthest(low, DVec3::new(0.4, 1.0, 1.0), DVec3::X)
        .unwrap();
    assert_near(part.x, 0.375, 1e-12);
    assert_eq!(
        gauges.farthest(DVec3::new(0.7, 0.0, 0.0), high, DVec3::X),
        None
    );
}

#[test]
fn totals_sum_all_particles() {
    let (setup, positions) = water(|_, _| 0.5);
    let count = positions.len();
    let water = Water {
        ids: (0..count as u32).collect(),
        velocities: vec![Vec3::new(1.0, 0.0, -2.0); count],
        densities: vec![1001.0; count],
        pressures: vec![5.0; count],
        positions,
        ..Water::default()
    };
    let totals = Totals::of(&setup, &water);
    // 500 kg with the centre of mass at a height of 0.25 m.
    assert_near(totals.mass, 500.0, 1e-9);
    assert!((totals.momentum[2] + 1000.0).abs() < 1e-9 && totals.momentum[1] == 0.0);
    assert_near(totals.kinetic_energy, 0.5 * 500.0 * 5.0, 1e-9);
    assert_near(totals.potential_energy, 500.0 * 9.81 * 0.25, 1e-8);
    assert_near(totals.max_speed, 5.0_f64.sqrt(), 1e-12);
    let cloud = point_cloud(
        &water,
        &[Field::Velocity, Field::Pressure, Field::Vorticity],
    );
    let names: Vec<&str> = cloud.arrays.iter().map(|a| a.name.as_str()).collect();
    assert_eq!(names, ["velocity", "pressure", "id"]);
    assert_eq!(
        (cloud.points.len(), cloud.arrays[0].values.len()),
        (count, 3 * count)
    );
    assert_eq!(cloud.arrays[2].values[count - 1], (count - 1) as f32);
}
