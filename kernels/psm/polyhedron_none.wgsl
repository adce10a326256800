// All parts are spheres.
// needs tables

fn polyhedron_quick(part: Part, r: vec3<f32>) -> vec2<f32> {
    return vec2(0.0);
}

fn polyhedron_fraction(part: Part, r: vec3<f32>) -> Fractions {
    return Fractions(0.0, vec2(0.0));
}
