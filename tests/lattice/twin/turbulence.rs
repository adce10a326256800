//! The f64 twin's eddy viscosity and quantities from a velocity gradient.

use kit::{
    assert_near, assert_relative,
    twin::{Domain, Face, diagnostics, wale},
};

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
            assert_near(g[component][1], slope, 1e-15);
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
    assert_relative(energy, 0.5 * omega * omega * cells * 35.0 / 6.0, 1e-13);
    let enstrophy = diagnostics::enstrophy(&domain, &u);
    assert_relative(enstrophy, 2.0 * omega * omega * cells, 1e-13);
    let g = wale::gradient(&domain, &u, 0);
    assert_relative(diagnostics::q_criterion(&g), omega * omega, 1e-13);
}
