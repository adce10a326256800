//! Pictures of blocks and of a fluid around them in space, drawn by a device without a window: [`Drawing`] → [`Renderer`] →
//! [`Picture`], single, as a strip of frames or as an [animation](animate).
//!
//! ```no_run
//! use riprap::{geometry::Polyhedron, wgpu};
//! use riprap_harness::{gpu, render::{Drawing, Instance, Mesh, Renderer}};
//! use glam::{DMat3, DVec3};
//!
//! fn draw(block: &Polyhedron) -> anyhow::Result<()> {
//!     let adapter = gpu::pick(None)?;
//!     let (device, queue) = gpu::open(&adapter, wgpu::Features::empty(), Default::default())?;
//!     let meshes = [Mesh::of(block)];
//!     let body = Instance {
//!         mesh: 0,
//!         centre: DVec3::ZERO,
//!         deformation: DMat3::IDENTITY,
//!         value: None,
//!         fixed: false,
//!     };
//!     let drawing = Drawing { meshes: &meshes, instances: vec![body], ..Drawing::default() };
//!     let renderer = Renderer::new(&device, &queue, [1280, 960])?;
//!     renderer.render(&drawing)?.save("block.png".as_ref())
//! }
//! ```

mod annotation;
mod camera;
mod drawing;
mod drops;
mod fluid_plane;
mod geometry;
mod light;
mod mesh;
mod picture;
mod pipelines;
mod plane_binding;
mod renderer;
mod scales;
mod strokes;
mod submission;
mod uniforms;

pub use camera::{Camera, Look};
pub use drawing::{Background, Colours, Drawing, Ground, Instance, Line, Traces, View};
pub use drops::{Drop, Drops};
pub use fluid_plane::FluidPlane;
pub use mesh::{Mesh, Vertex};
pub use picture::{Picture, animate};
pub use pipelines::SHADERS;
pub use renderer::Renderer;
