//! The constant part of a view: the meshes of the blocks, the camera and the colours.

use super::frame::{colours, share_ranges};
use super::{super::scene_run::SceneRun, shown::each_shape};
use crate::{
    gpu,
    render::{Camera, Colours, Drawing, Ground, Line, Look, Mesh, Picture, Renderer, View},
};
use anyhow::Result;
use glam::DVec3;
use riprap::{
    geometry::Form,
    rock::Motion,
    scene::{self, Domain, Scene},
    wgpu,
};

/// Subdivisions of an edge of the icosahedron by which a sphere is drawn.
const CUTS: u32 = 4;

/// Colour and width (pixels) of the edges of the domain.
const EDGE: ([u8; 3], f64) = ([150, 150, 150], 1.0);

/// Everything for the pictures of a view except what moves.
pub struct Stage {
    renderer: Renderer,
    /// Renderer of half the size, for strips.
    small: Renderer,
    title: String,
    meshes: Vec<Mesh>,
    /// Edges of the domain, if streamlines run through all of it.
    edges: Vec<Line>,
    camera: View,
    ground: Option<Ground>,
    /// Speed of the last colour of blocks, m/s; `None` if blocks are not coloured.
    speed: Option<f64>,
}

impl Stage {
    /// Opens the adapter called `adapter`, or the best one, and places the camera for the first `frame` of `run`.
    pub fn new(
        run: &SceneRun,
        view: &scene::View,
        adapter: Option<&str>,
        frame: &Drawing<'static>,
    ) -> Result<Self> {
        let adapter = gpu::pick(adapter)?;
        let limits = wgpu::Limits::downlevel_defaults().using_resolution(adapter.limits());
        let (device, queue) = gpu::open(&adapter, wgpu::Features::empty(), limits)?;
        let renderer = Renderer::new(&device, &queue, view.size)?;
        let small = Renderer::new(&device, &queue, view.size.map(|edge| edge / 2))?;
        let scene = run.scene();
        let meshes = meshes(run);
        let edges = match frame.traces.is_some() || frame.drops.is_some() {
            true => edges(&scene.domain),
            false => Vec::new(),
        };
        let speed = || view.speed.unwrap_or_else(|| usual_speed(run));
        let mut stage = Self {
            renderer,
            small,
            title: scene.title.clone(),
            camera: camera(scene, view),
            ground: view.ground.map(|height| Ground { height }),
            speed: (!view.shows_fluid() && frame.drops.is_none()).then(speed),
            meshes,
            edges,
        };
        if let View::Framing(look) = stage.camera {
            let drawing = stage.drawing(framed(frame));
            let camera = stage.renderer.framing(&[drawing], look)?;
            stage.camera = View::From(camera);
        }
        Ok(stage)
    }

    /// The picture of a frame.
    pub fn draw(&self, mut frame: Drawing<'static>) -> Result<Picture> {
        share_ranges(std::slice::from_mut(&mut frame));
        self.renderer.render(&self.drawing(frame))
    }

    /// The frames next to each other, two per row.
    pub fn strip(&self, mut frames: Vec<Drawing<'static>>) -> Result<Picture> {
        share_ranges(&mut frames);
        let drawings = frames.into_iter().map(|frame| self.drawing(frame));
        self.small.strip(&drawings.collect::<Vec<_>>(), 2)
    }

    fn drawing<'a>(&'a self, frame: Drawing<'a>) -> Drawing<'a> {
        Drawing {
            meshes: &self.meshes,
            lines: self.edges.clone(),
            view: self.camera,
            ground: self.ground,
            scale_bar: true,
            title: self.title.clone(),
            colours: self.speed.map(|speed| Colours {
                label: "speed".into(),
                unit: "m/s".into(),
                range: Some([0.0, speed]),
            }),
            ..frame
        }
    }
}

/// The camera that a view gives, or a rule to place it.
fn camera(scene: &Scene, view: &scene::View) -> View {
    let up = DVec3::from(scene.up_of(view));
    let field_of_view = view.field_of_view.to_radians();
    match (view.from, view.to) {
        (Some(from), Some(to)) => View::From(Camera {
            from: from.into(),
            to: to.into(),
            up,
            field_of_view,
        }),
        _ => View::Framing(Look {
            direction: view
                .direction
                .unwrap_or(scene::View::USUAL_DIRECTION)
                .into(),
            up,
            field_of_view,
        }),
    }
}

/// The content of the first frame by which the camera is placed; independent of the step at which a run begins.
fn framed(frame: &Drawing<'static>) -> Drawing<'static> {
    let mut seen = frame.clone();
    let fluid = seen.traces.is_some() || seen.drops.is_some() || !seen.planes.is_empty();
    // A large ground would push the camera away from what moves on it.
    if fluid || seen.instances.iter().any(|body| !body.fixed) {
        seen.instances.retain(|body| !body.fixed);
    }
    // The edges of the domain enclose all water.
    if let Some(drops) = &mut seen.drops {
        drops.drops.clear();
    }
    if let Some(traces) = &mut seen.traces {
        traces.lines.clear();
    }
    for colours in colours(&mut seen) {
        // Makes colour bars of about the usual width.
        colours.range.get_or_insert([0.0, 1.0]);
    }
    seen
}

/// A mesh for each part of each different shape.
fn meshes(run: &SceneRun) -> Vec<Mesh> {
    let mut made = Vec::new();
    each_shape(run.blocks(), |shape| {
        made.extend(shape.parts().iter().map(|part| match &part.form {
            Form::Convex(block) => Mesh::of(block),
            Form::Sphere { radius } => Mesh::sphere(*radius, CUTS),
        }));
    });
    made
}

/// The edges of a box.
fn edges(domain: &Domain) -> Vec<Line> {
    let ends = [domain.origin, domain.end()];
    // Corner n has the upper coordinate along the axes whose bits are set.
    let corner = |n: usize| DVec3::from_array([0, 1, 2].map(|axis| ends[n >> axis & 1][axis]));
    let pairs = (0..8).flat_map(|n| [0, 1, 2].map(|axis| (n, n | 1 << axis)));
    pairs
        .filter(|(from, to)| from != to)
        .map(|(from, to)| Line {
            ends: [corner(from), corner(to)],
            colour: EDGE.0,
            width: EDGE.1,
        })
        .collect()
}

/// √(2gL), where L is the largest extent of a moving block; without gravity, the largest present speed, m/s.
fn usual_speed(run: &SceneRun) -> f64 {
    let blocks = run.blocks().iter();
    let moving = blocks.filter(|block| block.motion != Motion::Fixed);
    let extent = moving
        .map(|block| 2.0 * block.shape.radius())
        .fold(0.0, f64::max);
    let gravity = DVec3::from(run.scene().rock.gravity).length();
    let speed = if gravity > 0.0 {
        (2.0 * gravity * extent).sqrt()
    } else {
        let poses = run.poses();
        let speeds = poses.iter().map(|pose| pose.velocity.length());
        speeds.fold(0.0, f64::max)
    };
    if speed > 0.0 { speed } else { 1.0 }
}
