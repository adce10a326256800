//! The golden trajectory: a periodic box of noise and shear after 50 steps, known in f64.

use kit::Rig;
use riprap::lattice::{C, Collision, Equilibrium, Force, Populations, Rates, Setup, Storage};

const CELLS: [u32; 3] = [12, 10, 8];

fn hash32(mut n: u32) -> u32 {
    n ^= n >> 16;
    n = n.wrapping_mul(0x7feb_352d);
    n ^= n >> 15;
    n = n.wrapping_mul(0x846c_a68b);
    n ^ (n >> 16)
}

fn weight(q: usize) -> f64 {
    [8.0 / 27.0, 2.0 / 27.0, 1.0 / 54.0, 1.0 / 216.0][C[q].iter().filter(|c| **c != 0).count()]
}

/// f_i(x) = w_i 0.05 (r − ½) + f_i^eq(1, u₀), second-order equilibrium, shifted.
fn noise_and_shear(equilibrium: Equilibrium) -> Populations {
    let [nx, ny, nz] = CELLS.map(|n| n as usize);
    let mut values = Vec::new();
    let mut velocity = vec![0f32; 3 * nx * ny * nz];
    for (q, c) in C.iter().enumerate() {
        for n in 0..nx * ny * nz {
            let (x, y, z) = (n % nx, (n / nx) % ny, n / (nx * ny));
            let angle = |k: usize, n: usize| (std::f64::consts::TAU * k as f64 / n as f64).sin();
            let u = [
                0.02 * angle(y, ny),
                0.02 * angle(z, nz),
                0.02 * angle(x, nx),
            ];
            let r = f64::from(hash32((q + 27 * n) as u32)) / 4294967296.0;
            let cu: f64 = (0..3).map(|a| f64::from(c[a]) * u[a]).sum();
            let uu: f64 = u.iter().map(|u| u * u).sum();
            let w = weight(q);
            let eq = match equilibrium {
                Equilibrium::SecondOrder => w * (3.0 * cu + 4.5 * cu * cu - 1.5 * uu),
                Equilibrium::Product => {
                    (0..3)
                        .map(|a| match c[a] {
                            0 => 2.0 / 3.0 - u[a] * u[a],
                            s => 1.0 / 6.0 + 0.5 * (u[a] * u[a] + f64::from(s) * u[a]),
                        })
                        .product::<f64>()
                        - w
                }
            };
            values.push((w * 0.05 * (r - 0.5) + eq) as f32);
            let _ = &mut velocity;
        }
    }
    Populations {
        step: 0,
        cells: CELLS,
        values,
        velocity,
        carried: Vec::new(),
    }
}

/// Σf, Σf² and f_1 at (3, 2, 1) after 50 steps.
fn run(change: impl Fn(&mut Setup), start: Equilibrium) -> [f64; 3] {
    let rig = Rig::new();
    let mut setup = Setup::periodic(CELLS, (1.0 / 1.9 - 0.5) / 3.0);
    setup.collision = Collision::Suga;
    setup.rates = Rates::SUGA;
    setup.equilibrium = Equilibrium::SecondOrder;
    setup.max_speed = 0.0;
    change(&mut setup);
    let wale = setup.wale.is_some();
    let mut lattice = riprap::lattice::Lattice::new(&rig.device, setup).unwrap();
    let mut start = noise_and_shear(start);
    if wale {
        let n = start.values.len() / 27;
        start.velocity = vec![0.0; 3 * n];
        for cell in 0..n {
            let f = |q: usize| f64::from(start.values[q * n + cell]);
            let rho = 1.0 + (0..27).map(f).sum::<f64>();
            for a in 0..3 {
                let j: f64 = (0..27).map(|q| f64::from(C[q][a]) * f(q)).sum();
                start.velocity[a * n + cell] = (j / rho) as f32;
            }
        }
    }
    lattice
        .set_populations(&rig.device, &rig.queue, &start)
        .unwrap();
    rig.run(&mut lattice, 50);
    let end = rig.populations(&mut lattice);
    let n = end.values.len() / 27;
    let full = |at: usize| f64::from(end.values[at]) + weight(at / n);
    let sum = (0..27 * n).map(full).sum();
    let squares = (0..27 * n).map(|at| full(at) * full(at)).sum();
    [sum, squares, full(n + 3 + 12 * (2 + 10))]
}

/// Relative to w_i the populations of f32 stay within 1e-6, of 16 bits within 2e-3.
fn assert_close(found: [f64; 3], sums: [f64; 2], single: f64, limit: f64) {
    println!(
        "found {found:?}, errors {:e} {:e} {:e}",
        found[0] / sums[0] - 1.0,
        found[1] / sums[1] - 1.0,
        (found[2] - single) / weight(1)
    );
    assert!((found[0] / sums[0] - 1.0).abs() < limit, "Σf");
    assert!((found[1] / sums[1] - 1.0).abs() < limit, "Σf²");
    assert!(((found[2] - single) / weight(1)).abs() < limit, "f_1");
}

const PLAIN: ([f64; 2], f64) = ([960.092464484255, 119.97860279855975], 0.07707931536167875);

#[test]
fn suga_in_f32() {
    assert_close(
        run(|_| {}, Equilibrium::SecondOrder),
        PLAIN.0,
        PLAIN.1,
        1e-6,
    );
}

#[test]
fn suga_in_f32_four_lanes() {
    assert_close(
        run(|s| s.lanes = 4, Equilibrium::SecondOrder),
        PLAIN.0,
        PLAIN.1,
        1e-6,
    );
}

#[test]
fn suga_in_16_bits() {
    for lanes in [2, 4] {
        let found = run(
            |s| (s.storage, s.lanes) = (Storage::F16, lanes),
            Equilibrium::SecondOrder,
        );
        assert_close(found, PLAIN.0, PLAIN.1, 2e-3);
    }
}

#[test]
fn guo_force() {
    let found = run(
        |s| s.force = Force::Constant([1e-4, -2e-4, 3e-4]),
        Equilibrium::SecondOrder,
    );
    assert_close(
        found,
        [PLAIN.0[0], 119.93706318447632],
        0.07853289024989864,
        1e-6,
    );
}

#[test]
fn wale() {
    let found = run(|s| s.wale = Some(0.5), Equilibrium::SecondOrder);
    assert_close(
        found,
        [PLAIN.0[0], 119.97977770593053],
        0.07702011099166237,
        1e-6,
    );
}

#[test]
fn product_equilibrium() {
    let found = run(
        |s| s.equilibrium = Equilibrium::Product,
        Equilibrium::SecondOrder,
    );
    assert_close(
        found,
        [PLAIN.0[0], 119.9786011214001],
        0.07707880968927251,
        1e-6,
    );
}
