//! The f64 twin's eddy viscosity and what is measured from a velocity gradient.

use kit::twin::{Domain, Face, diagnostics, wale};

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
    let faces = [
        Face::Periodic,
        Face::Periodic,
        Face::Wall([0.0; 3]),
        Face::FreeSlip,
        Face::Periodic,
        Face::Periodic,
    ];
    let mut domain = Domain::new([5, 5, 1], faces);
    let obstacle = domain.index([2, 2, 0]);
    domain.solid[obstacle] = true;
    let u: Vec<_> = (0..domain.cell_count())
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
    let u: Vec<_> = (0..domain.cell_count())
        .map(|cell| {
            let [x, y, _] = domain.position(cell).map(|p| p as f64 - 2.5);
            [-omega * y, omega * x, 0.0]
        })
        .collect();
    let cells = domain.cell_count() as f64;
    let energy = diagnostics::kinetic_energy(&domain, &vec![1.0; u.len()], &u);
    // Mean of x² + y² over centres ±½, ±3/2, ±5/2 is 35/6.
    assert!((energy / (0.5 * omega * omega * cells * 35.0 / 6.0) - 1.0).abs() < 1e-13);
    let enstrophy = diagnostics::enstrophy(&domain, &u);
    assert!((enstrophy / (2.0 * omega * omega * cells) - 1.0).abs() < 1e-13);
    let g = wale::gradient(&domain, &u, 0);
    assert!((diagnostics::q_criterion(&g) / (omega * omega) - 1.0).abs() < 1e-13);
}
