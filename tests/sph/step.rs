//! A step of the device against its twin.

use crate::{
    tank::{Tank, lattice, resting, walls},
    twin::{BoundaryParticle, FluidParticle, Twin, wrench},
};
use glam::{DMat3, DQuat, DVec3};
use kit::{Random, Rig, assert_near};
use riprap::{
    geometry::{HalfSpace, Polyhedron, Pose},
    sph::{Body, EquationOfState, Faces, NeighbourSearch, Setup, Side, Solid},
};

/// A vector of −1..1, in the plane if there is one.
pub fn noise_vector(noise: &mut Random, plane: bool) -> DVec3 {
    let v = noise.vector();
    if plane { DVec3::new(v.x, 0.0, v.z) } else { v }
}

fn base(plane: bool, periodic: bool) -> Setup {
    let spacing = 0.1;
    let size = if plane {
        DVec3::new(1.3, 0.7, 1.1)
    } else {
        DVec3::new(1.3, 1.3, 0.9)
    };
    let mut setup = Setup::tank(size, spacing, 20.0);
    setup.origin = DVec3::new(-3.0, 0.2, 5.0);
    setup.plane = plane;
    setup.smoothing = if plane { 1.7 } else { 1.5 };
    if periodic {
        setup.faces[0] = [Side::Periodic; 2];
        if !plane {
            setup.faces[1] = [Side::Periodic; 2];
        }
    }
    setup.faces[2][1] = Side::Open;
    setup
}

/// One step of disturbed water with walls and a rotated body of boundary particles.
fn check(setup: Setup) {
    for neighbours in [NeighbourSearch::Cells, NeighbourSearch::Lists] {
        for batched in [false, true] {
            let mut setup = setup.clone();
            (setup.neighbours, setup.batched_neighbours) = (neighbours, batched);
            check_with(setup);
        }
    }
}

/// A cylinder in a plane, or a cube of two halves with a sphere at its side, m.
fn solids(plane: bool) -> Vec<Solid> {
    let sphere = |x: f64| Solid::Sphere {
        centre: DVec3::X * x,
        radius: 0.15,
    };
    if plane {
        return vec![sphere(0.0)];
    }
    let cube = Polyhedron::cuboid(DVec3::splat(0.3)).unwrap();
    let half = |side: f64| {
        Solid::Faces(Faces {
            centre: DVec3::ZERO,
            radius: cube.radius(),
            exposed: cube
                .faces()
                .iter()
                .filter(|face| face.normal.x * side < 0.5)
                .copied()
                .collect(),
            internal: vec![HalfSpace {
                normal: side * DVec3::X,
                distance: 0.0,
            }],
        })
    };
    vec![half(-1.0), half(1.0), sphere(0.1)]
}

/// A symmetric matrix for the boundary particle at `x`, m³.
fn strain_area(x: &DVec3) -> DMat3 {
    let v = *x + DVec3::new(0.1, 0.2, -0.05);
    DMat3::from_cols(v * v.x, v * v.y, v * v.z) * 0.1
}

fn check_with(setup: Setup) {
    let plane = setup.plane;
    let mut setup = setup;
    let mut noise = Random(7);
    let middle = setup.origin + 0.5 * setup.size;
    // In a plane the body moves; in space it is fixed and repels the water inside it.
    let speed = if plane { 1.0 } else { 0.0 };
    let pose = Pose {
        centre: middle,
        ..Pose::rigid(
            middle,
            DQuat::from_rotation_y(0.4),
            speed * DVec3::new(0.3, 0.0, -0.2),
            speed * DVec3::new(0.0, 0.5, 0.0),
        )
    };
    let mut block = Vec::new();
    for k in -1..2 {
        for i in -1..2 {
            for j in if plane { 0..1 } else { -1..2 } {
                block.push(0.1 * DVec3::new(f64::from(i), f64::from(j), f64::from(k)));
            }
        }
    }
    let fixed = walls(&setup);
    // Walls are no-slip in space, and free-slip in a plane.
    let free_slip = plane;
    setup.bodies = vec![
        Body { free_slip, ..fixed },
        Body {
            boundary: block.clone(),
            solids: solids(plane),
            moves: plane,
            loaded: true,
            // The body deforms in space.
            strain_areas: block.iter().filter(|_| !plane).map(strain_area).collect(),
            ..Body::default()
        },
    ];
    let cells = (setup.size / setup.spacing)
        .round()
        .to_array()
        .map(|n| n as i32);
    let mut sites = lattice(&setup, [0; 3], [cells[0], cells[1], cells[2] - 2]);
    sites.retain(|x| (*x - middle).abs().max_element() > 0.3 || noise.between(-1.0, 1.0) > 0.5);
    let positions: Vec<DVec3> = sites
        .iter()
        .map(|x| *x + 0.01 * noise_vector(&mut noise, plane))
        .collect();
    let velocities: Vec<DVec3> = sites
        .iter()
        .map(|_| 0.5 * noise_vector(&mut noise, plane))
        .collect();
    let pressures: Vec<f64> = sites
        .iter()
        .map(|x| 9810.0 * (setup.origin.z + setup.size.z - x.z) + 500.0 * noise.between(-1.0, 1.0))
        .collect();
    let poses = vec![resting(DVec3::ZERO), pose];
    let mut tank = Tank::moving(
        setup.clone(),
        poses.clone(),
        &positions,
        &velocities,
        &pressures,
    );
    let before = tank.water();
    assert_eq!(before.len(), positions.len());
    let water: Vec<FluidParticle> = (0..before.len())
        .map(|n| FluidParticle {
            x: before.positions[n],
            v: before.velocities[n].as_dvec3(),
            rho: before.densities[n],
        })
        .collect();
    let inside = |particle: &&FluidParticle| (particle.x - middle).abs().max_element() < 0.12;
    assert!(water.iter().filter(inside).count() > 0);
    let mut boundary: Vec<BoundaryParticle> = setup.bodies[0]
        .boundary
        .iter()
        .map(|x| BoundaryParticle {
            x: *x,
            v: DVec3::ZERO,
            a: DVec3::ZERO,
            free_slip,
        })
        .collect();
    let first = boundary.len();
    boundary.extend(block.iter().map(|x| BoundaryParticle {
        x: pose.point(*x),
        v: pose.point_velocity(*x),
        a: DVec3::ZERO,
        free_slip: false,
    }));
    let dt = 0.9 * tank.particles.step_limit();
    // In the water, in the body, above the water and far away.
    let above = setup.origin + setup.size * DVec3::new(0.5, 0.5, 0.95);
    let in_water = [positions[0], positions[7], middle, above, DVec3::splat(1e4)];
    // Full coverage by more, and by less, water than there is.
    let on_walls = [(positions[0], 2.0), (positions[7], 0.1), (middle, 0.7)];
    let Rig { device, queue } = &tank.rig;
    let probes = tank
        .particles
        .set_probes(device, queue, &in_water, &on_walls);
    probes.unwrap();
    let done = tank.advance(dt);
    assert_eq!(done.steps, 1);
    let after = tank.water();
    let twin = Twin(&setup, &poses);
    let exact = twin.step(&water, &boundary, dt);
    let change = |a: f64, b: f64| (a - b).abs();
    let (mut dv, mut drho, mut dx, mut most) = (0.0f64, 0.0f64, 0.0f64, [0.0f64; 2]);
    for n in 0..after.len() {
        dv = dv.max((after.velocities[n].as_dvec3() - exact.water[n].v).length());
        drho = drho.max(change(after.densities[n], exact.water[n].rho));
        let mut miss = after.positions[n] - exact.water[n].x;
        for axis in 0..3 {
            miss[axis] -= setup.size[axis] * (miss[axis] / setup.size[axis]).round();
        }
        dx = dx.max(miss.length());
        most[0] = most[0].max((exact.water[n].v - water[n].v).length());
        most[1] = most[1].max(change(exact.water[n].rho, water[n].rho));
    }
    let probes = in_water.iter().map(|x| (x, 0.0));
    let probes = probes.chain(on_walls.iter().map(|(x, fraction)| (x, *fraction)));
    for ((x, fraction), found) in probes.zip(&done.pressures) {
        // The tolerance covers the rounding of positions to quanta.
        let at = BoundaryParticle {
            x: *x,
            v: DVec3::ZERO,
            a: DVec3::ZERO,
            free_slip: true,
        };
        let covered = if fraction > 0.0 {
            (twin.water_fraction(&water, *x) / fraction).min(1.0)
        } else {
            1.0
        };
        let expected = covered * twin.wall_pressure(&water, &at);
        assert!(
            change(*found, expected) < 1e-4 * 1e4,
            "{found} {expected} at {x}"
        );
    }
    assert!(done.pressures[..3].iter().all(|p| *p > 0.0));
    assert_eq!(done.pressures[4], 0.0);
    let limit = tank.particles.step_limit();
    let levers: Vec<DVec3> = block.iter().map(|x| pose.deformation * *x).collect();
    let width = if plane { setup.size.y } else { 1.0 };
    let (force, moment) = wrench(&exact.forces[first..], &levers);
    let (force, mut moment) = (width * force, moment * width);
    if !plane {
        let strain = block.iter().zip(&boundary[first..]).map(|(x, particle)| {
            let area = pose.deformation * strain_area(x) * pose.deformation.transpose();
            area * -twin.wall_pressure(&water, particle)
        });
        let strain = strain.fold(DMat3::ZERO, |sum, part| sum + part);
        moment = strain + (moment - moment.transpose()) * 0.5;
    }
    let load = done.loads[1];
    println!(
        "dv {dv:.2e} of {:.2e}, drho {drho:.2e} of {:.2e}, dx {dx:.2e}, limit {limit:.6e} {:.6e}, force {} {force}",
        most[0], most[1], exact.step_limit, load.force
    );
    // Sums of a hundred terms in f32, each with a rounding error of 6e-8, that cancel to a tenth.
    assert!(dv < 2e-6 * most[0].max(setup.sound_speed * 1e-2), "{dv}");
    assert!(drho < 1e-5 * most[1], "{drho}");
    assert!(dx < 1e-6 * setup.spacing, "{dx}");
    assert!(change(limit, exact.step_limit) < 1e-5 * exact.step_limit);
    let scale: f64 = exact.forces[first..]
        .iter()
        .map(|f| width * f.length())
        .sum();
    assert!((load.force - force).length() < 1e-5 * scale);
    let miss = load.moment - moment;
    let worst = miss
        .to_cols_array()
        .into_iter()
        .fold(0.0, |a: f64, b| a.max(b.abs()));
    assert!(worst < 1e-5 * scale * 0.2, "{worst}");
    assert_eq!(done.loads[0].moment, DMat3::ZERO);
    let works = tank.particles.work();
    let end = pose.after(dt);
    let bodies = -done.loads[1].work(&pose, &end);
    // Products of pressure, velocity and step, whose signs vary.
    let scale = scale * 0.5 * dt;
    for (found, expected) in [
        (works.boundary, width * exact.boundary_work),
        (works.penalty, width * exact.penalty_work),
        (works.bodies, bodies),
    ] {
        println!("work {found:.6e} {expected:.6e} of {scale:.2e}");
        assert!(change(found, expected) < 1e-5 * scale, "{found} {expected}");
    }
    // In a plane the body moves; in space it is fixed and repels the water inside it.
    assert!((works.bodies != 0.0) == plane && (works.penalty.abs() > 1e-3 * scale) != plane);
    assert!(works.boundary.abs() > 1e-3 * scale);
}

#[test]
fn in_space() {
    check(base(false, false));
    check(base(false, true));
}

#[test]
fn in_a_plane() {
    check(base(true, false));
    check(base(true, true));
}

#[test]
fn with_the_equation_of_state_of_tait() {
    let mut setup = base(true, false);
    setup.equation_of_state = EquationOfState::Tait;
    check(setup);
}

#[test]
fn with_laminar_viscosity() {
    // In space viscosity bounds the step, in a plane sound does.
    for (plane, laminar_viscosity) in [(false, 3.0), (true, 0.5)] {
        let mut setup = base(plane, true);
        setup.laminar_viscosity = laminar_viscosity;
        check(setup);
    }
}

#[test]
fn lists_grow_where_particles_are_dense() {
    // Three times as many particles as on the lattice, at zero pressure.
    let mut setup = base(true, false);
    setup.bodies = vec![walls(&setup)];
    let sites = lattice(&setup, [0; 3], [13, 1, 9]);
    let mut noise = Random(3);
    let positions: Vec<DVec3> = (0..3)
        .flat_map(|_| {
            sites
                .iter()
                .map(|x| *x + 0.03 * noise_vector(&mut noise, true))
                .collect::<Vec<_>>()
        })
        .collect();
    let results = [NeighbourSearch::Lists, NeighbourSearch::Cells].map(|neighbours| {
        let mut setup = setup.clone();
        setup.neighbours = neighbours;
        let mut tank = Tank::new(setup, vec![resting(DVec3::ZERO)], &positions, |_| 0.0);
        let time = 0.9 * tank.particles.step_limit();
        assert_eq!(tank.advance(time).steps, 1);
        tank.water()
    });
    let [lists, cells] = [&results[0], &results[1]];
    for n in 0..lists.len() {
        assert!((lists.velocities[n] - cells.velocities[n]).length() < 1e-5);
        assert_near(lists.densities[n], cells.densities[n], 1e-3);
    }
}

/// A block moves through sloshing water and jumps: the lists contain all neighbours throughout their validity.
#[test]
fn lists_are_valid_for_several_steps() {
    let mut setup = base(true, true);
    // Short steps, so that a list is valid for many.
    setup.courant = 0.2;
    let middle = setup.origin + 0.5 * setup.size;
    let grid = [-0.15, -0.05, 0.05, 0.15];
    let block = grid.map(|x| grid.map(|z| DVec3::new(x, 0.0, z))).concat();
    setup.bodies = vec![
        walls(&setup),
        Body {
            boundary: block,
            moves: true,
            loaded: true,
            ..Body::default()
        },
    ];
    let mut positions = lattice(&setup, [0; 3], [13, 1, 9]);
    positions.retain(|x| (*x - middle).abs().max_element() > 0.24);
    let velocities: Vec<DVec3> = positions
        .iter()
        .map(|x| DVec3::new(0.4 * (x.z - middle.z), 0.0, 0.3 * (x.x - middle.x).sin()))
        .collect();
    let depth = |x: &DVec3| setup.origin.z + 0.9 - x.z;
    let pressures: Vec<f64> = positions.iter().map(|x| 9810.0 * depth(x)).collect();
    let results = [NeighbourSearch::Lists, NeighbourSearch::Cells].map(|neighbours| {
        let mut setup = setup.clone();
        setup.neighbours = neighbours;
        let mut tank = Tank::moving(setup, Vec::new(), &positions, &velocities, &pressures);
        let (mut sorts, mut steps, mut time, mut load) = (0, 0, 0.0, DVec3::ZERO);
        for n in 0..60 {
            let dt = 0.99 * tank.particles.step_limit();
            let velocity = DVec3::new(0.3, 0.0, 0.1);
            let mut pose = Pose::rigid(
                middle + time * velocity,
                DQuat::from_rotation_y(0.5 * time),
                velocity,
                DVec3::new(0.0, 0.5, 0.0),
            );
            if n >= 30 {
                pose.centre.x += 0.02;
            }
            tank.poses = vec![resting(DVec3::ZERO), pose];
            let done = tank.advance(dt);
            (sorts, steps, time) = (sorts + done.sorts, steps + done.steps, time + dt);
            load += done.loads[1].force / 60.0;
        }
        println!("{neighbours:?}: {sorts} sorts in {steps} steps, {load} N");
        let uses_lists = neighbours == NeighbourSearch::Lists;
        assert!(if uses_lists {
            4 * sorts < steps
        } else {
            sorts == steps
        });
        (tank.water(), load)
    });
    let [(lists, by_lists), (cells, by_cells)] = [&results[0], &results[1]];
    assert!((*by_lists - *by_cells).length() < 1e-4 * by_cells.length());
    for n in 0..lists.len() {
        let miss = (lists.positions[n] - cells.positions[n]).length();
        assert!(miss < 1e-4 * setup.spacing, "{n}: {miss}");
    }
}
