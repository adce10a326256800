//! Streamlines in space follow the flow, are spread over the fluid, and avoid cells without fluid.

use glam::{DMat3, DVec3};
use riprap::geometry::{Form, Polyhedron};
use riprap::output::{Array, ImageData};
use riprap_harness::picture::{Placed, traces};

/// `velocity` (m/s) at the centres of cells of 0.1 m that fill the box of 4 m × 2 m × 2 m at the origin.
fn image(velocity: impl Fn(DVec3) -> DVec3) -> ImageData {
    let mut image = ImageData {
        origin: [0.0; 3],
        spacing: 0.1,
        cells: [40, 20, 20],
        arrays: Vec::new(),
    };
    let mut values = Vec::new();
    for k in 0..20 {
        for j in 0..20 {
            for i in 0..40 {
                let centre = 0.1 * (DVec3::new(f64::from(i), f64::from(j), f64::from(k)) + 0.5);
                values.extend(velocity(centre).to_array().map(|u| u as f32));
            }
        }
    }
    image.arrays.push(Array {
        name: "velocity".into(),
        components: 3,
        values,
    });
    image
}

#[test]
fn traces_of_a_turning_flow_stay_on_their_helices_with_their_speeds() {
    // A rigid rotation about the axis x at (1, 1), moving along x: u = (1, −(z − 1), y − 1).
    let helices = traces(&image(|x| DVec3::new(1.0, 1.0 - x.z, x.y - 1.0)), &[], 30);
    let radius = |x: DVec3| (x.y - 1.0).hypot(x.z - 1.0);
    // Beyond the outermost centres the velocity is constant, so that lines there are no helices.
    let inner = |x: &DVec3| (x.y - 1.0).abs().max((x.z - 1.0).abs()) < 0.95;
    let mut whole = 0;
    for trace in &helices {
        assert!(trace.points.is_sorted_by(|a, b| a.x < b.x), "downstream");
        assert_eq!(trace.points.len(), trace.speeds.len());
        if !trace.points.iter().all(inner) {
            continue;
        }
        whole += 1;
        let first = radius(trace.points[0]);
        for (x, speed) in trace.points.iter().zip(&trace.speeds) {
            // Trilinear interpolation of a linear field is exact, and the error of 80 steps of half a cell is 1e-8 each.
            assert!((radius(*x) - first).abs() < 1e-5, "{x} from {first}");
            // f32 has seven digits.
            assert!((speed - 1.0_f64.hypot(radius(*x))).abs() < 1e-6, "{speed}");
        }
    }
    assert!(whole > 10, "{whole} of {} lines", helices.len());
}

#[test]
fn traces_keep_apart_and_leave_no_part_of_the_fluid_out() {
    let along = traces(&image(|_| DVec3::X), &[], 40);
    // Lines along x through a square of 2 m: 40 of them have 0.40 m each, and seeds keep half of the distance that lines in
    // a cube of the same volume would have, ∛16/√40 m.
    let apart = 0.5 * 16.0_f64.cbrt() / 40.0_f64.sqrt();
    for (number, one) in along.iter().enumerate() {
        assert!(
            (one.points[one.points.len() - 1].x - one.points[0].x) > 3.8,
            "through the box"
        );
        for other in &along[..number] {
            let [from, to] = [one, other].map(|trace| trace.points[0]);
            let distance = (from.y - to.y).hypot(from.z - to.z);
            assert!(distance > apart - 1e-9, "{distance}");
        }
    }
    // No point of the square is farther from all lines than two of these distances.
    for (y, z) in
        (0..20).flat_map(|y| (0..20).map(move |z| (0.1 * f64::from(y), 0.1 * f64::from(z))))
    {
        let near = along
            .iter()
            .any(|t| (t.points[0].y - y).hypot(t.points[0].z - z) < 2.0 * apart);
        assert!(near, "a hole at {y} {z}");
    }
}

#[test]
fn traces_end_at_solids_and_at_blocks_and_still_water_has_none() {
    let mut channel = image(|_| DVec3::X);
    let count = channel.cell_count();
    // Solid for x > 3 m.
    let solid = |cell: usize| f32::from(cell % 40 >= 30);
    channel.arrays.push(Array {
        name: "solid".into(),
        components: 1,
        values: (0..count).map(solid).collect(),
    });
    let form = Form::Convex(Polyhedron::cuboid(DVec3::new(0.4, 4.0, 4.0)).expect("a wall"));
    let wall = Placed {
        form: &form,
        centre: DVec3::new(1.0, 1.0, 1.0),
        deformation: DMat3::IDENTITY,
    };
    let cut = traces(&channel, &[wall], 20);
    assert!(cut.len() > 10);
    let mut sides = [0; 2];
    for trace in &cut {
        let [first, last] = [0, trace.points.len() - 1].map(|at| trace.points[at].x);
        // The wall fills x from 0.8 m to 1.2 m.
        assert!(last < 0.8 || (first > 1.2 && last < 3.0), "{first} {last}");
        sides[usize::from(first > 1.2)] += 1;
    }
    assert!(sides[0] > 0 && sides[1] > sides[0], "{sides:?}");
    assert!(traces(&image(|_| DVec3::ZERO), &[], 20).is_empty());
}
