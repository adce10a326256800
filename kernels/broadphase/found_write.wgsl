// Pairs that are written, lower number first, each to its place in the list.

// Pairs before those of each invocation; the last one says how many there are.
@group(0) @binding(5) var<storage, read> pair_starts: array<u32>;
@group(0) @binding(6) var<storage, read_write> pair_list: array<vec2<u32>>;

var<private> place: u32;

fn begin(n: u32) -> bool {
    place = pair_starts[n];
    return pair_starts[n + 1u] > place;
}

fn found(i: u32, j: u32) {
    // A list that is longer than a binding may be is written in parts.
    if (place >= search.first_pair && place - search.first_pair < arrayLength(&pair_list)) {
        pair_list[place - search.first_pair] = vec2(min(i, j), max(i, j));
    }
    place++;
}

fn finish(n: u32, candidates: u32) {}
