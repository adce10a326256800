// A plane through a fluid: a rectangle of cells.

struct Plane {
    // xyz: lower corner, m.
    corner: vec4f,
    // xyz: the edges that begin there, m; w: number of cells along them.
    along: vec4f,
    upwards: vec4f,
}

@group(1) @binding(0) var<uniform> plane: Plane;
// Colour, 0 for cells without fluid, and the fraction of fluid.
@group(1) @binding(1) var cells: texture_2d<f32>;
@group(1) @binding(2) var cell_sampler: sampler;

struct Seen {
    @builtin(position) clip: vec4f,
    // Position in the plane, cells.
    @location(0) place: vec2f,
}

@vertex
fn plane_vertex(@builtin(vertex_index) index: u32) -> Seen {
    let part = vec2f(f32(index & 1u), f32(index >> 1u));
    let p = plane.corner.xyz + part.x * plane.along.xyz + part.y * plane.upwards.xyz;
    return Seen(projected(p), part * vec2f(plane.along.w, plane.upwards.w));
}

// Samples of a pixel along the longer edge of its footprint: copies as coarse as that edge would blur a plane that is
// seen at a grazing angle. Anisotropic filters of drivers do not all choose the same copy.
const TAPS = 8;

@fragment
fn plane_fragment(in: Seen) -> @location(0) vec4f {
    let right = dpdx(in.place);
    let down = dpdy(in.place);
    let leans = length(right) > length(down);
    let longer = select(down, right, leans);
    let shorter = select(right, down, leans);
    let level = log2(max(max(length(shorter), length(longer) / f32(TAPS)), 1.0));
    // A pixel smaller than a cell needs only one sample.
    let taps = select(1, TAPS, length(longer) > 1.0);
    let pixel = max(abs(right) + abs(down), vec2f(1e-6));
    var texel = vec4f(0.0);
    for (var tap = 0; tap < taps; tap++) {
        let place = in.place + ((f32(tap) + 0.5) / f32(taps) - 0.5) * longer;
        // Each cell has one colour: colours mix only within a pixel of an edge between two cells.
        let edge = floor(place + 0.5);
        let sharp = edge + clamp((place - edge) / pixel, vec2f(-0.5), vec2f(0.5));
        let size = vec2f(plane.along.w, plane.upwards.w);
        texel += textureSampleLevel(cells, cell_sampler, sharp / size, level) / f32(taps);
    }
    // The fraction of fluid gives the number of covered samples of the pixel.
    return vec4f(texel.rgb / max(texel.a, 1e-3), texel.a);
}
