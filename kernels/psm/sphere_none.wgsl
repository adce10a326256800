// No part is a sphere.
// needs tables

fn sphere_quick(part: Part, cell: vec3<i32>) -> f32 {
    return 0.0;
}

fn sphere_fraction(part: Part, cell: vec3<i32>) -> Fractions {
    return Fractions(0.0, vec2(0.0));
}
