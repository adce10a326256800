//! The f64 twin at its borders: walls, solids, mirrors, velocity faces, and WALE beside them.

#![allow(
    clippy::needless_range_loop,
    reason = "indices are those of the formulas"
)]

mod twin;

use twin::domain::Link;
use twin::lattice::{OPPOSITE, Q, W, c_dot};
use twin::rates::odd_rate;
use twin::{Config, Domain, Equilibrium, Face, Force, OddClass, Profile, Twin, diagnostics, wale};

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
    let u: Vec<_> = (0..flow.domain.len())
        .map(|cell| swirl(flow.domain.position(cell)))
        .collect();
    flow.start(&vec![1.0; u.len()], &u);
}

/// Largest error of plane Poiseuille flow over its maximum, 8 cells across.
fn poiseuille_error(config: Config) -> f64 {
    let (h, u_max) = (8, 1e-4);
    let height = h as f64;
    let acceleration = 8.0 * config.nu() * u_max / (height * height);
    let mut flow = Twin::new(Domain::new([1, h, 1], layer(REST, REST)), config);
    flow.force = Force::Uniform([acceleration, 0.0, 0.0]);
    // The slowest mode decays as exp(−ν π² t/h²): 25 of its times leave 1e-11.
    let time = height * height / (config.nu() * 9.87);
    flow.run((25.0 * time) as usize);
    (0..h)
        .map(|y| {
            let from_wall = y as f64 + 0.5;
            let exact = acceleration / (2.0 * config.nu()) * from_wall * (height - from_wall);
            (flow.macroscopic(y).1[0] - exact).abs() / u_max
        })
        .fold(0.0, f64::max)
}

#[test]
fn poiseuille_is_exact_with_lambda_three_sixteenths_at_any_tau() {
    for tau in [0.6, 1.0, 2.0] {
        let exact = Config {
            lambda_everywhere: Some(3.0 / 16.0),
            floor: 0.0,
            ..Config::new(tau)
        };
        let error = poiseuille_error(exact);
        assert!(error < 1e-8, "τ = {tau}: {error}");
    }
}

#[test]
fn poiseuille_slips_with_constant_odd_rates() {
    // Without Λ the wall moves by up to 1.6 % of U_max at 8 cells.
    let constants = Config {
        operator: twin::Operator::Suga,
        ..Config::new(0.55)
    };
    let error = poiseuille_error(constants);
    assert!((1e-3..2e-2).contains(&error), "{error}");
}

#[test]
fn odd_rate_stops_at_its_floor() {
    assert!((odd_rate(1.0, 0.25, 0.8) - 1.0).abs() < 1e-15);
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
        // u² of the equilibrium feeds ρ through the bulk rate, which differs from the shear rate.
        assert!((u[0] - exact).abs() < 1e-5 * lid, "{} for {exact}", u[0]);
    }
    // A tangential lid moves no mass.
    assert!((mass(&flow) - before).abs() < 1e-11);
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
    for cell in 0..flow.domain.len() {
        let rho = flow.macroscopic(cell).0;
        for i in 0..Q {
            if let Link::Moving(u_w) = flow.domain.link(cell, i) {
                let expected = collided[cell][i] - 6.0 * W[i] * rho * c_dot(i, u_w);
                assert!((flow.f[cell][OPPOSITE[i]] - expected).abs() < 1e-16);
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
    // Half-way bounce-back adds 6 w ρ c·u, exactly the odd part of the order-2 equilibrium.
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
        assert!((rho - 1.0).abs() < 1e-13);
        for axis in 0..3 {
            assert!((velocity[axis] - u[axis]).abs() < 1e-13);
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
        for cell in 0..flow.domain.len() {
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
    for cell in 0..octant.domain.len() {
        let twin_cell = whole.domain.index(octant.domain.position(cell));
        for i in 0..Q {
            let difference = octant.f[cell][i] - whole.f[twin_cell][i];
            assert!(difference.abs() < 1e-14, "{difference}");
        }
    }
}

#[test]
fn layer_of_solid_cells_is_a_wall_face() {
    // Cavity with a lid and a mirror: side walls once as faces, once as a layer of cells.
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
    for cell in 0..domain.len() {
        let [x, _, z] = domain.position(cell);
        domain.solid[cell] = x == 0 || x == 6 || z == 0 || z == 4;
    }
    let mut with_cells = Twin::new(domain, config);
    with_faces.run(100);
    with_cells.run(100);
    for cell in 0..with_faces.domain.len() {
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
fn rest_decides_over_moving_over_velocity_over_mirror_at_edges() {
    let moving = Face::Wall([0.1, 0.0, 0.0]);
    let inlet = Face::Velocity(Profile::Uniform([0.2, 0.0, 0.0]));
    let faces = [
        inlet,
        REST,
        moving,
        Face::FreeSlip,
        Face::Periodic,
        Face::Periodic,
    ];
    let domain = Domain::new([3, 3, 3], faces);
    let towards = |position, c| domain.link(domain.index(position), twin::lattice::direction(c));
    let corner = [0, 0, 1];
    assert_eq!(towards(corner, [-1, -1, 0]), Link::Moving([0.1, 0.0, 0.0]));
    assert_eq!(
        towards([0, 2, 1], [-1, 1, 1]),
        Link::Moving([0.2, 0.0, 0.0])
    );
    assert_eq!(towards([2, 0, 1], [1, -1, 0]), Link::Bounce);
    assert_eq!(towards([2, 2, 1], [1, 1, -1]), Link::Bounce);
    // Leaving (1, 2, 1) along (1, 1, 0) is what a mirror returns from (2, 2, 1) along (−1, 1, 0).
    let source = domain.index([2, 2, 1]);
    let direction = twin::lattice::direction([-1, 1, 0]);
    let mirror = Link::Mirror {
        cell: source,
        direction,
    };
    assert_eq!(towards([1, 2, 1], [1, 1, 0]), mirror);
}

#[test]
fn wale_vanishes_in_pure_shear() {
    for (i, j) in [(0, 1), (1, 2), (2, 0)] {
        let mut g = [[0.0; 3]; 3];
        g[i][j] = 0.3;
        assert_eq!(wale::nu_t(&g, 0.5), 0.0);
    }
    assert_eq!(wale::nu_t(&[[0.0; 3]; 3], 0.5), 0.0);
}

#[test]
fn wale_grows_with_the_cube_of_the_distance_from_a_wall() {
    // u = (a y, b y², c y) with slopes along x and z, v from continuity: what no slip leaves near a wall.
    let at = |y: f64| {
        let (x, z) = (0.3_f64, 0.7_f64);
        let g = [
            [-y * x.sin(), x.cos() + 2.0, 0.2 * y],
            [
                0.5 * y * y * x.cos(),
                y * (x.sin() + z.sin()),
                0.5 * y * y * z.cos(),
            ],
            [0.1 * y, z.cos(), -y * z.sin()],
        ];
        wale::nu_t(&g, 0.5)
    };
    let slope = (at(2e-4) / at(1e-4)).log2();
    assert!((slope - 3.0).abs() < 1e-3, "{slope}");
}

#[test]
fn wale_gives_0_226_omega_in_solid_rotation() {
    let omega = 0.01;
    let g = [[0.0, -omega, 0.0], [omega, 0.0, 0.0], [0.0; 3]];
    let exact = 0.25 * (2.0_f64 / 3.0).powf(0.25) * omega;
    assert!((wale::nu_t(&g, 0.5) / exact - 1.0).abs() < 1e-14);
    assert!((exact / omega - 0.226).abs() < 1e-4);
}

#[test]
fn gradient_of_a_linear_field_is_exact_beside_walls_and_zero_across_single_cells() {
    let mut domain = Domain::new([5, 5, 1], layer(REST, Face::FreeSlip));
    let obstacle = domain.index([2, 2, 0]);
    domain.solid[obstacle] = true;
    let u: Vec<_> = (0..domain.len())
        .map(|cell| {
            let y = domain.position(cell)[1] as f64;
            [0.01 * y, -0.02 * y, 0.03 * y]
        })
        .collect();
    for position in [
        [0, 0, 0],
        [0, 4, 0],
        [2, 1, 0],
        [2, 3, 0],
        [1, 2, 0],
        [0, 2, 0],
    ] {
        let g = wale::gradient(&domain, &u, domain.index(position));
        for (component, slope) in [0.01, -0.02, 0.03].into_iter().enumerate() {
            assert!((g[component][1] - slope).abs() < 1e-15);
            assert_eq!([g[component][0], g[component][2]], [0.0, 0.0]);
        }
    }
}

#[test]
fn solid_rotation_has_the_known_energy_enstrophy_and_q() {
    let (n, omega) = (6, 0.01);
    let faces = [const { Face::FreeSlip }; 6];
    let domain = Domain::new([n, n, 2], faces);
    let u: Vec<_> = (0..domain.len())
        .map(|cell| {
            let [x, y, _] = domain.position(cell).map(|p| p as f64 - 2.5);
            [-omega * y, omega * x, 0.0]
        })
        .collect();
    let cells = domain.len() as f64;
    let energy = diagnostics::kinetic_energy(&domain, &vec![1.0; u.len()], &u);
    // Mean of x² + y² over centres ±½, ±3/2, ±5/2 is 35/6.
    assert!((energy / (0.5 * omega * omega * cells * 35.0 / 6.0) - 1.0).abs() < 1e-13);
    let enstrophy = diagnostics::enstrophy(&domain, &u);
    assert!((enstrophy / (2.0 * omega * omega * cells) - 1.0).abs() < 1e-13);
    let g = wale::gradient(&domain, &u, 0);
    assert!((diagnostics::q_criterion(&g) / (omega * omega) - 1.0).abs() < 1e-13);
}

#[test]
fn shear_wave_decays_viscously_from_the_first_step() {
    let n = 32;
    let config = Config::new(0.8);
    let k = std::f64::consts::TAU / n as f64;
    let u: Vec<_> = (0..n)
        .map(|y| [1e-3 * (k * y as f64).sin(), 0.0, 0.0])
        .collect();
    let mut flow = Twin::new(Domain::periodic([1, n, 1]), config);
    flow.start(&vec![1.0; n], &u);
    flow.step();
    let loss = 1.0 - flow.macroscopic(n / 4).1[0] / u[n / 4][0];
    // A start in equilibrium would lose k²/6, as if τ were 1: 5/3 of this. Central differences err by k²/6.
    assert!((loss / (config.nu() * k * k) - 1.0).abs() < 0.01, "{loss}");
}
