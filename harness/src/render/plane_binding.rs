//! A plane through a fluid on the device.

use super::drawing::Drawing;
use super::fluid_plane::FluidPlane;
use super::pipelines::COLOUR;
use super::renderer::Renderer;
use super::scales::Scales;
use super::texels::{Level, levels};
use crate::picture::colour_bar::ColourBar;
use bytemuck::{Pod, Zeroable};
use glam::DVec3;
use riprap::{Error, Result, wgpu};

/// As in plane.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct Rectangle {
    corner: [f32; 4],
    along: [f32; 4],
    upwards: [f32; 4],
}

impl Rectangle {
    /// Relative to `target` (m).
    fn new(plane: &FluidPlane, target: DVec3) -> Self {
        let [corner, along, upwards] = plane.rectangle();
        let four = |v: DVec3, w: f64| [v.x, v.y, v.z, w].map(|value| value as f32);
        let [columns, rows] = plane.cells.map(|count| count as f64);
        Self {
            corner: four(corner - target, 0.0),
            along: four(along, columns),
            upwards: four(upwards, rows),
        }
    }
}

impl Renderer {
    /// What is bound to draw each plane of a drawing relative to `target` (m).
    pub(super) fn bind_planes(
        &self,
        drawing: &Drawing<'_>,
        scales: &Scales,
        target: DVec3,
    ) -> Result<Vec<wgpu::BindGroup>> {
        let planes = drawing.planes.iter().zip(&scales.planes);
        planes
            .map(|(plane, bar)| self.bind_plane(plane, bar, target))
            .collect()
    }

    fn bind_plane(
        &self,
        plane: &FluidPlane,
        bar: &ColourBar,
        target: DVec3,
    ) -> Result<wgpu::BindGroup> {
        let most = self.device.limits().max_texture_dimension_2d;
        let largest = plane.cells[0].max(plane.cells[1]) as u64;
        if largest > u64::from(most) {
            return Err(Error::Limit {
                name: "cells along a plane through the fluid".into(),
                wants: largest,
                has: most.into(),
                remedy: "give a plane of larger cells".into(),
            });
        }
        let rectangle = Rectangle::new(plane, target);
        let rectangle = self.buffer(&[rectangle], wgpu::BufferUsages::UNIFORM)?;
        let cells = self.cells(&levels(plane, bar));
        let sampler = self.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("plane"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            ..Default::default()
        });
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        Ok(self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("plane"),
            layout: &self.pipelines.plane_layout,
            entries: &[
                entry(0, rectangle.as_entire_binding()),
                entry(1, wgpu::BindingResource::TextureView(&cells)),
                entry(2, wgpu::BindingResource::Sampler(&sampler)),
            ],
        }))
    }

    /// The texture of a plane's cells.
    fn cells(&self, levels: &[Level]) -> wgpu::TextureView {
        let [width, height] = levels.first().map_or([1; 2], |level| level.size);
        let texture = self.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("plane"),
            size: extent([width, height]),
            mip_level_count: levels.len() as u32,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: COLOUR,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        for (mip_level, level) in (0..).zip(levels) {
            self.queue.write_texture(
                wgpu::TexelCopyTextureInfo {
                    mip_level,
                    ..texture.as_image_copy()
                },
                &level.rgba,
                wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(4 * level.size[0]),
                    rows_per_image: None,
                },
                extent(level.size),
            );
        }
        texture.create_view(&Default::default())
    }
}

fn extent([width, height]: [u32; 2]) -> wgpu::Extent3d {
    wgpu::Extent3d {
        width,
        height,
        depth_or_array_layers: 1,
    }
}
