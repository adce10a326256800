//! Files written by `riprap::output`: read back by VTK, restarted, and refused by the system.

use kit::assert_contains;
use riprap::output::{Array, Csv, ImageData, Pvd, Table, write_vti};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// An empty folder for one test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("output_{name}"));
    if folder.exists() {
        fs::remove_dir_all(&folder).unwrap();
    }
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// The content of a `.vti` or `.pvd` as read by VTK.
fn read_with_vtk(path: &Path) -> serde_json::Value {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap();
    let python = target.join("python/bin/python");
    let script = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../tests/output/read_vti.py"
    );
    let output = Command::new(&python)
        .arg(script)
        .arg(path)
        .output()
        .unwrap_or_else(|error| panic!("{}: {error}; run harness/python.sh", python.display()));
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.success() && complaint.is_empty(),
        "VTK: {complaint}\nif a module is missing, run harness/python.sh"
    );
    serde_json::from_slice(&output.stdout).unwrap()
}

/// An image with different sizes along each axis, so that swapped axes are detected.
fn example() -> ImageData {
    let cells = [3, 4, 5];
    let mut image = ImageData {
        origin: [-1.5, 0.25, 10.0],
        spacing: 0.125,
        cells,
        arrays: Vec::new(),
    };
    let count = image.cell_count();
    image.arrays.push(Array {
        name: "pressure".into(),
        components: 1,
        values: (0..count).map(|cell| cell as f32 * 0.5 - 3.0).collect(),
    });
    image.arrays.push(Array {
        name: "u < \"v\" & w".into(),
        components: 3,
        values: (0..3 * count).map(|value| (value as f32).sqrt()).collect(),
    });
    image
}

#[test]
fn vtk_reads_back_shape_position_and_every_array() {
    let path = folder("vti").join("flow.vti");
    let image = example();
    write_vti(&path, &image).unwrap();
    let found = read_with_vtk(&path);
    assert_eq!(found["points"], serde_json::json!([4, 5, 6]));
    assert_eq!(found["origin"], serde_json::json!([-1.5, 0.25, 10.0]));
    assert_eq!(found["spacing"], serde_json::json!([0.125, 0.125, 0.125]));
    let arrays = found["arrays"].as_object().unwrap();
    assert_eq!(arrays.len(), image.arrays.len());
    for array in &image.arrays {
        let read = &arrays[&array.name];
        let tuples: Vec<Vec<f64>> = array
            .values
            .chunks(array.components)
            .map(|tuple| tuple.iter().map(|&value| f64::from(value)).collect())
            .collect();
        assert_eq!(read["components"], array.components);
        assert_eq!(read["tuples"], image.cell_count());
        assert_eq!(read["first"], serde_json::json!(tuples[0]));
        assert_eq!(read["second"], serde_json::json!(tuples[1]));
        assert_eq!(read["last"], serde_json::json!(tuples[tuples.len() - 1]));
        for component in 0..array.components {
            let sum: f64 = tuples.iter().map(|tuple| tuple[component]).sum();
            let read = read["sums"][component].as_f64().unwrap();
            // Both add 60 exact f32 values in f64, possibly in another order.
            assert!(
                (read - sum).abs() <= 60.0 * f64::EPSILON * sum.abs(),
                "{read} ≠ {sum}"
            );
        }
    }
}

#[test]
fn an_image_is_replaced_whole_and_leaves_no_draft() {
    let folder = folder("replace");
    let path = folder.join("flow.vti");
    fs::write(&path, "older").unwrap();
    write_vti(&path, &example()).unwrap();
    assert!(fs::read(&path).unwrap().starts_with(b"<?xml"));
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
}

#[test]
fn an_array_that_does_not_fill_the_cells_is_refused() {
    let path = folder("fault").join("flow.vti");
    let mut image = example();
    image.arrays[0].values.pop();
    let error = write_vti(&path, &image)
        .expect_err("a value is missing")
        .to_string();
    assert_contains(&error, &["pressure has 59 values", "need 60"]);
    assert!(!path.exists());
}

#[test]
fn a_collection_continues_after_a_restart() {
    let folder = folder("pvd");
    let path = folder.join("flow.pvd");
    let mut pvd = Pvd::create(&path).unwrap();
    for step in 0..4_u32 {
        let file = folder.join(format!("flow_{step}.vti"));
        write_vti(&file, &example()).unwrap();
        pvd.add(0.1 * f64::from(step), &file).unwrap();
    }
    // The run falls back to step 2, whose time is 0.2 s.
    let mut pvd = Pvd::resume(&path, 0.2).unwrap();
    pvd.add(0.2, "flow_2.vti").unwrap();
    let wants = vec![
        (0.0, "flow_0.vti"),
        (0.1, "flow_1.vti"),
        (0.2, "flow_2.vti"),
    ];
    assert_eq!(pvd.entries().collect::<Vec<_>>(), wants);
    let found = read_with_vtk(&path);
    assert_eq!(found["entries"], serde_json::json!(wants));
    assert_eq!(found["arrays"]["pressure"]["tuples"], 60);

    let elsewhere = std::env::temp_dir().join("elsewhere.vti");
    let error = pvd
        .add(0.3, elsewhere)
        .expect_err("another folder")
        .to_string();
    assert!(error.contains("write this one below"), "{error}");
}

#[test]
fn a_table_restarts_without_double_rows_and_keeps_every_digit() {
    let path = folder("csv").join("gauge.csv");
    let columns = ["pressure", "velocity_x"];
    let value = |step: u64| [1.0 / (step as f64 + 3.0), -1e-300 * step as f64];
    let mut csv = Csv::create(&path, &columns).unwrap();
    for step in 0..10 {
        csv.append(step, 0.1 * step as f64, &value(step)).unwrap();
    }
    drop(csv);
    let unbroken = fs::read_to_string(&path).unwrap();
    // A row cut off by the kill, without its line break.
    fs::write(&path, unbroken.clone() + "10,1.0,0.").unwrap();

    let mut csv = Csv::resume(&path, &columns, 6).unwrap();
    // That step was written by the previous run.
    csv.append(6, 0.6, &value(9)).unwrap();
    for step in 7..10 {
        csv.append(step, 0.1 * step as f64, &value(step)).unwrap();
    }
    assert_eq!(fs::read_to_string(&path).unwrap(), unbroken);

    let table = Table::read(&path).unwrap();
    for (index, column) in columns.iter().enumerate() {
        let wants: Vec<f64> = (0..10).map(|step| value(step)[index]).collect();
        assert_eq!(table.column(column), Some(wants.as_slice()));
    }
}

/// Tables of lines, planes and faces have several rows of a step.
#[test]
fn all_rows_of_the_step_of_a_restart_are_kept() {
    let path = folder("csv_rows").join("line.csv");
    let columns = ["s"];
    let rows = |csv: &mut Csv, step: u64| {
        for point in 0..3 {
            csv.append(step, 0.1 * step as f64, &[f64::from(point)])
                .unwrap();
        }
    };
    let mut csv = Csv::create(&path, &columns).unwrap();
    (0..4).for_each(|step| rows(&mut csv, step));
    drop(csv);
    let unbroken = fs::read_to_string(&path).unwrap();
    let mut csv = Csv::resume(&path, &columns, 2).unwrap();
    (2..4).for_each(|step| rows(&mut csv, step));
    assert_eq!(fs::read_to_string(&path).unwrap(), unbroken);
}

#[test]
fn a_table_with_other_columns_is_not_continued() {
    let path = folder("csv_columns").join("gauge.csv");
    Csv::create(&path, &["pressure"]).unwrap();
    let error = Csv::resume(&path, &["force_x"], 0)
        .expect_err("other columns")
        .to_string();
    assert_contains(&error, &["`step,time,pressure`", "move the file"]);
    let error = Csv::create(&path, &["left, low"])
        .expect_err("a comma")
        .to_string();
    assert_contains(&error, &["left, low", "without comma"]);
}

#[test]
fn a_cut_or_wrong_number_is_reported_with_its_line() {
    let path = folder("table").join("gauge.csv");
    fs::write(&path, "step,time\n0,0.0\n1,x\n").unwrap();
    let error = Table::read(&path).expect_err("x is no number").to_string();
    assert_contains(&error, &["line 3", "`x`"]);
    fs::write(&path, "step,time\n0,0.0\n1\n").unwrap();
    let error = Table::read(&path)
        .expect_err("a value is missing")
        .to_string();
    assert!(error.contains("line 3: 1 values under 2 names"), "{error}");
}

/// `/dev/full` answers every write with ENOSPC, as a full disk does.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_named_with_its_remedy() {
    let mut csv = Csv::create(folder("full").join("gauge.csv"), &["p"]).unwrap();
    csv.append(0, 0.0, &[1.0]).unwrap();
    for error in [
        write_vti("/dev/full", &example()).expect_err("no space"),
        Pvd::create("/dev/full").map(|_| ()).expect_err("no space"),
        Csv::create("/dev/full", &["p"])
            .map(|_| ())
            .expect_err("no space"),
    ] {
        let error = error.to_string();
        assert!(error.starts_with("/dev/full: cannot write: "), "{error}");
        assert!(error.contains("free some space"), "{error}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_disk_that_fills_up_leaves_the_former_image() {
    let folder = folder("fills_up");
    let path = folder.join("flow.vti");
    write_vti(&path, &example()).unwrap();
    let former = fs::read(&path).unwrap();
    // The next draft is written to a full device.
    std::os::unix::fs::symlink("/dev/full", folder.join("flow.vti.part")).unwrap();
    let error = write_vti(&path, &example())
        .expect_err("no space")
        .to_string();
    assert!(error.contains("free some space"), "{error}");
    assert_eq!(fs::read(&path).unwrap(), former);
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
}

/// A folder below a file cannot be created, even by root.
#[cfg(unix)]
#[test]
fn a_folder_that_cannot_be_is_named_with_its_remedy() {
    let folder = folder("unwritable");
    fs::write(folder.join("file"), "").unwrap();
    let path = folder.join("file/flow.vti");
    let error = write_vti(&path, &example())
        .expect_err("no folder")
        .to_string();
    assert!(error.contains("flow.vti: cannot write: "), "{error}");
    assert!(error.contains("a part of the path is a file"), "{error}");
    let error = Csv::create(folder.join("missing/gauge.csv"), &["p"])
        .expect_err("no folder")
        .to_string();
    assert!(error.contains("create its folder first"), "{error}");
}
