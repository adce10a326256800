//! Drawings to pictures on a device.

use super::annotation::Layout;
use super::camera::{Camera, Look};
use super::drawing::{Drawing, View};
use super::geometry::{Geometry, List};
use super::light::{Light, Lights, MOST};
use super::picture::Picture;
use super::pipelines::{COLOUR, DEPTH, Pipelines, SAMPLES};
use super::uniforms::Uniforms;
use crate::gpu;
use bytemuck::Pod;
use glam::DVec3;
use riprap::readback::Readback;
use riprap::{Error, Result, wgpu};
use std::time::Duration;

/// Width and height of the texture with all shadow maps, where the device has that much.
const ATLAS: u32 = 4096;
/// A picture of 10⁵ blocks takes a CPU with two cores some seconds; this long, the device hangs.
const PATIENCE: Duration = Duration::from_secs(300);
/// Part of the view that a framing camera leaves free at each edge.
const MARGIN: f64 = 0.06;
/// Vertices up to which a framing camera looks at each, rather than at the ball around them.
const FEW_VERTICES: usize = 64;

/// Draws pictures of one size.
pub struct Renderer {
    device: wgpu::Device,
    queue: wgpu::Queue,
    size: [u32; 2],
    pipelines: Pipelines,
    atlas: wgpu::Texture,
    sampler: wgpu::Sampler,
}

impl Renderer {
    /// A renderer of pictures of `size` (width, height; pixels, title and colour bar included).
    ///
    /// # Errors
    /// [`Error::Limit`] if the device has no textures of that size, [`Error::Device`] if it refuses.
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

    /// The picture of a drawing, with title, colour bar and scale bar as it says.
    ///
    /// # Errors
    /// What in the drawing is not finite or refers to nothing, and what the device cannot do.
    pub fn render(&self, drawing: &Drawing<'_>) -> anyhow::Result<Picture> {
        let layout = Layout::new(drawing, self.size)?;
        let (camera, view) = self.view(drawing, layout.view_size())?;
        layout.finish(drawing, &camera, &view)
    }

    /// The camera that sees the bodies of all `drawings`, such as the frames of an animation.
    ///
    /// # Errors
    /// Those of [`Self::render`].
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

    /// What a camera sees, without annotations.
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
        let (palette, [low, high]) = drawing.palette()?;
        let value_colour = |value| {
            let colour = palette.colour((value - low) / (high - low));
            [colour.0, colour.1, colour.2]
        };
        let pixels_per_metre = |place: DVec3| {
            let depth = axes.forward.dot(place - camera.from).abs();
            camera.pixels_per_metre(size[1].into()) * camera.distance() / depth
        };
        let geometry = Geometry::new(drawing, camera.to, value_colour, pixels_per_metre);
        let zenith = camera.up.normalize();
        let level = axes.right.cross(zenith);
        // Over the spectator's left shoulder.
        let shoulder = 1.0 * zenith - 0.85 * axes.right + 0.35 * level;
        let sun = drawing.sun.unwrap_or(shoulder).normalize();
        let bounds = geometry.bounds.unwrap_or([DVec3::ZERO; 2]);
        let texels = self.atlas.width();
        let triangles = geometry.solid.triangles();
        let on_cpu = gpu::is_software(&self.device.adapter_info());
        let lights = Lights::new(sun, zenith, bounds, triangles, on_cpu, texels);
        let uniforms = Uniforms::new(drawing, &camera, &axes, size, bounds, sun, &lights);
        let (buffer, row) = guarded(&self.device, "a picture", || {
            self.submit(drawing, &geometry, &lights, &uniforms, size)
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

    /// Draws, and returns the buffer that will hold the pixels and the bytes of a row in it.
    fn submit(
        &self,
        drawing: &Drawing<'_>,
        geometry: &Geometry,
        lights: &Lights,
        uniforms: &Uniforms,
        size: [u32; 2],
    ) -> Result<(wgpu::Buffer, u32)> {
        let device = &self.device;
        let placements = self.buffer(&geometry.placements, wgpu::BufferUsages::VERTEX)?;
        let solid = self.upload(&geometry.solid)?;
        let plain = self.upload(&geometry.plain)?;
        let strokes = self.upload(&geometry.strokes)?;
        let mut encoder = device.create_command_encoder(&Default::default());
        if let Some(solid) = &solid {
            self.shadows(&mut encoder, lights, |pass| {
                pass.set_vertex_buffer(1, placements.slice(..));
                solid.draw(pass);
            })?;
        }
        let bound = self.bind(uniforms, lights)?;
        let colour = texture(device, "colour", size, COLOUR, SAMPLES);
        let depth = texture(device, "depth", size, DEPTH, SAMPLES);
        let resolved = texture(device, "picture", size, COLOUR, 1);
        let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
        let (colour, depth, resolve) = (view(&colour), view(&depth), view(&resolved));
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("picture"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &colour,
                depth_slice: None,
                resolve_target: Some(&resolve),
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::WHITE),
                    store: wgpu::StoreOp::Discard,
                },
            })],
            depth_stencil_attachment: Some(depth_attachment(&depth, 0.0, wgpu::StoreOp::Discard)),
            ..Default::default()
        });
        pass.set_bind_group(0, &bound, &[]);
        pass.set_pipeline(&self.pipelines.background);
        pass.draw(0..3, 0..1);
        pass.set_vertex_buffer(1, placements.slice(..));
        // Depth first, so that light is computed once a pixel.
        for pipeline in [&self.pipelines.depth, &self.pipelines.body] {
            pass.set_pipeline(pipeline);
            for list in solid.iter().chain(&plain) {
                list.draw(&mut pass);
            }
        }
        pass.set_pipeline(&self.pipelines.stroke);
        if let Some(list) = &strokes {
            list.draw(&mut pass);
        }
        if drawing.ground.is_some() && uniforms.above_ground() {
            pass.set_pipeline(&self.pipelines.ground);
            pass.draw(0..4, 0..1);
        }
        drop(pass);
        let row = (4 * size[0]).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let pixels = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("pixels"),
            size: u64::from(row) * u64::from(size[1]),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        encoder.copy_texture_to_buffer(
            resolved.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &pixels,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(row),
                    rows_per_image: Some(size[1]),
                },
            },
            resolved.size(),
        );
        self.queue.submit([encoder.finish()]);
        Ok((pixels, row))
    }

    /// Draws what each light sees.
    fn shadows(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        lights: &Lights,
        draw: impl Fn(&mut wgpu::RenderPass<'_>),
    ) -> Result<()> {
        let stride = self.device.limits().min_uniform_buffer_offset_alignment as usize;
        let stride = size_of::<Light>().next_multiple_of(stride);
        let mut bytes = vec![0_u8; stride * lights.lights.len()];
        for (slot, light) in bytes.chunks_mut(stride).zip(&lights.lights) {
            slot[..size_of::<Light>()].copy_from_slice(bytemuck::bytes_of(light));
        }
        let table = self.buffer(&bytes, wgpu::BufferUsages::UNIFORM)?;
        let bound = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("light"),
            layout: &self.pipelines.light_layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                    buffer: &table,
                    offset: 0,
                    size: wgpu::BufferSize::new(size_of::<Light>() as u64),
                }),
            }],
        });
        let atlas = self.atlas.create_view(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadows"),
            depth_stencil_attachment: Some(depth_attachment(&atlas, 1.0, wgpu::StoreOp::Store)),
            ..Default::default()
        });
        pass.set_pipeline(&self.pipelines.shadow);
        for (index, tile) in lights.tiles.iter().enumerate() {
            let [x, y, size] = tile.map(|texels| texels as f32);
            pass.set_viewport(x, y, size, size, 0.0, 1.0);
            pass.set_scissor_rect(tile[0], tile[1], tile[2], tile[2]);
            pass.set_bind_group(0, &bound, &[(index * stride) as u32]);
            draw(&mut pass);
        }
        Ok(())
    }

    fn bind(&self, uniforms: &Uniforms, lights: &Lights) -> Result<wgpu::BindGroup> {
        let view = self.buffer(&[*uniforms], wgpu::BufferUsages::UNIFORM)?;
        let mut table = lights.lights.clone();
        table.resize(MOST, bytemuck::Zeroable::zeroed());
        let table = self.buffer(&table, wgpu::BufferUsages::UNIFORM)?;
        let atlas = self.atlas.create_view(&Default::default());
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        Ok(self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("view"),
            layout: &self.pipelines.view_layout,
            entries: &[
                entry(0, view.as_entire_binding()),
                entry(1, table.as_entire_binding()),
                entry(2, wgpu::BindingResource::TextureView(&atlas)),
                entry(3, wgpu::BindingResource::Sampler(&self.sampler)),
            ],
        }))
    }

    fn upload<'a, V: Pod>(&self, list: &'a List<V>) -> Result<Option<Uploaded<'a, V>>> {
        if list.batches.is_empty() {
            return Ok(None);
        }
        Ok(Some(Uploaded {
            vertices: self.buffer(&list.vertices, wgpu::BufferUsages::VERTEX)?,
            indices: self.buffer(&list.indices, wgpu::BufferUsages::INDEX)?,
            list,
        }))
    }

    fn buffer<T: Pod>(&self, values: &[T], usage: wgpu::BufferUsages) -> Result<wgpu::Buffer> {
        let bytes: &[u8] = bytemuck::cast_slice(values);
        let most = self.device.limits().max_buffer_size;
        if bytes.len() as u64 > most {
            return Err(Error::Limit {
                name: "bytes of a picture's shapes".into(),
                wants: bytes.len() as u64,
                has: most,
                remedy: "draw fewer blocks, or blocks that share their meshes".into(),
            });
        }
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("picture"),
            size: bytes.len() as u64,
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.queue.write_buffer(&buffer, 0, bytes);
        Ok(buffer)
    }
}

/// A list on the device.
struct Uploaded<'a, V> {
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    list: &'a List<V>,
}

impl<V> Uploaded<'_, V> {
    fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        for batch in &self.list.batches {
            pass.draw_indexed(batch.indices.clone(), 0, batch.placements.clone());
        }
    }
}

/// Balls that hold all bodies.
fn balls<'a>(drawing: &'a Drawing<'_>) -> impl Iterator<Item = (DVec3, f64)> + 'a {
    let radii: Vec<f64> = drawing.meshes.iter().map(|mesh| mesh.radius()).collect();
    drawing.instances.iter().flat_map(move |body| {
        let vertices = &drawing.meshes[body.mesh].vertices;
        let stretch = [0, 1, 2].map(|axis| body.deformation.col(axis).length());
        let radius = radii[body.mesh] * stretch.into_iter().fold(0.0, f64::max);
        let few = vertices.len() <= FEW_VERTICES;
        let whole = (!few).then_some((body.centre, radius));
        let each = vertices.iter().take(if few { vertices.len() } else { 0 });
        let each = each.map(|v| (body.centre + body.deformation * v.position, 0.0));
        whole.into_iter().chain(each)
    })
}

/// What `make` makes, unless the device refuses.
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

fn texture(
    device: &wgpu::Device,
    label: &str,
    [width, height]: [u32; 2],
    format: wgpu::TextureFormat,
    sample_count: u32,
) -> wgpu::Texture {
    let also = match (format, sample_count) {
        (DEPTH, 1) => wgpu::TextureUsages::TEXTURE_BINDING,
        (_, 1) => wgpu::TextureUsages::COPY_SRC,
        _ => wgpu::TextureUsages::empty(),
    };
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d {
            width,
            height,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | also,
        view_formats: &[],
    })
}

fn depth_attachment(
    view: &wgpu::TextureView,
    clear: f32,
    store: wgpu::StoreOp,
) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations {
            load: wgpu::LoadOp::Clear(clear),
            store,
        }),
        stencil_ops: None,
    }
}
