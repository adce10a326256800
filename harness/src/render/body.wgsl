// Surfaces of bodies: shaded triangles.

struct Corner {
    @location(0) position: vec3f,
    @location(1) normal: vec4f,
    // sRGB.
    @location(2) colour: vec4f,
    // Rows of the 3 × 4 matrix that places the mesh, and its colour.
    @location(3) x: vec4f,
    @location(4) y: vec4f,
    @location(5) z: vec4f,
    @location(6) tint: vec4f,
}

struct Shaded {
    // Invariant, since the shading pass must reproduce the depths of the depth pass exactly.
    @builtin(position) @invariant clip: vec4f,
    @location(0) p: vec3f,
    @location(1) normal: vec3f,
    @location(2) colour: vec4f,
}

@vertex
fn body_vertex(in: Corner) -> Shaded {
    let position = vec4f(in.position, 1.0);
    let p = vec3f(dot(in.x, position), dot(in.y, position), dot(in.z, position));
    // Normals transform with the cofactors of the matrix, also for stretched bodies.
    let normal = vec3f(
        dot(cross(in.y.xyz, in.z.xyz), in.normal.xyz),
        dot(cross(in.z.xyz, in.x.xyz), in.normal.xyz),
        dot(cross(in.x.xyz, in.y.xyz), in.normal.xyz),
    );
    return Shaded(projected(p), p, normal, in.colour * in.tint);
}

@fragment
fn depth_fragment(in: Shaded) -> @location(0) vec4f {
    return vec4f(0.0);
}

@fragment
fn body_fragment(in: Shaded, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let colour = linear_of_srgb(in.colour.rgb);
    let normal = normalize(select(-in.normal, in.normal, front));
    return vec4f(colour * exposed(illuminance(in.p, normal)), 1.0);
}
