//! What is measured: a lattice that steps, one that only streams, or a copy.

use super::{
    arithmetic::Arithmetic,
    copy::{Copy, Method},
    stream_only::StreamOnly,
};
use riprap::{
    gpu::timer::{self, Timer},
    lattice::Lattice,
    wgpu,
};

/// Something that can be recorded over and over.
pub enum Subject<'a> {
    /// Steps of a fluid.
    Steps(Box<Lattice>),
    /// Steps without collision.
    Streaming(Box<StreamOnly>),
    /// Copies of a stretch of memory.
    Copying(&'a Copy, Method),
    /// Arithmetic and nothing else.
    Computing(&'a Arithmetic),
}

impl Subject<'_> {
    /// Records `turns`; says whether they are between timestamps.
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        timer: Option<&mut Timer>,
        turns: u32,
    ) -> bool {
        if let Self::Copying(copy, Method::Buffer) = self {
            (0..turns).for_each(|_| copy.record_buffers(encoder));
            return false;
        }
        let timed = timer.is_some();
        let mut pass = encoder.begin_compute_pass(&timer::pass(timer, "turns"));
        for _ in 0..turns {
            match self {
                Self::Steps(lattice) => lattice.record(&mut pass),
                Self::Streaming(lattice) => lattice.record(&mut pass),
                Self::Copying(copy, method) => copy.record(*method, &mut pass),
                Self::Computing(arithmetic) => arithmetic.record(&mut pass),
            }
        }
        timed
    }
}
