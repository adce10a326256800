//! Friction on walls by a wall law: compared with its f64 twin, no slip in laminar flow, and exact momentum balance.

use crate::kernels::assert_equal_to_twin;
use kit::{
    Rig, assert_near,
    twin::{
        WallLaw,
        of_setup::{layouts, noise},
    },
};
use riprap::lattice::{Face, Force, Rates, Setup, State, WallModel};

const WALL: Face = Face::Wall([0.0; 3]);

/// A channel normal to an axis, with rough or smooth walls, and a bar with edges on one of them.
fn channel(normal: usize, nu: f64) -> Setup {
    let mut cells = [8, 8, 8];
    cells[normal] = 11;
    let mut setup = Setup::periodic(cells, nu);
    setup.wale = Some(0.5);
    setup.wall_model = Some(WallModel::WernerWengle);
    setup.faces[normal] = [WALL, WALL];
    setup
}

#[test]
fn kernel_and_twin() {
    for (n, (storage, lanes, axis)) in layouts().into_iter().enumerate() {
        for normal in 0..3 {
            // No slip, blended, and the full model: at random velocities of 0.003, y+ of the first cell is near 0.3, 4 and 80.
            let nu = [3e-3, 3e-5, 1e-6][(n + normal) % 3];
            let mut setup = channel(normal, nu);
            (setup.storage, setup.lanes, setup.lane_axis) = (storage, lanes, axis);
            if n % 2 == 1 {
                setup.wall_model = Some(WallModel::Reichardt);
                setup.wall_roughness[normal] = [0.0, 0.7];
            }
            let name = format!("{storage:?} {lanes} along {axis}, normal {normal}, nu {nu}");
            assert_equal_to_twin(&name, &setup);
        }
    }
}

#[test]
fn edges_corners_gaps_and_other_faces() {
    for (storage, lanes, axis) in layouts() {
        let mut setup = Setup::periodic([16, 9, 12], 1e-5);
        (setup.storage, setup.lanes, setup.lane_axis) = (storage, lanes, axis);
        setup.wale = Some(0.5);
        setup.wall_model = Some(WallModel::WernerWengle);
        setup.solid_roughness = (0..16 * 9 * 12).map(|n| 0.1 * (n % 16) as f32).collect();
        setup.force = Force::Constant([1e-5, 0.0, 3e-4]);
        let inlet = (0..9 * 12).map(|n| [0.02, 0.005 * noise(n) as f32, 0.0]);
        setup.faces = [
            [Face::Velocity(inlet.collect()), Face::FreeSlip],
            [WALL, Face::FreeSlip],
            [WALL, Face::Wall([0.01, 0.0, 0.0])],
        ];
        // A step on the bed, and a lid four cells above it.
        setup.solid = (0..16 * 9 * 12)
            .map(|n| [n % 16, (n / 16) % 9, n / 144])
            .map(|[x, _, z]| (5..11).contains(&x) && (z < 4 || (x > 7 && (8..10).contains(&z))))
            .collect();
        let name = format!("{storage:?} {lanes} along {axis}");
        assert_equal_to_twin(&name, &setup);
    }
}

/// A wave along the walls, and noise.
fn waves(cells: [u32; 3], speed: f64) -> State {
    let count = cells.iter().product::<u32>() as usize;
    let mut state = State::rest(count);
    for n in 0..count {
        let z = n / (cells[0] * cells[1]) as usize;
        let shape = (std::f64::consts::PI * (z as f64 + 0.5) / f64::from(cells[2])).sin();
        for a in 0..3 {
            let mean = if a == 0 { shape.sqrt() } else { 0.0 };
            state.velocity[a][n] = (speed * (mean + 0.1 * noise(3 * n + a))) as f32;
        }
    }
    state
}

#[test]
fn laminar_walls_have_no_slip_to_the_bit() {
    let rig = Rig::new();
    // y+ of the first cell is up to 2.
    let setup = channel(2, 5e-3);
    let mut plain = setup.clone();
    plain.wall_model = None;
    let [with, without] = [setup, plain].map(|setup| {
        let mut lattice = rig.start(setup, &waves([8, 8, 11], 0.03), true);
        rig.run(&mut lattice, 200);
        let walls = rig
            .wait(lattice.wall_stresses(&rig.device, &rig.queue))
            .unwrap();
        assert!(walls.iter().all(|wall| wall.share == 0.0));
        rig.populations(&mut lattice).values
    });
    let bits = |values: Vec<f32>| values.into_iter().map(f32::to_bits).collect::<Vec<_>>();
    assert_eq!(bits(with), bits(without));
}

#[test]
fn the_fluid_loses_what_the_walls_receive() {
    for (side, count) in [(Face::Periodic, 2 * 8 * 8), (WALL, 2 * 8 * (8 + 11))] {
        let rig = Rig::new();
        let mut setup = channel(2, 1e-5);
        setup.faces[1] = [side.clone(), side];
        let force = 2e-5;
        setup.force = Force::Constant([force, 0.0, 0.0]);
        let cells = 8.0 * 8.0 * 11.0;
        let mut lattice = rig.start(setup, &waves([8, 8, 11], 0.03), true);
        // Momentum along x of the populations that are complete before a step.
        let mut before: Option<f64> = None;
        for _ in 0..20 {
            rig.run(&mut lattice, 1);
            let populations = rig.populations(&mut lattice);
            let own = (0..27).map(|q| {
                let c = f64::from(riprap::lattice::C[q][0]);
                let values = &populations.values[q * 704..(q + 1) * 704];
                c * values.iter().map(|f| f64::from(*f)).sum::<f64>()
            });
            let momentum: f64 = own.sum();
            let walls = rig
                .wait(lattice.wall_stresses(&rig.device, &rig.queue))
                .unwrap();
            assert_eq!(walls.len(), count);
            assert!(walls.iter().all(|wall| wall.share == 1.0));
            let received: f64 = walls.iter().map(|wall| f64::from(wall.stress[0])).sum();
            if let Some(before) = before {
                assert_near(
                    momentum - before,
                    force * cells - received,
                    1e-7 * cells * 0.03,
                );
            }
            before = Some(momentum);
        }
    }
}

/// In a stream of 0.1 cells per step, y+ of the first cell 250, the transverse velocity must not alternate from cell to cell along
/// the wall.
#[test]
fn water_at_a_wall_does_not_oscillate_from_cell_to_cell() {
    const SPEED: f64 = 0.1;
    let rig = Rig::new();
    let cells = [16_u32, 8, 12];
    let alternating = |rates: Option<Rates>, floor: Option<f64>| {
        let mut setup = Setup::periodic(cells, 1e-5);
        setup.wale = Some(0.5);
        setup.wall_model = Some(WallModel::WernerWengle);
        setup.faces[2] = [WALL, WALL];
        (setup.rates, setup.odd_rate_floor) = (rates, floor);
        let mut lattice = rig.start(setup, &eddies(cells, SPEED), true);
        rig.run(&mut lattice, 1000);
        let v = &rig.state(&mut lattice).velocity[1];
        let row = cells[0] as usize;
        let at_wall = &v[..row * cells[1] as usize];
        let squares = at_wall.chunks(row).flat_map(|row| {
            row.windows(3).map(|v| {
                let part = f64::from(v[0]) - 2.0 * f64::from(v[1]) + f64::from(v[2]);
                (0.25 * part).powi(2)
            })
        });
        (squares.sum::<f64>() / at_wall.len() as f64).sqrt() / SPEED
    };
    assert!(alternating(Some(Rates::SUGA), Some(0.8)) > 5e-3);
    assert!(alternating(None, None) < 5e-4);
}

/// A stream along x with three waves of 0.15 times its speed.
fn eddies(cells: [u32; 3], speed: f64) -> State {
    let count = cells.iter().product::<u32>() as usize;
    let mut state = State::rest(count);
    for n in 0..count {
        let row = n / cells[0] as usize;
        let at = [
            n % cells[0] as usize,
            row % cells[1] as usize,
            row / cells[1] as usize,
        ];
        let x = [0, 1, 2].map(|a| (at[a] as f64 + 0.5) / f64::from(cells[a]));
        let wave = |k: [f64; 3]| {
            let phase = k[0] * x[0] + k[1] * x[1] + k[2] * x[2];
            0.15 * (std::f64::consts::TAU * phase).sin()
        };
        let between = (std::f64::consts::PI * x[2]).sin();
        let u = [
            1.0 + wave([2.0, 1.0, 2.0]),
            wave([3.0, -2.0, 1.0]),
            wave([1.0, 2.0, 3.0]) * between,
        ];
        for a in 0..3 {
            state.velocity[a][n] = (speed * u[a]) as f32;
        }
    }
    state
}

/// Compares both laws with u⁺ = ln(y⁺)/0.384 + 4.27.
#[test]
fn laws_are_near_the_log_law() {
    let farthest = |law: WallLaw, from: f64, to: f64| {
        let heights = (0..=200).map(|n| from * (to / from).powf(f64::from(n) / 200.0));
        let error = |y: f64| (law.speed(y) / (y.ln() / 0.384 + 4.27) - 1.0).abs();
        heights.map(error).fold(0.0, f64::max)
    };
    assert!(farthest(WallLaw::WernerWengle, 30.0, 2500.0) < 0.03);
    assert!(farthest(WallLaw::Reichardt, 100.0, 1e8) < 0.01);
}
