//! The commands that draw a picture.

use super::drawing::Drawing;
use super::geometry::{Geometry, List};
use super::light::{Light, Lights, MOST};
use super::pipelines::{COLOUR, DEPTH, SAMPLES};
use super::renderer::Renderer;
use super::uniforms::Uniforms;
use bytemuck::Pod;
use riprap::{Error, Result, wgpu};

impl Renderer {
    /// Draws with the bind groups `planes` of the drawing's planes; returns the buffer for the pixels and its bytes per row.
    pub(super) fn submit(
        &self,
        drawing: &Drawing<'_>,
        geometry: &Geometry,
        lights: &Lights,
        uniforms: &Uniforms,
        planes: &[wgpu::BindGroup],
        size: [u32; 2],
    ) -> Result<(wgpu::Buffer, u32)> {
        let device = &self.device;
        let placements = self.buffer(&geometry.placements, wgpu::BufferUsages::VERTEX)?;
        let solid = self.upload(&geometry.solid)?;
        let strokes = self.upload(&geometry.strokes)?;
        let dots = match geometry.dots.is_empty() {
            true => None,
            false => Some(self.buffer(&geometry.dots, wgpu::BufferUsages::VERTEX)?),
        };
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
        // Depth first, so that light is computed once per pixel.
        for pipeline in [&self.pipelines.depth, &self.pipelines.body] {
            pass.set_pipeline(pipeline);
            if let Some(solid) = &solid {
                solid.draw(&mut pass);
            }
        }
        if let Some(dots) = &dots {
            pass.set_pipeline(&self.pipelines.drop);
            pass.set_vertex_buffer(0, dots.slice(..));
            pass.draw(0..4, 0..geometry.dots.len() as u32);
        }
        pass.set_pipeline(&self.pipelines.plane);
        for plane in planes {
            pass.set_bind_group(1, plane, &[]);
            pass.draw(0..4, 0..1);
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

    /// Draws the shadow map of each light.
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
        let one = wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer: &table,
            offset: 0,
            size: wgpu::BufferSize::new(size_of::<Light>() as u64),
        });
        let bound = self.bind_group("light", &self.pipelines.light_layout, &[one]);
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
        let resources = [
            view.as_entire_binding(),
            table.as_entire_binding(),
            wgpu::BindingResource::TextureView(&atlas),
            wgpu::BindingResource::Sampler(&self.sampler),
        ];
        Ok(self.bind_group("view", &self.pipelines.view_layout, &resources))
    }

    /// The bind group with the bindings 0, 1, … of a layout.
    pub(super) fn bind_group(
        &self,
        label: &str,
        layout: &wgpu::BindGroupLayout,
        resources: &[wgpu::BindingResource<'_>],
    ) -> wgpu::BindGroup {
        let entries = (0..).zip(resources.iter().cloned());
        let entries = entries.map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource });
        self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(label),
            layout,
            entries: &entries.collect::<Vec<_>>(),
        })
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

    pub(super) fn buffer<T: Pod>(
        &self,
        values: &[T],
        usage: wgpu::BufferUsages,
    ) -> Result<wgpu::Buffer> {
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

pub fn texture(
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
