//! A plane through a fluid on the device: its cells as the texels of a texture, and successively coarser copies (mip levels)
//! for planes that are far away.

use super::drawing::Drawing;
use super::fluid_plane::FluidPlane;
use super::pipelines::COLOUR;
use super::renderer::Renderer;
use super::scales::Scales;
use crate::picture::colour::{linear_of_srgb, srgb_of_linear};
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
    /// The bind group of each plane of a drawing, relative to `target` (m).
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
        let resources = [
            rectangle.as_entire_binding(),
            wgpu::BindingResource::TextureView(&cells),
            wgpu::BindingResource::Sampler(&sampler),
        ];
        Ok(self.bind_group("plane", &self.pipelines.plane_layout, &resources))
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

/// A mip level.
struct Level {
    /// Texels along both axes.
    size: [u32; 2],
    /// Red, green and blue (sRGB), which are 0 for cells without fluid, and the fraction of fluid.
    rgba: Vec<u8>,
}

/// All mip levels, from the cells themselves to one texel.
fn levels(plane: &FluidPlane, bar: &ColourBar) -> Vec<Level> {
    let texel = |value: &f32| match value.is_nan() {
        true => [0; 4],
        false => {
            let colour = bar.colour(f64::from(*value));
            [colour.0, colour.1, colour.2, u8::MAX]
        }
    };
    let rgba: Vec<u8> = plane.values.iter().flat_map(texel).collect();
    let size = plane.cells.map(|count| count as u32);
    let mut made = vec![Level { size, rgba }];
    while let Some(coarser) = made.last().and_then(coarser) {
        made.push(coarser);
    }
    made
}

/// Half as many texels along both axes, each the mean in linear light of those that it covers.
fn coarser(fine: &Level) -> Option<Level> {
    let size = fine.size.map(|count| (count / 2).max(1));
    if size == fine.size {
        return None;
    }
    let linear: [f64; 256] = std::array::from_fn(|channel| linear_of_srgb(channel as u8));
    // If a count is odd, one of the texels covers three.
    let covered = |along: usize, at: u32| {
        let place = |edge: u32| u64::from(edge) * u64::from(fine.size[along]);
        let whole = u64::from(size[along]);
        (place(at) / whole) as usize..place(at + 1).div_ceil(whole) as usize
    };
    let mut rgba = Vec::with_capacity(4 * (size[0] * size[1]) as usize);
    for v in 0..size[1] {
        for u in 0..size[0] {
            let mut sum = [0.0; 4];
            let mut count = 0.0;
            for row in covered(1, v) {
                for column in covered(0, u) {
                    let at = 4 * (row * fine.size[0] as usize + column);
                    for channel in 0..3 {
                        sum[channel] += linear[usize::from(fine.rgba[at + channel])];
                    }
                    sum[3] += f64::from(fine.rgba[at + 3]);
                    count += 1.0;
                }
            }
            rgba.extend([0, 1, 2].map(|channel| srgb_of_linear(sum[channel] / count)));
            rgba.push((sum[3] / count).round() as u8);
        }
    }
    Some(Level { size, rgba })
}
