//! The Wendland function, and its support near walls.

use crate::start::{DX, Initial, scene, tank};
use glam::DVec3;
use kit::assert_near;
use riprap::sph::Wendland;
use std::f64::consts::PI;

#[test]
fn the_kernel_has_the_integral_one() {
    let h = 0.3;
    let steps = 20_000;
    let step = 2.0 * h / f64::from(steps);
    let radii = (0..steps).map(|i| (f64::from(i) + 0.5) * step);
    let (space, plane) = (Wendland::space(h), Wendland::plane(h));
    let [whole, flat] = radii.fold([0.0, 0.0], |[whole, flat], r| {
        [
            whole + 4.0 * PI * r * r * space.at(r) * step,
            flat + 2.0 * PI * r * plane.at(r) * step,
        ]
    });
    assert!((whole - 1.0).abs() < 1e-7 && (flat - 1.0).abs() < 1e-7);
    assert_eq!(
        (space.at(0.6), space.at(1.0), space.support()),
        (0.0, 0.0, 0.6)
    );
}

/// The sum of the kernel over all particles at each fluid particle that `chosen` selects, times the particle volume; y is
/// periodic.
fn sums(initial: &Initial, chosen: impl Fn(DVec3) -> bool) -> Vec<f64> {
    let kernel = Wendland::space(2.0 * DX);
    let mut all = initial.start.positions.clone();
    all.extend(initial.all_boundary());
    let sum = |at: DVec3| {
        let near = all.iter().map(|x| {
            let mut r = *x - at;
            r.y -= r.y.round();
            kernel.at(r.length())
        });
        near.sum::<f64>() * DX.powi(3)
    };
    let places = initial.start.positions.iter().copied();
    places.filter(|x| chosen(*x)).map(sum).collect()
}

/// The same sum in an infinite lattice.
fn inner() -> f64 {
    let kernel = Wendland::space(2.0);
    let mut sum = 0.0;
    for i in -4..=4 {
        for j in -4..=4 {
            for k in -4..=4 {
                sum += kernel.at(DVec3::new(i.into(), j.into(), k.into()).length());
            }
        }
    }
    sum
}

#[test]
fn the_support_at_lattice_walls_and_corners_is_that_of_the_interior() {
    let initial = Initial::of(&tank("").unwrap());
    assert_near(inner(), 1.0, 2e-3);
    // The lowest layers, in the corner and away from it, beyond the support of the surface.
    let all = sums(&initial, |x| x.y < DX && x.z < 0.25);
    assert_eq!(all.len(), 40 * 5);
    for sum in all {
        assert_near(sum, inner(), 1e-9);
    }
}

#[test]
fn the_support_at_a_slope_is_near_that_of_the_interior() {
    let ramp = "[[solids]]\nname = \"ramp\"\nkind = \"half_space\"\npoint = [1, 0, 0]\nnormal = [-0.5, 0, 0.8660254037844386]\n";
    let initial = Initial::of(&tank(ramp).unwrap());
    let normal = DVec3::new(-0.5, 0.0, 0.75_f64.sqrt());
    // Particles within the support of the slope and not of the surface.
    let all = sums(&initial, |x| {
        let height = normal.dot(x - DVec3::X);
        x.y < DX && x.z < 0.3 && height < 0.15 && x.x > 0.9
    });
    let mean = all.iter().sum::<f64>() / all.len() as f64;
    let [least, most] = all
        .iter()
        .fold([f64::INFINITY, 0.0_f64], |[a, b], s| [a.min(*s), b.max(*s)]);
    println!(
        "slope: {} particles, mean {mean}, {least} to {most}",
        all.len()
    );
    assert_near(mean, 1.0, 0.03);
    assert!(least > 0.85 && most < 1.08, "{least} to {most}");
}

#[test]
fn the_support_at_a_rotated_block_is_near_that_of_the_interior() {
    let block = "[[blocks]]\nname = \"b\"\nkind = \"box\"\nsize = [0.4, 0.4, 0.2]\nposition = [1, 0.5, 0.25]\n\
                 rotation = { axis = [0, 1, 0], angle = 20 }\n";
    let initial = Initial::of(&tank(block).unwrap());
    let all = sums(&initial, |x| {
        (x - DVec3::new(1.0, 0.5, 0.25)).length() < 0.3 && x.z < 0.3
    });
    let mean = all.iter().sum::<f64>() / all.len() as f64;
    assert_near(mean, 1.0, 0.05);
}

#[test]
fn a_planar_scene_has_its_own_normalisation() {
    let initial = Initial::of(&scene("plane = true", "").unwrap());
    let kernel = Wendland::plane(2.0 * DX);
    let mut all = initial.start.positions.clone();
    all.extend(initial.all_boundary());
    let corner = DVec3::new(0.025, 0.5, 0.025);
    let sum: f64 = all.iter().map(|x| kernel.at(x.distance(corner))).sum();
    assert_near(sum * DX * DX, 1.0, 2e-3);
}
