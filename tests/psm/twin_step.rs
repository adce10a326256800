//! Collision and streaming with given solid fractions.

use crate::fixture::Subject;
use kit::Rig;
use kit::twin::of_setup::{limit, noise, walled};
use kit::twin::{
    lattice::{C, Q},
    statistics::moments,
};
use riprap::{
    gpu::kernel::submit_pass,
    lattice::{
        Collision, Equilibrium, Force, Setup, SolidOperator, SolidWeight, Statistic, Statistics,
        Storage,
    },
};

/// Compares with the twin after 1, 2 and 5 steps, and the statistics of the states before three of these. Forces are sums over the
/// populations of a cell, whose weights add up to 1, and have the rounding of the populations. The twin of 16 bits continues from the
/// populations of the lattice each time: a rounding is up to 1e-3 of a population.
fn assert_equal_to_twin(name: &str, setup: &Setup) {
    let mut subject = Subject::new(setup);
    let bricks = subject.some_bricks();
    subject.fill(&bricks);
    let mut sampling = Sampling::new(&mut subject);
    for steps in [1, 1, 3] {
        subject.rig.run(&mut subject.lattice, steps - 1);
        subject.twin.run(steps - 1);
        if let Some(sampling) = &mut sampling {
            sampling.record(&mut subject);
        }
        subject.rig.run(&mut subject.lattice, 1);
        let forces = subject.force_error(&bricks);
        subject.twin.step();
        let populations = subject.population_error();
        let step = subject.lattice.step();
        println!("{name}, step {step}: populations {populations:e}, forces {forces:e}");
        assert!(
            populations < limit(setup),
            "{name}, step {step}: {populations:e}"
        );
        assert!(
            forces < limit(setup),
            "{name}, step {step}: forces {forces:e}"
        );
        if setup.storage == Storage::F16 {
            subject.set_twin();
        }
    }
    if let Some(sampling) = sampling {
        sampling.assert_equal(name, &subject);
    }
}

/// Statistics of a lattice, and the samples of its twin.
struct Sampling {
    statistics: Statistics,
    samples: Vec<Vec<[f32; 4]>>,
}

impl Sampling {
    /// `None` if the device has too few bindings.
    fn new(subject: &mut Subject) -> Option<Self> {
        Some(Self {
            statistics: Statistics::new(&subject.rig.device, &mut subject.lattice).ok()?,
            samples: Vec::new(),
        })
    }

    /// Samples the present state. The momentum in the middle of a step is the mean of that before and after the collision.
    fn record(&mut self, subject: &mut Subject) {
        let (device, twin) = (&subject.rig.device, &subject.twin);
        let recorded = submit_pass(device, &subject.rig.queue, |pass| {
            self.statistics.record(device, &mut subject.lattice, pass)
        });
        recorded.unwrap();
        let momentum =
            |f: &[f64; Q], a: usize| (0..Q).map(|q| f[q] * f64::from(C[q][a])).sum::<f64>();
        let sample = |(cell, after): (usize, &[f64; Q])| {
            if twin.domain.solid[cell] {
                return [0.0; 4];
            }
            let (before, rho) = (&twin.f[cell], twin.macroscopic(cell).0);
            let u = [0, 1, 2].map(|a| (momentum(before, a) + momentum(after, a)) / (2.0 * rho));
            [rho - 1.0, u[0], u[1], u[2]].map(|value| value as f32)
        };
        let collided = twin.collided();
        self.samples
            .push(collided.iter().enumerate().map(sample).collect());
    }

    fn assert_equal(mut self, name: &str, subject: &Subject) {
        let (rig, lattice) = (&subject.rig, &subject.lattice);
        let velocity = (0..3).map(Statistic::Velocity);
        let means = std::iter::once(Statistic::Excess).chain(velocity);
        let stress = (0..6).map(Statistic::ReynoldsStress);
        let products = std::iter::once(Statistic::ExcessVariance).chain(stress);
        for (k, of) in means.chain(products).enumerate() {
            let read = self
                .statistics
                .read(&rig.device, &rig.queue, lattice, of, None);
            for (cell, found) in rig.wait(read).unwrap().into_iter().enumerate() {
                let own: Vec<_> = self.samples.iter().map(|sample| sample[cell]).collect();
                let (mean, product) = moments(&own);
                let expected = if k < 4 { mean[k] } else { product[k - 4] };
                assert!(
                    (f64::from(found) - expected).abs() < limit(&subject.setup),
                    "{name}, {of:?}, cell {cell}: {found}, not {expected}"
                );
            }
        }
    }
}

/// Odd and prime sizes; z is divisible by the lanes, and some bricks extend over the border.
fn box_of(nu: f64, operator: SolidOperator) -> Setup {
    let mut setup = Setup::periodic([5, 7, 4], nu);
    setup.solid_operator = Some(operator);
    setup.brick = [4, 4, 2];
    setup
}

#[test]
fn operators_collisions_and_equilibria() {
    use {Collision::*, Equilibrium::*, SolidOperator::*};
    let all = [
        (Holdych, Hermite, Product, Some(0.1)),
        (Holdych, Suga, Product, None),
        (Holdych, Bgk, SecondOrder, None),
        (Noble, Hermite, SecondOrder, Some(0.125)),
        (Superposition, Bgk, Product, None),
        (Noble, Suga, SecondOrder, None),
    ];
    for (operator, collision, equilibrium, lambda) in all {
        let mut setup = box_of(0.015, operator);
        (setup.collision, setup.equilibrium) = (collision, equilibrium);
        setup.solid_lambda = lambda;
        setup.force = Force::Constant([1e-3, -2e-3, 5e-4]);
        assert_equal_to_twin(
            &format!("{operator:?} {collision:?} {equilibrium:?}"),
            &setup,
        );
    }
}

/// From almost no viscosity to more than is useful, and with the weight of the paper.
#[test]
fn weights_at_any_viscosity() {
    for nu in [1e-6, 0.01, 0.5] {
        for weight in [SolidWeight::Standard, SolidWeight::Exact] {
            let mut setup = box_of(nu, SolidOperator::Holdych);
            setup.solid_weight = Some(weight);
            assert_equal_to_twin(&format!("{weight:?}, ν = {nu}"), &setup);
        }
    }
    let mut setup = box_of(0.01, SolidOperator::Holdych);
    setup.joint_aperture = Some(0.3);
    assert_equal_to_twin("joints of an aperture", &setup);
    let mut setup = box_of(0.01, SolidOperator::Noble);
    setup.solid_weight = Some(SolidWeight::Exact);
    let refused = riprap::lattice::Lattice::new(&Rig::new().device, setup);
    let error = refused.unwrap_err().to_string();
    assert!(error.contains("solid_weight"), "{error}");
}

/// (1/s − ½)(τ − ½) = Λ would yield less than the floor at this viscosity; the second setup has one Λ for all cells.
#[test]
fn odd_rates_beside_blocks_have_a_floor_and_one_magic_rate_has_none() {
    let mut setup = box_of(0.004, SolidOperator::Holdych);
    for (nu, wall, solid) in [
        (0.004, 1.12, 0.96),
        (1e-6, 1.59988, 1.19994),
        (0.02, 0.8, 0.8),
    ] {
        setup.nu = nu;
        let floors = setup.odd_rate_floors();
        assert!((floors[0] - wall).abs() < 1e-12 && (floors[1] - solid).abs() < 1e-12);
        assert!(setup.odd_rate(0.1) < 0.95 * solid);
        assert_equal_to_twin("default floors", &setup);
    }
    setup.odd_rate_floor = Some(0.7);
    assert_equal_to_twin("given floor", &setup);
    setup.lambda = Some(0.02);
    assert_equal_to_twin("one rate", &setup);
}

#[test]
fn layouts_with_walls_beside_blocks_and_everything_on() {
    let cases = [
        (Storage::F32, (1, 2), 2, [4, 4, 2], SolidOperator::Noble),
        (
            Storage::F32,
            (4, 2),
            5,
            [16, 2, 2],
            SolidOperator::Superposition,
        ),
        (Storage::F32, (4, 1), 2, [8, 4, 1], SolidOperator::Holdych),
        (Storage::F16, (2, 1), 3, [4, 2, 4], SolidOperator::Holdych),
        (Storage::F16, (4, 2), 2, [8, 4, 1], SolidOperator::Holdych),
    ];
    // All buffers except the populations take up to seven bindings, of the 10 that SwiftShader has.
    let most = Rig::new()
        .device
        .limits()
        .max_storage_buffers_per_shader_stage
        - 7;
    for (n, (storage, (lanes, axis), bindings, brick, operator)) in cases.into_iter().enumerate() {
        let mut setup = walled(lanes, storage);
        (setup.bindings, setup.brick) = (Some(bindings.min(most)), brick);
        setup.lane_axis = axis;
        setup.solid_operator = Some(operator);
        setup.wale = Some(0.5);
        setup.force = match n % 2 {
            0 => Force::Constant([0.0, -1e-3, 5e-4]),
            _ => Force::Field(
                (0..6 * 5 * 7)
                    .map(|n| [0, 1, 2].map(|a| 1e-3 * noise(3 * n + a) as f32))
                    .collect(),
            ),
        };
        let name = format!(
            "{storage:?}, {lanes} lanes along {axis}, {:?} bindings, {operator:?}",
            setup.bindings
        );
        assert_equal_to_twin(&name, &setup);
    }
}
