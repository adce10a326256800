//! Boundary particles of walls and blocks.

use crate::start::{
    DX, Initial, distance_to_nearest, error_of, is_on_lattice, least_distance, scene, tank,
};
use glam::{DQuat, DVec3};
use kit::{assert_contains, assert_near, assert_relative};
use riprap::{
    geometry::Form,
    scene::{
        Scene,
        build::{block_setup, particle_setup},
    },
    sph::Body,
};
use std::path::Path;

/// A block in the tank.
fn block(keys: &str) -> String {
    format!("[[blocks]]\nname = \"b\"\n{keys}\n")
}

/// Least depth of the boundary particles of block `b` below its faces, m.
fn least_depth(initial: &Initial) -> f64 {
    let index = initial.block("b");
    let shape = &initial.setup.setup.blocks[index].shape;
    let depth = |x: &DVec3| {
        let parts = shape.parts().iter().map(|part| {
            let x = *x - part.offset;
            match &part.form {
                Form::Sphere { radius } => radius - x.length(),
                Form::Convex(p) => p
                    .faces()
                    .iter()
                    .map(|f| -f.height(x))
                    .fold(f64::INFINITY, f64::min),
            }
        });
        parts.fold(f64::NEG_INFINITY, f64::max)
    };
    initial.boundary[index]
        .iter()
        .map(depth)
        .fold(f64::INFINITY, f64::min)
}

#[test]
fn walls_of_a_tank_are_four_layers_of_the_lattice_with_corners() {
    let initial = Initial::of(&tank("").unwrap());
    // Along x 40 cells and four layers at both ends, along z 20 and four below, and four above at the walls.
    assert_eq!(initial.all_boundary().len(), 20 * (2 * 4 * 28 + 40 * 4));
    // The walls that meet at a corner share its points.
    assert_eq!(initial.boundary_of("wall_x_min").len(), 20 * (4 * 24 + 10));
    assert_eq!(
        initial.boundary_of("wall_z_min").len(),
        20 * (40 * 4 + 2 * 6)
    );
    let all = initial.all_boundary();
    assert_near(least_distance(&all), DX, 1e-9);
    let aligned = |x: &DVec3| (0..3).all(|a| is_on_lattice(x[a], 0.0));
    assert!(all.iter().all(aligned));
    assert!(all.iter().all(|x| x.y > 0.0 && x.y < 1.0));
}

#[test]
fn a_box_on_the_lattice_has_exactly_its_layers() {
    // 14 × 12 × 10 cells: four layers leave 6 × 4 × 2 empty.
    let initial = Initial::of(
        &tank(&block(
            "kind = \"box\"\nsize = [0.7, 0.6, 0.5]\nposition = [1.05, 0.5, 0.75]",
        ))
        .unwrap(),
    );
    let particles = initial.boundary_of("b");
    assert_eq!(particles.len(), 14 * 12 * 10 - 6 * 4 * 2);
    let aligned = |x: &DVec3| (0..3).all(|a| is_on_lattice(x[a], 0.0));
    assert!(particles.iter().all(aligned));
    assert_relative(least_distance(&particles), DX, 1e-6);
}

#[test]
fn a_block_as_thick_as_the_spacing_has_one_layer() {
    let initial = Initial::of(
        &tank(&block(
            "kind = \"box\"\nsize = [0.4, 0.3, 0.05]\nposition = [1, 0.5, 0.8]",
        ))
        .unwrap(),
    );
    assert_eq!(initial.boundary_of("b").len(), 8 * 6);
}

#[test]
fn particles_keep_depth_and_distance_in_blocks_of_all_shapes() {
    for keys in [
        "kind = \"box\"\nsize = [0.43, 0.31, 0.27]\nposition = [1, 0.5, 0.7]\nrotation = { axis = [1, 2, 3], angle = 33 }",
        "kind = \"vertices\"\nvertices = [[0,0,0],[0.9,0,0],[0,0,0.45],[0,0.4,0],[0.9,0.4,0],[0,0.4,0.45]]\nposition = [0.5, 0.3, 0.52]",
        "kind = \"tetrahedron\"\nedge = 0.5\nposition = [1, 0.5, 0.7]",
        "kind = \"icosahedron\"\nedge = 0.15\nposition = [1, 0.5, 0.7]",
        "kind = \"sphere\"\nradius = 0.21\nposition = [1, 0.5, 0.7]",
        "kind = \"compound\"\nposition = [1, 0.5, 0.6]\nparts = [{ kind = \"box\", size = [0.6, 0.2, 0.1] }, \
         { kind = \"box\", size = [0.2, 0.2, 0.17], position = [0, 0, 0.135] }]",
    ] {
        for motion in ["free", "fixed"] {
            let initial =
                Initial::of(&tank(&block(&format!("{keys}\nmotion = \"{motion}\""))).unwrap());
            let particles = initial.boundary_of("b");
            assert!(particles.len() > 50, "{keys}: {}", particles.len());
            let depth = least_depth(&initial);
            assert!(depth >= 0.5 * DX * (1.0 - 1e-5), "{keys}: depth {depth}");
            let apart = least_distance(&particles);
            assert!(apart >= 0.599 * DX, "{keys}: {apart} m apart");
        }
    }
}

/// The number of boundary particles is that of the cubes in the layers.
#[test]
fn particles_fill_the_volume_of_the_layers() {
    for (keys, volume) in [
        // Four layers leave a box of 0.03 × 0 × 0: all of it is filled.
        (
            "kind = \"box\"\nsize = [0.43, 0.31, 0.27]\nposition = [1, 0.5, 0.7]\nrotation = { axis = [1, 2, 3], angle = 33 }",
            0.43 * 0.31 * 0.27,
        ),
        (
            "kind = \"sphere\"\nradius = 0.2\nposition = [1, 0.5, 0.7]",
            4.0 / 3.0 * std::f64::consts::PI * 0.2 * 0.2 * 0.2,
        ),
        (
            "kind = \"vertices\"\nvertices = [[0,0,0],[0.9,0,0],[0,0,0.45],[0,0.4,0],[0.9,0.4,0],[0,0.4,0.45]]\nposition = [0.5, 0.3, 0.52]",
            0.5 * 0.9 * 0.45 * 0.4,
        ),
    ] {
        let initial = Initial::of(&tank(&block(keys)).unwrap());
        let filled = initial.boundary_of("b").len() as f64 * DX.powi(3);
        assert!(
            (filled / volume - 1.0).abs() < 0.08,
            "{keys}: {}",
            filled / volume
        );
    }
}

#[test]
fn a_block_that_spans_a_period_has_the_rows_of_the_water_and_no_ends() {
    let initial = Initial::of(
        &tank(&block(
            "kind = \"box\"\nsize = [0.2, 1.0, 0.8]\nposition = [0.4, 0.5, 0.5]\nmotion = \"driven\"",
        ))
        .unwrap(),
    );
    // 4 cells thick: full, with a whole period of rows.
    assert_eq!(initial.boundary_of("b").len(), 4 * 20 * 16);
    assert!(
        initial
            .boundary_of("b")
            .iter()
            .all(|x| is_on_lattice(x.y, 0.0))
    );
}

#[test]
fn a_block_across_the_end_of_a_period_is_complete() {
    for motion in ["free", "fixed"] {
        let initial = [0.5, 0.05].map(|y| {
            let block = format!(
                "[[blocks]]\nname = \"b\"\nkind = \"box\"\nsize = [0.4, 0.3, 0.2]\nposition = [1, {y}, 0.3]\n\
                 motion = \"{motion}\"\n"
            );
            Initial::of(&tank(&block).unwrap())
        });
        let [inside, across] = &initial;
        assert_eq!(inside.start.positions.len(), 8000 - 8 * 6 * 4);
        assert_eq!(across.start.positions.len(), inside.start.positions.len());
        assert!(inside.boundary_of("b").len() > 150, "{motion}");
        assert_eq!(
            across.boundary_of("b").len(),
            inside.boundary_of("b").len(),
            "{motion}"
        );
    }
}

#[test]
fn ramps_keep_the_rows_of_the_water_and_do_not_overlap_the_floor() {
    // 30° up to the wall x_max, beyond the domain on all sides but one.
    let ramp = "[[solids]]\nname = \"ramp\"\nkind = \"half_space\"\npoint = [1, 0, 0]\nnormal = [-0.5, 0, 0.8660254037844386]\n";
    let initial = Initial::of(&tank(ramp).unwrap());
    let particles = initial.boundary_of("ramp");
    let normal = DVec3::new(-0.5, 0.0, 0.75_f64.sqrt());
    let depth = |x: &DVec3| -normal.dot(*x - DVec3::X);
    // Except particles that fill gaps where the floor or the wall is about as deep.
    let fills_gap = |x: &DVec3| (depth(x) - (-x.z).max(x.x - 2.0)).abs() < 0.26 * DX;
    assert!(
        particles
            .iter()
            .all(|x| is_on_lattice(x.y, 0.0) || fills_gap(x))
    );
    for layer in 0..4 {
        let at = (f64::from(layer) + 0.5) * DX;
        let rows = particles.iter().filter(|x| (depth(x) - at).abs() < 1e-7);
        let under = rows
            .filter(|x| x.x > 1.4 && x.x < 1.95 && x.z > 0.0)
            .count();
        // 0.55 m along x are 0.635 m along the slope: 13 rows, or one less.
        assert!(
            under == 12 * 20 || under == 13 * 20,
            "layer {layer}: {under}"
        );
    }
    // Each is where its own block is deepest.
    assert!(particles.iter().all(|x| depth(x) >= -x.z - 1e-6));
    let floor = initial.boundary_of("wall_z_min");
    assert!(floor.iter().all(|x| -x.z >= depth(x) - 1e-6));
    assert!(least_distance(&initial.all_boundary()) >= 0.599 * DX);
}

#[test]
fn a_rotated_block_keeps_its_particles() {
    let keys = "kind = \"box\"\nsize = [0.4, 0.3, 0.2]\nposition = [1, 0.5, 0.7]";
    let straight = Initial::of(&tank(&block(keys)).unwrap());
    let turned = format!("{keys}\nrotation = {{ axis = [0, 0, 1], angle = 90 }}");
    let turned = Initial::of(&tank(&block(&turned)).unwrap());
    let index = turned.block("b");
    let rotation = turned.setup.setup.blocks[index].rotation;
    assert!(rotation.angle_between(DQuat::from_rotation_z(90_f64.to_radians())) < 1e-12);
    let (a, b) = (&straight.boundary[index], &turned.boundary[index]);
    assert_eq!(a.len(), b.len());
    for x in a {
        assert!(b.iter().any(|y| x.distance(*y) < 1e-9), "{x}");
    }
}

#[test]
fn blocks_too_thin_or_not_planar_are_refused() {
    let words = error_of(
        &tank(&block(
            "kind = \"box\"\nsize = [0.4, 0.3, 0.04]\nposition = [1, 0.5, 0.8]",
        ))
        .unwrap(),
    );
    assert_contains(&words, &["block b: is thinner than the spacing"]);
    for (keys, part) in [
        ("kind = \"sphere\"\nradius = 0.2", "is a sphere"),
        (
            "kind = \"box\"\nsize = [0.3, 1.0, 0.3]\nrotation = { axis = [1, 0, 0], angle = 10 }",
            "oblique to y",
        ),
        (
            "kind = \"box\"\nsize = [0.3, 0.9, 0.3]",
            "give it that width",
        ),
    ] {
        let more = block(&format!("{keys}\nposition = [1, 0.5, 0.75]"));
        let words = error_of(&scene("plane = true", &more).unwrap());
        assert!(words.contains(part), "{words}");
    }
}

/// A valley of several convex parts: the layers below all its exposed faces have no hole.
#[test]
fn internal_faces_of_a_compound_leave_no_holes() {
    let profile = [
        [0.0, 0.1],
        [0.6, 0.1],
        [0.72, 0.16],
        [0.84, 0.1],
        [0.92, 0.1],
        [1.2, 0.2],
        [1.8, 0.65],
        [2.0, 0.65],
    ];
    let ends = [[2.0, -0.3], [0.0, -0.3]];
    let section: Vec<[f64; 2]> = profile.into_iter().chain(ends).collect();
    let mesh = prism(&section);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("valley.obj");
    std::fs::write(&file, mesh).unwrap();
    let valley = block(&format!(
        "kind = \"mesh\"\nfile = \"{}\"\nmotion = \"fixed\"",
        file.display()
    ));
    let initial = Initial::of(&tank(&valley).unwrap());
    assert!(
        initial.setup.setup.blocks[initial.block("b")]
            .shape
            .parts()
            .len()
            > 2
    );
    let boundary = initial.all_boundary();
    let mut widest = 0.0f64;
    for pair in profile.windows(2) {
        let [a, b] = [pair[0], pair[1]].map(|p| DVec3::new(p[0], 0.0, p[1]));
        let down = DVec3::Y.cross(b - a).normalize();
        assert!(down.z < 0.0);
        for n in 0..40 {
            for layer in [0.5, 1.5] {
                let x = a.lerp(b, (f64::from(n) + 0.5) / 40.0) + down * layer * DX;
                let x = x + DVec3::Y * 0.475;
                widest = widest.max(distance_to_nearest(x, &boundary));
            }
        }
    }
    // In a cubic lattice no point is farther than half a diagonal from a particle.
    let lattice = 0.75f64.sqrt();
    assert!(widest < lattice * DX, "{} spacings", widest / DX);
    // The floor continues where the wall ends: the corner between them has a complete lattice.
    for i in -4..6 {
        for k in -2..2 {
            let place = DVec3::new(f64::from(i) + 0.5, 9.5, f64::from(k) + 0.5) * DX;
            let near = distance_to_nearest(place, &boundary);
            assert!(near < 1e-6 * DX, "{i} {k}: {} spacings", near / DX);
        }
    }
}

/// OBJ of a prism across the tank: its section in x and z, clockwise seen from −y.
fn prism(section: &[[f64; 2]]) -> String {
    let n = section.len();
    let mut text = String::new();
    for y in [0, 1] {
        for [x, z] in section {
            text += &format!("v {x} {y} {z}\n");
        }
    }
    let ring: Vec<String> = (1..=n).map(|i| i.to_string()).collect();
    let back: Vec<String> = (n + 1..=2 * n).rev().map(|i| i.to_string()).collect();
    let front: Vec<String> = ring.into_iter().rev().collect();
    text += &format!(
        "f {}\nf {}\n",
        front.join(" "),
        back.into_iter().rev().collect::<Vec<_>>().join(" ")
    );
    for i in 1..=n {
        let j = i % n + 1;
        text += &format!("f {i} {j} {}\nf {j} {} {}\n", i + n, j + n, i + n);
    }
    text
}

/// The layers of a dam on the floor continue into the floor. Those particles do not count for the load on the dam if a
/// probe measures it.
#[test]
fn the_load_on_a_fixed_block_acts_on_its_own_surface() {
    let bodies = |probe: &str| {
        let text = format!(
            r#"
            domain = {{ size = [2, 0.1, 1] }}
            fluid = {{ acceleration = [0, 0, -9.81] }}
            particles = {{ spacing = 0.05, plane = true, largest_speed = 4 }}
            water = [{{ kind = "box", size = [2, 0.1, 0.6], position = [1, 0.05, 0.3] }}]
            materials = [{{ name = "rock", density = 2500, normal_stiffness = 1e8, friction = 30 }}]
            run = {{ duration = 1 }}
            [boundaries]
            x_min = {{ kind = "wall" }}
            x_max = {{ kind = "wall" }}
            z_min = {{ kind = "wall" }}
            z_max = {{ kind = "open" }}
            [[blocks]]
            name = "dam"
            kind = "box"
            size = [0.5, 0.1, 0.4]
            position = [1, 0.05, 0.2]
            motion = "fixed"
            {probe}
            "#
        );
        let scene = Scene::from_toml(&text, Path::new("."), "dam").unwrap();
        let blocks = block_setup(&scene).unwrap();
        let (setup, _) = particle_setup(&scene, &blocks).unwrap();
        setup.bodies
    };
    let probe = "[[probes]]\nname = \"dam\"\nkind = \"block\"\nblock = \"dam\"";
    let [plain, probed] = ["", probe].map(bodies);
    let lowest = |boundary: &[DVec3]| boundary.iter().map(|x| x.z).fold(0.0, f64::min);
    assert!(lowest(&plain[0].boundary) < -0.3);
    assert!(lowest(&probed[0].boundary) > -0.2);
    let count = |bodies: &[Body]| bodies.iter().map(|body| body.boundary.len()).sum::<usize>();
    assert_eq!(count(&plain), count(&probed));
}

/// A flat beach meets the floor and side walls, whose rows have different phases.
#[test]
fn layers_of_blocks_that_meet_leave_no_gaps() {
    let text = r#"
        domain = { size = [2, 0.4, 1] }
        fluid = { acceleration = [0, 0, -9.81] }
        particles = { spacing = 0.05, largest_speed = 4 }
        water = [{ kind = "box", size = [2, 0.4, 0.6], position = [1, 0.2, 0.3] }]
        materials = [{ name = "rock", density = 2500, normal_stiffness = 1e8, friction = 30 }]
        run = { duration = 1 }
        [boundaries]
        x_min = { kind = "wall" }
        x_max = { kind = "wall" }
        y_min = { kind = "wall" }
        y_max = { kind = "wall" }
        z_min = { kind = "wall" }
        z_max = { kind = "open" }
        [[blocks]]
        name = "beach"
        kind = "vertices"
        vertices = [[0.51, 0, 0], [4, 0, 0], [4, 0, 0.1396], [0.51, 0.4, 0], [4, 0.4, 0], [4, 0.4, 0.1396]]
        motion = "fixed"
    "#;
    let initial = Initial::of(&Scene::from_toml(text, Path::new("."), "beach").unwrap());
    let boundary = initial.all_boundary();
    assert!(least_distance(&boundary) >= 0.599 * DX);
    let (toe, slope) = (
        DVec3::new(0.51, 0.0, 0.0),
        DVec3::new(1.0, 0.0, 0.04).normalize(),
    );
    let down = DVec3::Y.cross(slope);
    let mut places = Vec::new();
    for i in 0..300 {
        // Half a spacing below the floor and the beach, and behind a side wall at several heights.
        let along = -0.4 + 1.8 * f64::from(i) / 300.0;
        let (surface, into) = if along < 0.0 {
            (toe + along * DVec3::X, -DVec3::Z)
        } else {
            (toe + along * slope, down)
        };
        let behind = (0..20).map(|j| into * (0.5 * DX) + DVec3::Y * (f64::from(j) * 0.02));
        let at_wall = (0..20).map(|k| DVec3::new(0.0, -0.5 * DX, (f64::from(k) - 5.0) * 0.01));
        places.extend(behind.chain(at_wall).map(|x| surface + x));
    }
    let far = |x: &DVec3| distance_to_nearest(*x, &boundary) / DX;
    let widest = places.iter().map(far).fold(0.0, f64::max);
    // Half the diagonal of a square is 0.71; gaps of 1.6 spacings have 0.94.
    assert!(widest < 0.8, "{widest} spacings");
}
