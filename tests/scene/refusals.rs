//! Every scene that contradicts itself is refused with its key, line and a remedy.

use crate::{changed, channel, refused};

#[test]
fn domains_are_whole_cells() {
    refused(
        changed("0.01,", "0.0105,"),
        &[
            "channel.toml:3:15: domain.size[1]",
            "10.5",
            "0.01 and 0.011 m",
        ],
    );
    refused(
        changed("0.01,", "1e-4,"),
        &["domain.size[1]", "0.001 and 0.002 m"],
    );
    refused(
        changed("cell = 1e-3", "cell = 0"),
        &["domain.cell", "greater than 0"],
    );
    refused(
        changed("cell = 1e-3", "cell = nan"),
        &["domain.cell", "greater than 0"],
    );
    refused(
        changed("0.02,", "-0.02,"),
        &["domain.size[0]", "greater than 0"],
    );
    refused(
        changed("0.02,", "inf,"),
        &["domain.size[0]", "greater than 0"],
    );
    refused(
        changed("cell = 1e-3", "cell = 1e-7"),
        &["domain.cell", "cells", "cell ≥"],
    );
}

#[test]
fn fluids_have_positive_properties() {
    refused(
        changed("1e-6", "0"),
        &["channel.toml:6:13: fluid.viscosity", "greater than 0"],
    );
    refused(
        changed("1e-6", "-1e-6"),
        &["fluid.viscosity", "-0.000001 m²/s"],
    );
    refused(
        changed("[fluid]", "[fluid]\ndensity = 0"),
        &["fluid.density", "kg/m³"],
    );
    refused(
        changed("[fluid]", "[fluid]\nacceleration = [0, \"t\", 0]"),
        &["fluid.acceleration", "uses t"],
    );
    refused(
        changed("[fluid]", "[fluid]\nacceleration = [0, inf, 0]"),
        &["fluid.acceleration"],
    );
}

#[test]
fn numerics_do_not_contradict_themselves() {
    for (keys, parts) in [
        (
            "time_step = 1e-3\nmach = 0.1",
            ["numerics.mach", "keep one"],
        ),
        ("time_step = 0", ["numerics.time_step", "greater than 0"]),
        ("mach = -1", ["numerics.mach", "greater than 0"]),
        (
            "velocity_scale = inf",
            ["numerics.velocity_scale", "greater than 0"],
        ),
        ("lanes = 3", ["numerics.lanes", "1, 2 and 4"]),
        ("lanes = 2", ["numerics.lanes", "f16"]),
        ("lanes = 1\nstorage = \"f16\"", ["numerics.lanes", "2 or 4"]),
        ("lambda = 0", ["numerics.lambda", "greater than 0"]),
        (
            "lambda = 0.1\ncollision = \"bgk\"",
            ["numerics.lambda", "hermite"],
        ),
        (
            "wall_lambda = nan",
            ["numerics.wall_lambda", "greater than 0"],
        ),
        ("wale_constant = -0.5", ["numerics.wale_constant", "0.5"]),
        ("odd_rate_floor = 2", ["numerics.odd_rate_floor", "0.8"]),
    ] {
        refused(channel(&format!("[numerics]\n{keys}\n")), &parts);
    }
    for keys in [
        "lanes = 4\nstorage = \"f16\"",
        "lanes = 2\nstorage = \"f16\"",
        "lanes = 1",
    ] {
        channel(&format!("[numerics]\n{keys}\n")).unwrap();
    }
}

#[test]
fn boundaries_fit_each_other() {
    refused(
        channel("[boundaries]\ny_max = { kind = \"wall\" }\n"),
        &[
            "channel.toml:9:",
            "boundaries.y_min",
            "y_max is `wall`",
            "make both periodic",
        ],
    );
    refused(
        channel(
            "[boundaries]\ny_max = { kind = \"wall\", velocity = [1, 1, 0] }\ny_min = { kind = \"wall\" }\n",
        ),
        &["boundaries.y_max.velocity", "y component must be 0"],
    );
    refused(
        channel("[boundaries]\ny_max = { kind = \"wall\", velocity = [\"x\", 0, 0] }\n"),
        &["three numbers"],
    );
    refused(
        channel(
            "[boundaries]\nx_min = { kind = \"velocity\", velocity = [2, 0, 0] }\nx_max = { kind = \"velocity\", velocity = [1, 0, 0] }\n",
        ),
        &[
            "channel.toml:10:",
            "8.000000e-5 m³/s in",
            "4.000000e-5 m³/s out",
            "pressure",
        ],
    );
    refused(
        channel(
            "[boundaries]\nx_min = { kind = \"pressure\", pressure = nan }\nx_max = { kind = \"free_slip\" }\n",
        ),
        &["boundaries.x_min.pressure", "finite"],
    );
}

#[test]
fn velocity_faces_that_balance_are_accepted() {
    channel("[boundaries]\nx_min = { kind = \"velocity\", velocity = [\"0.01-y\", 0, 0] }\nx_max = { kind = \"velocity\", velocity = [\"y\", 0, 0] }\n").unwrap();
    // The lower half of the outlet is solid: only the upper half lets fluid out.
    channel(
        "[boundaries]\nx_min = { kind = \"velocity\", velocity = [1, 0, 0] }\n\
         x_max = { kind = \"velocity\", velocity = [2, 0, 0] }\n\
         [[solids]]\nkind = \"box\"\nmin = [0.015, 0, 0]\nmax = [0.02, 0.005, 0.004]\n",
    )
    .unwrap();
}

#[test]
fn solids_have_an_extent_in_the_domain() {
    for (keys, parts) in [
        (
            "kind = \"box\"\nmin = [0, 0, 0]\nmax = [0.01, 0, 0.01]",
            ["solids[0].max", "along y"],
        ),
        (
            "kind = \"box\"\nmin = [1, 1, 1]\nmax = [2, 2, 2]",
            ["solids[0]", "wholly outside"],
        ),
        (
            "kind = \"sphere\"\ncenter = [0, 0, 0]\nradius = -1",
            ["solids[0].radius", "greater than 0"],
        ),
        (
            "kind = \"sphere\"\ncenter = [0, 9, 0]\nradius = 1",
            ["solids[0]", "wholly outside"],
        ),
        (
            "kind = \"half_space\"\npoint = [0, 0, 0]\nnormal = [0, 0, 0]",
            ["solids[0].normal", "direction"],
        ),
        (
            "kind = \"mesh\"\nfile = \"a.stl\"\nscale = 0",
            ["solids[0].scale", "greater than 0"],
        ),
        (
            "kind = \"box\"\nname = \"a/b\"\nmin = [0, 0, 0]\nmax = [0.01, 0.01, 0.01]",
            ["solids[0].name", "A-Z"],
        ),
    ] {
        refused(channel(&format!("[[solids]]\n{keys}\n")), &parts);
    }
}

#[test]
fn runs_have_one_end() {
    refused(
        changed("steps = 10", ""),
        &["channel.toml:7:", "run", "`duration`", "`steps`"],
    );
    refused(
        changed("steps = 10", "steps = 10\nduration = 1"),
        &["run.steps", "keep one"],
    );
    refused(
        changed("steps = 10", "steps = 0"),
        &["run.steps", "at least 1"],
    );
    refused(
        changed("steps = 10", "duration = -1"),
        &["run.duration", "greater than 0"],
    );
    refused(
        changed("steps = 10", "steps = 10\ncheckpoint_every = 0"),
        &["run.checkpoint_every", "greater than 0"],
    );
}

#[test]
fn outputs_can_be_written() {
    let slice = "[[output.slices]]\naxis = \"z\"\nfield = \"speed\"\n";
    for (keys, parts) in [
        (
            "[output]\nevery = 0\n".to_owned(),
            ["output.every", "greater than 0"],
        ),
        ("[output]\nfields = []\n".into(), ["output.fields", "empty"]),
        (
            "[output]\nfields = [\"solid\", \"solid\"]\n".into(),
            ["output.fields", "twice"],
        ),
        (
            "[output]\nfields = [\"eddy_viscosity\"]\n".into(),
            ["output.fields", "wale"],
        ),
        (
            format!("{slice}name = \"a b\"\n"),
            ["output.slices[0].name", "`a b`"],
        ),
        (
            format!("{slice}name = \"a\"\n{slice}name = \"A\"\n"),
            ["output.slices[1].name", "taken"],
        ),
        (
            format!("{slice}name = \"a\"\nposition = 1\n"),
            ["output.slices[0].position", "outside"],
        ),
        (
            format!("{slice}name = \"a\"\nrange = [1, 1]\n"),
            ["output.slices[0].range", "smaller"],
        ),
        (
            format!("{slice}name = \"a\"\nevery = -1\n"),
            ["output.slices[0].every", "greater"],
        ),
        (
            "[[output.histories]]\nquantities = []\n".into(),
            ["output.histories[0].quantities", "empty"],
        ),
        (
            "[[output.histories]]\nquantities = [\"mass\"]\nevery = 0\n".into(),
            ["output.histories[0].every", "greater"],
        ),
    ] {
        refused(channel(&keys), &parts);
    }
}

#[test]
fn probes_lie_in_the_domain() {
    for (keys, parts) in [
        (
            "kind = \"point\"\nat = [0, 0, 1]",
            ["probes[0].at", "outside the domain"],
        ),
        (
            "kind = \"line\"\nfrom = [0, 0, 0]\nto = [1, 0, 0]\ncount = 3",
            ["probes[0].to", "outside"],
        ),
        (
            "kind = \"line\"\nfrom = [0, 0, 0]\nto = [0.01, 0, 0]\ncount = 1",
            ["probes[0].count", "2"],
        ),
        (
            "kind = \"plane\"\naxis = \"x\"\nposition = -1",
            ["probes[0].position", "outside"],
        ),
        (
            "kind = \"box\"\nmin = [0.01, 0, 0]\nmax = [0, 0.01, 0.004]",
            ["probes[0].max", "along x"],
        ),
        (
            "kind = \"face\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\nnormal = \"+x\"",
            ["probes[0].max", "outside"],
        ),
        (
            "kind = \"point\"\nat = [0, 0, 0]\nevery = 0",
            ["probes[0].every", "greater"],
        ),
        (
            "kind = \"point\"\nat = [0, 0, 0]\nfields = []",
            ["probes[0].fields", "empty"],
        ),
        (
            "kind = \"point\"\nat = [0, nan, 0]",
            ["probes[0].at", "finite"],
        ),
    ] {
        refused(
            channel(&format!("[[probes]]\nname = \"p\"\n{keys}\n")),
            &parts,
        );
    }
    let point = "[[probes]]\nname = \"p\"\nkind = \"point\"\nat = [0, 0, 0]\n";
    refused(
        channel(&point.repeat(2)),
        &["channel.toml:14:", "probes[1].name", "taken"],
    );
}
