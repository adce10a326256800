//! Which work goes to all threads, and which stays on one: handing it out takes tens of µs, as long as a sub-step of some
//! hundred blocks.

use rayon::iter::{IntoParallelIterator, ParallelIterator};
use rayon_cond::CondIterator;

/// Blocks from which on they move on all threads.
const BLOCKS: usize = 2048;
/// Convex parts from which on they are placed on all threads, and pairs from which on their contacts are found there.
pub(super) const PARTS: usize = 256;

/// Iterates over what there is one of for each of `count` blocks: on all threads where they are many.
pub(super) fn each_block<I, P, S>(items: I, count: usize) -> CondIterator<P, S>
where
    I: IntoParallelIterator<Iter = P, Item = P::Item> + IntoIterator<IntoIter = S, Item = S::Item>,
    P: ParallelIterator,
    S: Iterator<Item = P::Item>,
{
    CondIterator::new(items, count >= BLOCKS)
}
