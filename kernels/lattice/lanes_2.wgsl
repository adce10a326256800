// Henretty et al. 2011, dimension lifting: two cells per invocation, the cells of an element in grid.wgsl.

alias Real = vec2<f32>;
alias Mask = vec2<bool>;
const LANES = 2u;

fn mask_any(m: Mask) -> bool {
    return any(m);
}

// The upper neighbour of the top slice is the bottom slice: rotate_up shifts a value of the bottom slice to
// the lanes of the top slice, and rotate_down back.
fn rotate_up(v: Real) -> Real {
    return v.yx;
}

fn rotate_down(v: Real) -> Real {
    return v.yx;
}

// Bit `bit` of each lane's byte.
fn flag(word: u32, bit: u32) -> Mask {
    return (vec2(word) & (vec2(1u, 0x100u) << vec2(bit))) != vec2(0u);
}

// Whether the cells at z, z + slices, ... are in the layer `layer`.
fn in_slice(z: u32, slices: u32, layer: u32) -> Mask {
    return vec2(z) + vec2(0u, slices) == vec2(layer);
}

// Bits are compared as integers. above: at least `limit`, or NaN; not_positive: zero, negative, infinite or NaN.
fn above(v: Real, limit: f32) -> Mask {
    return bitcast<vec2<u32>>(v) >= vec2<u32>(bitcast<u32>(limit));
}

fn not_positive(v: Real) -> Mask {
    return bitcast<vec2<u32>>(v) - vec2<u32>(1u) >= vec2<u32>(0x7f7fffffu);
}

// The first lane in which the mask is set, if there is one.
fn lowest_lane(m: Mask) -> u32 {
    return select(1u, 0u, m.x);
}
