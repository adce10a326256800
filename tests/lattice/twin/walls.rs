//! The f64 twin at its boundaries: walls, solids, mirrors and velocity faces.

#![allow(
    clippy::needless_range_loop,
    reason = "indices are those of the formulas"
)]

use std::f64::consts::{PI, TAU};

use kit::twin::lattice::{OPPOSITE, Q, W, c_dot};
use kit::twin::rates::{moment_rates, odd_rate};
use kit::twin::{
    self, Config, Domain, Equilibrium, Face, Force, OddClass, Operator, Profile, Rates, Twin,
};
use kit::{assert_near, assert_relative, twin::domain::Link};

const REST: Face = Face::Wall([0.0; 3]);

/// Faces that are periodic along x and z.
fn layer(y_min: Face, y_max: Face) -> [Face; 6] {
    [
        Face::Periodic,
        Face::Periodic,
        y_min,
        y_max,
        Face::Periodic,
        Face::Periodic,
    ]
}

/// A velocity field without symmetry.
fn swirl(position: [usize; 3]) -> [f64; 3] {
    let [x, y, z] = position.map(|p| p as f64);
    [
        0.02 * (0.7 * y + 0.3 * z).sin(),
        0.015 * (0.9 * z - 0.4 * x).cos(),
        0.01 * (0.5 * x + 1.1 * y).sin(),
    ]
}

fn start_with_swirl(flow: &mut Twin) {
    let u: Vec<_> = (0..flow.domain.cell_count())
        .map(|cell| swirl(flow.domain.position(cell)))
        .collect();
    flow.start(&vec![1.0; u.len()], &u);
}

/// Plane Poiseuille flow 8 cells across: u − u_exact of each cell over its second derivative F/ν.
fn poiseuille_offset(config: Config) -> [f64; 8] {
    let height = 8.0;
    let acceleration = 8.0 * config.nu() * 1e-4 / (height * height);
    let mut flow = Twin::new(Domain::new([1, 8, 1], layer(REST, REST)), config);
    flow.force = Force::Uniform([acceleration, 0.0, 0.0]);
    // The slowest mode decays as exp(−ν π² t/h²): 25 of its times leave 1e-11.
    let time = height * height / (config.nu() * PI * PI);
    flow.run((25.0 * time) as usize);
    std::array::from_fn(|y| {
        let from_wall = y as f64 + 0.5;
        let exact = 0.5 * from_wall * (height - from_wall);
        flow.macroscopic(y).1[0] * config.nu() / acceleration - exact
    })
}

/// Remainder of the start, and of u² in ρ, in units of u'': U_max is 8 of them.
const STEADY: f64 = 1e-7;

#[test]
fn poiseuille_is_exact_with_lambda_three_sixteenths_at_any_tau() {
    for tau in [0.6, 1.0, 2.0] {
        let exact = Config {
            lambda_everywhere: Some(3.0 / 16.0),
            ..Config::new(tau)
        };
        for offset in poiseuille_offset(exact) {
            assert!(offset.abs() < STEADY, "τ = {tau}: {offset}");
        }
    }
}

#[test]
fn lambda_away_from_the_wall_decides_the_slip_of_the_interior() {
    // Half-way bounce-back displaces the parabola by 2/3 (Λ − 3/16) u''. A cell with another Λ than its neighbours is displaced
    // by its own Λ alone, so that a rule for the wall cells does not change the flow between them.
    let s_odd = 1.6;
    let tau = 1.0;
    let interior = 2.0 / 3.0 * ((1.0 / s_odd - 0.5) * (tau - 0.5) - 3.0 / 16.0);
    for lambda_wall in [3.0 / 16.0, 1.0] {
        let config = Config {
            lambda_wall,
            floors: [0.0; 2],
            rates: Some(Rates {
                s10: s_odd,
                s13: s_odd,
                s23: s_odd,
                s26: s_odd,
                ..Rates::SUGA
            }),
            ..Config::new(tau)
        };
        let wall = 2.0 / 3.0 * (lambda_wall - 3.0 / 16.0);
        for (y, offset) in poiseuille_offset(config).into_iter().enumerate() {
            let expected = if y == 0 || y == 7 { wall } else { interior };
            assert!((offset - expected).abs() < STEADY, "{y}: {offset}");
        }
    }
}

#[test]
fn odd_rates_of_hermite_follow_lambda_and_those_of_suga_do_not() {
    let hermite = Config::new(0.6);
    let s_odd = odd_rate(0.6, 3.0 / 16.0, 0.8);
    let bulk = moment_rates(&hermite, 0.01, OddClass::Bulk);
    let wall = moment_rates(&hermite, 0.01, OddClass::Wall);
    for k in 0..Q {
        let odd = matches!(k, 10..=15 | 23..=26);
        assert_eq!(wall[k], if odd { s_odd } else { bulk[k] }, "moment {k}");
    }
    let suga = Config {
        operator: Operator::Suga,
        lambda_everywhere: Some(0.25),
        ..hermite
    };
    assert_eq!(moment_rates(&suga, 0.01, OddClass::Wall), bulk);
}

#[test]
fn odd_rate_stops_at_its_floor() {
    assert_near(odd_rate(1.0, 0.25, 0.8), 1.0, 1e-15);
    assert_eq!(odd_rate(0.5001, 3.0 / 16.0, 0.8), 0.8);
}

#[test]
fn couette_is_linear_between_wall_and_lid() {
    let (h, lid) = (6, 0.02);
    let faces = layer(REST, Face::Wall([lid, 0.0, 0.0]));
    let mut flow = Twin::new(Domain::new([2, h, 2], faces), Config::new(0.9));
    let mass = |flow: &Twin| flow.density().iter().sum::<f64>();
    let before = mass(&flow);
    flow.run(1500);
    for y in 0..h {
        let exact = lid * (y as f64 + 0.5) / h as f64;
        let u = flow.macroscopic(flow.domain.index([1, y, 0])).1;
        // u² of the equilibrium affects ρ through the bulk rate, which differs from the shear rate.
        assert_near(u[0], exact, 1e-5 * lid);
    }
    // A tangential lid moves no mass.
    assert_near(mass(&flow), before, 1e-11);
}

#[test]
fn velocity_face_reflects_with_the_density_that_results() {
    let faces = [
        Face::Velocity(Profile::Table(
            (0..12)
                .map(|n| [0.01 + 0.001 * f64::from(n), 0.002, -0.003])
                .collect(),
        )),
        REST,
        Face::Wall([0.0, 0.0, 0.04]),
        Face::FreeSlip,
        Face::FreeSlip,
        REST,
    ];
    let mut flow = Twin::new(Domain::new([5, 4, 3], faces), Config::new(0.7));
    start_with_swirl(&mut flow);
    let collided = flow.collided();
    flow.step();
    let mut moving_links = 0;
    for cell in 0..flow.domain.cell_count() {
        let rho = flow.macroscopic(cell).0;
        for i in 0..Q {
            if let Link::Moving(u_w) = flow.domain.link(cell, i) {
                let expected = collided[cell][i] - 6.0 * W[i] * rho * c_dot(i, u_w);
                assert_near(flow.f[cell][OPPOSITE[i]], expected, 1e-16);
                moving_links += 1;
            }
        }
    }
    assert!(moving_links > 100);
    // The table is read with y running faster than z.
    let link = flow.domain.link(flow.domain.index([0, 2, 1]), 2);
    assert_eq!(link, Link::Moving([0.016, 0.002, -0.003]));
}

#[test]
fn uniform_stream_between_velocity_faces_and_mirrors_stays_uniform() {
    // Half-way bounce-back adds 6 w ρ c·u, the exact odd part of the order-2 equilibrium.
    let u = [0.05, 0.0, 0.0];
    let open = || Face::Velocity(Profile::Uniform(u));
    let faces = [
        open(),
        open(),
        Face::FreeSlip,
        Face::FreeSlip,
        Face::FreeSlip,
        Face::FreeSlip,
    ];
    let config = Config {
        equilibrium: Equilibrium::Order2,
        ..Config::new(0.6)
    };
    let mut flow = Twin::new(Domain::new([6, 4, 3], faces), config);
    flow.start(&[1.0; 72], &[u; 72]);
    flow.run(50);
    for cell in 0..72 {
        let (rho, velocity) = flow.macroscopic(cell);
        assert_near(rho, 1.0, 1e-13);
        for axis in 0..3 {
            assert_near(velocity[axis], u[axis], 1e-13);
        }
    }
}

#[test]
fn free_slip_faces_are_mirrors() {
    // An octant between mirrors is one eighth of a box that is periodic and symmetric.
    let n = [4, 3, 5];
    let config = Config::new(0.57);
    let mut octant = Twin::new(Domain::new(n, [const { Face::FreeSlip }; 6]), config);
    let mut whole = Twin::new(Domain::periodic(n.map(|cells| 2 * cells)), config);
    let populations = |flow: &mut Twin| {
        for cell in 0..flow.domain.cell_count() {
            let mut position = flow.domain.position(cell);
            let mut sign = [1.0; 3];
            for axis in 0..3 {
                if position[axis] >= n[axis] {
                    position[axis] = 2 * n[axis] - 1 - position[axis];
                    sign[axis] = -1.0;
                }
            }
            let u = swirl(position);
            let mirrored = std::array::from_fn(|axis| sign[axis] * u[axis]);
            flow.f[cell] = twin::equilibrium::product(1.0, mirrored);
        }
        flow.run(30);
    };
    populations(&mut octant);
    populations(&mut whole);
    for cell in 0..octant.domain.cell_count() {
        let twin_cell = whole.domain.index(octant.domain.position(cell));
        for i in 0..Q {
            let difference = octant.f[cell][i] - whole.f[twin_cell][i];
            assert!(difference.abs() < 1e-14, "{difference}");
        }
    }
}

#[test]
fn layer_of_solid_cells_is_a_wall_face() {
    // A cavity with a lid and a mirror: side walls once as faces, once as a layer of cells.
    let lid = || Face::Wall([0.05, 0.0, 0.01]);
    let config = Config {
        c_w: Some(0.5),
        ..Config::new(0.53)
    };
    let n = [5, 4, 3];
    let faces = [REST, REST, Face::FreeSlip, lid(), REST, REST];
    let mut with_faces = Twin::new(Domain::new(n, faces), config);
    let faces = [
        Face::Periodic,
        Face::Periodic,
        Face::FreeSlip,
        lid(),
        Face::FreeSlip,
        Face::FreeSlip,
    ];
    let mut domain = Domain::new([7, 4, 5], faces);
    for cell in 0..domain.cell_count() {
        let [x, _, z] = domain.position(cell);
        domain.solid[cell] = x == 0 || x == 6 || z == 0 || z == 4;
    }
    let mut with_cells = Twin::new(domain, config);
    with_faces.run(100);
    with_cells.run(100);
    for cell in 0..with_faces.domain.cell_count() {
        let [x, y, z] = with_faces.domain.position(cell);
        let same = with_cells.domain.index([x + 1, y, z + 1]);
        assert_eq!(with_faces.odd_class(cell), with_cells.odd_class(same));
        assert_eq!(with_faces.f[cell], with_cells.f[same]);
    }
    let lid_cell = with_faces.domain.index([2, 3, 1]);
    assert!(with_faces.macroscopic(lid_cell).1[0] > 0.01);
}

#[test]
fn odd_rates_change_beside_bounce_back_but_not_beside_mirrors() {
    let faces = layer(REST, Face::FreeSlip);
    let mut domain = Domain::new([6, 8, 6], faces);
    let obstacle = domain.index([3, 4, 3]);
    domain.solid[obstacle] = true;
    let flow = Twin::new(domain, Config::new(0.6));
    let class = |position| flow.odd_class(flow.domain.index(position));
    assert_eq!(class([0, 0, 0]), OddClass::Wall);
    assert_eq!(class([0, 1, 0]), OddClass::Bulk);
    assert_eq!(class([0, 7, 0]), OddClass::Bulk);
    assert_eq!(class([2, 5, 4]), OddClass::Wall);
    assert_eq!(class([3, 6, 3]), OddClass::Bulk);
}

#[test]
fn velocity_decides_over_rest_over_moving_over_mirror_at_edges() {
    let moving = Face::Wall([0.1, 0.0, 0.0]);
    let inlet = Face::Velocity(Profile::Uniform([0.2, 0.0, 0.0]));
    let faces = [inlet, REST, moving, Face::FreeSlip, REST, Face::FreeSlip];
    let domain = Domain::new([3, 3, 3], faces);
    let towards = |position, c| domain.link(domain.index(position), twin::lattice::direction(c));
    let fed = Link::Moving([0.2, 0.0, 0.0]);
    assert_eq!(towards([0, 0, 1], [-1, -1, 0]), fed);
    assert_eq!(towards([0, 2, 1], [-1, 1, 1]), fed);
    assert_eq!(towards([0, 0, 0], [-1, -1, -1]), fed);
    assert_eq!(towards([2, 0, 1], [1, -1, 0]), Link::Bounce);
    assert_eq!(towards([1, 0, 0], [0, -1, -1]), Link::Bounce);
    let dragged = Link::Moving([0.1, 0.0, 0.0]);
    assert_eq!(towards([1, 0, 2], [0, -1, 1]), dragged);
    assert_eq!(towards([2, 2, 0], [1, 1, -1]), Link::Bounce);
    // The link that leaves (1, 2, 1) along (1, 1, 0) receives the mirrored population of (2, 2, 1) along (−1, 1, 0).
    let source = domain.index([2, 2, 1]);
    let direction = twin::lattice::direction([-1, 1, 0]);
    let mirror = Link::Mirror {
        cell: source,
        direction,
    };
    assert_eq!(towards([1, 2, 1], [1, 1, 0]), mirror);
}

#[test]
fn shear_wave_decays_viscously_from_the_first_step() {
    let n = 32;
    let config = Config::new(0.8);
    let k = TAU / n as f64;
    let u: Vec<_> = (0..n)
        .map(|y| [1e-3 * (k * y as f64).sin(), 0.0, 0.0])
        .collect();
    let mut flow = Twin::new(Domain::periodic([1, n, 1]), config);
    flow.start(&vec![1.0; n], &u);
    flow.step();
    let loss = 1.0 - flow.macroscopic(n / 4).1[0] / u[n / 4][0];
    // A start in equilibrium would lose k²/6, as for τ = 1: 5/3 of this. Central differences have an error of k²/6.
    assert_relative(loss, config.nu() * k * k, 0.01);
}
