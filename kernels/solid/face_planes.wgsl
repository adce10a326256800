// One face of a convex polyhedron in a cell.
// needs tables, faces, several_planes

struct FaceInCell {
    // No other face is higher over the cell; of those that are as high the first one counts.
    owns: bool,
    // In the cell.
    area: f32,
}

// r: the centre of the cell from the part's centroid.
fn face_in_cell(part: Part, number: u32, r: vec3<f32>) -> FaceInCell {
    let own = faces[part.first_face + number];
    let height = dot(own.xyz, r) - own.w;
    let w = half_width(own.xyz);
    // The lowest place is still in the cell, the highest one in the next: a face along the grid is in one of them.
    let passes = height >= -w - TOUCH && height < w - TOUCH;
    var cuts = with_cut(NO_CUTS, 0u, plane_from_corner(own.xyz, max(height, -w)));
    var count = 1u;
    var owns = true;
    for (var k = 0u; k < part.faces; k++) {
        let face = faces[part.first_face + k];
        let s = dot(face.xyz, r) - face.w;
        if (k == number) {
            continue;
        }
        owns = owns && (s < height || (s == height && k > number));
        // More cuts than there are places for are rare, and then the area is a little too large.
        if (s > TOUCH - half_width(face.xyz) && count < CUTS) {
            cuts = with_cut(cuts, count, plane_from_corner(face.xyz, s));
            count++;
        }
    }
    return FaceInCell(owns, select(0.0, 0.5 * twice_face(cuts, count, 3u), passes));
}
