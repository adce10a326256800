//! What a view shows: the meshes of the blocks, the camera and the colours, the same in every picture.

use super::Rock;
use crate::{
    gpu,
    render::{Camera, Colours, Drawing, Ground, Instance, Look, Mesh, Picture, Renderer, View},
};
use anyhow::Result;
use glam::DVec3;
use riprap::{
    block::{Form, Shape},
    bodies::Motion,
    scene, wgpu,
};
use std::{collections::HashMap, sync::Arc};

/// Cuts of an edge of the icosahedron that a sphere is drawn as.
const CUTS: u32 = 4;

/// Everything for the pictures of a view but the bodies' places.
pub struct Stage {
    renderer: Renderer,
    /// Of half the size, for strips.
    small: Renderer,
    meshes: Vec<Mesh>,
    camera: Camera,
    ground: Option<Ground>,
    /// Speed of the last colour, m/s.
    speed: f64,
}

impl Stage {
    /// Opens the adapter called `adapter`, or the best one, and places the camera for what `engine`
    /// shows now.
    pub fn new(engine: &Rock<'_>, view: &scene::View, adapter: Option<&str>) -> Result<Self> {
        let adapter = gpu::pick(adapter)?;
        let limits = wgpu::Limits::downlevel_defaults().using_resolution(adapter.limits());
        let (device, queue) = gpu::open(&adapter, wgpu::Features::empty(), limits)?;
        let renderer = Renderer::new(&device, &queue, view.size)?;
        let small = Renderer::new(&device, &queue, view.size.map(|edge| edge / 2))?;
        let meshes = meshes(engine);
        let up = DVec3::from(engine.scene.up_of(view));
        let field_of_view = view.field_of_view.to_radians();
        let camera = match (view.from, view.to) {
            (Some(from), Some(to)) => Camera {
                from: from.into(),
                to: to.into(),
                up,
                field_of_view,
            },
            _ => {
                let direction = view.direction.unwrap_or(scene::View::USUAL_DIRECTION);
                let look = Look {
                    direction: direction.into(),
                    up,
                    field_of_view,
                };
                let mut seen = bodies(engine);
                // A ground that reaches far would push the camera away from what moves on it.
                if seen.iter().any(|body| !body.fixed) {
                    seen.retain(|body| !body.fixed);
                }
                let drawing = Drawing {
                    meshes: &meshes,
                    instances: seen,
                    ..Drawing::default()
                };
                renderer.framing(&[drawing], look)?
            }
        };
        Ok(Self {
            renderer,
            small,
            camera,
            ground: view.ground.map(|height| Ground { height }),
            speed: view.speed.unwrap_or_else(|| usual_speed(engine)),
            meshes,
        })
    }

    /// The present picture.
    pub fn draw(&self, engine: &Rock<'_>) -> Result<Picture> {
        self.renderer
            .render(&self.drawing(engine, engine.time, bodies(engine)))
    }

    /// The frames side by side, two in a row.
    pub fn strip(&self, engine: &Rock<'_>, frames: &[(f64, Vec<Instance>)]) -> Result<Picture> {
        let frames = frames.iter();
        let drawings: Vec<_> = frames
            .map(|(time, bodies)| self.drawing(engine, *time, bodies.clone()))
            .collect();
        self.small.strip(&drawings, 2)
    }

    fn drawing(&self, engine: &Rock<'_>, time: f64, instances: Vec<Instance>) -> Drawing<'_> {
        Drawing {
            meshes: &self.meshes,
            instances,
            view: View::From(self.camera),
            ground: self.ground,
            scale_bar: true,
            title: engine.scene.title.clone(),
            time: Some(time),
            colours: Some(Colours {
                label: "speed".into(),
                unit: "m/s".into(),
                range: Some([0.0, self.speed]),
            }),
            ..Drawing::default()
        }
    }
}

/// A mesh for each part of each different shape.
fn meshes(engine: &Rock<'_>) -> Vec<Mesh> {
    let mut made = Vec::new();
    each_shape(engine, |shape| {
        made.extend(shape.parts().iter().map(|part| match &part.form {
            Form::Convex(block) => Mesh::of(block),
            Form::Sphere { radius } => Mesh::sphere(*radius, CUTS),
        }));
    });
    made
}

/// Where the blocks are, each coloured by the speed of its centroid.
pub fn bodies(engine: &Rock<'_>) -> Vec<Instance> {
    let first = each_shape(engine, |_| {});
    let poses = engine.blocks.poses();
    let blocks = engine.setup.blocks[..engine.shown].iter().zip(&poses);
    let parts = blocks.flat_map(|(block, pose)| {
        let first = first[&Arc::as_ptr(&block.shape)];
        let parts = block.shape.parts().iter().enumerate();
        parts.map(move |(number, part)| Instance {
            mesh: first + number,
            centre: pose.point(part.offset),
            deformation: pose.deformation,
            value: Some(pose.velocity.length()),
            fixed: block.motion == Motion::Fixed,
        })
    });
    parts.collect()
}

/// Calls `with` for each different shape; says which of all their parts is the first of each.
fn each_shape(engine: &Rock<'_>, mut with: impl FnMut(&Shape)) -> HashMap<*const Shape, usize> {
    let mut first = HashMap::new();
    let mut parts = 0;
    for block in &engine.setup.blocks[..engine.shown] {
        first.entry(Arc::as_ptr(&block.shape)).or_insert_with(|| {
            with(&block.shape);
            let at = parts;
            parts += block.shape.parts().len();
            at
        });
    }
    first
}

/// √(2gL), L the largest extent of a block that moves; without gravity the largest speed now, m/s.
fn usual_speed(engine: &Rock<'_>) -> f64 {
    let blocks = engine.setup.blocks[..engine.shown].iter();
    let moving = blocks.filter(|block| block.motion != Motion::Fixed);
    let extent = moving
        .map(|block| 2.0 * block.shape.radius())
        .fold(0.0, f64::max);
    let gravity = DVec3::from(engine.scene.rock.gravity).length();
    let speed = if gravity > 0.0 {
        (2.0 * gravity * extent).sqrt()
    } else {
        engine.max_speed()
    };
    if speed > 0.0 { speed } else { 1.0 }
}
