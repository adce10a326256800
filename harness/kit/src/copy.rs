//! The copy bandwidth of an adapter: the fastest of four methods.

use super::{clock::Clock, subject::Subject};
use riprap::{
    Error,
    gpu::{
        kernel::{Kernel, largest_binding},
        link::Program,
    },
    wgpu,
};
use std::time::{Duration, Instant};

/// A method of copying.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// `copy_buffer_to_buffer`.
    Buffer,
    /// A kernel of `KERNELS`.
    Kernel(usize),
}

/// Entry points and sources of the copy kernels, and the bytes that a workgroup of each copies.
const KERNELS: [(&str, &str, u64); 3] = [
    (
        "copy_scalar",
        include_str!("kernels/copy_scalar.wgsl"),
        64 * 4,
    ),
    (
        "copy_vector",
        include_str!("kernels/copy_vector.wgsl"),
        64 * 16,
    ),
    (
        "copy_four_vectors",
        include_str!("kernels/copy_four_vectors.wgsl"),
        256 * 16,
    ),
];

/// All methods, first those that are fastest on most adapters.
pub const METHODS: [Method; 4] = [
    Method::Buffer,
    Method::Kernel(1),
    Method::Kernel(2),
    Method::Kernel(0),
];

/// Source and target memory, in pieces that fit a binding.
pub struct Copy {
    pieces: Vec<Piece>,
    kernels: Vec<Kernel>,
    bytes: u64,
}

struct Piece {
    original: wgpu::Buffer,
    duplicate: wgpu::Buffer,
    binds: Vec<wgpu::BindGroup>,
}

impl Copy {
    /// At least `bytes` for source and target each.
    pub fn new(device: &wgpu::Device, bytes: u64) -> Result<Self, Error> {
        let largest = largest_binding(&device.limits());
        // Whole workgroups of every kernel.
        let unit = KERNELS[2].2;
        let count = bytes.div_ceil(largest - largest % unit).max(1);
        let size = bytes.div_ceil(count).next_multiple_of(unit);
        let kernels = KERNELS
            .iter()
            .map(|(entry, text, _)| {
                let linked = Program::new(entry).text(entry, *text).link()?;
                Kernel::new(device, &linked, entry, &[])
            })
            .collect::<Result<Vec<_>, _>>()?;
        let buffer = |label| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage: wgpu::BufferUsages::STORAGE
                    | wgpu::BufferUsages::COPY_SRC
                    | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let piece = |_| {
            let (original, duplicate) = (buffer("original"), buffer("duplicate"));
            let named = [("original", &original), ("duplicate", &duplicate)];
            let binds = kernels.iter().map(|kernel| kernel.bind(device, &named));
            let binds = binds.collect::<Result<Vec<_>, _>>()?;
            Ok(Piece {
                original,
                duplicate,
                binds,
            })
        };
        let pieces = (0..count).map(piece).collect::<Result<Vec<_>, Error>>()?;
        Ok(Self {
            pieces,
            kernels,
            bytes: count * size,
        })
    }

    /// Bytes read and written by a copy.
    pub fn traffic(&self) -> f64 {
        2.0 * self.bytes as f64
    }

    /// Records a copy by `copy_buffer_to_buffer`.
    pub fn record_buffers(&self, encoder: &mut wgpu::CommandEncoder) {
        for piece in &self.pieces {
            encoder.copy_buffer_to_buffer(&piece.original, 0, &piece.duplicate, 0, None);
        }
    }

    /// Records a copy by a kernel.
    pub fn record(&self, method: Method, pass: &mut wgpu::ComputePass<'_>) {
        let Method::Kernel(n) = method else { return };
        for piece in &self.pieces {
            let groups = piece.original.size().div_ceil(KERNELS[n].2) as u32;
            self.kernels[n].record(pass, &piece.binds[n], groups);
        }
    }
}

/// Bytes that the device reads and writes per second when copying by the fastest method: over `bytes`, or as many as a
/// quarter of a second allows.
pub fn copy_bandwidth(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    bytes: u64,
) -> Result<f64, Error> {
    // Copying 16 MiB takes a CPU some milliseconds. A GPU that takes less than one may hold them in its cache, and gets
    // 256 MiB.
    const CPU: u64 = 16 << 20;
    const GPU: u64 = 256 << 20;
    const TIME: Duration = Duration::from_millis(250);
    let start = Instant::now();
    let mut clock = Clock::new(device, queue, false);
    let mut best: f64 = 0.0;
    for size in [bytes.min(CPU), bytes.min(GPU)] {
        let copy = Copy::new(device, size)?;
        // The first repetition clears memory, the first one of each kernel compiles it.
        clock.run(&mut Subject::Copying(&copy, Method::Buffer), 1)?;
        best = 0.0;
        for method in METHODS.repeat(3) {
            let spent = clock.run(&mut Subject::Copying(&copy, method), 1)?;
            best = best.max(copy.traffic() / spent.basis);
            if start.elapsed() > TIME {
                return Ok(best);
            }
        }
        if copy.traffic() / best > 1e-3 {
            break;
        }
    }
    Ok(best)
}
