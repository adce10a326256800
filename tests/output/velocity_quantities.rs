//! Quantities that `riprap::output` computes from an image: values between cells, vorticity, Q.

use riprap::output::{Array, ImageData, VelocityQuantities};
use std::f64::consts::TAU;

#[test]
fn a_sample_is_linear_between_centres_clamped_and_blind_to_solids() {
    let mut image = ImageData {
        origin: [1.0, 0.0, 0.0],
        spacing: 0.5,
        cells: [4, 3, 2],
        arrays: Vec::new(),
    };
    // Exact in f32 and f64, so that the interpolation of a linear field can be compared by ==.
    let linear = |[x, y, z]: [f64; 3]| 2.0 * x - y + 4.0 * z;
    let mut values = Vec::new();
    let mut solid = Vec::new();
    for k in 0..2 {
        for j in 0..3 {
            for i in 0..4 {
                let centre = [i, j, k].map(|index| 0.5 * (f64::from(index) + 0.5));
                values.push(linear([centre[0] + 1.0, centre[1], centre[2]]) as f32);
                solid.push(f32::from(i == 3));
            }
        }
    }
    image.arrays.push(Array {
        name: "p".into(),
        components: 1,
        values,
    });
    let at = |image: &ImageData, point| image.sample("p", point).map(|values| values[0]);
    assert_eq!(
        at(&image, [1.5, 0.625, 0.5]),
        Some(linear([1.5, 0.625, 0.5]))
    );
    assert_eq!(
        at(&image, [-9.0, 9.0, 0.5]),
        Some(linear([1.25, 1.25, 0.5]))
    );
    assert_eq!(at(&image, [f64::NAN, 0.0, 0.0]), None);
    assert_eq!(image.sample("q", [1.5, 0.5, 0.5]), None);

    image.arrays.push(Array {
        name: "solid".into(),
        components: 1,
        values: solid,
    });
    // Half-way to the solid only the last fluid cell contributes; inside there is no value.
    assert_eq!(
        at(&image, [2.5, 0.75, 0.25]),
        Some(linear([2.25, 0.75, 0.25]))
    );
    assert_eq!(at(&image, [2.75, 0.75, 0.25]), None);
}

/// A Taylor–Green vortex u = (sin x cos y, −cos x sin y, 0) on `cells` per period, 2π m long.
fn vortex(cells: usize, solid: impl Fn(f64, f64) -> bool) -> ImageData {
    let spacing = TAU / cells as f64;
    let mut velocity = Vec::new();
    let mut mask = Vec::new();
    for j in 0..cells {
        for i in 0..cells {
            let [x, y] = [i, j].map(|index| (index as f64 + 0.5) * spacing);
            velocity.extend([(x.sin() * y.cos()) as f32, (-x.cos() * y.sin()) as f32, 0.0]);
            mask.push(f32::from(solid(x, y)));
        }
    }
    ImageData {
        origin: [0.0; 3],
        spacing,
        cells: [cells, cells, 1],
        arrays: vec![
            Array {
                name: "velocity".into(),
                components: 3,
                values: velocity,
            },
            Array {
                name: "solid".into(),
                components: 1,
                values: mask,
            },
        ],
    }
}

/// Largest errors of the vorticity 2 sin x sin y and of Q = cos²x cos²y·(−1) + sin²x sin²y in the fluid.
fn vortex_errors(cells: usize, periodic: bool, solid: fn(f64, f64) -> bool) -> [f64; 2] {
    let image = vortex(cells, solid);
    let quantities =
        VelocityQuantities::new(&image, [periodic; 3]).expect("a velocity on every cell");
    let (vorticity, q) = (quantities.vorticity(), quantities.q_criterion());
    let mut errors = [0.0_f64; 2];
    for j in 0..cells {
        for i in 0..cells {
            let [x, y] = [i, j].map(|index| (index as f64 + 0.5) * image.spacing);
            let cell = image.cell_index(i, j, 0);
            let found = [vorticity.values[3 * cell + 2], q.values[cell]].map(f64::from);
            let mut wants = [
                2.0 * x.sin() * y.sin(),
                (x.sin() * y.sin()).powi(2) - (x.cos() * y.cos()).powi(2),
            ];
            if image.is_solid(cell) {
                wants = [0.0; 2];
            }
            for (error, (found, want)) in errors.iter_mut().zip(found.into_iter().zip(wants)) {
                *error = error.max((found - want).abs());
            }
        }
    }
    errors
}

#[test]
fn vorticity_and_q_converge_with_second_order_up_to_walls_and_solids() {
    let plate: fn(f64, f64) -> bool = |x, y| (x - 3.0).abs() < 0.8 && (y - 3.0).abs() < 0.8;
    let open: fn(f64, f64) -> bool = |_, _| false;
    for (periodic, solid) in [(true, open), (false, open), (true, plate), (false, plate)] {
        let coarse = vortex_errors(32, periodic, solid);
        let fine = vortex_errors(64, periodic, solid);
        for (coarse, fine) in coarse.into_iter().zip(fine) {
            // One-sided truncation error (h²/3)|u'''|, for both gradients: h = 0.098 m.
            assert!(fine < 2.0 * 0.098_f64.powi(2) / 3.0, "error {fine}");
            let order = (coarse / fine).log2();
            // From a maximum over cells whose positions shift with h; 2 in the limit.
            assert!((1.8..2.2).contains(&order), "order {order}");
        }
    }
}

#[test]
fn a_gradient_uses_what_neighbours_there_are() {
    // u_x = x² on three cells of 1 m, then a solid, then one fluid cell between solids.
    let u = [0.25_f32, 2.25, 6.25, 99.0, 5.0, 99.0];
    let solid = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 1.0];
    let image = ImageData {
        origin: [0.0; 3],
        spacing: 1.0,
        cells: [6, 1, 1],
        arrays: vec![
            Array {
                name: "velocity".into(),
                components: 3,
                values: u.iter().flat_map(|&u| [u, 0.0, 0.0]).collect(),
            },
            Array {
                name: "solid".into(),
                components: 1,
                values: solid.to_vec(),
            },
        ],
    };
    let quantities = VelocityQuantities::new(&image, [false; 3]).expect("a velocity");
    let derivative = |i| quantities.gradient([i, 0, 0])[0][0];
    // Second-order differences of a parabola are exact: 2x at x = 0.5, 1.5, 2.5 m.
    assert_eq!([0, 1, 2].map(derivative), [1.0, 3.0, 5.0]);
    assert_eq!([3, 4, 5].map(derivative), [0.0; 3]);
}
