// Share of a convex polyhedron in a cell that at most one of its faces cuts.
// needs tables, faces, one_plane

// r: the centre of the cell from the part's centroid.
fn hull_quick(part: Part, r: vec3<f32>) -> f32 {
    if (any(r + 1.5 <= part.low) || any(r - 1.5 >= part.high)) {
        return 0.0;
    }
    var reached = all(r + 0.5 > part.low) && all(r - 0.5 < part.high);
    var deep = true;
    var cuts = 0u;
    var last: vec4<f32>;
    for (var k = 0u; k < part.faces; k++) {
        let face = faces[part.first_face + k];
        let s = dot(face.xyz, r) - face.w;
        let w = half_width(face.xyz);
        // A cell beside this one is at most 2 w lower, one two layers away at most 4 w higher.
        if (s >= 3.0 * w) {
            return 0.0;
        }
        reached = reached && s < w - TOUCH;
        deep = deep && s <= -5.0 * w;
        if (s > TOUCH - w) {
            last = vec4(face.xyz, s);
            cuts++;
        }
    }
    if (!reached) {
        return NEAR;
    }
    if (cuts == 0u) {
        return select(1.0, DEEP, deep);
    }
    if (cuts > 1u) {
        return UNDECIDED;
    }
    let share = one_plane_volume(last.xyz, last.w, half_width(last.xyz));
    return select(NEAR, share, share > EMPTY);
}
