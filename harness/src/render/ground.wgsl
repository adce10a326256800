// A disc of ground with a grid, fading into the background.

struct Spot {
    @builtin(position) clip: vec4f,
    @location(0) p: vec3f,
    // Position relative to the middle along the ground's axes, m.
    @location(1) place: vec2f,
}

// Width of the grid's lines, pixels, and how much darker they are.
const WIDTH = 1.1;
const DARKER = 0.2;

@vertex
fn ground_vertex(@builtin(vertex_index) index: u32) -> Spot {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u)) * 2.0 - 1.0;
    let place = corner * view.ground_y.w;
    let p = view.ground.xyz + place.x * view.ground_x.xyz + place.y * view.ground_y.xyz;
    return Spot(projected(p), p, place);
}

@fragment
fn ground_fragment(in: Spot) -> @location(0) vec4f {
    let lines = (in.place + view.grid.xy) / view.ground_x.w;
    // Grid cells per pixel; as this approaches one, the lines fade to their mean.
    let pixel = fwidth(lines);
    let from_line = abs(fract(lines - 0.5) - 0.5) / pixel;
    let fine = clamp(1.0 - 3.0 * pixel, vec2f(0.0), vec2f(1.0));
    let cover = clamp(0.5 + 0.5 * WIDTH - from_line, vec2f(0.0), vec2f(1.0)) * fine;
    let grid = 1.0 - DARKER * max(cover.x, cover.y);
    let fade = 1.0 - smoothstep(view.ground.w, view.ground_y.w, length(in.place));
    // White where all light reaches the ground: on paper it has no edge and leaves only grid and shadows.
    let light = illuminance(in.p, view.zenith.xyz) / view.weights.z;
    return vec4f(vec3f(grid * light), fade);
}
