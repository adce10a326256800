// Effective fractions for the weight of weight_exact.wgsl, which is exact for planes. If one plane cuts a cell, the effective
// fraction is the volume fraction; for curved surfaces and edges it is corrected (docs/src/theory/solids.md).
// needs tables, faces, one_plane

// Constant c of a sphere, cells^2: its radius grows by c / R.
override SPHERE_GROWTH: f32;

// Shift of a plane, cells, over 1 - (n_x^4 + n_y^4 + n_z^4).
const OBLIQUE_SHIFT = 0.05;

// Radius, cells, below which the growth is constant.
const LEAST_RADIUS = 2.0;

fn effective_radius(radius: f32) -> f32 {
    return radius + SPHERE_GROWTH / max(radius, LEAST_RADIUS);
}

// Distance, cells, by which a plane at an angle to the grid moves outwards: the exact weight alone would leave it inside.
fn oblique_shift(normal: vec3<f32>) -> f32 {
    let squares = normal * normal;
    return OBLIQUE_SHIFT * max(1.0 - dot(squares, squares), 0.0);
}

// Effective fraction of a cell that one plane cuts; s: the height of its centre over the plane.
fn effective_plane(normal: vec3<f32>, s: f32, solid: f32) -> f32 {
    let shift = oblique_shift(normal);
    if (shift < TOUCH) {
        return solid;
    }
    return left_of(normal, s - shift);
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
        let s = dot(normal, r) - faces[part.first_face + k].w;
        product *= left_of(normal, s);
        let left = left_of(normal, s - oblique_shift(normal));
        lowest = select(lowest, normal, left < least);
        least = min(least, left);
    }
    var effective = least;
    let own = draw(least);
    for (var k = 0u; k < part.faces; k++) {
        let face = faces[part.first_face + k];
        let steepness = clamp(1.0 - dot(face.xyz, lowest), 0.0, 1.0);
        let left = left_of(face.xyz, dot(face.xyz, r) - face.w - oblique_shift(face.xyz));
        let other = steepness * draw(left);
        effective = max(effective, (own * least + other * left) / max(own + other, 1e-9));
    }
    return vec2(effective, least) * min(sqrt(solid / product), 1.0);
}

// Fraction of a cell below one plane; s: the height of its centre over the plane.
fn left_of(normal: vec3<f32>, s: f32) -> f32 {
    let w = half_width(normal);
    if (s <= TOUCH - w) {
        return 1.0;
    }
    return max(one_plane_volume(normal, s, w), EMPTY);
}

// Weight of a plane. With the fourth root, the drag of a cube equals that of bounce-back at every offset.
fn draw(left: f32) -> f32 {
    return sqrt(sqrt((1.0 - left) / left));
}
