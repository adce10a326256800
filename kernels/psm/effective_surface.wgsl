// Effective fractions for the weight of weight_exact.wgsl, which is exact for planes. If one plane cuts a cell, the effective
// fraction is the volume fraction; for curved surfaces and edges it is corrected (docs/src/theory/solids.md).
// needs tables, faces, one_plane

// Constant c of a sphere, cells^2: its radius grows by c / R.
override SPHERE_GROWTH: f32;

// Radius, cells, below which the growth is constant.
const LEAST_RADIUS = 2.0;

fn effective_radius(radius: f32) -> f32 {
    return radius + SPHERE_GROWTH / max(radius, LEAST_RADIUS);
}

// Effective fractions of a cell that several planes cut, alone and next to other parts. Alone: the fraction below the lowest
// plane, averaged with that below another plane. The weight of the other plane increases with the angle between both and with
// the fraction that it cuts off; a plane that leaves the cell has no effect. Next to other parts: the fraction below the
// lowest plane. Both are reduced for a tip that has just entered the cell.
fn effective_polyhedron(part: Part, r: vec3<f32>, solid: f32) -> vec2<f32> {
    if (solid <= 0.0) {
        return vec2(0.0);
    }
    var lowest: vec3<f32>;
    var least = 1.0;
    var product = 1.0;
    for (var k = 0u; k < part.faces; k++) {
        let normal = faces[part.first_face + k].xyz;
        let left = left_by(part, k, r);
        product *= left;
        lowest = select(lowest, normal, left < least);
        least = min(least, left);
    }
    var effective = least;
    let own = draw(least);
    for (var k = 0u; k < part.faces; k++) {
        let steepness = clamp(1.0 - dot(faces[part.first_face + k].xyz, lowest), 0.0, 1.0);
        let left = left_by(part, k, r);
        let other = steepness * draw(left);
        effective = max(effective, (own * least + other * left) / max(own + other, 1e-9));
    }
    return vec2(effective, least) * min(sqrt(solid / product), 1.0);
}

// Fraction of the cell below one plane.
fn left_by(part: Part, k: u32, r: vec3<f32>) -> f32 {
    let face = faces[part.first_face + k];
    let s = dot(face.xyz, r) - face.w;
    let w = half_width(face.xyz);
    if (s <= TOUCH - w) {
        return 1.0;
    }
    return max(one_plane_volume(face.xyz, s, w), EMPTY);
}

// Weight of a plane. With the fourth root, the drag of a cube equals that of bounce-back at every offset.
fn draw(left: f32) -> f32 {
    return sqrt(sqrt((1.0 - left) / left));
}
