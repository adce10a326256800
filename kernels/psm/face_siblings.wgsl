// Relation of the cells along one face of a part to the other parts of its block.
// needs tables, faces, face_layer

// Gap between the face and another part, cells, below which there is a seam.
const SEAM_GAP = 1e-3;

// Position of the other parts: outside of the cell, in the cell, or over the face at the foot of the cell.
const OPEN = 0u;
const CUT = 1u;
const SEAM = 2u;

// A seam contains no fluid that could exert pressure. A cell that another part cuts may still contain water at the face.
fn sibling_over_face(tile: Tile, cell: vec3<i32>, layer: LayerCell) -> u32 {
    var found = OPEN;
    // The parts of a block are consecutive.
    for (var k = tile.part; k > 0u && parts[k - 1u].block == tile.block; k--) {
        found = max(found, part_over_face(parts[k - 1u], cell, layer));
    }
    for (var k = tile.part + 1u; k < arrayLength(&parts) && parts[k].block == tile.block; k++) {
        found = max(found, part_over_face(parts[k], cell, layer));
    }
    return found;
}

fn part_over_face(other: Part, cell: vec3<i32>, layer: LayerCell) -> u32 {
    let r = centre_from(cell, other.base, other.fraction);
    let foot = r - (layer.height - SEAM_GAP) * layer.normal;
    if (other.faces == 0u) {
        let cut = length(max(abs(r) - 0.5, vec3(0.0))) < other.radius;
        return select(select(OPEN, CUT, cut), SEAM, length(foot) < other.radius);
    }
    var cut = true;
    var seam = true;
    for (var k = 0u; k < other.faces && (cut || seam); k++) {
        let face = faces[other.first_face + k];
        cut = cut && dot(face.xyz, r) - face.w < half_width(face.xyz) - TOUCH;
        seam = seam && dot(face.xyz, foot) < face.w;
    }
    return select(select(OPEN, CUT, cut), SEAM, seam);
}
