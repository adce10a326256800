// Small balls: a square that faces the eye, with the surface, normal and depth of the ball.

struct Dot {
    // Centre and radius, m.
    @location(0) ball: vec4f,
    @location(1) colour: vec4f,
}

struct Disc {
    @builtin(position) clip: vec4f,
    // From the middle, in radii.
    @location(0) across: vec2f,
    @location(1) @interpolate(flat) ball: vec4f,
    @location(2) @interpolate(flat) colour: vec4f,
}

struct Point {
    @location(0) colour: vec4f,
    @builtin(frag_depth) depth: f32,
}

// Smallest radius, pixels: a smaller ball would fall between the samples.
const LEAST = 0.75;

@vertex
fn drop_vertex(in: Dot, @builtin(vertex_index) index: u32) -> Disc {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u)) * 2.0 - 1.0;
    let middle = seen(in.ball.xyz);
    let radius = max(in.ball.w, LEAST * middle.z / view.eye.w);
    let near = view.forward.w;
    if (middle.z - radius <= near) {
        // At the eye: outside the picture.
        return Disc(vec4f(0.0, 0.0, 2.0, 1.0), vec2f(0.0), vec4f(0.0), vec4f(0.0));
    }
    // Wider by half a pixel, for the smooth edge.
    let wide = corner * (1.0 + 0.5 * middle.z / (view.eye.w * radius));
    let s = middle + vec3f(wide * radius, 0.0);
    let clip = vec4f(s.x * view.right.w, s.y * view.up.w, near, s.z);
    return Disc(clip, wide, vec4f(in.ball.xyz, radius), in.colour);
}

@fragment
fn drop_fragment(in: Disc) -> Point {
    let out = length(in.across);
    // Smoothed within a pixel: opacity covers a proportional number of its samples.
    let covered = clamp((1.0 - out) / max(fwidth(out), 1e-6) + 0.5, 0.0, 1.0);
    if (covered == 0.0) {
        discard;
    }
    let towards = sqrt(max(1.0 - out * out, 0.0));
    let normal = in.across.x * view.right.xyz + in.across.y * view.up.xyz - towards * view.forward.xyz;
    let p = in.ball.xyz + in.ball.w * normal;
    // The whole sky without shadow maps, whose cost is not worth it for small balls.
    let sun = lights[0].towards.xyz;
    let sky = view.weights.z - view.weights.x * max(dot(sun, view.zenith.xyz), 0.0);
    let below = 0.5 - 0.5 * dot(normal, view.zenith.xyz);
    let light = view.weights.x * sunlight(p, normal, 0) + sky * (1.0 - below) + view.zenith.w * below;
    let colour = linear_of_srgb(in.colour.rgb) * exposed(light);
    return Point(vec4f(colour, covered), view.forward.w / seen(p).z);
}
