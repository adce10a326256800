//! What a user gets wrong: the program ends with code 2, and says where and what instead.

use std::{
    path::PathBuf,
    process::{Command, Output},
};

/// A scene that is right, to be spoilt.
const RIGHT: &str = r#"
[domain]
size = [0.08, 0.08, 0.04]
cell = 0.01

[fluid]
viscosity = 1e-4

[boundaries]
x_min = { kind = "velocity", velocity = [0.01, 0, 0] }
x_max = { kind = "pressure" }
y_min = { kind = "wall" }
y_max = { kind = "wall" }

[run]
steps = 10
"#;

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_TARGET_TMPDIR"))
}

/// `riprap check` on a file in the tests' folder.
fn check(name: &str, text: &str) -> Command {
    let path = folder().join(format!("{name}.toml"));
    std::fs::write(&path, text).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_riprap"));
    command.arg("check").arg(path);
    command
}

/// What the program says when it refuses.
fn refusal(command: &mut Command) -> String {
    let Output {
        status,
        stderr,
        stdout,
    } = command.output().unwrap();
    let said = String::from_utf8(stderr).unwrap();
    assert_eq!(status.code(), Some(2), "{command:?}: {said}");
    assert!(stdout.is_empty(), "{}", String::from_utf8_lossy(&stdout));
    assert!(!said.contains("panicked"), "{said}");
    said
}

/// The refusal of the right scene with `from` replaced by `to` contains each of `words`.
fn refused(name: &str, from: &str, to: &str, words: &[&str]) {
    assert!(RIGHT.contains(from), "{from}");
    let said = refusal(&mut check(name, &RIGHT.replace(from, to)));
    for word in words.iter().chain(&[format!("{name}.toml").as_str()]) {
        assert!(said.contains(word), "`{word}` is not in: {said}");
    }
}

#[test]
fn the_scene_itself_is_right() {
    let Output { status, stderr, .. } = check("right", RIGHT).output().unwrap();
    assert!(status.success(), "{}", String::from_utf8_lossy(&stderr));
}

#[test]
fn a_file_that_is_not_there() {
    let mut command = Command::new(env!("CARGO_BIN_EXE_riprap"));
    let said = refusal(command.args(["check", "no_such_scene.toml"]));
    assert!(said.contains("no_such_scene.toml"), "{said}");
    assert!(said.contains("check the path"), "{said}");
}

#[test]
fn a_folder_in_place_of_a_file() {
    let mut command = Command::new(env!("CARGO_BIN_EXE_riprap"));
    let said = refusal(command.arg("check").arg(folder()));
    assert!(said.contains("cannot read the scene"), "{said}");
}

#[test]
fn text_that_is_no_toml() {
    refused(
        "no_toml",
        "cell = 0.01",
        "cell = = 0.01",
        &["no_toml.toml:4:"],
    );
}

#[test]
fn a_wrong_type() {
    let words = ["wrong_type.toml:4:", "domain.cell", "expected a number"];
    refused("wrong_type", "cell = 0.01", "cell = \"fine\"", &words);
}

#[test]
fn an_unknown_key() {
    let words = [
        "unknown_key.toml:7:",
        "`viscocity`",
        "did you mean `viscosity`?",
    ];
    refused("unknown_key", "viscosity =", "viscocity =", &words);
}

#[test]
fn an_unknown_word() {
    let words = ["unknown_word.toml:12:", "`wal`", "did you mean `wall`?"];
    refused(
        "unknown_word",
        "y_min = { kind = \"wall\" }",
        "y_min = { kind = \"wal\" }",
        &words,
    );
}

#[test]
fn a_negative_size() {
    let words = [
        "negative_size.toml:3:",
        "domain.size[1]",
        "-0.08 m",
        "greater than 0",
    ];
    refused("negative_size", "0.08, 0.08", "0.08, -0.08", &words);
}

#[test]
fn a_size_that_is_not_a_whole_number_of_cells() {
    let words = ["fraction.toml:3:", "8.500000 cells", "0.08 and 0.09 m"];
    refused("fraction", "0.08, 0.08", "0.08, 0.085", &words);
}

#[test]
fn no_viscosity() {
    let words = [
        "no_viscosity.toml:7:",
        "fluid.viscosity",
        "is 0 m²/s",
        "greater than 0",
    ];
    refused("no_viscosity", "1e-4", "0", &words);
}

#[test]
fn a_viscosity_that_drowns_in_rounding() {
    let words = ["fluid.viscosity", "viscosity ≥", "cell ≤"];
    let said = refusal(&mut check("low_viscosity", &RIGHT.replace("1e-4", "1e-12")));
    words
        .iter()
        .for_each(|word| assert!(said.contains(word), "{said}"));
}

#[test]
fn a_mach_number_above_0_3() {
    let text = RIGHT.to_owned() + "[numerics]\ntime_step = 1\n";
    let said = refusal(&mut check("mach", &text));
    for word in [
        "numerics.time_step",
        "Mach number",
        "use time_step ≤ 5.774e-2 s",
    ] {
        assert!(said.contains(word), "{said}");
    }
}

#[test]
fn one_face_periodic_without_the_other() {
    let words = [
        "boundaries.x_max",
        "x_min is `velocity`",
        "make both periodic",
    ];
    refused(
        "half_periodic",
        "{ kind = \"pressure\" }",
        "{ kind = \"periodic\" }",
        &words,
    );
}

#[test]
fn an_inlet_without_an_outlet() {
    let words = ["boundaries.x_min", "kind = \"pressure\"", "m³/s"];
    refused(
        "no_outlet",
        "{ kind = \"pressure\" }",
        "{ kind = \"wall\" }",
        &words,
    );
}

#[test]
fn more_cells_than_an_index_reaches() {
    let words = ["huge.toml:4:", "domain.cell", "1.591e8", "cell ≥"];
    refused("huge", "cell = 0.01", "cell = 1e-5", &words);
}

/// 1.3e8 cells pass for a scene, but one of 27 directions alone is 526 MB in f32, and few bindings hold several each.
/// Where bindings hold them, what a scene may have is the limit.
#[test]
fn more_cells_than_the_device_holds() {
    let mut list = Command::new(env!("CARGO_BIN_EXE_riprap"));
    let adapters = list.args(["adapters", "--json"]).output().unwrap().stdout;
    let adapters: serde_json::Value = serde_json::from_slice(&adapters).unwrap();
    let limit = |name: &str| adapters[0]["limits"][name].as_u64().unwrap();
    let binding = limit("storage_binding_bytes").min(limit("buffer_bytes"));
    // Flags and the four results of the kernel of output take five.
    let wants = 525_927_680 * 27_u64.div_ceil(limit("storage_buffers") - 5);
    let (cell, words) = if wants > binding {
        let numbers = format!("wants {wants}, the adapter has {binding}; the adapter holds about");
        let remedy = "use a larger cell, 16-bit storage, or another adapter".into();
        ("cell = 1.25e-4", [numbers, remedy])
    } else {
        let numbers = "2.560e8 cells, more than 1.591e8".into();
        ("cell = 1e-4", [numbers, "use cell ≥ 1.172e-4 m".into()])
    };
    let said = refusal(&mut check("large", &RIGHT.replace("cell = 0.01", cell)));
    for word in &words {
        assert!(said.contains(word), "{said}");
    }
}

#[test]
fn a_mesh_that_is_not_closed() {
    let open = "solid open\nfacet normal 0 0 1\nouter loop\nvertex 0.02 0.02 0.02\nvertex 0.06 0.02 \
                0.02\nvertex 0.02 0.06 0.03\nendloop\nendfacet\nendsolid open\n";
    std::fs::write(folder().join("open.stl"), open).unwrap();
    let text = RIGHT.to_owned() + "[[solids]]\nkind = \"mesh\"\nfile = \"open.stl\"\n";
    let said = refusal(&mut check("open_mesh", &text));
    for word in ["open.stl", "3 boundary edges", "close its holes"] {
        assert!(said.contains(word), "{said}");
    }
}

#[test]
fn a_mesh_that_is_not_there() {
    let text = RIGHT.to_owned() + "[[solids]]\nkind = \"mesh\"\nfile = \"missing.stl\"\n";
    let said = refusal(&mut check("missing_mesh", &text));
    assert!(said.contains("missing.stl"), "{said}");
}

#[test]
fn a_formula_that_is_not_finite() {
    let text = RIGHT.to_owned() + "[initial]\nvelocity = [\"sqrt(x - 0.04)\", 0, 0]\n";
    let said = refusal(&mut check("nan", &text));
    for word in ["initial.velocity", "sqrt(x - 0.04)", "NaN"] {
        assert!(said.contains(word), "{said}");
    }
}

#[test]
fn an_unknown_function() {
    let text = RIGHT.to_owned() + "[initial]\nvelocity = [\"sine(x)\", 0, 0]\n";
    let said = refusal(&mut check("function", &text));
    for word in ["function.toml", "sine"] {
        assert!(said.contains(word), "{said}");
    }
}

/// Hides every driver from the program.
fn without_adapters(command: &mut Command) -> &mut Command {
    command
        .env("VK_DRIVER_FILES", "/nonexistent")
        .env("VK_ICD_FILENAMES", "/nonexistent")
        .env("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent")
        .env("LIBGL_DRIVERS_PATH", "/nonexistent")
}

#[cfg(target_os = "linux")]
#[test]
fn a_machine_without_an_adapter() {
    let said = refusal(without_adapters(&mut check("no_adapter", RIGHT)));
    for word in [
        "no GPU adapter",
        "apt-get install mesa-vulkan-drivers libvulkan1",
    ] {
        assert!(said.contains(word), "{said}");
    }
    let mut list = Command::new(env!("CARGO_BIN_EXE_riprap"));
    let said = refusal(without_adapters(list.arg("adapters")));
    assert!(said.contains("apt-get install"), "{said}");
}

#[test]
fn an_adapter_that_does_not_exist() {
    let said = refusal(check("other_adapter", RIGHT).args(["--adapter", "Voodoo 2"]));
    for word in ["no adapter is called 'Voodoo 2'", "there are: "] {
        assert!(said.contains(word), "{said}");
    }
}

#[test]
fn an_unknown_subcommand() {
    let said = refusal(Command::new(env!("CARGO_BIN_EXE_riprap")).arg("chek"));
    assert!(said.contains("check"), "{said}");
}
