//! Draws each kind of picture from formulas: `cargo run --example pictures [folder]`.

use anyhow::Result;
use riprap::output::{Array, Csv, Image, Table, VelocityQuantities};
use riprap_harness::picture::{Chart, Curve, Mark, Measure, Plane, Quantity, Slice, Track};
use std::f64::consts::{PI, TAU};
use std::path::PathBuf;

fn main() -> Result<()> {
    let folder = std::env::args()
        .nth(1)
        .map_or_else(std::env::temp_dir, PathBuf::from);
    std::fs::create_dir_all(&folder)?;
    let vortices = vortices();
    let mut slice = Slice {
        title: "Taylor–Green vortices",
        time: 12.5,
        plane: Plane {
            normal: 2,
            position: 0.25,
        },
        quantity: Quantity::Scalar("vorticity_z"),
        label: "vorticity",
        unit: "s⁻¹",
        range: None,
        streamlines: true,
        blocks: &[],
    };
    slice.draw(&vortices, &folder.join("vorticity.png"))?;
    let flow = cylinder(420, 120);
    slice.title = "Potential flow around a cylinder";
    slice.quantity = Quantity::Magnitude("velocity");
    (slice.label, slice.unit) = ("speed", "m/s");
    slice.draw(&flow, &folder.join("speed.png"))?;
    slice.streamlines = false;
    slice.title = "Pressure around a cylinder";
    slice.quantity = Quantity::Scalar("pressure");
    (slice.label, slice.unit) = ("pressure", "Pa");
    slice.draw(&cylinder(100, 260), &folder.join("pressure.png"))?;

    let path = folder.join("gauge.csv");
    let mut csv = Csv::create(&path, &["pressure", "velocity_x", "velocity_y"])?;
    for step in 0..2000_u32 {
        let time = 0.01 * f64::from(step);
        let decay = (-0.1 * time).exp();
        let values = [
            9810.0 + 35.0 * decay * (TAU * time).sin(),
            2e-3 * (1.0 - decay),
            4e-4 * decay * (0.5 * TAU * time).cos(),
        ];
        csv.append(u64::from(step), time, &values)?;
    }
    let tracks = [
        Track {
            quantity: "pressure",
            unit: "Pa",
            columns: &["pressure"],
        },
        Track {
            quantity: "velocity",
            unit: "m/s",
            columns: &["velocity_x", "velocity_y"],
        },
    ];
    Chart::history("Gauge behind the weir", &Table::read(&path)?, &tracks)?
        .draw(&folder.join("history.png"))?;

    let curve = |name: &str, mark, points: Vec<[f64; 2]>| Curve {
        name: name.to_owned(),
        points,
        mark,
    };
    let theory = (0..=100)
        .map(|n| f64::from(n) / 100.0)
        .map(|y| [y, 6.0 * y * (1.0 - y)]);
    let computed = (0..16).map(|n| (f64::from(n) + 0.5) / 16.0);
    let computed = computed.map(|y| [y, 6.0 * y * (1.0 - y) - 0.02]);
    Chart::profile(
        "Plane Poiseuille flow",
        Measure::linear("y/H", ""),
        Measure::linear("mean velocity u/U", ""),
        vec![
            curve("theory", Mark::Dashed, theory.collect()),
            curve("16 cells", Mark::Points, computed.collect()),
        ],
    )
    .draw(&folder.join("profile.png"))?;
    let error = |order: i32| {
        [8.0, 16.0, 32.0, 64.0_f64]
            .map(|n| [n, 0.3 * n.powi(-order)])
            .to_vec()
    };
    Chart::profile(
        "Taylor–Green vortices: convergence",
        Measure::logarithmic("cells per period", ""),
        Measure::logarithmic("relative error of velocity", ""),
        vec![
            curve("computed", Mark::LinePoints, error(2)),
            curve("first order", Mark::Dashed, error(1)),
        ],
    )
    .draw(&folder.join("convergence.png"))
}

/// Four vortices in a periodic box 1 m wide.
fn vortices() -> Image {
    let cells = 128;
    let mut image = Image {
        origin: [0.0; 3],
        spacing: 1.0 / cells as f64,
        cells: [cells, cells, 1],
        arrays: Vec::new(),
    };
    image.origin[2] = 0.25 - 0.5 * image.spacing;
    let mut velocity = Vec::new();
    for j in 0..cells {
        for i in 0..cells {
            let [x, y] = [i, j].map(|index| TAU * (index as f64 + 0.5) * image.spacing);
            velocity.extend([(x.sin() * y.cos()) as f32, (-x.cos() * y.sin()) as f32, 0.0]);
        }
    }
    image.arrays.push(Array {
        name: "velocity".into(),
        components: 3,
        values: velocity,
    });
    let vorticity = VelocityQuantities::new(&image, [true; 3]).map(|found| found.vorticity());
    let values = vorticity
        .iter()
        .flat_map(|found| found.values.chunks(3))
        .map(|tuple| tuple[2]);
    let values = values.collect();
    image.arrays.push(Array {
        name: "vorticity_z".into(),
        components: 1,
        values,
    });
    image
}

/// Flow past a cylinder with circulation, without friction.
fn cylinder(nx: usize, ny: usize) -> Image {
    let spacing = 0.005;
    let [a, speed, circulation] = [0.1, 1.0, -0.3];
    let centre = [0.4 * nx as f64 * spacing, 0.5 * ny as f64 * spacing];
    let [mut velocity, mut pressure, mut solid] = [const { Vec::new() }; 3];
    for j in 0..ny {
        for i in 0..nx {
            let x = (i as f64 + 0.5) * spacing - centre[0];
            let y = (j as f64 + 0.5) * spacing - centre[1];
            let r2 = x * x + y * y;
            let swirl = circulation / (2.0 * PI * r2);
            let u = speed * (1.0 - a * a * (x * x - y * y) / (r2 * r2)) - swirl * y;
            let v = -2.0 * speed * a * a * x * y / (r2 * r2) + swirl * x;
            let inside = r2 < a * a;
            solid.push(f32::from(inside));
            velocity.extend(if inside {
                [0.0; 3]
            } else {
                [u as f32, v as f32, 0.0]
            });
            pressure.push((500.0 * (speed * speed - u * u - v * v)) as f32);
        }
    }
    Image {
        origin: [-1.0, 0.0, 0.0],
        spacing,
        cells: [nx, ny, 100],
        arrays: [
            ("velocity", 3, velocity),
            ("pressure", 1, pressure),
            ("solid", 1, solid),
        ]
        .map(|(name, components, layer): (&str, usize, Vec<f32>)| Array {
            name: name.into(),
            components,
            values: layer.repeat(100),
        })
        .into(),
    }
}
