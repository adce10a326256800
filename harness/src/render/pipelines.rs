//! The render pipelines of a picture.

use riprap::wgpu;
use std::mem::size_of;

use super::drops::Dot;
use super::geometry::{Corner, Placement};
use super::strokes::End;

/// Colours are blended and averaged in linear light, and stored as sRGB.
pub const COLOUR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
/// Depth of the view and of shadow maps.
pub const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Samples per pixel; the number that every device supports.
pub const SAMPLES: u32 = 4;

/// Prefixes a shader of the view with view.wgsl.
macro_rules! with_view {
    ($file:literal) => {
        concat!(include_str!("view.wgsl"), include_str!($file))
    };
}

/// Name and source of each shader.
pub const SHADERS: [(&str, &str); 7] = [
    ("background", with_view!("background.wgsl")),
    ("ground", with_view!("ground.wgsl")),
    ("body", with_view!("body.wgsl")),
    ("plane", with_view!("plane.wgsl")),
    ("stroke", with_view!("stroke.wgsl")),
    ("drop", with_view!("drop.wgsl")),
    ("shadow", include_str!("shadow.wgsl")),
];

/// Pipelines, and the layouts of their bind groups.
pub struct Pipelines {
    pub view_layout: wgpu::BindGroupLayout,
    pub light_layout: wgpu::BindGroupLayout,
    pub plane_layout: wgpu::BindGroupLayout,
    pub background: wgpu::RenderPipeline,
    pub ground: wgpu::RenderPipeline,
    pub depth: wgpu::RenderPipeline,
    pub body: wgpu::RenderPipeline,
    pub plane: wgpu::RenderPipeline,
    pub stroke: wgpu::RenderPipeline,
    pub drop: wgpu::RenderPipeline,
    pub shadow: wgpu::RenderPipeline,
}

const CORNER: [wgpu::VertexAttribute; 3] =
    wgpu::vertex_attr_array![0 => Float32x3, 1 => Snorm16x4, 2 => Unorm8x4];
const CORNER_PLACEMENT: [wgpu::VertexAttribute; 4] =
    wgpu::vertex_attr_array![3 => Float32x4, 4 => Float32x4, 5 => Float32x4, 6 => Unorm8x4];
const END: [wgpu::VertexAttribute; 5] = wgpu::vertex_attr_array![
    0 => Float32x3, 1 => Float32x3, 2 => Unorm8x4, 3 => Float32x2, 8 => Float32];
const END_PLACEMENT: [wgpu::VertexAttribute; 4] =
    wgpu::vertex_attr_array![4 => Float32x4, 5 => Float32x4, 6 => Float32x4, 7 => Unorm8x4];

const DOT: [wgpu::VertexAttribute; 2] = wgpu::vertex_attr_array![0 => Float32x4, 1 => Unorm8x4];

impl Pipelines {
    pub fn new(device: &wgpu::Device) -> Self {
        let (vertex, fragment) = (wgpu::ShaderStages::VERTEX, wgpu::ShaderStages::FRAGMENT);
        let compare = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison);
        let filter = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let colours = texture(wgpu::TextureSampleType::Float { filterable: true });
        let view = [
            (vertex | fragment, uniform(false)),
            (fragment, uniform(false)),
            (fragment, texture(wgpu::TextureSampleType::Depth)),
            (fragment, compare),
        ];
        let plane = [
            (vertex | fragment, uniform(false)),
            (fragment, colours),
            (fragment, filter),
        ];
        let view_layout = bindings(device, "view", &view);
        let light_layout = bindings(device, "light", &[(vertex, uniform(true))]);
        let plane_layout = bindings(device, "plane", &plane);
        let corners = [
            layout::<Corner>(wgpu::VertexStepMode::Vertex, &CORNER),
            layout::<Placement>(wgpu::VertexStepMode::Instance, &CORNER_PLACEMENT),
        ];
        let ends = [
            layout::<End>(wgpu::VertexStepMode::Vertex, &END),
            layout::<Placement>(wgpu::VertexStepMode::Instance, &END_PLACEMENT),
        ];
        let dots = [layout::<Dot>(wgpu::VertexStepMode::Instance, &DOT)];
        let make = |name, buffers: &[_], kind| {
            let bound = match kind {
                Kind::Shadow => &[Some(&light_layout)][..],
                Kind::Plane => &[Some(&view_layout), Some(&plane_layout)],
                _ => &[Some(&view_layout)],
            };
            pipeline(device, name, bound, buffers, kind)
        };
        Self {
            background: make("background", &[], Kind::Background),
            ground: make("ground", &[], Kind::Ground),
            depth: make("body", &corners, Kind::Depth),
            body: make("body", &corners, Kind::Shaded),
            plane: make("plane", &[], Kind::Plane),
            stroke: make("stroke", &ends, Kind::Stroke),
            drop: make("drop", &dots, Kind::Drop),
            shadow: make("shadow", &corners, Kind::Shadow),
            view_layout,
            light_layout,
            plane_layout,
        }
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Background,
    Ground,
    /// Writes only the depth.
    Depth,
    /// Shades the surfaces whose depth has been written.
    Shaded,
    /// Covers samples according to its opacity.
    Plane,
    Stroke,
    /// Has its own depth at each pixel, and covers samples according to its opacity.
    Drop,
    Shadow,
}

fn pipeline(
    device: &wgpu::Device,
    name: &str,
    bound: &[Option<&wgpu::BindGroupLayout>],
    buffers: &[Option<wgpu::VertexBufferLayout<'_>>],
    kind: Kind,
) -> wgpu::RenderPipeline {
    let text = SHADERS.iter().find(|(shader, _)| *shader == name);
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(name),
        source: wgpu::ShaderSource::Wgsl(text.map_or("", |(_, text)| text).into()),
    });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(name),
        bind_group_layouts: bound,
        immediate_size: 0,
    });
    let fragment = match kind {
        Kind::Depth => "depth_fragment",
        _ => &format!("{name}_fragment"),
    };
    let target = wgpu::ColorTargetState {
        format: COLOUR,
        blend: (kind == Kind::Ground).then_some(wgpu::BlendState::ALPHA_BLENDING),
        write_mask: match kind {
            Kind::Depth => wgpu::ColorWrites::empty(),
            // Opacity only selects samples.
            Kind::Plane | Kind::Drop => wgpu::ColorWrites::COLOR,
            _ => wgpu::ColorWrites::ALL,
        },
    };
    let (depth_compare, depth_write) = match kind {
        Kind::Background => (wgpu::CompareFunction::Always, false),
        // Drawn last, over what is farther away than the ground.
        Kind::Ground => (wgpu::CompareFunction::Greater, false),
        Kind::Depth | Kind::Plane | Kind::Stroke | Kind::Drop => {
            (wgpu::CompareFunction::Greater, true)
        }
        Kind::Shaded => (wgpu::CompareFunction::Equal, false),
        Kind::Shadow => (wgpu::CompareFunction::Less, true),
    };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(name),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(&format!("{name}_vertex")),
            compilation_options: Default::default(),
            buffers,
        },
        primitive: wgpu::PrimitiveState {
            topology: match kind {
                Kind::Ground | Kind::Plane | Kind::Drop => wgpu::PrimitiveTopology::TriangleStrip,
                _ => wgpu::PrimitiveTopology::TriangleList,
            },
            ..Default::default()
        },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(depth_write),
            depth_compare: Some(depth_compare),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: wgpu::MultisampleState {
            count: if kind == Kind::Shadow { 1 } else { SAMPLES },
            alpha_to_coverage_enabled: matches!(kind, Kind::Plane | Kind::Drop),
            ..Default::default()
        },
        fragment: (kind != Kind::Shadow).then_some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(fragment),
            compilation_options: Default::default(),
            targets: &[Some(target)],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// Layout of the bindings 0, 1, …, each with its shader stages.
fn bindings(
    device: &wgpu::Device,
    label: &str,
    types: &[(wgpu::ShaderStages, wgpu::BindingType)],
) -> wgpu::BindGroupLayout {
    let entries = (0..).zip(types);
    let entries = entries.map(|(binding, (visibility, ty))| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: *visibility,
        ty: *ty,
        count: None,
    });
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries: &entries.collect::<Vec<_>>(),
    })
}

fn uniform(has_dynamic_offset: bool) -> wgpu::BindingType {
    wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset,
        min_binding_size: None,
    }
}

fn texture(sample_type: wgpu::TextureSampleType) -> wgpu::BindingType {
    wgpu::BindingType::Texture {
        sample_type,
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    }
}

fn layout<T>(
    step_mode: wgpu::VertexStepMode,
    attributes: &[wgpu::VertexAttribute],
) -> Option<wgpu::VertexBufferLayout<'_>> {
    Some(wgpu::VertexBufferLayout {
        array_stride: size_of::<T>() as u64,
        step_mode,
        attributes,
    })
}
