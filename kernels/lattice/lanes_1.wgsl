// One cell per invocation.

alias Real = f32;
alias Mask = bool;
const LANES = 1u;

fn mask_any(m: Mask) -> bool {
    return m;
}

// The upper neighbour of the top slice is the bottom slice: rotate_up shifts a value of the bottom slice to
// the lanes of the top slice, and rotate_down back.
fn rotate_up(v: Real) -> Real {
    return v;
}

fn rotate_down(v: Real) -> Real {
    return v;
}

// Bit `bit` of each lane's byte.
fn flag(word: u32, bit: u32) -> Mask {
    return (word & (1u << bit)) != 0u;
}

// Whether the cells at z, z + slices, ... are in the layer `layer`.
fn in_slice(z: u32, slices: u32, layer: u32) -> Mask {
    return z == layer;
}

// Bits are compared as integers. above: at least `limit`, or NaN; not_positive: zero, negative, infinite or NaN.
fn above(v: Real, limit: f32) -> Mask {
    return bitcast<u32>(v) >= bitcast<u32>(limit);
}

fn not_positive(v: Real) -> Mask {
    return bitcast<u32>(v) - u32(1u) >= u32(0x7f7fffffu);
}

// The first lane in which the mask is set, if there is one.
fn lowest_lane(m: Mask) -> u32 {
    return 0u;
}
