// Fractions of a convex polyhedron in a cell that several of its faces cut.
// needs tables, faces, several_planes, columns, $effective

// r: the centre of the cell from the part's centroid.
fn polyhedron_fraction(part: Part, r: vec3<f32>) -> Fractions {
    var cuts = 0u;
    var planes = NO_CUTS;
    for (var k = 0u; k < part.faces; k++) {
        let face = faces[part.first_face + k];
        let s = dot(face.xyz, r) - face.w;
        if (s > TOUCH - half_width(face.xyz)) {
            planes = with_cut(planes, cuts, plane_from_corner(face.xyz, s));
            cuts++;
        }
    }
    var fraction: f32;
    if (cuts <= CUTS) {
        fraction = several_planes_volume(planes, cuts);
    } else {
        fraction = many_planes_volume(part, r);
    }
    let solid = select(0.0, fraction, fraction > EMPTY);
    return Fractions(solid, effective_polyhedron(part, r, solid));
}

// Volume by columns that are clipped by all faces of the part.
fn many_planes_volume(part: Part, r: vec3<f32>) -> f32 {
    // Some adapters silently end loops after 65535 iterations; these take at most 41000 for up to 8192 faces.
    let n = clamp(2u * u32(sqrt(f32(8192u / part.faces))), 2u, 8u);
    let axis = main_axis(r);
    var sum = 0.0;
    for (var j = 0u; j < n; j++) {
        for (var i = 0u; i < n; i++) {
            sum += column_length(part, r, axis, vec2(column(i, n), column(j, n)));
        }
    }
    return sum / f32(n * n);
}

fn column_length(part: Part, r: vec3<f32>, axis: u32, at: vec2<f32>) -> f32 {
    var low = -0.5;
    var high = 0.5;
    for (var k = 0u; k < part.faces; k++) {
        let face = faces[part.first_face + k];
        let n = permuted(face.xyz, axis);
        let s = dot(face.xyz, r) - face.w + dot(n.xy, at);
        // A steeper face does not cross the column within the cell.
        if (abs(n.z) < 1e-6) {
            if (s > 0.0) {
                return 0.0;
            }
        } else if (n.z > 0.0) {
            high = min(high, -s / n.z);
        } else {
            low = max(low, -s / n.z);
        }
    }
    return max(high - low, 0.0);
}
