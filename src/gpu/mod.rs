//! Infrastructure of the compute kernels: linking of WGSL files, pipelines, buffers, readback, timing, and the sorting
//! primitives that SPH and the broadphase share.
//!
//! [`link`] creates one shader from the files that a kernel needs, [`kernel`] creates its pipeline and binds buffers by name,
//! [`layout`] compares Rust structs with WGSL structs, [`readback`] reads buffers, and [`timer`] times passes on the device.
//!
//! ```
//! use riprap::{gpu::{kernel::{Kernel, submit_pass}, link::Program}, wgpu};
//!
//! # fn main() -> riprap::Result<()> {
//! // Any device; this one does nothing, so that the example runs everywhere.
//! let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
//! const DOUBLE: &str = "// Doubles each value.
//! @group(0) @binding(0) var<storage, read_write> values: array<f32>;
//!
//! @compute @workgroup_size(64)
//! fn double(@builtin(global_invocation_id) id: vec3<u32>) {
//!     if (id.x < arrayLength(&values)) {
//!         values[id.x] *= 2.0;
//!     }
//! }
//! ";
//! let linked = Program::new("double").text("double", DOUBLE).link()?;
//! let kernel = Kernel::new(&device, &linked, "double", &[])?;
//! let values = device.create_buffer(&wgpu::BufferDescriptor {
//!     label: Some("values"),
//!     size: 4 * 1000,
//!     usage: wgpu::BufferUsages::STORAGE,
//!     mapped_at_creation: false,
//! });
//! let bind = kernel.bind(&device, &[("values", &values)])?;
//! submit_pass(&device, &queue, |pass| kernel.record(pass, &bind, 1000u32.div_ceil(64)));
//! # Ok(())
//! # }
//! ```

pub mod bins;
pub(crate) mod buffers;
pub mod kernel;
pub mod layout;
pub mod link;
#[cfg(feature = "checkpoint")]
pub(crate) mod plain_bytes;
mod processor;
pub mod readback;
pub mod timer;

pub use processor::Processor;
