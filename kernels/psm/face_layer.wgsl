// The layers of cells along one face of a convex polyhedron.
// needs tables, faces

struct LayerCell {
    // Whether the cell lies in the layer, and its foot on the plane of the face lies in the face.
    here: bool,
    normal: vec3<f32>,
    // Height of the cell's centre over the face.
    height: f32,
}

// r: the centre of the cell from the part's centroid. The first layer, 0, begins where cells no longer intersect the plane.
// Layers are one cell thick, so that each contains one cell per unit of the face's area.
fn layer_cell(part: Part, number: u32, layer: u32, r: vec3<f32>) -> LayerCell {
    let own = faces[part.first_face + number];
    let height = dot(own.xyz, r) - own.w;
    let first = half_width(own.xyz) - TOUCH + f32(layer);
    var here = height >= first && height < first + 1.0;
    let foot = r - height * own.xyz;
    for (var k = 0u; k < part.faces && here; k++) {
        let face = faces[part.first_face + k];
        here = k == number || dot(face.xyz, foot) <= face.w;
    }
    return LayerCell(here, own.xyz, height);
}
