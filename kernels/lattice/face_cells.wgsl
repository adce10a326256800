// Latt et al. 2008, Phys. Rev. E 77:056703: the cells at open faces.

// A padded cell at a face, its inner neighbour, the directions that enter through the face, the face (x-, x+, y-, ...), and its
// turn among the dispatches of a stage.
struct FaceCell {
    cell: u32,
    inner: u32,
    entering: u32,
    face: u32,
    turn: u32,
}

@group(0) @binding(40) var<storage, read> face_cells: array<FaceCell>;

struct OpenFace {
    // Outward.
    normal: vec3<f32>,
    // Density in cell 0 of the domain; `gradient` is its increase from cell to cell along the face.
    density: f32,
    // Fractions of the difference to that density, and of its sum over time, that an outflow face removes in each step.
    hold: f32,
    integral: f32,
    gradient: vec3<f32>,
}

@group(0) @binding(46) var<uniform> open_faces: array<OpenFace, 6>;

// Density that the face holds at a padded cell, less 1.
fn held_excess(face: OpenFace, cell: u32) -> f32 {
    return face.density + dot(face.gradient, vec3<f32>(padded_cell(cell))) - 1.0;
}
