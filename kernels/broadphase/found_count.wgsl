// First pass: counts the pairs.

// One per invocation, and a last one that stays zero.
@group(0) @binding(5) var<storage, read_write> hits: array<u32>;

struct Header {
    // Largest number of candidates of a box.
    candidates: atomic<u32>,
    // Total number of pairs.
    pairs: u32,
}

@group(0) @binding(6) var<storage, read_write> header: Header;

var<private> hits_here: u32;

fn begin(n: u32) -> bool {
    hits_here = 0u;
    return true;
}

fn found(i: u32, j: u32) {
    hits_here++;
}

fn finish(n: u32, candidates: u32) {
    hits[n] = hits_here;
    // Most boxes have few candidates, so that the atomic is rare.
    if (candidates > SLICE * search.slices) {
        atomicMax(&header.candidates, candidates);
    }
}
