// Camera and light, shared by all shaders of a picture. Positions are relative to the camera's target, m.

struct View {
    // Camera: xyz unit vectors. w: pixels from the middle to an edge, over metres, at a depth of 1 m,
    // in units of half the view's width (right) and height (up); forward.w: depth of the near plane, m.
    right: vec4f,
    up: vec4f,
    forward: vec4f,
    // xyz: position of the eye, m; w: pixels per metre at a depth of 1 m.
    eye: vec4f,
    // x, y: size of the view, pixels; z: number of lights.
    size: vec4f,
    // xyz: away from the ground; w: illuminance from below, sun on a facing surface being `weights.x`.
    zenith: vec4f,
    // x: illuminance of the sun on a facing surface; y: of each direction of the sky; z: of all of them
    // on open ground; w: of the sky on the ground, if it has no directions.
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
    // Position in the light's shadow map: dot(xyz, p) + w is in 0..1 inside the map.
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

// Components to the right, up and into the picture, m.
fn seen(p: vec3f) -> vec3f {
    let d = p - view.eye.xyz;
    return vec3f(dot(view.right.xyz, d), dot(view.up.xyz, d), dot(view.forward.xyz, d));
}

// Depth goes from 1 at the near plane to 0 at infinity, so that f32 resolves far and near alike.
fn projected(p: vec3f) -> vec4f {
    let s = seen(p);
    return vec4f(s.x * view.right.w, s.y * view.up.w, view.forward.w, s.z);
}

fn linear_of_srgb(c: vec3f) -> vec3f {
    return select(pow((c + 0.055) / 1.055, vec3f(2.4)), c / 12.92, c <= vec3f(0.04045));
}

// Illuminance from which the response is compressed, so that surfaces facing the sun are not overexposed.
const SHOULDER = 0.75;

fn exposed(light: f32) -> f32 {
    let rest = 1.0 - SHOULDER;
    let bent = 1.0 - rest * exp((SHOULDER - light) / rest);
    return select(bent, light, light < SHOULDER);
}

// A surface as seen by a light: xy in its shadow map, z its depth there; w: cosine of its slant.
fn seen_by(light: Light, p: vec3f, n: vec3f, reach: f32) -> vec4f {
    let cosine = dot(n, light.towards.xyz);
    // Offset from the surface by more than a texel covers on it; otherwise the surface would shadow itself.
    let q = p + n * light.towards.w * (2.25 - 1.5 * cosine + reach);
    return vec4f(
        dot(light.across.xyz, q) + light.across.w,
        1.0 - dot(light.upwards.xyz, q) - light.upwards.w,
        dot(light.depth.xyz, q) + light.depth.w,
        cosine,
    );
}

// Whether the shadow map is needed: not if the light is behind the surface, nor outside of the map, where nothing hides
// the light. Callers skip by loops of zero iterations, since CPU devices execute both sides of a branch.
fn needs_look(place: vec4f) -> bool {
    return place.w > 0.0 && all(place.xy > vec2f(0.0)) && all(place.xy < vec2f(1.0));
}

// Illuminance from the sun at p on a surface with the normal n, 1 at normal incidence without shadow; `reach` texels
// smooth the edges of shadows.
fn sunlight(p: vec3f, n: vec3f, reach: i32) -> f32 {
    let light = lights[0];
    let place = seen_by(light, p, n, f32(reach));
    let looks = select(-1, reach, needs_look(place));
    var hidden = 0.0;
    for (var j = -looks; j <= looks; j++) {
        for (var i = -looks; i <= looks; i++) {
            let texel = clamp(
                place.xy * light.tile.z + vec2f(f32(i), f32(j)) * light.tile.w,
                vec2f(light.tile.w),
                vec2f(light.tile.z - light.tile.w),
            );
            hidden += 1.0 - textureSampleCompareLevel(
                shadows, shadow_sampler, light.tile.xy + texel, min(place.z, 1.0));
        }
    }
    let width = f32(2 * reach + 1);
    return max(place.w, 0.0) * (1.0 - hidden / (width * width));
}

// The same for direction `index` of the sky; with so many directions the nearest texel suffices.
fn skylight(index: u32, p: vec3f, n: vec3f) -> f32 {
    let light = lights[index];
    let place = seen_by(light, p, n, 0.0);
    let looks = select(0, 1, needs_look(place));
    var open = 1.0;
    for (var look = 0; look < looks; look++) {
        let texel = vec2i((light.tile.xy + place.xy * light.tile.z) / light.tile.w);
        open = select(0.0, 1.0, min(place.z, 1.0) <= textureLoad(shadows, texel, 0));
    }
    return max(place.w, 0.0) * open;
}

// Illuminance: the sun, a uniform sky hidden in part by bodies, and light reflected from the ground. All are white, so that
// a shaded colour keeps the ratios of its channels and the colour map remains readable.
fn illuminance(p: vec3f, n: vec3f) -> f32 {
    var sky = 0.0;
    for (var index = 1u; index < u32(view.size.z); index++) {
        sky += view.weights.y * skylight(index, p, n);
    }
    let below = 0.5 - 0.5 * dot(n, view.zenith.xyz);
    // Without directions, the sky is unobstructed.
    sky += view.weights.w * (1.0 - below);
    return view.weights.x * sunlight(p, n, 1) + sky + view.zenith.w * below;
}
