//! The contacts of all pairs, in the order of the pairs.

use crate::rock::contact::Placed;

use super::{
    films::Film,
    touch::{NONE, Pair, Touch},
};

/// Pairs that one thread takes at a time: enough to outweigh the handing out.
pub(super) const CHUNK: usize = 64;

/// Contacts in one list for each [`CHUNK`] pairs: whoever resolves them writes a list of its own, which the
/// step after the next uses again.
#[derive(Clone, Debug, Default)]
pub(super) struct Touches {
    pub chunks: Vec<Chunk>,
}

/// Contacts of neighbouring pairs.
#[derive(Clone, Debug, Default)]
pub(super) struct Chunk {
    /// At most [`CHUNK`].
    pub touches: Vec<Touch>,
    /// Films in the gaps of pairs that nearly touch.
    pub films: Vec<Film>,
    /// What the springs held whose contact has ended in this step, J.
    pub ended: Vec<f64>,
    /// Room for the image of a part.
    pub image: Placed,
    /// Power that the dashpots of each contact take, W.
    pub dashpots: Vec<f64>,
}

impl Touches {
    /// Makes room for the contacts of `pairs` pairs.
    pub fn reset(&mut self, pairs: usize) {
        let count = pairs.div_ceil(CHUNK);
        self.chunks.resize_with(count, Chunk::default);
    }

    pub fn iter(&self) -> impl Iterator<Item = &Touch> {
        self.chunks.iter().flat_map(|chunk| &chunk.touches)
    }

    /// The films of all pairs, in their order.
    pub fn films(&self) -> impl Iterator<Item = &Film> {
        self.chunks.iter().flat_map(|chunk| &chunk.films)
    }

    /// The contact that a pair names.
    pub fn of(&self, pair: &Pair) -> Option<&Touch> {
        let id = pair.touch as usize;
        (pair.touch != NONE).then(|| &self.chunks[id / CHUNK].touches[id % CHUNK])
    }

    /// All contacts into one list, and into `pairs` their places in it.
    pub fn list(&self, pairs: &mut [Pair], list: &mut Vec<Touch>) {
        list.clear();
        let mut firsts = Vec::with_capacity(self.chunks.len());
        for chunk in &self.chunks {
            firsts.push(list.len() as u32);
            list.extend_from_slice(&chunk.touches);
        }
        for pair in pairs.iter_mut().filter(|pair| pair.touch != NONE) {
            let id = pair.touch as usize;
            pair.touch = firsts[id / CHUNK] + (id % CHUNK) as u32;
        }
    }

    /// The contacts of a list, whose places name them, and films.
    pub fn from_list(list: &[Touch], films: &[Film]) -> Self {
        let chunk = |touches: &[Touch]| Chunk {
            touches: touches.to_vec(),
            ..Chunk::default()
        };
        let mut chunks: Vec<Chunk> = list.chunks(CHUNK).map(chunk).collect();
        if !films.is_empty() {
            chunks.resize_with(chunks.len().max(1), Chunk::default);
            chunks[0].films = films.to_vec();
        }
        Self { chunks }
    }
}
