//! Turbulence at velocity faces: compared with the sum of its modes in f64; its variance, divergence and net flow.

use kit::{Rig, assert_contains, assert_near};
use riprap::{
    gpu::readback::Readback,
    lattice::{Face, FourierMode, Lattice, Setup, State, SyntheticTurbulence, in_plane},
};

const TURBULENCE: SyntheticTurbulence = SyntheticTurbulence {
    intensity: 0.2,
    length: 3.0,
    seed: 5,
};

/// A box with a face that has these velocities and turbulence.
fn setup(axis: usize, side: usize, velocity: [f32; 3], turbulence: SyntheticTurbulence) -> Setup {
    let mut setup = Setup::periodic([7, 11, 9], 0.02);
    setup.max_speed = 0.0;
    let (a, b) = in_plane(axis);
    let count = setup.cells[a] * setup.cells[b];
    setup.faces[axis] = [
        Face::Outflow { density: 1.0 },
        Face::Outflow { density: 1.0 },
    ];
    setup.faces[axis][side] = Face::Velocity(vec![velocity; count as usize]);
    setup.turbulence[axis][side] = Some(turbulence);
    setup
}

fn start(rig: &Rig, setup: Setup) -> Lattice {
    let cells = setup.cells.iter().product::<u32>() as usize;
    let lattice = rig.start(setup, &State::rest(cells), true);
    let poison = vec![f32::NAN; cells];
    let buffer = lattice.wall_velocity_buffer().unwrap();
    let words = (buffer.size() / 4) as usize;
    let bytes = bytemuck::cast_slice(&poison[..words.min(cells)]);
    rig.queue.write_buffer(buffer, 0, bytes);
    lattice
}

/// Position on the face and velocity of each of its cells in the last step.
fn velocities(rig: &Rig, lattice: &Lattice, axis: usize) -> Vec<([u32; 2], [f64; 3])> {
    let buffer = lattice.wall_velocity_buffer().unwrap();
    let count = (buffer.size() / 4) as usize;
    let mut readback = Readback::default();
    let read = readback.read::<f32>(&rig.device, &rig.queue, buffer, count);
    let values = rig.wait(read).unwrap();
    let (a, b) = in_plane(axis);
    let cells = lattice.geometry().moving.iter().zip(values.chunks(9));
    cells
        .map(|(cell, faces)| {
            let at = lattice.grid().padded_cell(cell.cell);
            let u = [0, 1, 2].map(|i| f64::from(faces[3 * axis + i]));
            ([at[a], at[b]], u)
        })
        .collect()
}

/// u'/(intensity U) at a position on the face when the flow has travelled this far.
fn fluctuation(modes: &[FourierMode], axis: usize, at: [u32; 2], travelled: f64) -> [f64; 3] {
    let (a, b) = in_plane(axis);
    let mut u = [0.0; 3];
    for mode in modes {
        let along = mode.k[a] * f64::from(at[0]) + mode.k[b] * f64::from(at[1]);
        let (sin, cos) = (along - mode.k[axis] * travelled + mode.phase).sin_cos();
        for i in 0..3 {
            u[i] += mode.a[i] * cos + mode.b[i] * sin;
        }
    }
    u
}

#[test]
fn a_face_has_the_sum_of_its_modes_without_their_net_flow() {
    let rig = Rig::new();
    for axis in 0..3 {
        for side in 0..2 {
            let mut mean = [0.01f32, -0.02, 0.015];
            mean[axis] = [0.05, -0.05][side];
            let mut lattice = start(&rig, setup(axis, side, mean, TURBULENCE));
            let modes = TURBULENCE.modes(axis);
            // Rounded to 2^-16 cell.
            let advance = (f64::from(mean[axis]) * 65536.0).round() / 65536.0;
            for steps in [2, 1, 500] {
                rig.run(&mut lattice, steps);
                // The initial state is complete: step 1 is the first with turbulence at the face.
                let distance = (lattice.step() - 2) as f64 * advance;
                let found = velocities(&rig, &lattice, axis);
                let expected: Vec<_> = found
                    .iter()
                    .map(|(at, _)| fluctuation(&modes, axis, *at, distance))
                    .collect();
                let net = expected.iter().map(|u| u[axis]).sum::<f64>() / expected.len() as f64;
                let mut flow = 0.0;
                for ((_, found), expected) in found.iter().zip(&expected) {
                    for i in 0..3 {
                        let net = if i == axis { net } else { 0.0 };
                        let u = f64::from(mean[i]) + 0.2 * 0.05 * (expected[i] - net);
                        assert_near(found[i], u, 2e-8);
                    }
                    flow += found[axis] - f64::from(mean[axis]);
                }
                // Velocities of 0.05 are rounded to 3.7e-9.
                assert_near(flow / found.len() as f64, 0.0, 4e-9);
            }
        }
    }
}

/// Each component has the intensity, whatever the seed and the length.
#[test]
fn the_modes_have_the_intensity() {
    for seed in 0..40 {
        for length in [1.0, 4.0, 20.0] {
            let modes = SyntheticTurbulence {
                seed,
                length,
                ..TURBULENCE
            }
            .modes(0);
            for i in 0..3 {
                let variance: f64 = modes
                    .iter()
                    .map(|m| 0.5 * (m.a[i].powi(2) + m.b[i].powi(2)))
                    .sum();
                assert_near(variance.sqrt(), 1.0, 1e-3);
            }
        }
    }
}

/// The flow moves one cell per step, so that three steps give the difference along the normal; the net flow that is subtracted
/// is the same in all cells.
#[test]
fn central_differences_have_no_divergence() {
    let rig = Rig::new();
    for axis in 0..3 {
        let mut mean = [0.0f32; 3];
        mean[axis] = 1.0;
        let mut lattice = start(&rig, setup(axis, 0, mean, TURBULENCE));
        rig.run(&mut lattice, 9);
        let fields = [0, 1, 2].map(|_| {
            rig.run(&mut lattice, 1);
            velocities(&rig, &lattice, axis)
        });
        let (a, b) = in_plane(axis);
        let at = |step: usize, place: [u32; 2], i: usize| {
            let found = fields[step].iter().find(|(at, _)| *at == place);
            found.unwrap().1[i]
        };
        let cells = lattice.grid().cells;
        let mut divergence = Vec::new();
        for y in 1..cells[b] - 1 {
            for x in 1..cells[a] - 1 {
                let here = [x, y];
                // Fluid farther upstream arrives later.
                let normal = at(0, here, axis) - at(2, here, axis);
                let lower = at(1, [x + 1, y], a) - at(1, [x - 1, y], a);
                let upper = at(1, [x, y + 1], b) - at(1, [x, y - 1], b);
                divergence.push(0.5 * (normal + lower + upper));
            }
        }
        let mean = divergence.iter().sum::<f64>() / divergence.len() as f64;
        for value in divergence {
            // The rates are 0.1; velocities of 1 round to 6e-8.
            assert_near(value, mean, 5e-7);
        }
    }
}

/// A flow that accelerates carries the same eddies faster and amplifies them.
#[test]
fn a_change_of_the_mean_velocity_goes_on_from_the_same_eddies() {
    let rig = Rig::new();
    let mut lattice = start(&rig, setup(0, 0, [0.03125, 0.0, 0.0], TURBULENCE));
    rig.run(&mut lattice, 20);
    let faster = vec![[0.0625, 0.0, 0.0]; 99];
    lattice.set_face_velocity(&rig.queue, 0, 0, faster).unwrap();
    rig.run(&mut lattice, 11);
    let modes = TURBULENCE.modes(0);
    let distance = 19.0 * 0.03125 + 10.0 * 0.0625;
    for (at, found) in velocities(&rig, &lattice, 0) {
        let expected = fluctuation(&modes, 0, at, distance);
        for i in 1..3 {
            assert_near(found[i], 0.2 * 0.0625 * expected[i], 2e-8);
        }
    }
}

#[test]
fn what_is_no_turbulence_is_refused() {
    let rig = Rig::new();
    let refused = |setup: Setup| Lattice::new(&rig.device, setup).unwrap_err();
    let with = |change: fn(&mut SyntheticTurbulence)| {
        let mut turbulence = TURBULENCE;
        change(&mut turbulence);
        refused(setup(0, 0, [0.1, 0.0, 0.0], turbulence))
    };
    assert_contains(with(|t| t.intensity = 0.0), &["x_min.turbulence.intensity"]);
    assert_contains(with(|t| t.intensity = f64::NAN), &["intensity", "NaN"]);
    assert_contains(with(|t| t.length = 0.5), &["length", "0.5 cells"]);
    let mut wall = setup(0, 0, [0.1, 0.0, 0.0], TURBULENCE);
    wall.faces[0][0] = Face::Wall([0.0; 3]);
    assert_contains(refused(wall), &["x_min", "velocity face"]);
}
