// Lines with a width in pixels: each end of a line is two corners of a quadrilateral that faces the eye.

struct End {
    @location(0) position: vec3f,
    // The other end.
    @location(1) other: vec3f,
    @location(2) colour: vec4f,
    // Half of the width, pixels, positive for one corner and negative for the other; and its upper limit, m.
    @location(3) half_width: vec2f,
    @location(4) x: vec4f,
    @location(5) y: vec4f,
    @location(6) z: vec4f,
    @location(7) tint: vec4f,
    // Coloured fraction of the width, negative at the second end; the rims at both sides are dark.
    @location(8) core: f32,
}

struct Stroke {
    @builtin(position) clip: vec4f,
    @location(0) colour: vec4f,
    // −1 at one side to 1 at the other.
    @location(1) across: f32,
    @location(2) @interpolate(flat) core: f32,
}

// Brightness of a rim.
const RIM = 0.12;

// Offset of a line towards the eye from the surface it lies on, in half widths: a surface inclined by up to atan(3) does
// not hide half of the line.
const LIFT = 3.0;
// Largest offset, pixels: an arrow head must not show through what hides its line.
const MOST_LIFT = 7.5;

@vertex
fn stroke_vertex(in: End) -> Stroke {
    let near = view.forward.w;
    let position = vec4f(in.position, 1.0);
    let other = vec4f(in.other, 1.0);
    var a = seen(vec3f(dot(in.x, position), dot(in.y, position), dot(in.z, position)));
    var b = seen(vec3f(dot(in.x, other), dot(in.y, other), dot(in.z, other)));
    if (max(a.z, b.z) <= near) {
        // Behind the eye: outside the picture.
        return Stroke(vec4f(0.0, 0.0, 2.0, 1.0), vec4f(0.0), 0.0, 1.0);
    }
    if (a.z < near) {
        a = mix(a, b, (near - a.z) / (b.z - a.z));
    }
    if (b.z < near) {
        b = mix(b, a, (near - b.z) / (a.z - b.z));
    }
    let at = view.eye.w * a.xy / a.z;
    let along = view.eye.w * b.xy / b.z - at;
    let direction = along / max(length(along), 1e-6);
    let half_width = min(abs(in.half_width.x), in.half_width.y * view.eye.w / a.z);
    let side = sign(in.half_width.x) * half_width * vec2f(-direction.y, direction.x);
    // Longer by half a width, so that adjoining lines leave no notch.
    let place = (at + side - 0.5 * half_width * direction) / (0.5 * view.size.xy);
    let lift = min(LIFT * half_width, MOST_LIFT) / view.eye.w;
    let lifted = max(a.z * (1.0 - lift), near);
    let clip = vec4f(place * a.z, near * a.z / lifted, a.z);
    // The sides of each end are defined looking away from the other end.
    return Stroke(clip, in.colour * in.tint, sign(in.half_width.x * in.core), abs(in.core));
}

@fragment
fn stroke_fragment(in: Stroke) -> @location(0) vec4f {
    let colour = linear_of_srgb(in.colour.rgb);
    // Smoothed within a pixel.
    let pixel = max(fwidth(in.across), 1e-6);
    let rim = clamp((abs(in.across) - in.core) / pixel + 0.5, 0.0, 1.0);
    return vec4f(mix(colour, RIM * colour, select(rim, 0.0, in.core >= 1.0)), 1.0);
}
