//! Films of fluid between blocks that nearly touch: lubrication, without a fluid solver.

use crate::fixture::{assert_restarts, blocks, cuboid, floor, joint, run, setup};
use glam::{DQuat, DVec3};
use kit::{assert_near, assert_relative};
use riprap::{
    geometry::Shape,
    rock::{
        Block, Blocks, Setup,
        law::{Film, LoadDelay},
    },
};
use std::f64::consts::PI;

fn film(viscosity: f64) -> Film {
    Film {
        viscosity,
        round: 0.1,
        flat: 0.1,
        roughness: 1e-4,
        delay: None,
        slip: Vec::new(),
    }
}

fn with_film(list: Vec<Block>, viscosity: f64, time_step: f64) -> Setup {
    Setup {
        film: Some(film(viscosity)),
        time_step: Some(time_step),
        ..setup(list, joint(1e6, 30.0))
    }
}

fn ball(name: &str, radius: f64, at: DVec3) -> Block {
    Block::new(name, Shape::sphere(radius).expect("a radius"), at)
}

fn momentum(blocks: &Blocks) -> [DVec3; 2] {
    let mut sums = [DVec3::ZERO; 2];
    for (k, pose) in blocks.poses().iter().enumerate() {
        let linear = blocks.mass(k) * pose.velocity;
        sums[0] += linear;
        sums[1] += blocks.angular_momentum(k) + pose.centre.cross(linear);
    }
    sums
}

/// Under its weight W a sphere sinks at W/c(h): 6πμR² [ln(h₁/h) − (h₁ − h)/h₀] = W t; a plate with the torsion constant J:
/// 3μJ [(h⁻² − h₁⁻²)/2 − (h₁ − h)/h₀³] = W t. The film is so viscous that its time constant, m/c, is far below the step.
#[test]
fn blocks_sink_onto_a_floor_as_lubrication_says() {
    let floor = || Block::new("floor", cuboid(20.0, 20.0, 1.0), -0.5 * DVec3::Z).fixed();
    let (start, end) = (0.08, 5e-3);
    let viscosity = [2e6, 2e3];
    let (range, weight) = (0.1f64, 9.81 * 2500.0);
    let ball = ball("ball", 1.0, DVec3::Z * (1.0 + start));
    let sphere = 6.0 * PI * viscosity[0] * ((start / end).ln() - (start - end) / range);
    let times = [sphere / (weight * 4.0 / 3.0 * PI), {
        let torsion = 1.0 / (4.0 * PI * PI / 6.0);
        let inverse = 0.5 * (end.powi(-2) - start.powi(-2)) - (start - end) / range.powi(3);
        3.0 * viscosity[1] * torsion * inverse / (weight * 0.5)
    }];
    let plate = Block::new("plate", cuboid(1.0, 1.0, 0.5), DVec3::Z * (0.25 + start));
    for (((block, half), time), viscosity) in [(ball, 1.0), (plate, 0.25)]
        .into_iter()
        .zip(times)
        .zip(viscosity)
    {
        let name = block.name.clone();
        let mut blocks = blocks(with_film(vec![block, floor()], viscosity, time / 4000.0));
        run(&mut blocks, time);
        let gap = blocks.poses()[0].centre.z - half;
        assert!((gap / end - 1.0).abs() < 5e-3, "{name}: {gap} of {end}");
        let load = blocks.film_forces()[0].z;
        let share = load / (blocks.mass(0) * 9.81);
        assert!((share - 1.0).abs() < 1e-3, "{name}: carries {share} of it");
    }
}

#[test]
fn a_film_takes_energy_and_neither_momentum_nor_more_than_there_is() {
    // A ball and two spinning cubes that pass close by each other, all free.
    let mut cube = Block::new("cube", cuboid(1.0, 1.0, 1.0), DVec3::X * 1.04);
    cube.spin = DVec3::new(0.0, 0.01, -0.02);
    cube.velocity = DVec3::new(-0.02, 0.01, 0.0);
    let mut other = Block::new("other", cuboid(1.0, 1.0, 1.0), DVec3::ZERO);
    other.spin = DVec3::X * 0.1;
    let mut ball = ball("ball", 0.5, DVec3::new(1.0, 0.0, 1.06));
    ball.velocity = DVec3::Z * -0.05;
    let list = vec![other, cube, ball];
    for viscosity in [1.0, 1e3, 1e9] {
        let mut blocks = blocks(Setup {
            gravity: DVec3::ZERO,
            ..with_film(list.clone(), viscosity, 1e-3)
        });
        let (start, carried) = (blocks.ledger(), momentum(&blocks));
        run(&mut blocks, 0.3);
        let end = blocks.ledger();
        for (now, before) in momentum(&blocks).into_iter().zip(carried) {
            assert!(
                (now - before).length() < 1e-11 * before.length(),
                "{now} {before}"
            );
        }
        assert!(end.film > 0.0 && end.kinetic < start.kinetic, "{end:?}");
        // The energy taken by the film is the energy lost, by the trapezoidal rule of the ledger.
        let error = (end.balance() - start.balance()).abs();
        assert!(error < 1e-3 * end.film, "{viscosity}: {error} J of {end:?}");
    }
}

/// A row of plates above a floor, each on a film: the lowest film carries the weight of all.
#[test]
fn films_in_a_row_carry_what_is_above_them() {
    let mut list = vec![floor()];
    for k in 0..5 {
        let z = 0.03 + 0.53 * f64::from(k) + 0.25;
        list.push(Block::new(
            format!("{k}"),
            cuboid(2.0, 2.0, 0.5),
            DVec3::Z * z,
        ));
    }
    let setup = with_film(list, 1e8, 1e-3);
    let mut blocks = blocks(setup.clone());
    run(&mut blocks, 0.02);
    let carried = blocks.film_forces()[0].z;
    let snapshot = blocks.snapshot();
    let mut again = Blocks::new(setup).unwrap();
    again.restore(&snapshot).unwrap();
    assert_eq!(again.film_forces(), blocks.film_forces());
    let weight = 5.0 * blocks.mass(1) * 9.81;
    assert_relative(-carried, weight, 1e-3);
    // Each gap closes at the velocity given by its load over its resistance.
    let torsion = 16.0 * 16.0 / (4.0 * PI * PI * 16.0 / 6.0);
    let resistance = 3.0 * 1e8 * torsion * (0.03f64.powi(-3) - 0.1f64.powi(-3));
    let poses = blocks.poses();
    for k in 1..6 {
        let closing = poses[k - 1].velocity.z - poses[k].velocity.z;
        let expected = blocks.mass(1) * 9.81 * (6 - k) as f64 / resistance;
        assert!(
            (closing / expected - 1.0).abs() < 1e-2,
            "{k}: {closing} of {expected}"
        );
    }
}

#[test]
fn faces_that_slip_and_films_that_are_off() {
    let list = |slide: f64| {
        let floor = floor();
        let mut ball = ball("ball", 1.0, DVec3::Z * 1.05);
        ball.velocity = DVec3::new(slide, 0.0, -0.1);
        vec![floor, ball]
    };
    let slowed = |film: Option<Film>| {
        let mut blocks = blocks(Setup {
            film,
            gravity: DVec3::ZERO,
            ..with_film(list(3.0), 1.0, 1e-3)
        });
        run(&mut blocks, 1e-3);
        let velocity = blocks.poses()[1].velocity;
        // The film acts only along the normal.
        assert_eq!(velocity.x, 3.0);
        0.1 + velocity.z
    };
    let stuck = slowed(Some(film(1.0)));
    let slips = slowed(Some(Film {
        slip: vec![0],
        ..film(1.0)
    }));
    assert_near(stuck / slips, 4.0, 1e-3);
    assert_eq!(slowed(None), 0.0);
}

/// Delayed loads: m dv/dt = F − c (v − v̄), dv̄/dt = (v − v̄)/T. Steady motion meets no resistance, and a constant
/// load accelerates the plate by F/(m + c T), after F/m at first.
#[test]
fn a_delay_resists_changes_of_velocity_alone() {
    let delay = LoadDelay {
        impedance: 1e5,
        range: 0.2,
        memory: 0.02,
    };
    let velocities = |gravity: f64, start: f64| {
        let mut plate = Block::new("plate", cuboid(1.0, 1.0, 0.5), DVec3::Z * 0.3);
        plate.velocity = DVec3::Z * start;
        let mut blocks = blocks(Setup {
            film: Some(Film {
                delay: Some(delay),
                ..film(0.0)
            }),
            gravity: DVec3::Z * gravity,
            ..with_film(vec![floor(), plate], 1.0, 2e-5)
        });
        [1e-3, 0.1, 0.2].map(|time| {
            run(&mut blocks, time);
            blocks.poses()[1].velocity.z
        })
    };
    for velocity in velocities(0.0, -0.01) {
        assert_relative(velocity, -0.01, 1e-12);
    }
    let [first, before, after] = velocities(-0.01, 0.0);
    let mass = 0.5 * 2500.0;
    let share = mass / (mass + delay.impedance * delay.memory);
    // c/m + 1/T is 130 1/s: the mean over the first millisecond is lower by 6 %.
    assert_relative(first, -0.01 * 1e-3, 0.06);
    assert_relative((after - before) / 0.1, -0.01 * share, 1e-3);
}

#[test]
fn a_restart_amid_films_gives_the_same_bits() {
    let mut list = vec![floor()];
    for k in 0..3 {
        let at = DVec3::new(0.1 * f64::from(k), 0.0, 0.33 + 0.55 * f64::from(k));
        let tilt = DQuat::from_rotation_x(0.02 * f64::from(k));
        list.push(Block::new(format!("{k}"), cuboid(1.0, 1.0, 0.5), at).rotated(tilt));
    }
    let mut setup = with_film(list, 1e3, 1e-3);
    setup.film.as_mut().expect("a film").delay = Some(LoadDelay {
        impedance: 1e4,
        range: 0.1,
        memory: 0.02,
    });
    let whole = assert_restarts(&setup, 0.05, 0.2);
    assert!(whole.ledger().film > 0.0);
}
