// Lasserre 1983, J. Optim. Theory Appl. 39:363: the volume of a convex polyhedron from its planes alone. With the
// origin at a corner of the cell, V = sum of d A / 3 over the faces, and A = sum of d L / 2 over the sides of a face.
// The three faces and two sides of the cell through the origin add nothing. Every A depends continuously on its
// planes, however many meet in a point, and so does V. Planes are kept in vectors, because arrays would be in memory.
// needs axes

// Largest number of planes that cut a cell; one more entry is for a face of the cell.
const CUTS = 7u;
// Sine of the angle below which two planes count as parallel: the resulting error, and the rounding error of
// intersections at larger angles, are both below 1e-4 of the cell.
const PARALLEL = 3e-4;

// Four planes x X + y Y + z Z <= d, from the lower corner of the cell.
struct Planes {
    x: vec4<f32>,
    y: vec4<f32>,
    z: vec4<f32>,
    d: vec4<f32>,
}

struct Cuts {
    low: Planes,
    high: Planes,
}

// Four lines x X + y Y <= d in a plane, x x + y y = 1.
struct Lines {
    x: vec4<f32>,
    y: vec4<f32>,
    d: vec4<f32>,
}

const LOW = vec4(0u, 1u, 2u, 3u);
const HIGH = vec4(4u, 5u, 6u, 7u);
const EVERYWHERE = Planes(vec4(0.0), vec4(0.0), vec4(0.0), vec4(1.0));
const NO_CUTS = Cuts(EVERYWHERE, EVERYWHERE);
// The sides of the unit square.
const SQUARE = Lines(vec4(-1.0, 0.0, 1.0, 0.0), vec4(0.0, -1.0, 0.0, 1.0), vec4(0.0, 0.0, 1.0, 1.0));

fn with_cut(cuts: Cuts, number: u32, plane: vec4<f32>) -> Cuts {
    return Cuts(with_plane(cuts.low, LOW == vec4(number), plane), with_plane(cuts.high, HIGH == vec4(number), plane));
}

fn with_plane(p: Planes, here: vec4<bool>, plane: vec4<f32>) -> Planes {
    return Planes(
        select(p.x, vec4(plane.x), here),
        select(p.y, vec4(plane.y), here),
        select(p.z, vec4(plane.z), here),
        select(p.d, vec4(plane.w), here),
    );
}

fn cut_of(cuts: Cuts, number: u32) -> vec4<f32> {
    let k = number & 3u;
    let low = vec4(cuts.low.x[k], cuts.low.y[k], cuts.low.z[k], cuts.low.d[k]);
    let high = vec4(cuts.high.x[k], cuts.high.y[k], cuts.high.z[k], cuts.high.d[k]);
    return select(low, high, number > 3u);
}

// Volume that the first `count` cuts leave of the unit cell.
fn several_planes_volume(cuts: Cuts, count: u32) -> f32 {
    var sum = 0.0;
    for (var face = 0u; face < 3u + count; face++) {
        let d = select(cut_of(cuts, face - 3u).w, 1.0, face < 3u);
        sum += d * twice_face(cuts, count, face);
    }
    return clamp(sum / 6.0, 0.0, 1.0);
}

// Twice the area of one of the three far faces of the cell, or of cut face - 3.
fn twice_face(cuts: Cuts, count: u32, face: u32) -> f32 {
    let of_cell = face < 3u;
    let cut = cut_of(cuts, face - 3u);
    let axis = select(main_axis(cut.xyz), face, of_cell);
    let n = select(permuted(cut.xyz, axis), vec3(0.0, 0.0, 1.0), of_cell);
    // Both sides are multiplied by the sign, so that the lines on the face keep their orientation.
    let own = select(vec4(n, cut.w) * sign(n.z), vec4(n, 1.0), of_cell);
    let number = select(face - 3u, 8u, of_cell);
    let next = select(count, 8u, of_cell);
    let low = on_face(permuted_planes(cuts.low, axis), own, LOW, number, next);
    let high = on_face(permuted_planes(cuts.high, axis), own, HIGH, number, next);
    // Corrects for the projection of the face along the axis.
    return twice_area(low, high, select(count + 1u, count, of_cell)) / abs(n.z);
}

fn permuted_planes(p: Planes, axis: u32) -> Planes {
    if (axis == 0u) {
        return Planes(p.y, p.z, p.x, p.d);
    }
    if (axis == 1u) {
        return Planes(p.z, p.x, p.y, p.d);
    }
    return p;
}

// Intersections of planes with the face own.xyz . X = own.w, own.z > 0, projected along Z. The entry of the face itself
// becomes Z >= 0, and the entry `next` Z <= 1.
fn on_face(p: Planes, own: vec4<f32>, numbers: vec4<u32>, number: u32, next: u32) -> Lines {
    let lowest = numbers == vec4(number);
    let highest = numbers == vec4(next);
    let x = select(select(p.x * own.z - p.z * own.x, vec4(own.x), lowest), vec4(-own.x), highest);
    let y = select(select(p.y * own.z - p.z * own.y, vec4(own.y), lowest), vec4(-own.y), highest);
    let d = select(select(p.d * own.z - p.z * own.w, vec4(own.w), lowest), vec4(own.z - own.w), highest);
    let length = sqrt(x * x + y * y);
    let parallel = length <= vec4(PARALLEL);
    // Parallel planes become lines that leave all or nothing of the unit square; of two identical faces, the first cut
    // counts.
    let all = (d > vec4(0.0)) | ((d == vec4(0.0)) & (numbers >= vec4(number)));
    return Lines(
        select(x / length, vec4(1.0), parallel),
        select(y / length, vec4(0.0), parallel),
        select(d / length, select(vec4(-2.0), vec4(2.0), all), parallel),
    );
}

// Twice the area that the first `count` lines leave of the unit square.
fn twice_area(low: Lines, high: Lines, count: u32) -> f32 {
    let right = stretch_between(vec2(0.0, 1.0), low, high, vec3(1.0, 0.0, 1.0), 8u);
    let top = stretch_between(vec2(-1.0, 0.0), low, high, vec3(0.0, 1.0, 1.0), 8u);
    var sum = right.y - right.x + top.y - top.x;
    for (var e = 0u; e < count; e++) {
        let k = e & 3u;
        let line = select(vec3(low.x[k], low.y[k], low.d[k]), vec3(high.x[k], high.y[k], high.d[k]), e > 3u);
        // Larger than the stretch of any line in the square, measured from its foot.
        let inside = stretch_within(vec2(-2.0, 2.0), SQUARE, line, vec4(true), vec4(false));
        let side = stretch_between(inside, low, high, line, e);
        sum += line.z * (side.y - side.x);
    }
    return sum;
}

// The part of a stretch of line e that all other lines leave.
fn stretch_between(stretch: vec2<f32>, low: Lines, high: Lines, line: vec3<f32>, e: u32) -> vec2<f32> {
    let number = vec4(e);
    let first = vec4(e < 8u);
    let left = stretch_within(stretch, low, line, (LOW < number) & first, LOW == number);
    return stretch_within(left, high, line, (HIGH < number) & first, HIGH == number);
}

// The part of a stretch of line x X + y Y = d that the lines that are not `skipped` leave. A parallel line may hide all of
// it; of two identical lines the first one counts, and of two opposite lines with no space between them neither.
fn stretch_within(
    stretch: vec2<f32>,
    l: Lines,
    line: vec3<f32>,
    first: vec4<bool>,
    skipped: vec4<bool>,
) -> vec2<f32> {
    let along = l.x * line.x + l.y * line.y;
    let rate = l.y * line.x - l.x * line.y;
    let parallel = abs(rate) <= vec4(PARALLEL);
    // Compared, not subtracted: a device may fuse a difference with the product that yields l.d, and then the results for
    // two lines would contradict each other about which one is lower.
    let behind = (l.d < vec4(line.z)) | ((l.d == vec4(line.z)) & first);
    let hides = select(l.d <= vec4(-line.z), behind, along >= vec4(0.0));
    if (any(parallel & hides & !skipped)) {
        return vec2(0.0);
    }
    let reach = (l.d - along * line.z) / select(rate, vec4(1.0), parallel);
    let high = select(vec4(stretch.y), reach, rate > vec4(PARALLEL));
    let low = select(vec4(stretch.x), reach, rate < vec4(-PARALLEL));
    let end = min(min(min(high.x, high.y), min(high.z, high.w)), stretch.y);
    let begin = max(max(max(low.x, low.y), max(low.z, low.w)), stretch.x);
    return vec2(begin, max(begin, end));
}
