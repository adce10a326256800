//! Probes of images with values from formulas.

use kit::{assert_contains, assert_near};
use riprap::output::{Array, ImageData};
use riprap::scene::{Axis, Scene};
use riprap::simulation::probe::{Gauge, Layer};

/// 8 × 6 × 4 cells of 0.5 m, walls in y, with a block in a corner; z is periodic.
fn text(probe: &str) -> String {
    format!(
        r#"
        [domain]
        size = [4, 3, 2]
        cell = 0.5
        [fluid]
        viscosity = 1e-3
        [boundaries]
        x_min = {{ kind = "free_slip" }}
        x_max = {{ kind = "free_slip" }}
        y_min = {{ kind = "wall" }}
        y_max = {{ kind = "wall", velocity = [2, 0, 0] }}
        [[solids]]
        kind = "box"
        name = "block"
        min = [2, 0, 0]
        max = [4, 1, 2]
        [run]
        steps = 1
        [[probes]]
        name = "p"
        {probe}
        "#
    )
}

fn scene(probe: &str) -> Scene {
    kit::scene::read(&text(probe)).unwrap()
}

fn solid(scene: &Scene) -> Vec<bool> {
    let mask = scene.solid_mask().unwrap();
    mask.as_slice().iter().map(|s| *s != 0).collect()
}

/// The scene with p = 1 + 2x − 3y and u = (y, x, 4).
fn image(scene: &Scene) -> ImageData {
    let (mut pressure, mut velocity) = (Vec::new(), Vec::new());
    for [x, y, _] in scene.domain.centres() {
        pressure.push((1.0 + 2.0 * x - 3.0 * y) as f32);
        velocity.extend([y as f32, x as f32, 4.0]);
    }
    let array = |name: &str, components, values| Array {
        name: name.into(),
        components,
        values,
    };
    ImageData {
        origin: scene.domain.origin,
        spacing: scene.domain.cell,
        cells: scene.cells().map(|n| n as usize),
        arrays: vec![
            array("velocity", 3, velocity),
            array("pressure", 1, pressure),
            array(
                "solid",
                1,
                solid(scene)
                    .iter()
                    .map(|s| f32::from(u8::from(*s)))
                    .collect(),
            ),
        ],
    }
}

fn measure(probe: &str) -> (Vec<String>, Vec<Vec<f64>>) {
    let scene = scene(probe);
    let gauge = Gauge::new(&scene, &solid(&scene), &scene.probes[0]).unwrap();
    let rows = gauge.measure(&image(&scene)).unwrap();
    assert!(rows.iter().all(|row| row.len() == gauge.columns().len()));
    (gauge.columns().to_vec(), rows)
}

fn refusal(probe: &str) -> String {
    let scene = scene(probe);
    let made = Gauge::new(&scene, &solid(&scene), &scene.probes[0]);
    made.unwrap_err().to_string()
}

/// Asserts equality up to the f32 rounding of sums of a few numbers below 16.
#[track_caller]
fn near(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (found, expected) in found.iter().zip(expected) {
        assert_near(*found, *expected, 1e-5);
    }
}

#[test]
fn a_point_in_the_fluid_has_the_value_of_a_linear_field() {
    let (columns, rows) = measure("kind = \"point\"\nat = [1.1, 1.3, 0.9]");
    let names = ["velocity_x", "velocity_y", "velocity_z", "pressure"];
    assert_eq!(columns, names);
    near(&rows[0], &[1.3, 1.1, 4.0, 1.0 + 2.2 - 3.9]);
    assert_eq!(rows.len(), 1);
}

#[test]
fn a_point_reads_the_eight_cells_around_it() {
    let scene = scene("kind = \"point\"\nat = [1.1, 1.3, 0.9]");
    let gauge = Gauge::new(&scene, &solid(&scene), &scene.probes[0]).unwrap();
    assert_eq!(gauge.cells().len(), 8);
    assert_eq!(gauge.fields().len(), 2);
}

#[test]
fn velocity_goes_to_the_wall_and_pressure_stays_before_it() {
    // The last centres lie at y = 2.75, the wall, moving with 2 m/s, at y = 3.
    let (_, rows) =
        measure("kind = \"line\"\nfrom = [1.25, 2.75, 1]\nto = [1.25, 3, 1]\ncount = 3");
    let pressure = 1.0 + 2.5 - 8.25;
    near(&rows[0][4..], &[2.75, 1.25, 4.0, pressure]);
    near(&rows[1][4..], &[2.375, 0.625, 2.0, pressure]);
    near(&rows[2][4..], &[2.0, 0.0, 0.0, pressure]);
}

#[test]
fn a_line_counts_its_distance_and_has_both_ends() {
    let (columns, rows) = measure(
        "kind = \"line\"\nfrom = [0, 2, 1]\nto = [3, 2, 1]\ncount = 4\nfields = [\"pressure\"]",
    );
    assert_eq!(columns, ["s", "x", "y", "z", "pressure"]);
    assert_eq!(rows.len(), 4);
    near(&rows[1], &[1.0, 1.0, 2.0, 1.0, 1.0 + 2.0 - 6.0]);
    // Free slip keeps the values in front of the face.
    near(&rows[0], &[0.0, 0.0, 2.0, 1.0, 1.0 + 0.5 - 6.0]);
    assert_eq!(rows[3][..4], [3.0, 3.0, 2.0, 1.0]);
}

#[test]
fn a_periodic_end_joins_the_other_one() {
    let scene = scene("kind = \"point\"\nat = [1.25, 1.75, 0]\nfields = [\"pressure\"]");
    let mut image = image(&scene);
    let pressure = &mut image.arrays[1].values;
    let layer = pressure.len() / 4;
    pressure.fill(0.0);
    pressure[3 * layer..].fill(6.0);
    let gauge = Gauge::new(&scene, &solid(&scene), &scene.probes[0]).unwrap();
    near(&gauge.measure(&image).unwrap()[0], &[3.0]);
}

/// Blocks and cells that solids fill in part have no mark in the scene, only in the field.
#[test]
fn the_solid_fraction_is_that_of_the_field() {
    for probe in [
        "kind = \"line\"\nfrom = [0.25, 2.25, 0.75]\nto = [3.75, 2.25, 0.75]\ncount = 8\n",
        "kind = \"plane\"\naxis = \"z\"\nposition = 0.75\n",
    ] {
        let scene = scene(&format!("{probe}fields = [\"solid\"]"));
        let mut image = image(&scene);
        let centres = scene.domain.centres();
        let field = image.arrays[2].values.iter_mut().zip(centres);
        field.for_each(|(value, [x, ..])| *value = value.max((x / 8.0) as f32));
        let gauge = Gauge::new(&scene, &solid(&scene), &scene.probes[0]).unwrap();
        for row in gauge.measure(&image).unwrap() {
            let n = row.len();
            let [x, y] = [row[n - 4], row[n - 3]];
            let expected = if x > 2.0 && y < 1.0 { 1.0 } else { x / 8.0 };
            assert_near(row[n - 1], expected, 1e-6);
        }
    }
}

#[test]
fn a_point_in_the_middle_of_a_solid_cell_is_no_number() {
    let third = 0.1 + 0.2;
    let (_, rows) = measure(&format!(
        "kind = \"line\"\nfrom = [3, {}, 1]\nto = [3, 2, 1]\ncount = 2\nfields = [\"pressure\"]",
        0.75 + third - 0.3
    ));
    assert!(rows[0][4].is_nan() && rows[1][4].is_finite());
}

#[test]
fn solids_carry_no_weight_and_points_inside_them_are_no_number() {
    // The block's top is y = 1, the first fluid centre above it y = 1.25.
    let line = "kind = \"line\"\nfrom = [3, 0.25, 1]\nto = [3, 1.25, 1]\ncount = 5\n";
    let (_, rows) = measure(&format!("{line}fields = [\"pressure\", \"solid\"]"));
    assert!(rows[0][4].is_nan());
    assert_eq!([rows[0][5], rows[4][5]], [1.0, 0.0]);
    near(&rows[3][4..5], &[1.0 + 6.0 - 3.75]);
    near(&rows[4][4..5], &[1.0 + 6.0 - 3.75]);
}

#[test]
fn the_weight_of_water_adds_to_the_pressure_at_walls_and_solids() {
    let heavy = |probe: &str| {
        let text = text(probe);
        let scene = text.replace("1e-3", "1e-3\nacceleration = [0, \"-10\", 3]");
        let scene = kit::scene::read(&scene).unwrap();
        let gauge = Gauge::new(&scene, &solid(&scene), &scene.probes[0]).unwrap();
        gauge.measure(&image(&scene)).unwrap()[0].clone()
    };
    // 10 kPa/m over a quarter of a metre, below the lowest centre and above the highest.
    let point = |y: f64| {
        heavy(&format!(
            "kind = \"point\"\nat = [1, {y}, 1]\nfields = [\"pressure\"]"
        ))
    };
    near(&point(0.0), &[3.0 - 0.75 + 2500.0]);
    near(&point(3.0), &[3.0 - 8.25 - 2500.0]);
    near(&point(1.4), &[3.0 - 4.2]);
    // Between a solid cell and the first centre above it.
    let above = "kind = \"point\"\nat = [3, 1.05, 1]\nfields = [\"pressure\"]";
    near(&heavy(above), &[7.0 - 3.75 + 2000.0]);
    let top = heavy("kind = \"face\"\nmin = [2, 1, 0]\nmax = [4, 1.5, 2]\nnormal = \"+y\"");
    near(&top[1..2], &[7.0 - 3.75 + 2500.0]);
}

#[test]
fn a_plane_has_all_its_cells_the_lower_axis_first() {
    let (columns, rows) =
        measure("kind = \"plane\"\naxis = \"x\"\nposition = 2.5\nfields = [\"pressure\"]");
    assert_eq!(columns, ["x", "y", "z", "pressure"]);
    assert_eq!(rows.len(), 6 * 4);
    // On a face between two layers the upper layer is used.
    assert_eq!(rows[1][..3], [2.75, 0.75, 0.25]);
    assert!(rows[1][3].is_nan(), "the block");
    near(&rows[2], &[2.75, 1.25, 0.25, 1.0 + 5.5 - 3.75]);
}

#[test]
fn a_box_has_mean_and_extremes_of_its_fluid() {
    let (columns, rows) = measure("kind = \"box\"\nmin = [1, 0, 0]\nmax = [3, 1, 2]");
    assert_eq!(
        columns[..3],
        ["velocity_x_mean", "velocity_x_min", "velocity_x_max"]
    );
    assert_eq!(
        columns[9..],
        ["pressure_mean", "pressure_min", "pressure_max"]
    );
    // Centres x = 1.25 and 1.75 in front of the block, y = 0.25 and 0.75.
    near(&rows[0][..3], &[0.5, 0.25, 0.75]);
    near(&rows[0][3..6], &[1.5, 1.25, 1.75]);
    let p = |x: f64, y: f64| 1.0 + 2.0 * x - 3.0 * y;
    near(&rows[0][9..], &[p(1.5, 0.5), p(1.25, 0.75), p(1.75, 0.25)]);
}

#[test]
fn a_face_has_the_force_on_the_solid_and_its_stagnation_point() {
    let face = "kind = \"face\"\nmin = [1, 0, 0]\nmax = [2, 1, 2]\nnormal = \"-x\"";
    let (columns, rows) = measure(face);
    let names = "area pressure_mean pressure_min pressure_max force x_of_max y_of_max z_of_max";
    assert_eq!(columns, names.split(' ').collect::<Vec<_>>());
    // The cells at x = 1.75; the block's face at x = 2 is 1 m high and 2 m wide.
    let p = |y: f64| 1.0 + 3.5 - 3.0 * y;
    near(
        &rows[0],
        &[2.0, p(0.5), p(0.75), p(0.25), 2.0 * p(0.5), 2.0, 0.25, 0.25],
    );
}

#[test]
fn a_probe_without_fluid_is_refused_with_a_remedy() {
    let void = refusal("kind = \"box\"\nmin = [2.1, 0.1, 0]\nmax = [3, 0.9, 1]");
    assert_contains(&void, &["probes.p", "0.5 m wide"]);
    let face = "kind = \"face\"\nmin = [1, 0, 0]\nmax = [2, 1, 2]\nnormal = \"+x\"";
    let void = refusal(face);
    assert!(void.contains("normal +x"), "{void}");
    let void = refusal("kind = \"point\"\nat = [3.5, 0.2, 1]");
    assert!(void.contains("move it into the fluid"), "{void}");
}

#[test]
fn arrays_that_do_not_fit_are_refused() {
    let scene = scene("kind = \"point\"\nat = [1, 2, 1]");
    let gauge = Gauge::new(&scene, &solid(&scene), &scene.probes[0]).unwrap();
    let error = gauge.rows(&[]).unwrap_err().to_string();
    assert!(error.contains("`velocity` on 8 cells"), "{error}");
}

#[test]
fn a_layer_is_a_thin_image_of_its_own() {
    let layer = Layer::new(&scene("kind = \"point\"\nat = [1, 2, 1]"), Axis::Z, 1.0);
    let frame = layer.frame();
    assert_eq!(frame.cells, [8, 6, 1]);
    assert_eq!(frame.origin, [0.0, 0.0, 1.0]);
    assert_eq!(layer.cells().len(), 48);
    assert_eq!(layer.cells()[..2], [96, 97]);
}
