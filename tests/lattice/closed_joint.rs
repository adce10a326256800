//! Conductance of closed joints, compared with a reduced model of their rows.

use kit::twin::{self, joint, of_setup::twin_of};
use riprap::lattice::{Collision, Lattice, Setup, SolidOperator};

fn setup(nu: f64, operator: SolidOperator) -> Setup {
    let mut setup = Setup::periodic([4; 3], nu);
    setup.solid_operator = Some(operator);
    setup
}

fn operators() -> [(SolidOperator, twin::SolidOperator); 3] {
    [
        (SolidOperator::Holdych, twin::SolidOperator::Holdych),
        (SolidOperator::Noble, twin::SolidOperator::Noble),
        (
            SolidOperator::Superposition,
            twin::SolidOperator::Superposition,
        ),
    ]
}

#[test]
fn apertures_are_those_of_steady_flow_in_rows_of_cells() {
    for nu in [1e-6, 0.01, 0.3] {
        for (operator, its_twin) in operators() {
            let mut setup = setup(nu, operator);
            setup.collision = match nu < 0.1 {
                true => Collision::Hermite,
                false => Collision::Bgk,
            };
            let config = twin_of(&setup).config;
            let of = |rows, weight| {
                let conductance = joint::conductance(&config, its_twin, rows, weight);
                (12.0 * nu * conductance).cbrt()
            };
            let expected = [of(1, 0.25), of(2, 0.25)];
            let found = setup.joint_apertures();
            println!("ν = {nu}, {operator:?}: {found:?}, twin {expected:?}");
            for (found, expected) in found.iter().zip(expected) {
                assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
            }
            let range = setup.joint_aperture_range();
            for (found, expected) in range
                .iter()
                .zip([of(1, 0.95).max(of(2, 0.98)), of(1, 0.25)])
            {
                assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
            }
        }
    }
}

#[test]
fn joints_of_one_row_and_of_two_have_the_aperture_that_is_asked_for() {
    let mut setup = setup(1e-4, SolidOperator::Holdych);
    let range = setup.joint_aperture_range();
    for part in [0.0, 0.3, 1.0] {
        let aperture = range[0] + part * (range[1] - range[0]);
        setup.joint_aperture = Some(aperture);
        for found in setup.joint_apertures() {
            assert!((found / aperture - 1.0).abs() < 1e-9, "{found} {aperture}");
        }
    }
}

#[test]
fn apertures_out_of_range_are_refused() {
    let rig = kit::Rig::new();
    let mut setup = setup(1e-4, SolidOperator::Holdych);
    let [least, largest] = setup.joint_aperture_range();
    for aperture in [0.9 * least, 1.1 * largest, f64::NAN] {
        setup.joint_aperture = Some(aperture);
        let refused = Lattice::new(&rig.device, setup.clone()).unwrap_err();
        let message = refused.to_string();
        assert!(message.contains("joint_aperture"), "{message}");
        assert!(message.contains(&format!("{least:.4}")), "{message}");
    }
    (setup.solid_operator, setup.joint_aperture) = (Some(SolidOperator::Noble), Some(largest));
    let refused = Lattice::new(&rig.device, setup).unwrap_err();
    assert!(refused.to_string().contains("Holdych"), "{refused}");
}
