//! Initial fluid particles.

use crate::start::{DX, Initial, error_of, is_on_lattice, scene, tank};
use glam::DVec3;
use kit::assert_relative;
use riprap::scene::build::{block_setup, particle_lattice, particle_setup};

#[test]
fn a_box_of_water_in_a_tank_loses_no_particle_to_its_walls() {
    let initial = Initial::of(&tank("").unwrap());
    let start = &initial.start;
    assert_eq!(start.positions.len(), 40 * 20 * 10);
    let low = start
        .positions
        .iter()
        .fold(DVec3::INFINITY, |a, b| a.min(*b));
    let high = start
        .positions
        .iter()
        .fold(DVec3::NEG_INFINITY, |a, b| a.max(*b));
    assert!(low.distance(DVec3::splat(0.025)) < 1e-12);
    assert!(high.distance(DVec3::new(1.975, 0.975, 0.475)) < 1e-12);
    assert!(start.velocities.iter().all(|v| *v == DVec3::ZERO));
}

#[test]
fn the_initial_pressure_is_hydrostatic() {
    let initial = Initial::of(&tank("").unwrap());
    for (x, p) in initial.start.positions.iter().zip(&initial.start.pressures) {
        let exact = 1000.0 * 9.81 * (0.5 - x.z);
        assert!((p - exact).abs() < 1e-9 * 4905.0, "{x}: {p}");
    }
}

/// A column of volumes 1/(1 + p/(ρc²)) stands on the floor; its pressures, the weight above, do not change.
#[test]
fn compressed_particles_have_the_volume_of_their_density() {
    let scene = tank("").unwrap();
    let mut start = Initial::of(&scene).start;
    let pressures = start.pressures.clone();
    let unit = 1000.0 * 8.0_f64.powi(2);
    let lattice = particle_lattice(&scene).unwrap();
    start.compress(&lattice, DVec3::NEG_Z * 9810.0, |p| p / unit);
    assert_eq!(start.pressures, pressures);
    for (x, p) in start.positions.iter().zip(&start.pressures) {
        let row = ((0.5 - p / 9810.0) / DX).floor() as usize;
        let part = |k: usize| 1.0 / (1.0 + 9810.0 * (0.475 - DX * k as f64) / unit);
        let below: f64 = (0..row).map(part).sum();
        let exact = DX * (below + 0.5 * part(row));
        assert!((x.z - exact).abs() < 1e-12, "{x}: {exact}");
    }
}

/// Water that gravity drives along a periodic axis, more than it presses it on the floor, is compressed towards the floor alone.
#[test]
fn water_is_not_compressed_along_periodic_axes() {
    let mut scene = crate::start::scene("disorder = 0", "").unwrap();
    scene.fluid.acceleration[1] = 20.0.into();
    let blocks = block_setup(&scene).unwrap();
    let (_, start) = particle_setup(&scene, &blocks).unwrap();
    assert!(start.positions.iter().all(|x| is_on_lattice(x.y, 0.0)));
    assert!(start.positions.iter().any(|x| !is_on_lattice(x.z, 0.0)));
}

#[test]
fn a_drop_in_the_air_has_no_pressure() {
    let drop = "[[water]]\nkind = \"sphere\"\nradius = 0.15\nposition = [1, 0.5, 0.8]\nvelocity = [0, 0, -1]\n";
    let initial = Initial::of(&tank(drop).unwrap());
    let drop = initial.start.positions.iter().zip(&initial.start.pressures);
    let drop: Vec<_> = drop.filter(|(x, _)| x.z > 0.6).collect();
    let middle = DVec3::new(1.0, 0.5, 0.8);
    let lattice = (0..40).flat_map(|i| (0..20).flat_map(move |j| (0..20).map(move |k| [i, j, k])));
    let inside = lattice.filter(|ijk| {
        let x = DVec3::from(ijk.map(f64::from)) * DX + DX / 2.0;
        x.distance(middle) <= 0.15
    });
    assert_eq!(drop.len(), inside.count());
    assert!(drop.iter().all(|(_, p)| **p == 0.0));
    assert_eq!(
        initial.start.velocities.last(),
        Some(&DVec3::new(0.0, 0.0, -1.0))
    );
}

#[test]
fn blocks_displace_as_much_water_as_they_have_volume() {
    let block = "[[blocks]]\nname = \"b\"\nkind = \"box\"\nsize = [0.4, 0.3, 0.2]\nposition = [1, 0.5, 0.2]\n\
                 rotation = { axis = [0, 1, 0], angle = 20 }\n";
    let initial = Initial::of(&tank(block).unwrap());
    let block = &initial.setup.setup.blocks[initial.block("b")];
    let half = DVec3::new(0.2, 0.15, 0.1);
    let mut nearest = f64::INFINITY;
    for x in &initial.start.positions {
        let own = (block.rotation.inverse() * (*x - block.centre)).abs();
        let outside = (own - half).max(DVec3::ZERO).length();
        nearest = nearest.min(outside);
    }
    assert!(nearest >= 0.1 * DX * (1.0 - 1e-5), "{nearest}");
    // The block and a clearance of a tenth of a spacing displace the water; along y they take six rows.
    let missing = (8000 - initial.start.positions.len()) as f64 * DX.powi(3);
    let displaced = 0.41 * 0.3 * 0.21;
    assert_relative(missing, displaced, 0.03);
}

#[test]
fn a_planar_scene_has_one_row_in_the_middle() {
    let initial = Initial::of(&scene("plane = true", "").unwrap());
    assert_eq!(initial.start.positions.len(), 40 * 10);
    assert!(initial.start.positions.iter().all(|x| x.y == 0.5));
    assert!(
        initial
            .all_boundary()
            .iter()
            .all(|x| (x.y - 0.5).abs() < 1e-12)
    );
}

#[test]
fn water_of_any_shape_is_on_the_lattice() {
    let wedge = "[[water]]\nkind = \"vertices\"\nvertices = [[0,0,0.5],[0.5,0,0.5],[0,0,0.9],[0,0.9,0.5],[0.5,0.9,0.5],[0,0.9,0.9]]\n";
    let initial = Initial::of(&tank(wedge).unwrap());
    let count = initial.start.positions.len() - 8000;
    let volume = count as f64 * DX.powi(3);
    assert_relative(volume, 0.5 * 0.4 * 0.5 * 0.9, 0.1);
    let aligned = |x: &DVec3| (0..3).all(|a| is_on_lattice(x[a], 0.0));
    assert!(initial.start.positions.iter().all(aligned));
}

#[test]
fn invalid_water_is_refused() {
    let water = |keys: &str| tank(&format!("[[water]]\n{keys}\n")).unwrap();
    for (keys, parts) in [
        (
            "kind = \"box\"\nsize = [0.2, 0.2, 0.2]\nposition = [1, 0.5, 0.5]",
            ["water[1]", "overlaps other water"],
        ),
        (
            "kind = \"box\"\nsize = [0.2, 0.2, 0.2]\nposition = [1, 0.5, 1.0]",
            ["water[1]", "cut it, or enlarge the domain"],
        ),
        (
            "kind = \"box\"\nsize = [0.01, 0.01, 0.01]\nposition = [1, 0.5, 0.9]",
            ["water[1]", "no particle"],
        ),
    ] {
        let words = error_of(&water(keys));
        assert!(parts.iter().all(|part| words.contains(part)), "{words}");
    }
    let tilted = tank("").unwrap();
    let mut open = tilted.clone();
    open.boundaries.x_max = riprap::scene::Boundary::Open;
    let words = error_of(&open);
    assert!(words.contains("touches the open face x_max"), "{words}");
}

#[test]
fn bodies_of_water_may_touch() {
    let above = "[[water]]\nkind = \"box\"\nsize = [0.5, 1.0, 0.2]\nposition = [0.25, 0.5, 0.6]\n";
    let initial = Initial::of(&tank(above).unwrap());
    assert_eq!(initial.start.positions.len(), 8000 + 10 * 20 * 4);
}

#[test]
fn water_that_rests_on_water_adds_to_its_pressure() {
    let level = |initial: &Initial, level: &dyn Fn(DVec3) -> f64| {
        for (x, p) in initial.start.positions.iter().zip(&initial.start.pressures) {
            let exact = 1000.0 * 9.81 * (level(*x) - x.z);
            assert!((p - exact).abs() < 1e-9 * 7848.0, "{x}: {p} {exact}");
        }
    };
    let all = "[[water]]\nkind = \"box\"\nsize = [2.0, 1.0, 0.3]\nposition = [1.0, 0.5, 0.65]\n";
    let mut stacked = tank(all).unwrap();
    level(&Initial::of(&stacked), &|_| 0.8);
    stacked.water.swap(0, 1);
    level(&Initial::of(&stacked), &|_| 0.8);
    // A column adds to the pressure below it, through a block as well.
    let column = "[[water]]\nkind = \"box\"\nsize = [0.5, 1.0, 0.2]\nposition = [0.25, 0.5, 0.6]\n";
    let below = |x: DVec3| if x.x < 0.5 { 0.7 } else { 0.5 };
    level(&Initial::of(&tank(column).unwrap()), &below);
    let slab = "[[blocks]]\nname = \"b\"\nkind = \"box\"\nsize = [0.2, 1.0, 0.1]\nposition = [0.2, 0.5, 0.25]\n";
    let initial = Initial::of(&tank(&format!("{column}{slab}")).unwrap());
    assert!(initial.start.positions.len() < 8800);
    level(&initial, &below);
    // Adjacent water adds nothing.
    let mut step = tank("").unwrap();
    let shape = |size| riprap::scene::BlockShape::Box { size };
    step.water.push(step.water[0].clone());
    step.water[0].shape = shape([1.0, 1.0, 0.8]);
    step.water[0].position = [0.5, 0.5, 0.4];
    step.water[1].shape = shape([1.0, 1.0, 0.2]);
    step.water[1].position = [1.5, 0.5, 0.1];
    level(&Initial::of(&step), &|x| if x.x < 1.0 { 0.8 } else { 0.2 });
}
