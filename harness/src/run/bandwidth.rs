//! What memory allows: bytes a cell, and how fast the device copies.

use crate::gpu;
use riprap::{
    Result,
    lattice::{Force, Setup, bytes_a_population},
    wgpu,
};
use std::time::{Duration, Instant};

/// Copies, of which the fastest counts.
const REPEATS: usize = 4;
/// More than caches hold, and less than any adapter has.
const BYTES: u64 = 128 << 20;

/// Bytes read and written a second when the device copies a buffer.
pub fn copy_bandwidth(device: &wgpu::Device, queue: &wgpu::Queue) -> Result<f64> {
    let bytes = BYTES.min(device.limits().max_buffer_size);
    let [from, to] = ["from", "to"].map(|label| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: bytes,
            usage: wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    });
    let mut best = f64::INFINITY;
    for _ in 0..REPEATS {
        let mut encoder = device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(&from, 0, &to, 0, bytes);
        let start = Instant::now();
        queue.submit([encoder.finish()]);
        let (send, receive) = std::sync::mpsc::channel();
        queue.on_submitted_work_done(move || {
            // The receiver is gone only after a time-out.
            let _ = send.send(());
        });
        let done = std::future::poll_fn(|_| match receive.try_recv() {
            Ok(()) => std::task::Poll::Ready(()),
            Err(_) => std::task::Poll::Pending,
        });
        gpu::drive(device, Duration::from_secs(60), "a copy", done)?;
        best = best.min(start.elapsed().as_secs_f64());
    }
    Ok(2.0 * bytes as f64 / best)
}

/// Bytes that a step reads and writes for a fluid cell: the 27 populations, the velocities for the
/// eddy viscosity, the body force of the cell.
pub fn bytes_a_cell(setup: &Setup) -> u64 {
    const VECTOR: u64 = 12;
    let populations = 2 * 27 * bytes_a_population(setup.storage);
    let velocity = setup.wale.map_or(0, |_| 2 * VECTOR);
    let force = match setup.force {
        Force::Field(_) => VECTOR,
        Force::None | Force::Constant(_) => 0,
    };
    populations + velocity + force
}
