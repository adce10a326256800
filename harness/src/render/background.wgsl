// The background: one triangle over the whole view.

struct Back {
    @builtin(position) clip: vec4f,
    @location(0) height: f32,
}

@vertex
fn background_vertex(@builtin(vertex_index) index: u32) -> Back {
    let corner = vec2f(f32((index & 1u) << 2u), f32((index & 2u) << 1u)) - 1.0;
    return Back(vec4f(corner, 0.0, 1.0), 0.5 + 0.5 * corner.y);
}

@fragment
fn background_fragment(in: Back) -> @location(0) vec4f {
    return mix(view.below, view.above, in.height);
}
