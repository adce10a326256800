// Depth as seen by a light, written to the light's tile of the atlas.

struct Light {
    across: vec4f,
    upwards: vec4f,
    depth: vec4f,
    towards: vec4f,
    tile: vec4f,
}

@group(0) @binding(0) var<uniform> light: Light;

@vertex
fn shadow_vertex(
    @location(0) position: vec3f,
    @location(3) x: vec4f,
    @location(4) y: vec4f,
    @location(5) z: vec4f,
) -> @builtin(position) vec4f {
    let local = vec4f(position, 1.0);
    let p = vec4f(dot(x, local), dot(y, local), dot(z, local), 1.0);
    return vec4f(
        2.0 * dot(light.across, p) - 1.0,
        2.0 * dot(light.upwards, p) - 1.0,
        dot(light.depth, p),
        1.0,
    );
}
