// Gardner & Sitar 2018, eq. 10: the weight of the solid follows from the volume of a part in a cell.
// needs tables

fn effective_radius(radius: f32) -> f32 {
    return radius;
}

fn effective_plane(normal: vec3<f32>, s: f32, solid: f32) -> f32 {
    return solid;
}

fn effective_polyhedron(part: Part, r: vec3<f32>, solid: f32) -> vec2<f32> {
    return vec2(solid);
}
