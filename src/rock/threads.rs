//! Which work goes to all threads, and which stays on one: handing it out takes tens of µs, as long as a sub-step of some
//! hundred blocks.

use rayon::iter::{IntoParallelIterator, ParallelIterator};
use rayon_cond::CondIterator;

/// Rigid blocks from which on they move on all threads.
const BLOCKS: usize = 2048;
/// Dearer work: deforming blocks that move, convex parts that are placed, and pairs whose contacts are found.
pub(super) const PAIRS: usize = 256;
/// Chunks of contacts whose works are summed.
pub(super) const CHUNKS: usize = 128;

/// Iterates over what there is one of for each of `count` blocks: on all threads where they are many.
pub(super) fn each_block<I, P, S>(items: I, count: usize) -> CondIterator<P, S>
where
    I: IntoParallelIterator<Iter = P, Item = P::Item> + IntoIterator<IntoIter = S, Item = S::Item>,
    P: ParallelIterator,
    S: Iterator<Item = P::Item>,
{
    CondIterator::new(items, count >= BLOCKS)
}
