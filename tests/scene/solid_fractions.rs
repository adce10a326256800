//! Static solids at their exact positions: the solid fraction of each cell, and terrain from survey files.

use crate::{
    refused,
    solids::{cuboid, write_stl},
};
use glam::{DQuat, DVec3};
use kit::assert_near;
use riprap::{
    Result,
    geometry::Terrain,
    scene::{Scene, SolidFractions, build::lattice_setup},
    units::Units,
};
use std::{
    fs,
    path::{Path, PathBuf},
};

/// Cells of 0.1 m, 12 × 10 × 8.
fn scene(dir: &Path, solids: &str) -> Result<Scene> {
    let text = format!(
        "domain = {{ size = [1.2, 1.0, 0.8], cell = 0.1 }}\nfluid.viscosity = 1e-3\nnumerics.time_step = 1e-3\nrun.steps = 1\n{solids}"
    );
    Scene::from_toml(&text, dir, "bed.toml")
}

fn cells(solids: &str) -> SolidFractions {
    scene(Path::new(""), solids)
        .unwrap()
        .solid_fractions()
        .unwrap()
}

/// Sum of the solid fractions.
fn volume(cells: &SolidFractions) -> f64 {
    let partial = cells.partial.iter().map(|(_, part)| f64::from(*part));
    cells.mask.solid_count() as f64 + partial.sum::<f64>()
}

#[test]
fn a_half_space_fills_what_is_below_its_plane() {
    let found = cells(
        "[[solids]]\nkind = \"half_space\"\npoint = [0.6, 0.5, 0.4]\nnormal = [1, -0.5, 3]\nsurface = \"exact\"",
    );
    // The plane passes through the middle of the domain and meets only its sides.
    assert_near(volume(&found), 0.5 * 960.0, 1e-3);
    assert!(found.partial.len() > 120);
    assert!(found.partial.is_sorted_by_key(|(cell, _)| *cell));
    let staircase =
        cells("[[solids]]\nkind = \"half_space\"\npoint = [0.6, 0.5, 0.4]\nnormal = [1, -0.5, 3]");
    assert!(staircase.partial.is_empty());
}

#[test]
fn a_box_along_the_grid_is_the_same_either_way() {
    let solid = "[[solids]]\nkind = \"box\"\nmin = [0.3, 0.1, 0]\nmax = [0.7, 0.6, 0.5]\n";
    let (exact, staircase) = (cells(&format!("{solid}surface = \"exact\"")), cells(solid));
    assert_eq!(exact, staircase);
    let shifted = cells(
        "[[solids]]\nkind = \"box\"\nmin = [0.33, 0.1, 0]\nmax = [0.7, 0.6, 0.57]\nsurface = \"exact\"",
    );
    assert_near(volume(&shifted), 3.7 * 5.0 * 5.7, 1e-3);
}

/// With either orientation of its triangles.
#[test]
fn a_mesh_of_a_box_fills_what_the_box_does() {
    let dir = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("exact_mesh");
    fs::create_dir_all(&dir).unwrap();
    let (min, max) = (
        [0.328125, 0.109375, 0.046875],
        [0.7265625, 0.6015625, 0.5703125],
    );
    let triangles = cuboid(min.into(), max.into());
    write_stl(&dir.join("out.stl"), &triangles);
    let inside_out: Vec<_> = triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    write_stl(&dir.join("in.stl"), &inside_out);
    let expected = cells(&format!(
        "[[solids]]\nkind = \"box\"\nmin = {min:?}\nmax = {max:?}\nsurface = \"exact\""
    ));
    for file in ["out.stl", "in.stl"] {
        let solids = format!("[[solids]]\nkind = \"mesh\"\nfile = \"{file}\"\nsurface = \"exact\"");
        let found = scene(&dir, &solids).unwrap().solid_fractions().unwrap();
        assert_eq!(found.mask, expected.mask);
        assert_eq!(found.partial.len(), expected.partial.len());
        for (found, expected) in found.partial.iter().zip(&expected.partial) {
            assert_eq!(found.0, expected.0);
            assert_near(found.1, expected.1, 1e-6);
        }
    }
}

#[test]
fn a_sphere_and_a_hole_in_it_have_their_volumes() {
    let sphere = |radius: f64| {
        format!(
            "[[solids]]\nkind = \"sphere\"\ncenter = [0.61, 0.47, 0.42]\nradius = {radius}\nsurface = \"exact\"\n"
        )
    };
    let of = |radius: f64| 4.0 / 3.0 * std::f64::consts::PI * (10.0 * radius).powi(3);
    let whole = cells(&sphere(0.37));
    assert_near(volume(&whole) / of(0.37), 1.0, 1e-4);
    let shell = cells(&format!("{}{}void = true", sphere(0.37), sphere(0.25)));
    assert_near(volume(&shell) / (of(0.37) - of(0.25)), 1.0, 1e-3);
}

/// Sum of the fractions that determine the weights of cells in the lattice.
fn effective(dir: &Path, solids: &str) -> f64 {
    let scene = scene(dir, solids).unwrap();
    let setup = lattice_setup(&scene, &Units::of(&scene).unwrap(), None).unwrap();
    let partial = setup.surface.iter().map(|cell| f64::from(cell.fraction));
    setup.solid.iter().filter(|solid| **solid).count() as f64 + partial.sum::<f64>()
}

/// For the weight, a plane with the unit normal n is 0.05 (1 − Σn_a⁴) of a cell farther out.
#[test]
fn oblique_planes_move_outwards_for_the_weight() {
    let shift = |n: DVec3| 0.05 * (1.0 - (n * n).dot(n * n));
    let near = |found: f64, expected: f64| assert_near(found, expected, 0.1);
    let none = Path::new("");
    let n = DVec3::new(1.0, -0.5, 3.0).normalize();
    let half_space = effective(
        none,
        "[[solids]]\nkind = \"half_space\"\npoint = [0.6, 0.5, 0.4]\nnormal = [1, -0.5, 3]\nsurface = \"exact\"",
    );
    near(half_space, 0.5 * 960.0 + 120.0 * shift(n) / n.z);
    let along = "[[solids]]\nkind = \"box\"\nmin = [0.33, 0.1, 0]\nmax = [0.7, 0.6, 0.57]\nsurface = \"exact\"";
    near(effective(none, along), 3.7 * 5.0 * 5.7);

    let dir = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("oblique_planes");
    fs::create_dir_all(&dir).unwrap();
    let turn = DQuat::from_rotation_z(0.6) * DQuat::from_rotation_x(0.4);
    let half = DVec3::new(0.2, 0.15, 0.15);
    let turned = cuboid(-half, half).into_iter();
    let turned = turned.map(|t| t.map(|p| turn * p + DVec3::new(0.6, 0.5, 0.4)));
    write_stl(&dir.join("box.stl"), &turned.collect::<Vec<_>>());
    let moved = |sign: f64| -> f64 {
        let edge = |a: usize| 2.0 * (10.0 * half[a] + sign * shift(turn * DVec3::AXES[a]));
        edge(0) * edge(1) * edge(2)
    };
    let mesh = "[[solids]]\nkind = \"mesh\"\nfile = \"box.stl\"\nsurface = \"exact\"\n";
    near(effective(&dir, mesh), moved(1.0));
    let around =
        "[[solids]]\nkind = \"box\"\nmin = [0.1, 0, 0]\nmax = [1.2, 1, 0.8]\nsurface = \"exact\"\n";
    let hole = effective(&dir, &format!("{around}{mesh}void = true"));
    near(hole, 880.0 - moved(-1.0));

    let mut bed = String::new();
    for (i, j) in (0..7).flat_map(|i| (0..6).map(move |j| (i, j))) {
        let [x, y] = [i, j].map(|n| 0.2 * f64::from(n));
        bed += &format!("{x} {y} {}\n", 0.2 + 0.3 * x);
    }
    fs::write(dir.join("slope.xyz"), bed).unwrap();
    let n = DVec3::new(-0.3, 0.0, 1.0).normalize();
    let terrain = effective(&dir, "[[solids]]\nkind = \"terrain\"\nfile = \"slope.xyz\"");
    near(terrain, 120.0 * (3.8 + shift(n) / n.z));
}

/// A bed whose heights are plane except for a ridge, and its volume below the triangles.
fn heights() -> (Vec<f64>, f64) {
    let mut all = Vec::new();
    for j in 0..6 {
        for i in 0..7 {
            let ridge = if i == 3 { 0.1 } else { 0.0 };
            all.push(0.2 + 0.03 * f64::from(j) + ridge);
        }
    }
    // Nodes every 0.2 m; the ridge is a roof 0.4 m wide.
    let plane = (0.2 + 0.03 * 2.5) * 1.2 * 1.0;
    (all, (plane + 0.1 * 0.2) * 1e3)
}

/// Writes the bed in each format.
fn surveys(dir: &Path) -> [&'static str; 4] {
    fs::create_dir_all(dir).unwrap();
    let (heights, _) = heights();
    let row = |j: usize| &heights[7 * j..7 * (j + 1)];
    let mut xyz = String::from("x y z\n");
    // In any order.
    for n in (0..42).map(|n| n * 5 % 42) {
        let (i, j) = (n % 7, n / 7);
        xyz += &format!(
            "{:.1} {:.1} {:.4}\n",
            0.2 * i as f64,
            0.2 * j as f64,
            heights[n]
        );
    }
    fs::write(dir.join("bed.xyz"), xyz.replace(' ', ",")).unwrap();
    let mut grid = String::from(
        "ncols 7\nnrows 6\nxllcenter 1000\nyllcenter 2000\ncellsize 0.2\nNODATA_value -9999\n",
    );
    let mut corners = grid.replace("xllcenter 1000", "xllcorner 999.9");
    corners = corners.replace("yllcenter 2000", "yllcorner 1999.9");
    for j in (0..6).rev() {
        let words: Vec<String> = row(j).iter().map(f64::to_string).collect();
        grid += &format!("{}\n", words.join(" "));
        corners += &format!("{}\n", words.join(" "));
    }
    fs::write(dir.join("bed.asc"), grid).unwrap();
    fs::write(dir.join("corners.asc"), corners).unwrap();
    let values: Vec<f32> = (0..6).rev().flat_map(row).map(|h| *h as f32).collect();
    // GTModelType: metres, and degrees.
    write_tiff(&dir.join("bed.tif"), &values, 1);
    write_tiff(&dir.join("degrees.tif"), &values, 2);
    ["bed.xyz", "bed.asc", "corners.asc", "bed.tif"]
}

fn write_tiff(path: &Path, values: &[f32], model: u16) {
    let file = fs::File::create(path).unwrap();
    let mut tiff = tiff::encoder::TiffEncoder::new(file).unwrap();
    let mut image = tiff
        .new_image::<tiff::encoder::colortype::Gray32Float>(7, 6)
        .unwrap();
    let tags = image.encoder();
    let keys = [1u16, 1, 0, 1, 1024, 0, 1, model];
    tags.write_tag(tiff::tags::Tag::GeoKeyDirectoryTag, &keys[..])
        .unwrap();
    let tag = tiff::tags::Tag::ModelPixelScaleTag;
    tags.write_tag(tag, &[0.2f64, 0.2, 0.0][..]).unwrap();
    // The corner of the first pixel, in the north-west.
    let tie = [0.0f64, 0.0, 0.0, 999.9, 2001.1, 0.0];
    tags.write_tag(tiff::tags::Tag::ModelTiepointTag, &tie[..])
        .unwrap();
    image.write_data(values).unwrap();
}

#[test]
fn terrain_of_every_format_fills_what_is_below_its_heights() {
    let dir = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("terrain_formats");
    let (_, expected) = heights();
    let mut all = Vec::new();
    for file in surveys(&dir) {
        let translate = if file == "bed.xyz" {
            "[0, 0, 0]"
        } else {
            "[-1000, -2000, 0]"
        };
        let solids =
            format!("[[solids]]\nkind = \"terrain\"\nfile = \"{file}\"\ntranslate = {translate}");
        let found = scene(&dir, &solids).unwrap().solid_fractions().unwrap();
        assert_near(volume(&found), expected, 1e-3 * expected);
        all.push(found);
        let staircase = scene(&dir, &format!("{solids}\nsurface = \"staircase\"")).unwrap();
        let staircase = staircase.solid_fractions().unwrap();
        assert!(staircase.partial.is_empty());
        assert_near(volume(&staircase), expected, 0.2 * expected);
    }
    assert!(
        all.iter()
            .all(|cells| cells.partial.len() == all[0].partial.len())
    );
    let terrain = Terrain::read(&dir.join("bed.xyz"), 2.0, [0.5, 0.0, 1.0]).unwrap();
    // Half-way up the ridge, midway between two rows.
    assert_near(
        terrain.height(0.5 + 2.0 * 0.5, 2.0 * 0.2).unwrap(),
        2.0 * (0.23 + 0.05) + 1.0,
        1e-9,
    );
    assert_eq!(terrain.height(0.49, 0.2), None);
}

#[test]
fn terrain_that_is_none_is_refused() {
    let dir = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("terrain_refused");
    surveys(&dir);
    let write = |name: &str, text: &str| fs::write(dir.join(name), text).unwrap();
    let of = |file: &str, more: &str| {
        let solids = format!("[[solids]]\nkind = \"terrain\"\nfile = \"{file}\"\n{more}");
        scene(&dir, &solids).and_then(|scene| scene.solid_fractions())
    };
    refused(of("none.xyz", ""), &["none.xyz", "check the path"]);
    write("bed.dem", "");
    refused(of("bed.dem", ""), &["bed.dem", ".xyz, .asc or .tif"]);
    write("words.xyz", "0 0 1\n1 0 b\n");
    refused(of("words.xyz", ""), &["words.xyz", "line 2"]);
    write("commas.xyz", "0,5 0,5 1,0\n1,5 0,5 1,0\n");
    refused(of("commas.xyz", ""), &["commas.xyz", "line 1", "decimal"]);
    write("scattered.xyz", "0 0 1\n1 0 1\n0 1 1\n1.37 1 1\n");
    refused(of("scattered.xyz", ""), &["scattered.xyz", "resample"]);
    write("sparse.xyz", "0 0 1\n0.01 0.01 1\n1 1 1\n2 2 1\n");
    refused(of("sparse.xyz", ""), &["sparse.xyz", "regular grid"]);
    refused(of("degrees.tif", ""), &["degrees.tif", "metres"]);
    write("two.xyz", "0 0 1\n1 0 1\n0 1 1\n1 1 1\n0 0 2\n");
    refused(of("two.xyz", ""), &["two.xyz", "two heights"]);
    write("line.xyz", "0 0 1\n1 0 1\n");
    refused(of("line.xyz", ""), &["line.xyz", "the same y"]);
    write(
        "short.asc",
        "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3 4 5\n",
    );
    refused(of("short.asc", ""), &["short.asc", "5 heights"]);
    write(
        "spacing.asc",
        "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 0\n1 2 3 4\n",
    );
    refused(of("spacing.asc", ""), &["spacing.asc", "0 and 0 apart"]);
    assert!(Terrain::new([0.0; 2], [1.0; 2], [2, 2], vec![0.0; 3]).is_err());
    write("header.asc", "ncols 3\nnrows 2\ncellsize 1\n1 2 3 4 5 6\n");
    refused(of("header.asc", ""), &["header.asc", "xllcorner"]);
    write("noise.tif", "no TIFF at all");
    refused(of("noise.tif", ""), &["noise.tif", "TIFF"]);
    refused(
        of("bed.xyz", "translate = [0.1, 0, 0]"),
        &["solids[0].file", "x = 0.05", "translate"],
    );
    write(
        "hole.asc",
        "ncols 3\nnrows 2\nxllcenter 0\nyllcenter 0\ncellsize 1\nnodata_value -1\n1 -1 1\n1 1 1\n",
    );
    refused(of("hole.asc", ""), &["solids[0].file", "no height"]);
    write(
        "undeclared.xyz",
        "0 0 1\n1 0 1\n2 0 -9999\n0 1 1\n1 1 1\n2 1 1\n",
    );
    refused(of("undeclared.xyz", ""), &["solids[0].file", "no height"]);
}
