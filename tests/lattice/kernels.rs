//! Every kernel of the lattice against its f64 twin, on random states in poisoned buffers.

use kit::{Rig, twin};
use kit::{
    assert_near,
    twin::of_setup::{layouts, limit, noise, poison, random_populations, twin_of, walled},
};
use riprap::lattice::{
    Collision, Equilibrium, Face, Force, Lattice, Observer, Setup, State, Storage,
};

/// Largest |f − f_twin| / w_i over the fluid cells.
fn distance(rig: &Rig, lattice: &mut Lattice, twin: &twin::Twin) -> f64 {
    let end = rig.populations(lattice);
    let n = twin.domain.cell_count();
    let mut worst: f64 = 0.0;
    for cell in (0..n).filter(|&cell| !twin.domain.solid[cell]) {
        for q in 0..27 {
            let found = f64::from(end.values[q * n + cell]);
            assert!(found.is_finite(), "cell {cell}, direction {q} read poison");
            worst = worst.max((found - twin.f[cell][q]).abs() / twin::lattice::W[q]);
        }
    }
    worst
}

/// After 1, 2 and 5 steps from random populations.
pub(super) fn assert_equal_to_twin(name: &str, setup: &Setup) {
    let rig = Rig::new();
    let mut twin = twin_of(setup);
    let start = random_populations(&mut twin);
    let mut lattice = Lattice::new(&rig.device, setup.clone()).unwrap();
    poison(&rig, &lattice);
    lattice
        .set_populations(&rig.device, &rig.queue, &start)
        .unwrap();
    for more in [1, 1, 3] {
        rig.run(&mut lattice, more);
        twin.run(more);
        let (found, steps) = (distance(&rig, &mut lattice, &twin), lattice.step());
        println!("{name}, {steps} steps: {found:e}");
        assert!(found < limit(setup), "{name}, {steps} steps: {found:e}");
    }
}

/// Odd and prime sizes; z divides by the lanes.
fn box_of(nu: f64) -> Setup {
    Setup::periodic([5, 7, 4], nu)
}

/// The same box with another layout; the periodic axis of the lanes divides by them.
fn laid_out(mut setup: Setup, storage: Storage, lanes: u32, axis: usize) -> Setup {
    (setup.storage, setup.lanes, setup.lane_axis) = (storage, lanes, axis);
    setup.cells.swap(2, axis);
    setup
}

#[test]
fn collisions_and_equilibria() {
    for collision in [Collision::Bgk, Collision::Hermite, Collision::Suga] {
        for equilibrium in [Equilibrium::Product, Equilibrium::SecondOrder] {
            for force in [Force::None, Force::Constant([1e-3, -2e-3, 5e-4])] {
                let mut setup = box_of(0.015);
                (setup.collision, setup.equilibrium) = (collision, equilibrium);
                setup.force = force.clone();
                let name = format!("{collision:?} {equilibrium:?} {force:?}");
                assert_equal_to_twin(&name, &setup);
            }
        }
    }
}

#[test]
fn layouts_with_everything_on() {
    for (storage, lanes, axis) in layouts() {
        for bindings in [2, Rig::new().most_bindings()] {
            let mut setup = laid_out(box_of(0.01), storage, lanes, axis);
            setup.bindings = Some(bindings);
            (setup.wale, setup.wale_interval) = (Some(0.5), 1 + axis as u32 % 2);
            setup.force = Force::Field(
                (0..140)
                    .map(|n| [0, 1, 2].map(|a| 1e-3 * noise(3 * n + a) as f32))
                    .collect(),
            );
            assert_equal_to_twin(
                &format!("{storage:?} {lanes} lanes along {axis}, {bindings}"),
                &setup,
            );
        }
    }
}

#[test]
fn walls_of_every_kind() {
    for (storage, lanes, axis) in layouts() {
        let mut setup = walled(lanes, storage);
        setup.lane_axis = axis;
        assert_equal_to_twin(&format!("walls {storage:?} {lanes} along {axis}"), &setup);
        setup.wale = Some(0.5);
        setup.force = Force::Constant([0.0, -1e-3, 5e-4]);
        assert_equal_to_twin(
            &format!("walls, WALE, force {storage:?} {lanes} along {axis}"),
            &setup,
        );
        setup.lambda = Some(3.0 / 16.0);
        assert_equal_to_twin(
            &format!("walls, one magic rate {storage:?} {lanes} along {axis}"),
            &setup,
        );
    }
}

#[test]
fn channels_along_each_axis() {
    for normal in 0..3 {
        for (storage, lanes, axis) in layouts() {
            let mut setup = laid_out(box_of(0.03), storage, lanes, axis);
            setup.faces[normal] = [Face::FreeSlip, Face::Wall([0.0; 3])];
            let name = format!("normal {normal}, {storage:?} {lanes} along {axis}");
            assert_equal_to_twin(&name, &setup);
        }
    }
}

#[test]
fn consistent_start_and_macroscopic_fields() {
    let rig = Rig::new();
    for (storage, lanes, axis) in layouts() {
        let mut setup = walled(lanes, storage);
        setup.lane_axis = axis;
        setup.force = Force::Constant([1e-3, 2e-3, -1e-3]);
        let mut twin = twin_of(&setup);
        let n = twin.domain.cell_count();
        let state = State {
            excess: (0..n).map(|k| 0.01 * noise(k) as f32).collect(),
            velocity: [1, 2, 3].map(|a| (0..n).map(|k| 0.05 * noise(a * n + k) as f32).collect()),
        };
        let rho: Vec<f64> = state.excess.iter().map(|e| 1.0 + f64::from(*e)).collect();
        let u: Vec<[f64; 3]> = (0..n)
            .map(|k| {
                if twin.domain.solid[k] {
                    [0.0; 3]
                } else {
                    [0, 1, 2].map(|a| state.velocity[a][k].into())
                }
            })
            .collect();
        twin.start(&rho, &u);
        // The initial velocity is the given one: Σ c f = ρu − F/2.
        for f in twin
            .f
            .iter_mut()
            .zip(&twin.domain.solid)
            .filter(|(_, solid)| !**solid)
            .map(|(f, _)| f)
        {
            for q in 0..27 {
                let cf = twin::lattice::c_dot(q, [1e-3, 2e-3, -1e-3]);
                f[q] -= 1.5 * twin::lattice::W[q] * cf;
            }
        }
        let mut lattice = Lattice::new(&rig.device, setup.clone()).unwrap();
        poison(&rig, &lattice);
        lattice
            .start(&rig.device, &rig.queue, &state, true)
            .unwrap();
        let start = rig.populations(&mut lattice);
        let seen = rig.state(&mut lattice);
        for cell in (0..n).filter(|&cell| !twin.domain.solid[cell]) {
            for q in 0..27 {
                let error = f64::from(start.values[q * n + cell]) - twin.f[cell][q];
                let error = error.abs() / twin::lattice::W[q];
                assert!(error < limit(&setup), "{storage:?} {lanes}: {error:e}");
            }
            let (rho, u) = twin.macroscopic(cell);
            assert!((1.0 + f64::from(seen.excess[cell]) - rho).abs() < limit(&setup));
            for a in 0..3 {
                assert_near(f64::from(seen.velocity[a][cell]), u[a], limit(&setup));
            }
        }
    }
}

#[test]
fn derived_fields_and_sums() {
    use riprap::lattice::Derived;
    let rig = Rig::new();
    let mut setup = walled(4, Storage::F32);
    setup.wale = Some(0.5);
    let mut twin = twin_of(&setup);
    let start = random_populations(&mut twin);
    let mut lattice = Lattice::new(&rig.device, setup).unwrap();
    lattice
        .set_populations(&rig.device, &rig.queue, &start)
        .unwrap();
    let mut observer = Observer::new(&rig.device, &lattice).unwrap();
    let u = twin.velocity();
    let rho = twin.density();
    let n = twin.domain.cell_count();
    let gradient = |cell| twin::wale::gradient(&twin.domain, &u, cell);
    let fluid: Vec<usize> = (0..n).filter(|&cell| !twin.domain.solid[cell]).collect();
    let kinds = [
        Derived::QCriterion,
        Derived::EddyViscosity,
        Derived::Vorticity(0),
        Derived::Vorticity(1),
        Derived::Vorticity(2),
    ];
    for kind in kinds {
        let seen = rig
            .wait(observer.derived(&rig.device, &rig.queue, &mut lattice, kind))
            .unwrap();
        for &cell in &fluid {
            let g = gradient(cell);
            let exact = match kind {
                Derived::QCriterion => twin::diagnostics::q_criterion(&g),
                Derived::EddyViscosity => twin::wale::nu_t(&g, 0.5),
                Derived::Vorticity(axis) => twin::diagnostics::vorticity(&g)[axis as usize],
            };
            // Speeds are of order 0.1: an absolute error of f32 rounding.
            assert!(
                (f64::from(seen[cell]) - exact).abs() < 1e-7,
                "{kind:?} {exact} {}",
                seen[cell]
            );
        }
    }
    let sums = rig
        .wait(observer.sums(&rig.device, &rig.queue, &mut lattice))
        .unwrap();
    let energy = twin::diagnostics::kinetic_energy(&twin.domain, &rho, &u);
    let enstrophy = twin::diagnostics::enstrophy(&twin.domain, &u);
    let excess: f64 = fluid.iter().map(|&cell| rho[cell] - 1.0).sum();
    let speed = fluid
        .iter()
        .map(|&c| u[c].iter().map(|v| v * v).sum::<f64>().sqrt())
        .fold(0.0, f64::max);
    let close = |name: &str, found: f64, exact: f64| {
        assert!(
            (found - exact).abs() < 1e-6 * exact.abs().max(0.1),
            "{name}: {found} {exact}"
        );
    };
    close("kinetic energy", sums.kinetic_energy, energy);
    close("enstrophy", sums.enstrophy, enstrophy);
    close("excess mass", sums.excess, excess);
    close("largest speed", sums.max_speed, speed);
    assert_eq!(sums.cells, fluid.len() as f64);
}
