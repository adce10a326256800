// Latt et al. 2008, Phys. Rev. E 77:056703: the cells at an open face.

// A padded cell at the face, its inner neighbour, and the directions that enter through the face.
struct FaceCell {
    cell: u32,
    inner: u32,
    entering: u32,
}

@group(0) @binding(40) var<storage, read> face_cells: array<FaceCell>;

// The cells of the list that are completed now.
override FROM: u32;
override TO: u32;
override FACE_DENSITY: f32;
