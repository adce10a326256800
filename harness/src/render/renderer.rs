//! Renders drawings to pictures on a device.

use super::annotation::Layout;
use super::camera::{Camera, Look};
use super::drawing::{Drawing, View};
use super::geometry::Geometry;
use super::light::Lights;
use super::picture::Picture;
use super::pipelines::{DEPTH, Pipelines};
use super::scales::Scales;
use super::submission::texture;
use super::uniforms::Uniforms;
use crate::gpu;
use glam::DVec3;
use riprap::gpu::readback::Readback;
use riprap::{Error, Result, wgpu};
use std::time::Duration;

/// Width and height of the texture with all shadow maps, if the device supports it.
const ATLAS: u32 = 4096;
/// Timeout of a wait: a picture of 10⁵ blocks takes a CPU with two cores some seconds.
const PATIENCE: Duration = Duration::from_secs(300);
/// Margin that a framing camera leaves at each edge, relative to the view.
const MARGIN: f64 = 0.06;
/// Number of vertices up to which a framing camera considers each of them, rather than the ball around them.
const FEW_VERTICES: usize = 64;

/// Draws pictures of one size.
pub struct Renderer {
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    size: [u32; 2],
    pub(super) pipelines: Pipelines,
    /// Shadow maps.
    pub(super) atlas: wgpu::Texture,
    pub(super) sampler: wgpu::Sampler,
}

impl Renderer {
    /// A renderer of pictures of `size` (width, height; pixels, title and colour bar included).
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue, size: [u32; 2]) -> Result<Self> {
        let most = device.limits().max_texture_dimension_2d;
        let [least, largest] = [size[0].min(size[1]), size[0].max(size[1])];
        if least == 0 || largest > most {
            return Err(Error::Limit {
                name: "width and height of a picture, pixels".into(),
                wants: largest.into(),
                has: most.into(),
                remedy: format!("give a width and a height from 1 to {most} pixels"),
            });
        }
        let (pipelines, atlas) = guarded(device, "a picture's pipelines", || {
            let atlas = texture(device, "shadows", [ATLAS.min(most); 2], DEPTH, 1);
            (Pipelines::new(device), atlas)
        })?;
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("shadows"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            compare: Some(wgpu::CompareFunction::LessEqual),
            ..Default::default()
        });
        Ok(Self {
            device: device.clone(),
            queue: queue.clone(),
            size,
            pipelines,
            atlas,
            sampler,
        })
    }

    /// The picture of a drawing, with its title, colour bars and scale bar.
    pub fn render(&self, drawing: &Drawing<'_>) -> anyhow::Result<Picture> {
        let layout = Layout::new(drawing, self.size)?;
        let (camera, view) = self.view(drawing, layout.view_size())?;
        layout.finish(drawing, &camera, &view)
    }

    /// The camera that has everything in all `drawings`, such as the frames of an animation, in view.
    pub fn framing(&self, drawings: &[Drawing<'_>], look: Look) -> anyhow::Result<Camera> {
        let mut aspect = f64::INFINITY;
        for drawing in drawings {
            drawing.check()?;
            let [width, height] = Layout::new(drawing, self.size)?.view_size();
            aspect = aspect.min(f64::from(width) / f64::from(height));
        }
        let balls = drawings.iter().flat_map(balls);
        Ok(look.framing(balls, if aspect.is_finite() { aspect } else { 1.0 }, MARGIN)?)
    }

    /// Width and height of its pictures, pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The view of the camera, without annotations.
    pub(super) fn view(&self, drawing: &Drawing<'_>, size: [u32; 2]) -> Result<(Camera, Picture)> {
        drawing.check()?;
        let camera = match drawing.view {
            View::From(camera) => camera,
            View::Framing(look) => {
                let aspect = f64::from(size[0]) / f64::from(size[1]);
                look.framing(balls(drawing), aspect, MARGIN)?
            }
        };
        let axes = camera.axes()?;
        let scales = Scales::of(drawing)?;
        let pixels_per_metre = |place: DVec3| {
            let depth = axes.forward.dot(place - camera.from).abs();
            camera.pixels_per_metre(size[1].into()) * camera.distance() / depth
        };
        let geometry = Geometry::new(drawing, camera.to, &scales, pixels_per_metre);
        let zenith = camera.up.normalize();
        let level = axes.right.cross(zenith);
        // Over the viewer's left shoulder.
        let shoulder = 1.0 * zenith - 0.85 * axes.right + 0.35 * level;
        let sun = drawing.sun.unwrap_or(shoulder).normalize();
        let bounds = geometry.bounds.unwrap_or([DVec3::ZERO; 2]);
        let texels = self.atlas.width();
        let triangles = geometry.solid.triangles();
        let on_cpu = gpu::is_software(&self.device.adapter_info());
        let lights = Lights::new(sun, zenith, bounds, triangles, on_cpu, texels);
        let uniforms = Uniforms::new(drawing, &camera, &axes, size, bounds, sun, &lights);
        let (buffer, row) = guarded(&self.device, "a picture", || {
            let planes = self.bind_planes(drawing, &scales, camera.to)?;
            self.submit(drawing, &geometry, &lights, &uniforms, &planes, size)
        })??;
        let count = buffer.size() as usize;
        let mut readback = Readback::default();
        let read = readback.read::<u8>(&self.device, &self.queue, &buffer, count);
        let bytes = gpu::drive(&self.device, PATIENCE, "a picture", read)??;
        let used = 4 * size[0] as usize;
        let rows = bytes.chunks(row as usize);
        let rgba = rows.flat_map(|row| &row[..used]).copied().collect();
        let [width, height] = size;
        let picture = Picture {
            width,
            height,
            rgba,
        };
        Ok((camera, picture))
    }
}

/// Balls that enclose all bodies, planes and lines.
fn balls<'a>(drawing: &'a Drawing<'_>) -> impl Iterator<Item = (DVec3, f64)> + 'a {
    let radii: Vec<f64> = drawing.meshes.iter().map(|mesh| mesh.radius()).collect();
    let bodies = drawing.instances.iter().flat_map(move |body| {
        let vertices = &drawing.meshes[body.mesh].vertices;
        let stretch = [0, 1, 2].map(|axis| body.deformation.col(axis).length());
        let radius = radii[body.mesh] * stretch.into_iter().fold(0.0, f64::max);
        let few = vertices.len() <= FEW_VERTICES;
        let whole = (!few).then_some((body.centre, radius));
        let each = vertices.iter().take(if few { vertices.len() } else { 0 });
        let each = each.map(|v| (body.centre + body.deformation * v.position, 0.0));
        whole.into_iter().chain(each)
    });
    let corners = drawing.planes.iter().flat_map(|plane| plane.corners());
    let traces = drawing.traces.iter().flat_map(|traces| &traces.lines);
    let points = traces.flat_map(|trace| trace.points.iter().copied());
    let ends = drawing.lines.iter().flat_map(|line| line.ends);
    let drops = drawing.drops.iter().flat_map(|drops| &drops.drops);
    let points = points.chain(drops.map(|drop| drop.centre));
    bodies.chain(corners.chain(points).chain(ends).map(|point| (point, 0.0)))
}

/// The result of `make`, or the error that the device reports.
fn guarded<T>(device: &wgpu::Device, what: &str, make: impl FnOnce() -> T) -> Result<T> {
    let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let validity = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let made = make();
    let errors = async { validity.pop().await.or(memory.pop().await) };
    match gpu::drive(device, PATIENCE, what, errors)? {
        Some(error) => Err(Error::Device(format!("{what}: {error}"))),
        None => Ok(made),
    }
}
