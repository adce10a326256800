// What all shaders of a picture share: camera and light. Places are relative to the camera's target, m.

struct View {
    // Camera: xyz unit vectors. w: pixels from the middle to an edge, over metres, at a depth of 1 m,
    // in units of half the view's width (right) and height (up); forward.w: depth of the near plane, m.
    right: vec4f,
    up: vec4f,
    forward: vec4f,
    // xyz: place of the eye, m; w: pixels per metre at a depth of 1 m.
    eye: vec4f,
    // x, y: size of the view, pixels; z: number of lights.
    size: vec4f,
    // xyz: away from the ground; w: illuminance from below, sun on a facing surface being `weights.x`.
    zenith: vec4f,
    // x: illuminance of the sun on a facing surface; y: of each direction of the sky;
    // z: of all of them on open ground.
    weights: vec4f,
    // Ground: xyz: its middle, m; w: radius at which it begins to fade, m.
    ground: vec4f,
    // xyz: axes in the ground; w: of `ground_x` the spacing of the grid, m, of `ground_y` the radius at
    // which the ground has faded, m.
    ground_x: vec4f,
    ground_y: vec4f,
    // x, y: grid coordinates of the ground's middle, m, less a multiple of the spacing.
    grid: vec4f,
    // Background above and below, linear.
    above: vec4f,
    below: vec4f,
}

struct Light {
    // Place in the light's shadow map: dot(xyz, p) + w is in 0..1 in what the light sees.
    across: vec4f,
    upwards: vec4f,
    depth: vec4f,
    // xyz: unit vector towards the light; w: size of a texel of its shadow map, m.
    towards: vec4f,
    // Its shadow map in the atlas: x, y: corner; z: size; w: size of a texel, all in atlas widths.
    tile: vec4f,
}

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var<uniform> lights: array<Light, 64>;
@group(0) @binding(2) var shadows: texture_depth_2d;
@group(0) @binding(3) var shadow_sampler: sampler_comparison;

// Right, up and into the picture, m.
fn seen(p: vec3f) -> vec3f {
    let d = p - view.eye.xyz;
    return vec3f(dot(view.right.xyz, d), dot(view.up.xyz, d), dot(view.forward.xyz, d));
}

// Depth runs from 1 at the near plane to 0 at infinity, so that f32 resolves far and near alike.
fn projected(p: vec3f) -> vec4f {
    let s = seen(p);
    return vec4f(s.x * view.right.w, s.y * view.up.w, view.forward.w, s.z);
}

fn linear_of_srgb(c: vec3f) -> vec3f {
    return select(pow((c + 0.055) / 1.055, vec3f(2.4)), c / 12.92, c <= vec3f(0.04045));
}

// Where the response to light begins to bend, so that what faces the sun does not burn out.
const SHOULDER = 0.75;

fn exposed(light: f32) -> f32 {
    let rest = 1.0 - SHOULDER;
    let bent = 1.0 - rest * exp((SHOULDER - light) / rest);
    return select(bent, light, light < SHOULDER);
}

// Part of light `index` that reaches p on a surface with the normal n; `reach` texels soften it.
fn reached(index: u32, p: vec3f, n: vec3f, reach: i32) -> f32 {
    let light = lights[index];
    // Off the surface by more than a texel slants over it, else it would shade itself.
    let slant = 1.0 - max(dot(n, light.towards.xyz), 0.0);
    let q = p + n * light.towards.w * (0.75 + 1.5 * slant + f32(reach));
    let place = vec3f(
        dot(light.across.xyz, q) + light.across.w,
        1.0 - dot(light.upwards.xyz, q) - light.upwards.w,
        dot(light.depth.xyz, q) + light.depth.w,
    );
    if (any(place.xy <= vec2f(0.0)) || any(place.xy >= vec2f(1.0))) {
        return 1.0;
    }
    var sum = 0.0;
    for (var j = -reach; j <= reach; j++) {
        for (var i = -reach; i <= reach; i++) {
            let texel = clamp(
                place.xy * light.tile.z + vec2f(f32(i), f32(j)) * light.tile.w,
                vec2f(light.tile.w),
                vec2f(light.tile.z - light.tile.w),
            );
            sum += textureSampleCompareLevel(
                shadows, shadow_sampler, light.tile.xy + texel, min(place.z, 1.0));
        }
    }
    let width = f32(2 * reach + 1);
    return sum / (width * width);
}

// Illuminance: the sun, an even sky hidden in part by bodies, and light back from the ground. All are
// white, so that a shaded colour keeps the ratios of its channels and the colour map can be read.
fn illuminance(p: vec3f, n: vec3f) -> f32 {
    var total = view.zenith.w * (0.5 - 0.5 * dot(n, view.zenith.xyz));
    let sun = dot(n, lights[0].towards.xyz);
    if (sun > 0.0) {
        total += view.weights.x * sun * reached(0u, p, n, 1);
    }
    for (var index = 1u; index < u32(view.size.z); index++) {
        let cosine = dot(n, lights[index].towards.xyz);
        if (cosine > 0.0) {
            total += view.weights.y * cosine * reached(index, p, n, 0);
        }
    }
    return total;
}
