// Second pass: writes the pairs, lower number first, to their positions in the list.

// Number of pairs before those of each invocation; the last value is the total.
@group(0) @binding(5) var<storage, read> pair_starts: array<u32>;
@group(0) @binding(6) var<storage, read_write> pair_list: array<vec2<u32>>;

var<private> place: u32;

fn begin(n: u32) -> bool {
    place = pair_starts[n];
    return pair_starts[n + 1u] > place;
}

fn found(i: u32, j: u32) {
    // A list that exceeds the size of a binding is written in parts.
    if (place >= search.first_pair && place - search.first_pair < arrayLength(&pair_list)) {
        pair_list[place - search.first_pair] = vec2(min(i, j), max(i, j));
    }
    place++;
}

fn finish(n: u32, candidates: u32) {}
