//! Flows between walls whose exact solutions are known.

mod rig;

use rig::Rig;
use riprap::lattice::{Face, Force, Setup, State, Storage};

fn channel(cells: [u32; 3], tau: f64, faces: [Face; 2]) -> Setup {
    let mut setup = Setup::periodic(cells, (tau - 0.5) / 3.0);
    setup.faces[1] = faces;
    setup.lambda = Some(3.0 / 16.0);
    setup
}

/// Largest difference of u_x(y) from `exact`, relative to the largest exact value.
fn profile_error(rig: &Rig, setup: Setup, steps: usize, exact: impl Fn(f64) -> f64) -> f64 {
    let [nx, ny, nz] = setup.cells.map(|n| n as usize);
    let state = State::rest(nx * ny * nz);
    let mut lattice = rig.start(setup, &state, false);
    rig.run(&mut lattice, steps);
    let end = rig.state(&mut lattice);
    let scale = (0..ny)
        .map(|y| exact(y as f64 + 0.5).abs())
        .fold(0.0, f64::max);
    let mut worst: f64 = 0.0;
    for n in 0..nx * ny * nz {
        let y = ((n / nx) % ny) as f64 + 0.5;
        worst = worst.max((f64::from(end.velocity[0][n]) - exact(y)).abs());
    }
    worst / scale
}

const REST: [f64; 3] = [0.0; 3];

#[test]
fn poiseuille_is_exact_with_the_magic_parameter() {
    let rig = Rig::new();
    for (tau, lanes, storage, limit) in [
        (0.6, 1, Storage::F32, 1e-5),
        (1.0, 4, Storage::F32, 1e-5),
        (2.0, 1, Storage::F32, 1e-5),
        (1.0, 2, Storage::F16, 1e-2),
    ] {
        let h = 9.0;
        let mut setup = channel([3, 9, 4], tau, [Face::Wall(REST), Face::Wall(REST)]);
        (setup.lanes, setup.storage) = (lanes, storage);
        let nu = setup.nu;
        let force = 0.01 * 8.0 * nu / (h * h);
        setup.force = Force::Constant([force, 0.0, 0.0]);
        let steps = (8.0 * h * h / nu) as usize / 4;
        let error = profile_error(&rig, setup, steps, |y| force / (2.0 * nu) * y * (h - y));
        println!("tau {tau} lanes {lanes} {storage:?}: {error:e}");
        assert!(error < limit, "tau {tau}: {error:e}");
    }
}

#[test]
fn couette_is_linear() {
    let rig = Rig::new();
    for axis_lanes in [1, 4] {
        let mut setup = channel(
            [3, 7, 4],
            0.8,
            [Face::Wall(REST), Face::Wall([0.01, 0.0, 0.0])],
        );
        setup.lanes = axis_lanes;
        let error = profile_error(&rig, setup, 4000, |y| 0.01 * y / 7.0);
        println!("couette {error:e}");
        assert!(error < 1e-5);
    }
}

#[test]
fn film_with_a_slip_top() {
    let rig = Rig::new();
    let h = 8.0;
    let mut setup = channel([3, 8, 4], 0.7, [Face::Wall(REST), Face::FreeSlip]);
    let nu = setup.nu;
    let force = 0.01 * 2.0 * nu / (h * h);
    setup.force = Force::Constant([force, 0.0, 0.0]);
    let error = profile_error(&rig, setup, 12000, |y| force / nu * (h * y - 0.5 * y * y));
    println!("film {error:e}");
    assert!(error < 1e-5);
}

#[test]
fn channel_with_velocity_inlet_and_pressure_outlet() {
    let rig = Rig::new();
    for outlet in [
        Face::Pressure { density: 1.0 },
        Face::Outflow { density: 1.0 },
    ] {
        let h = 11.0;
        let mut setup = channel([40, 11, 4], 0.9, [Face::Wall(REST), Face::Wall(REST)]);
        setup.lanes = 4;
        let u_max = 0.004;
        let profile: Vec<[f32; 3]> = (0..4 * 11)
            .map(|n| {
                let y = (n % 11) as f64 + 0.5;
                [(4.0 * u_max * y * (h - y) / (h * h)) as f32, 0.0, 0.0]
            })
            .collect();
        setup.faces[0] = [Face::Velocity(profile), outlet.clone()];
        let nu = setup.nu;
        let cells = 40 * 11 * 4;
        let mut lattice = rig.start(setup, &State::rest(cells), false);
        for _ in 0..6 {
            rig.run(&mut lattice, 5000);
            println!(
                "outlet p {:e}",
                rig.state(&mut lattice).excess[5 * 40 + 38] / 3.0
            );
        }
        let end = rig.state(&mut lattice);
        let at = |x: usize, y: usize| x + 40 * y;
        let p = |x: usize| f64::from(end.excess[at(x, 5)]) / 3.0;
        let slope = (p(28) - p(12)) / 16.0;
        let exact = -8.0 * nu * u_max / (h * h);
        println!(
            "outlet {outlet:?}: slope {slope:e} exact {exact:e}; p_end {:e}, inlet u {}",
            p(39),
            end.velocity[0][at(0, 5)]
        );
        for y in 0..11 {
            print!("{:.5} ", end.velocity[0][at(20, y)]);
        }
        println!();
        assert!((slope / exact - 1.0).abs() < 0.01);
    }
}

#[test]
fn outlet_lets_sound_out() {
    let rig = Rig::new();
    for hold in [0.0] {
        for u in [0.0, 0.05] {
            let n = 200;
            let mut setup = Setup::periodic([n, 1, 4], 1e-3);
            setup.faces[0] = [
                Face::Velocity(vec![[u, 0.0, 0.0]; 4]),
                Face::Outflow { density: 1.0 },
            ];
            let mut state = State::rest(n as usize * 4);
            for k in 0..n as usize * 4 {
                let x = (k % n as usize) as f64 - 100.0;
                let pulse = 1e-3 * (-x * x / (2.0 * 64.0)).exp();
                state.excess[k] = pulse as f32;
                state.velocity[0][k] = u + (pulse / 3f64.sqrt() / (1.0 + pulse)) as f32;
            }
            let mut lattice = rig.start(setup, &state, false);
            rig.run(&mut lattice, 300);
            let end = rig.state(&mut lattice);
            let (lo, hi) = end
                .excess
                .iter()
                .fold((0f32, 0f32), |(l, h), v| (l.min(*v), h.max(*v)));
            println!(
                "reflect hold {hold} u {u}: {:.4} {:.4} %",
                lo * 1e5,
                hi * 1e5
            );
        }
    }
}
