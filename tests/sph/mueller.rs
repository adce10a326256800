//! The scheme of Müller, Charypar & Gross (2003) and Geraili Mikola & Sitar (2014) against its twin in f64 and SI.

use crate::{
    step::noise_vector,
    tank::{Tank, lattice, resting},
    twin::{Spring, penalty, wrench},
};
use glam::{DQuat, DVec3};
use kit::{Random, Rig, assert_contains};
use riprap::{
    geometry::{Polyhedron, Pose, Shape},
    sph::{Body, NeighbourSearch, Scheme, Setup, Side, Solid, SphSolver, Water},
};
use std::f64::consts::PI;

const VISCOSITY: f64 = 0.02;

struct Twin<'a> {
    setup: &'a Setup,
    poses: &'a [Pose],
}

impl Twin<'_> {
    /// Support of the kernels.
    fn support(&self) -> f64 {
        2.0 * self.setup.smoothing * self.setup.spacing
    }

    fn mass(&self) -> f64 {
        let power = if self.setup.plane { 2 } else { 3 };
        self.setup.density * self.setup.spacing.powi(power)
    }

    fn poly6(&self, r: f64) -> f64 {
        let h = self.support();
        let scale = if self.setup.plane {
            4.0 / (PI * h.powi(8))
        } else {
            315.0 / (64.0 * PI * h.powi(9))
        };
        scale * (h * h - r * r).max(0.0).powi(3)
    }

    /// Gradient of the spiky function and Laplacian of the viscosity function.
    fn spiky(&self, r: DVec3) -> (DVec3, f64) {
        let (h, d) = (self.support(), r.length());
        if d >= h || d == 0.0 {
            return (DVec3::ZERO, 0.0);
        }
        let [gradient, laplacian] = if self.setup.plane {
            [30.0 / (PI * h.powi(5)), 40.0 / (PI * h.powi(5))]
        } else {
            [45.0 / (PI * h.powi(6)); 2]
        };
        (-gradient * (h - d).powi(2) * r / d, laplacian * (h - d))
    }

    /// Acceleration by the penalty force of a body: frequency c/(2Δx), half of critical damping.
    fn penalty(&self, body: usize, x: DVec3, v: DVec3) -> DVec3 {
        let omega = 0.5 * self.setup.sound_speed / self.setup.spacing;
        let spring = Spring {
            stiffness: omega.powi(2),
            damping: omega,
        };
        let solids = self.setup.bodies[body].solids.iter();
        let accelerations = solids.map(|solid| penalty(spring, &self.poses[body], solid, x, v));
        accelerations.sum()
    }

    /// Velocities after `dt`, and the force of each particle on the body.
    fn step(&self, water: &Water, body: usize, dt: f64) -> (Vec<DVec3>, Vec<f64>, Vec<DVec3>) {
        let (m, c2) = (self.mass(), self.setup.sound_speed.powi(2));
        let x = &water.positions;
        let v: Vec<DVec3> = water.velocities.iter().map(|v| v.as_dvec3()).collect();
        let rho: Vec<f64> = x
            .iter()
            .map(|a| x.iter().map(|b| m * self.poly6((*a - *b).length())).sum())
            .collect();
        let p = |n: usize| c2 * (rho[n] - self.setup.density);
        let (mut new_velocities, mut forces) = (Vec::new(), Vec::new());
        for i in 0..x.len() {
            let mut f = DVec3::ZERO;
            for j in 0..x.len() {
                let (gradient, laplacian) = self.spiky(x[i] - x[j]);
                f -= m * (p(i) + p(j)) / (2.0 * rho[j]) * gradient;
                f += self.setup.density * VISCOSITY * m * (v[j] - v[i]) / rho[j] * laplacian;
            }
            let mut a = f / rho[i] + self.setup.gravity;
            for other in 0..self.poses.len() {
                a += self.penalty(other, x[i], v[i]);
            }
            new_velocities.push(v[i] + a * dt);
            forces.push(-m * self.penalty(body, x[i], v[i]));
        }
        (new_velocities, rho, forces)
    }
}

fn check(plane: bool) {
    let spacing = 0.1;
    let size = if plane {
        DVec3::new(1.2, 0.4, 1.0)
    } else {
        DVec3::new(0.9, 0.9, 0.8)
    };
    let middle = 0.5 * size;
    let half = if plane {
        DVec3::new(0.2, 0.4, 0.15)
    } else {
        DVec3::splat(0.17)
    };
    let cube = |half: DVec3| Shape::from(Polyhedron::cuboid(2.0 * half).unwrap());
    let mut noise = Random(11);
    let setup = |neighbours| {
        let mut setup = Setup::tank(size, spacing, 20.0);
        setup.plane = plane;
        setup.smoothing = 1.3;
        setup.neighbours = neighbours;
        setup.batched_neighbours = neighbours == NeighbourSearch::Cells;
        setup.scheme = Scheme::Mueller {
            viscosity: VISCOSITY,
        };
        setup.faces[2][1] = Side::Open;
        let body = |half, loaded| Body {
            solids: Solid::parts(&cube(half)),
            moves: loaded,
            loaded,
            ..Body::default()
        };
        setup.bodies = vec![
            body(0.5 * size + DVec3::splat(0.3), false),
            body(half, true),
        ];
        setup
    };
    // The floor is the upper face of a box below the tank.
    let floor = resting(DVec3::new(middle.x, middle.y, -0.5 * size.z - 0.3));
    let block = Pose::rigid(
        middle,
        DQuat::from_rotation_y(0.3),
        DVec3::new(0.4, 0.0, -0.1),
        DVec3::new(0.0, 0.6, 0.0),
    );
    let poses = [floor, block];
    let cells = (size / spacing).round().to_array().map(|n| n as i32);
    let one = setup(NeighbourSearch::Cells);
    let positions: Vec<DVec3> = lattice(&one, [0; 3], [cells[0], cells[1], cells[2] - 2])
        .into_iter()
        .map(|x| x + 0.03 * noise_vector(&mut noise, plane) - 0.05 * DVec3::Z)
        .collect();
    let velocities: Vec<DVec3> = positions
        .iter()
        .map(|_| 0.5 * noise_vector(&mut noise, plane))
        .collect();
    for neighbours in [NeighbourSearch::Cells, NeighbourSearch::Lists] {
        let setup = setup(neighbours);
        let pressures = vec![0.0; positions.len()];
        let mut tank = Tank::moving(
            setup.clone(),
            poses.to_vec(),
            &positions,
            &velocities,
            &pressures,
        );
        let before = tank.water();
        let dt = 0.5 * tank.particles.step_limit();
        let done = tank.advance(dt);
        assert_eq!(done.steps, 1);
        let after = tank.water();
        let twin = Twin {
            setup: &setup,
            poses: &poses,
        };
        let (new_velocities, rho, forces) = twin.step(&before, 1, dt);
        let (mut dv, mut drho, mut dx, mut most) = (0.0f64, 0.0f64, 0.0f64, 0.0f64);
        for n in 0..after.len() {
            dv = dv.max((after.velocities[n].as_dvec3() - new_velocities[n]).length());
            most = most.max((new_velocities[n] - before.velocities[n].as_dvec3()).length());
            drho = drho.max((after.densities[n] - rho[n]).abs());
            let expected = before.positions[n] + new_velocities[n] * dt;
            dx = dx.max((after.positions[n] - expected).length());
        }
        let levers: Vec<DVec3> = before.positions.iter().map(|x| *x - block.centre).collect();
        let width = if plane { size.y } else { 1.0 };
        let (force, moment) = wrench(&forces, &levers);
        let load = done.loads[1];
        let scale: f64 = forces.iter().map(|f| width * f.length()).sum();
        println!(
            "dv {dv:.1e} of {most:.1e}, drho {drho:.1e}, dx {dx:.1e}, {} {}",
            load.force,
            width * force
        );
        assert!(scale > 0.0, "water inside the block");
        assert!(dv < 1e-5 * most && drho < 1e-2 && dx < 1e-5 * spacing);
        assert!((load.force - width * force).length() < 1e-4 * scale);
        let miss = (load.moment - width * moment).to_cols_array();
        let worst = miss.into_iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        assert!(worst < 1e-4 * scale * 0.2, "{worst}");
    }
}

#[test]
fn a_step_in_a_plane() {
    check(true);
}

#[test]
fn a_step_in_space() {
    check(false);
}

/// Invocations of software adapters end loops after 65 535 iterations; each of these would need 200 times 1200.
#[test]
fn loads_of_many_parts_and_particles_are_complete() {
    let mut noise = Random(5);
    let mut setup = Setup::tank(DVec3::new(16.0, 0.1, 8.0), 0.1, 20.0);
    setup.plane = true;
    setup.smoothing = 1.3;
    setup.scheme = Scheme::Mueller {
        viscosity: VISCOSITY,
    };
    let solid = |_| Solid::Sphere {
        centre: noise_vector(&mut noise, true) * DVec3::new(7.5, 0.0, 3.5),
        radius: 0.15,
    };
    setup.bodies = vec![Body {
        solids: (0..400).map(solid).collect(),
        moves: true,
        loaded: true,
        ..Body::default()
    }];
    let poses = [resting(0.5 * setup.size)];
    let positions = lattice(&setup, [0; 3], [160, 1, 80]);
    let mut tank = Tank::new(setup.clone(), poses.to_vec(), &positions, |_| 0.0);
    let dt = 0.5 * tank.particles.step_limit();
    let done = tank.advance(dt);
    assert_eq!(done.steps, 1);
    let twin = Twin {
        setup: &setup,
        poses: &poses,
    };
    let force = |x: &DVec3| -setup.particle_mass() * twin.penalty(0, *x, DVec3::ZERO);
    let forces: Vec<DVec3> = positions.iter().map(force).collect();
    let force: DVec3 = forces.iter().sum();
    let scale: f64 = forces.iter().map(|f| f.length()).sum();
    let miss = (done.loads[0].force - force).length();
    println!("{} {force}, of {scale} N in all", done.loads[0].force);
    assert!(miss < 1e-4 * scale, "{miss} of {scale} N");
}

/// The adapter would end the loops without an error.
#[test]
fn more_parts_than_a_software_adapter_can_loop_over_are_refused() {
    let rig = Rig::new();
    if rig.device.adapter_info().device_type != riprap::wgpu::DeviceType::Cpu {
        return;
    }
    let sphere = Solid::Sphere {
        centre: DVec3::ZERO,
        radius: 0.1,
    };
    let mut setup = Setup::tank(DVec3::ONE, 0.1, 20.0);
    setup.bodies = vec![Body {
        solids: vec![sphere; 20_000],
        ..Body::default()
    }];
    let result = SphSolver::new(&rig.device, &rig.queue, setup, &[], &[], &[]);
    let message = result.unwrap_err().to_string();
    assert_contains(&message, &["20000 convex parts", "use a GPU"]);
}
