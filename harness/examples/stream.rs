//! Draws blocks in a stream that a formula gives, in space and cut by a plane: `cargo run --example stream [folder]`.

use anyhow::Result;
use glam::{DMat3, DVec3};
use riprap::geometry::{Form, Polyhedron};
use riprap::output::{Array, Image};
use riprap::wgpu;
use riprap_harness::gpu;
use riprap_harness::picture::{Placed, Plane, Quantity, Section, Slice, traces};
use riprap_harness::render::{
    Colours, Drawing, FluidPlane, Ground, Instance, Mesh, Renderer, Traces,
};
use std::path::PathBuf;

/// Cells along each axis, and their size, m.
const CELLS: [usize; 3] = [120, 60, 50];
const CELL: f64 = 0.05;

fn main() -> Result<()> {
    let folder = std::env::args()
        .nth(1)
        .map_or_else(std::env::temp_dir, PathBuf::from);
    std::fs::create_dir_all(&folder)?;
    let stream = stream();
    let shapes = [
        Polyhedron::cuboid(DVec3::new(1.0, 1.0, 0.8))?,
        Polyhedron::cuboid(DVec3::new(0.6, 0.5, 0.5))?,
    ];
    let forms = shapes.clone().map(Form::Convex);
    let meshes = shapes.each_ref().map(Mesh::of);
    let turned = DMat3::from_rotation_z(0.5) * DMat3::from_rotation_x(0.3);
    let bodies = [
        (0, DVec3::new(2.2, 1.5, 0.8), turned),
        (1, DVec3::new(3.7, 1.1, 0.45), DMat3::from_rotation_z(1.5)),
        (1, DVec3::new(4.4, 2.2, 0.5), DMat3::from_rotation_y(0.7)),
        (1, DVec3::new(1.0, 2.4, 0.4), DMat3::from_rotation_x(0.4)),
    ];
    let blocks = bodies.map(|(mesh, centre, deformation)| Placed {
        form: &forms[mesh],
        centre,
        deformation,
    });
    let plane = Plane {
        normal: 1,
        position: 1.525,
    };

    let slice = Slice {
        title: "Blocks in a stream",
        time: 0.0,
        plane,
        quantity: Quantity::Magnitude("velocity"),
        label: "speed",
        unit: "m/s",
        range: None,
        streamlines: true,
        blocks: &blocks,
    };
    slice.draw(&stream, &folder.join("stream_slice.png"))?;

    let colours = Colours {
        label: "speed".into(),
        unit: "m/s".into(),
        range: Some([0.0, 1.6]),
    };
    let mut section = Section::new(&stream, plane, slice.quantity)?;
    section.leave_out(&blocks, plane);
    let drawing = Drawing {
        meshes: &meshes,
        instances: bodies
            .map(|(mesh, centre, deformation)| Instance {
                mesh,
                centre,
                deformation,
                value: None,
                fixed: false,
            })
            .to_vec(),
        planes: vec![FluidPlane::of(&section, plane, colours.clone())],
        traces: Some(Traces {
            lines: traces(&stream, &blocks, 40),
            colours,
        }),
        ground: Some(Ground { height: 0.1 }),
        scale_bar: true,
        title: slice.title.into(),
        ..Drawing::default()
    };
    let adapter = gpu::pick(None)?;
    let (device, queue) = gpu::open(&adapter, wgpu::Features::empty(), Default::default())?;
    let renderer = Renderer::new(&device, &queue, [1280, 720])?;
    renderer.render(&drawing)?.save(&folder.join("stream.png"))
}

/// A potential flow around a ball (Lamb, 1932, art. 96) in the place of the first block, which slows down towards a
/// rising bed and turns behind the ball.
fn stream() -> Image {
    let radius = 0.7_f64;
    let [mut velocity, mut solid] = [const { Vec::new() }; 2];
    for k in 0..CELLS[2] {
        for j in 0..CELLS[1] {
            for i in 0..CELLS[0] {
                let x = CELL * (DVec3::new(i as f64, j as f64, k as f64) + 0.5);
                let d = x - DVec3::new(2.2, 1.5, 0.8);
                let r = d.length().max(radius);
                let dipole = 0.5 * (radius / r).powi(3) * (3.0 * d.x * d / (r * r) - DVec3::X);
                let across = DVec3::new(0.0, x.y - 1.5, x.z - 1.2);
                let swirl = (-2.0 * across.length_squared()).exp() * x.x / 4.0;
                let turn = swirl * DVec3::new(0.0, -across.z, across.y);
                let slow = (x.z / 0.5).min(1.0);
                let u = slow * (DVec3::X - dipole + turn);
                velocity.extend(u.to_array().map(|u| u as f32));
                solid.push(f32::from(x.z < 0.1 + 0.2 * (x.x - 4.0).max(0.0)));
            }
        }
    }
    Image {
        origin: [0.0; 3],
        spacing: CELL,
        cells: CELLS,
        arrays: [("velocity", 3, velocity), ("solid", 1, solid)]
            .map(|(name, components, values)| Array {
                name: name.into(),
                components,
                values,
            })
            .into(),
    }
}
