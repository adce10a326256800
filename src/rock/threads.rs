//! Thresholds from which work is distributed over all threads. Distribution takes tens of µs, as long as a sub-step of some
//! hundred blocks.

use rayon::iter::{IntoParallelIterator, ParallelIterator};
use rayon_cond::CondIterator;

/// Number of rigid blocks from which they are moved by all threads.
const BLOCKS: usize = 2048;
/// The same for more expensive work: motion of deformable blocks, placing of convex parts, contacts of pairs.
pub(super) const PAIRS: usize = 256;
/// The same for chunks of contacts whose works are summed.
pub(super) const CHUNKS: usize = 128;

/// Iterates over data of `count` blocks, on all threads if there are many.
pub(super) fn each_block<I, P, S>(items: I, count: usize) -> CondIterator<P, S>
where
    I: IntoParallelIterator<Iter = P, Item = P::Item> + IntoIterator<IntoIter = S, Item = S::Item>,
    P: ParallelIterator,
    S: Iterator<Item = P::Item>,
{
    CondIterator::new(items, count >= BLOCKS)
}
