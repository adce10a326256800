//! Every kernel of the lattice against its f64 twin, on random states in poisoned buffers.

mod rig;
mod twin;

use rig::Rig;
use riprap::lattice::{
    Collision, Equilibrium, Face, Force, Lattice, Observer, Populations, Setup, State, Storage,
};
use twin::Twin;

/// A number in (−1, 1) that depends on `n` alone.
fn noise(n: usize) -> f64 {
    let mut x = (n as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x1234_5678;
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((x >> 11) as f64) / (1u64 << 52) as f64 - 1.0
}

/// The twin of a setup; pressure and outflow faces have none.
fn twin_of(setup: &Setup) -> Twin {
    let faces = [0, 1, 2, 3, 4, 5].map(|n| match &setup.faces[n / 2][n % 2] {
        Face::Periodic => twin::Face::Periodic,
        Face::Wall(velocity) => twin::Face::Wall(*velocity),
        Face::FreeSlip => twin::Face::FreeSlip,
        Face::Velocity(table) => twin::Face::Velocity(twin::Profile::Table(
            table.iter().map(|u| u.map(f64::from)).collect(),
        )),
        other => panic!("no twin of {other:?}"),
    });
    let mut domain = twin::Domain::new(setup.cells.map(|n| n as usize), faces);
    if !setup.solid.is_empty() {
        domain.solid.clone_from(&setup.solid);
    }
    let mut config = twin::Config::new(setup.tau());
    config.equilibrium = match setup.equilibrium {
        Equilibrium::Product => twin::Equilibrium::Product,
        Equilibrium::SecondOrder => twin::Equilibrium::Order2,
    };
    config.operator = match setup.collision {
        Collision::Bgk => twin::Operator::Bgk,
        Collision::Suga => twin::Operator::Suga,
        Collision::Hermite => twin::Operator::Hermite,
    };
    config.c_w = setup.wale;
    config.lambda_everywhere = setup.lambda;
    config.floor = if setup.lambda.is_some() {
        0.0
    } else {
        setup.odd_rate_floor
    };
    if let Some(lambda) = setup.wall_lambda {
        config.lambda_wall = lambda;
    }
    let mut twin = Twin::new(domain, config);
    twin.force = match &setup.force {
        Force::None => twin::Force::Uniform([0.0; 3]),
        Force::Constant(force) => twin::Force::Uniform(*force),
        Force::Field(field) => twin::Force::Field(field.iter().map(|f| f.map(f64::from)).collect()),
    };
    twin
}

/// Populations of order 0.025 w_i as in the golden trajectory, exactly the same in f32 and f64, with their own velocity.
fn random_populations(twin: &mut Twin) -> Populations {
    let n = twin.domain.len();
    let mut values = vec![0f32; 27 * n];
    for cell in (0..n).filter(|&cell| !twin.domain.solid[cell]) {
        for q in 0..27 {
            let value = (0.025 * twin::lattice::W[q] * noise(27 * cell + q)) as f32;
            values[q * n + cell] = value;
            twin.f[cell][q] = f64::from(value);
        }
    }
    let u = twin.velocity();
    let velocity = (0..3)
        .flat_map(|a| u.iter().map(move |u| u[a] as f32))
        .collect();
    let cells = twin.domain.cells.map(|n| n as u32);
    Populations {
        step: 0,
        cells,
        values,
        velocity,
        carried: Vec::new(),
    }
}

fn poison(rig: &Rig, lattice: &Lattice) {
    for buffer in lattice.population_buffers() {
        let nan = vec![0x7fc0_7fc0_u32; buffer.size() as usize / 4];
        rig.queue
            .write_buffer(buffer, 0, bytemuck::cast_slice(&nan));
    }
}

/// Largest |f − f_twin| / w_i over the fluid cells after some steps.
fn distance(setup: &Setup, steps: usize) -> f64 {
    let rig = Rig::new();
    let mut twin = twin_of(setup);
    let start = random_populations(&mut twin);
    let mut lattice = Lattice::new(&rig.device, setup.clone()).unwrap();
    poison(&rig, &lattice);
    lattice
        .set_populations(&rig.device, &rig.queue, &start)
        .unwrap();
    rig.run(&mut lattice, steps);
    twin.run(steps);
    let end = rig.populations(&mut lattice);
    let n = twin.domain.len();
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

/// Rounding of f32, and of half precision. The rows of `suga` have unit weight, so that the rounding
/// of the rest population reaches corners whose weight is 64 times smaller.
fn limit(setup: &Setup) -> f64 {
    match (setup.storage, setup.collision) {
        (Storage::F16, _) => 2e-3,
        (Storage::F32, Collision::Suga) => 2e-6,
        (Storage::F32, _) => 1e-6,
    }
}

fn assert_equal_to_twin(name: &str, setup: &Setup) {
    for steps in [1, 2, 5] {
        let found = distance(setup, steps);
        println!("{name}, {steps} steps: {found:e}");
        assert!(found < limit(setup), "{name}, {steps} steps: {found:e}");
    }
}

fn layouts() -> [(Storage, u32); 4] {
    [
        (Storage::F32, 1),
        (Storage::F32, 4),
        (Storage::F16, 2),
        (Storage::F16, 4),
    ]
}

/// Odd and prime sizes; z divides by the lanes.
fn box_of(nu: f64) -> Setup {
    Setup::periodic([5, 7, 4], nu)
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
    for (storage, lanes) in layouts() {
        for bindings in [2, Rig::new().most_bindings()] {
            let mut setup = box_of(0.01);
            (setup.storage, setup.lanes, setup.bindings) = (storage, lanes, Some(bindings));
            setup.wale = Some(0.5);
            setup.force = Force::Field(
                (0..140)
                    .map(|n| [0, 1, 2].map(|a| 1e-3 * noise(3 * n + a) as f32))
                    .collect(),
            );
            assert_equal_to_twin(&format!("{storage:?} {lanes} lanes {bindings}"), &setup);
        }
    }
}

/// Walls of every kind, corners where they meet, and a solid with an edge.
fn walled(lanes: u32, storage: Storage) -> Setup {
    let mut setup = Setup::periodic([6, 5, 7], 0.02);
    (setup.lanes, setup.storage) = (lanes, storage);
    let inlet = (0..5 * 7).map(|n| [0.05, 0.01 * noise(n) as f32, 0.01 * noise(99 + n) as f32]);
    setup.faces = [
        [Face::Velocity(inlet.collect()), Face::FreeSlip],
        [Face::Wall([0.0; 3]), Face::Wall([0.04, 0.0, -0.02])],
        [Face::FreeSlip, Face::Wall([0.0; 3])],
    ];
    setup.solid = (0..6 * 5 * 7)
        .map(|n| [n % 6, (n / 6) % 5, n / 30])
        .map(|[x, y, z]| {
            let block = (2..4).contains(&x) && y < 2 && (2..6).contains(&z);
            let bed = x < 2 && y < 2 && z < 3;
            let under_the_lid = x == 4 && y == 4 && z < 2;
            block || bed || under_the_lid
        })
        .collect();
    setup
}

#[test]
fn walls_of_every_kind() {
    for (storage, lanes) in layouts() {
        let mut setup = walled(lanes, storage);
        assert_equal_to_twin(&format!("walls {storage:?} {lanes}"), &setup);
        setup.wale = Some(0.5);
        setup.force = Force::Constant([0.0, -1e-3, 5e-4]);
        assert_equal_to_twin(&format!("walls, WALE, force {storage:?} {lanes}"), &setup);
        setup.lambda = Some(3.0 / 16.0);
        assert_equal_to_twin(
            &format!("walls, one magic rate {storage:?} {lanes}"),
            &setup,
        );
    }
}

#[test]
fn channels_along_each_axis() {
    for axis in 0..3 {
        for (storage, lanes) in layouts() {
            let mut setup = box_of(0.03);
            (setup.storage, setup.lanes) = (storage, lanes);
            setup.faces[axis] = [Face::FreeSlip, Face::Wall([0.0; 3])];
            assert_equal_to_twin(&format!("axis {axis} {storage:?} {lanes}"), &setup);
        }
    }
}

#[test]
fn consistent_start_and_macroscopic_fields() {
    let rig = Rig::new();
    for (storage, lanes) in layouts() {
        let mut setup = walled(lanes, storage);
        setup.force = Force::Constant([1e-3, 2e-3, -1e-3]);
        let mut twin = twin_of(&setup);
        let n = twin.domain.len();
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
        // The first velocity is the given one: Σ c f = ρu − F/2.
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
                assert!((f64::from(seen.velocity[a][cell]) - u[a]).abs() < limit(&setup));
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
    let n = twin.domain.len();
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
