// Henretty et al. 2011, dimension lifting: four cells per invocation, the cells of an element in grid.wgsl.

alias Real = vec4<f32>;
alias Mask = vec4<bool>;
const LANES = 4u;

fn mask_any(m: Mask) -> bool {
    return any(m);
}

// The upper neighbour of the top slice is the bottom slice of the next lane: rotate_up shifts a value of the
// bottom slice to the lanes of the top slice, and rotate_down back.
fn rotate_up(v: Real) -> Real {
    return v.yzwx;
}

fn rotate_down(v: Real) -> Real {
    return v.wxyz;
}

// Bit `bit` of each lane's byte.
fn flag(word: u32, bit: u32) -> Mask {
    return (vec4(word) & (vec4(1u, 0x100u, 0x10000u, 0x1000000u) << vec4(bit))) != vec4(0u);
}

// Whether the cells at z, z + slices, ... are in the layer `layer`.
fn in_slice(z: u32, slices: u32, layer: u32) -> Mask {
    return vec4(z) + slices * vec4(0u, 1u, 2u, 3u) == vec4(layer);
}

// Bits are compared as integers. above: at least `limit`, or NaN; not_positive: zero, negative, infinite or NaN.
fn above(v: Real, limit: f32) -> Mask {
    return bitcast<vec4<u32>>(v) >= vec4<u32>(bitcast<u32>(limit));
}

fn not_positive(v: Real) -> Mask {
    return bitcast<vec4<u32>>(v) - vec4<u32>(1u) >= vec4<u32>(0x7f7fffffu);
}

// The first lane in which the mask is set, if there is one.
fn lowest_lane(m: Mask) -> u32 {
    return select(select(select(3u, 2u, m.z), 1u, m.y), 0u, m.x);
}
