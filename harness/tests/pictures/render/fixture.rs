//! Shared by tests of pictures in space: a device, a cube, cameras, and projections of points.

use glam::{DMat3, DVec3};
use riprap::geometry::Polyhedron;
use riprap::wgpu;
use riprap_harness::gpu;
use riprap_harness::render::{Camera, Colours, Drawing, Instance, Mesh, Picture, Renderer, View};
use std::sync::LazyLock;

pub const WHITE: [u8; 3] = [255; 3];

pub static DEVICE: LazyLock<(wgpu::Device, wgpu::Queue)> = LazyLock::new(|| {
    let adapter = gpu::pick(None).expect("an adapter");
    // Limits that every WebGPU device has.
    gpu::open(&adapter, wgpu::Features::empty(), wgpu::Limits::default()).expect("a device")
});

pub fn renderer(size: [u32; 2]) -> Renderer {
    Renderer::new(&DEVICE.0, &DEVICE.1, size).expect("a renderer")
}

pub fn render(drawing: &Drawing<'_>, size: [u32; 2]) -> Picture {
    renderer(size).render(drawing).expect("a picture")
}

/// A cube with edges of 1 m, without lines on its edges.
pub fn plain_cube() -> Mesh {
    let cube = Polyhedron::cuboid(DVec3::ONE).expect("a cube");
    Mesh {
        edges: Vec::new(),
        ..Mesh::of(&cube)
    }
}

pub fn body(centre: DVec3) -> Instance {
    Instance {
        mesh: 0,
        centre,
        deformation: DMat3::IDENTITY,
        value: None,
        fixed: false,
    }
}

/// Bodies seen by a camera, and nothing else.
pub fn drawing(meshes: &[Mesh], instances: Vec<Instance>, camera: Camera) -> Drawing<'_> {
    Drawing {
        meshes,
        instances,
        view: View::From(camera),
        ..Drawing::default()
    }
}

/// Along +y from 10 m in front of the origin.
pub fn level() -> Camera {
    Camera {
        from: DVec3::new(0.0, -10.0, 0.0),
        to: DVec3::ZERO,
        up: DVec3::Z,
        field_of_view: 15_f64.to_radians(),
    }
}

/// From the right and above, 10 m from the origin, with three faces of a cube there in view.
pub fn oblique() -> Camera {
    Camera {
        from: 10.0 * DVec3::new(0.4, -0.8, 0.6).normalize(),
        ..level()
    }
}

pub fn speed(range: [f64; 2]) -> Option<Colours> {
    Some(Colours {
        label: "speed".into(),
        unit: "m/s".into(),
        range: Some(range),
    })
}

/// The projection of a point by a pinhole camera, pixels from the upper left.
pub fn seen(camera: &Camera, [width, height]: [u32; 2], point: DVec3) -> [f64; 2] {
    let forward = (camera.to - camera.from).normalize();
    let right = forward.cross(camera.up).normalize();
    let up = right.cross(forward);
    let offset = point - camera.from;
    let scale = 0.5 * f64::from(height) / (0.5 * camera.field_of_view).tan() / offset.dot(forward);
    [
        0.5 * f64::from(width) + scale * offset.dot(right),
        0.5 * f64::from(height) - scale * offset.dot(up),
    ]
}

pub fn pixel_at(picture: &Picture, [x, y]: [f64; 2]) -> [u8; 3] {
    picture.pixel(x as u32, y as u32)
}

pub fn linear(srgb: u8) -> f64 {
    let c = f64::from(srgb) / 255.0;
    if c <= 0.04045 {
        c / 12.92
    } else {
        ((c + 0.055) / 1.055).powf(2.4)
    }
}

/// Columns and rows that are not white: first and last of each.
pub fn extent(picture: &Picture) -> [[u32; 2]; 2] {
    let mut found = [[u32::MAX, 0]; 2];
    for y in 0..picture.height {
        for x in 0..picture.width {
            if picture.pixel(x, y) != WHITE {
                for (range, at) in found.iter_mut().zip([x, y]) {
                    *range = [range[0].min(at), range[1].max(at)];
                }
            }
        }
    }
    found
}

/// Middle of the leftmost run of coloured pixels in the middle row.
pub fn body_in_the_middle_row(picture: &Picture) -> [u32; 2] {
    let y = picture.height / 2;
    let first = (0..picture.width).find(|&x| picture.pixel(x, y) != WHITE);
    let first = first.expect("a body");
    let last = (first..picture.width).find(|&x| picture.pixel(x, y) == WHITE);
    [(first + last.expect("an end")) / 2, y]
}
