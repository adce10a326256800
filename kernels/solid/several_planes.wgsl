// Lasserre 1983, J. Optim. Theory Appl. 39:363: the volume of a convex polyhedron from its planes alone. With the
// origin at a corner of the cell, V = sum of d_a A_a / 3, the area of face a being A_a = sum of d_e L_e / 2 over its
// edges e, seen from the foot of the origin. Every A_a depends on its planes without jumps, however many meet in a
// point, and so does V.

// Faces of a convex part that may cut a cell.
const CUTS = 8u;
// The faces of the cell and the cuts.
const MOST_PLANES = 14u;
// Sine of the angle below which two planes count as parallel: what that neglects, and the rounding of where they meet
// otherwise, are both below 1e-4 of the cell.
const PARALLEL = 3e-4;

// n.x <= w from the lower corner of the cell. The first three pass through it.
var<private> planes: array<vec4<f32>, MOST_PLANES>;
// The same in the plane of one of them.
var<private> lines: array<vec4<f32>, MOST_PLANES>;

// Begins with the faces of the cell.
fn begin_planes() {
    planes[0] = vec4(-1.0, 0.0, 0.0, 0.0);
    planes[1] = vec4(0.0, -1.0, 0.0, 0.0);
    planes[2] = vec4(0.0, 0.0, -1.0, 0.0);
    planes[3] = vec4(1.0, 0.0, 0.0, 1.0);
    planes[4] = vec4(0.0, 1.0, 0.0, 1.0);
    planes[5] = vec4(0.0, 0.0, 1.0, 1.0);
}

// What `cuts` planes, the sixth and later ones, leave of the unit cell.
fn several_planes_volume(cuts: u32) -> f32 {
    var sum = 0.0;
    for (var a = 3u; a < 6u + cuts; a++) {
        sum += planes[a].w * twice_area(a, 6u + cuts);
    }
    return clamp(sum / 6.0, 0.0, 1.0);
}

// Twice the area of the face that lies in plane a.
fn twice_area(a: u32, count: u32) -> f32 {
    let n = planes[a].xyz;
    let d = planes[a].w;
    var edges = 0u;
    for (var b = 0u; b < count; b++) {
        if (b == a) {
            continue;
        }
        let other = planes[b];
        let along = dot(n, other.xyz);
        let across = other.xyz - along * n;
        let sine = length(across);
        if (sine > PARALLEL) {
            lines[edges] = vec4(across, other.w - along * d) / sine;
            edges++;
        } else if (hides(other.w, d, along, b < a)) {
            return 0.0;
        }
    }
    var sum = 0.0;
    for (var e = 0u; e < edges; e++) {
        sum += lines[e].w * edge_length(e, edges, n);
    }
    return sum;
}

// Length of line e between all others, in the plane with normal n.
fn edge_length(e: u32, edges: u32, n: vec3<f32>) -> f32 {
    let line = lines[e];
    let direction = cross(n, line.xyz);
    // The cell is not longer from any foot.
    var low = -2.0;
    var high = 2.0;
    for (var c = 0u; c < edges; c++) {
        if (c == e) {
            continue;
        }
        let other = lines[c];
        let along = dot(line.xyz, other.xyz);
        let rate = dot(direction, other.xyz);
        if (abs(rate) <= PARALLEL) {
            if (hides(other.w, line.w, along, c < e)) {
                return 0.0;
            }
            continue;
        }
        let reach = (other.w - along * line.w) / rate;
        if (rate > 0.0) {
            high = min(high, reach);
        } else {
            low = max(low, reach);
        }
    }
    return max(high - low, 0.0);
}

// Whether nothing of a plane (or line) at distance d is inside a parallel one at distance `other`. Of two that are the
// same the first one counts.
fn hides(other: f32, d: f32, along: f32, first: bool) -> bool {
    if (along < 0.0) {
        return other + d <= 0.0;
    }
    return other < d || (other == d && first);
}
