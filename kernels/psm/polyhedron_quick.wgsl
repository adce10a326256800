// Fractions of a convex polyhedron in a cell that at most one of its faces cuts.
// needs tables, faces, one_plane, joint_gap, $effective

// r: the centre of the cell from the part's centroid. Returns the solid fraction, or a mark, and the effective fraction.
fn polyhedron_quick(part: Part, r: vec3<f32>) -> vec2<f32> {
    if (any(r + 1.5 <= part.low) || any(r - 1.5 >= part.high)) {
        return vec2(0.0);
    }
    var reached = all(r + 0.5 > part.low) && all(r - 0.5 < part.high);
    var interior = true;
    var cuts = 0u;
    var outside = 0u;
    var last: vec4<f32>;
    for (var k = 0u; k < part.faces; k++) {
        let face = faces[part.first_face + k];
        let s = dot(face.xyz, r) - face.w;
        let w = half_width(face.xyz);
        // A neighbouring cell is at most 2 w lower, and a cell two layers away at most 4 w higher.
        if (s >= 3.0 * w) {
            return vec2(0.0);
        }
        outside += select(0u, 1u, s >= w - TOUCH);
        interior = interior && s <= -5.0 * w;
        if (s > TOUCH - w) {
            if (outside == 0u || s >= w - TOUCH) {
                last = vec4(face.xyz, s);
            }
            cuts++;
        }
    }
    reached = reached && outside == 0u;
    if (!reached) {
        return vec2(select(NEAR, TOUCHES, outside == 1u && touches(part, r, last)), 0.0);
    }
    if (cuts == 0u) {
        return vec2(select(1.0, INTERIOR, interior), 1.0);
    }
    if (cuts > 1u) {
        return vec2(UNDECIDED, 1.0);
    }
    let fraction = one_plane_volume(last.xyz, last.w, half_width(last.xyz));
    if (fraction > EMPTY) {
        return vec2(fraction, effective_plane(last.xyz, last.w, fraction));
    }
    return vec2(select(NEAR, TOUCHES, touches(part, r, last)), 0.0);
}

// Whether the foot of the cell's centre on a face lies in the face, and there is no gap between the cell and the face;
// own: normal of the face, and height of the centre over it.
fn touches(part: Part, r: vec3<f32>, own: vec4<f32>) -> bool {
    var here = own.w < half_width(own.xyz) + TOUCHING_GAP;
    let foot = r - own.w * own.xyz;
    for (var k = 0u; k < part.faces && here; k++) {
        let face = faces[part.first_face + k];
        here = dot(face.xyz, foot) < face.w + TOUCHING_GAP;
    }
    return here;
}
