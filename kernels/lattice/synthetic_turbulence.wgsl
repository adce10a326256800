// Kraichnan 1970, Phys. Fluids 13:22; Smirnov, Shi & Celik 2001, J. Fluids Eng. 123:359: turbulence at a velocity inlet, a sum of
// Fourier modes that the mean flow carries in. The amplitudes are normal to (sin kx, sin ky, sin kz), so that central differences
// have no divergence. Phases are fractions of a cycle in 32 bits: their sums wrap and never round.
// needs scalar_grid, moving_cells

struct Mode {
    // Amplitude of the cosine, and cycles per cell along the lower axis of the face.
    a: vec3<f32>,
    lower: u32,
    // Amplitude of the sine, and cycles per cell along the upper axis.
    b: vec3<f32>,
    upper: u32,
    // Mean normal velocity of the mode over the face: of the cosine and of the sine of its phase in the first cell.
    mean: vec2<f32>,
    // Cycles per 2^-16 cell in the normal direction.
    normal: u32,
    phase: u32,
}

const MODES = 66u;

struct TurbulentFace {
    // Modes at unit intensity.
    modes: array<Mode, MODES>,
    // Axis normal to the face.
    axis: u32,
    // Signed distance that the mean flow travels in a step, 2^-16 cell.
    advance: u32,
    // RMS of each component.
    intensity: f32,
}

@group(0) @binding(46) var<uniform> turbulent_face: TurbulentFace;
// Velocities of the faces of each moving cell: three faces, three components each.
@group(0) @binding(41) var<storage, read_write> wall_velocity: array<f32>;
// The cells of this face among the moving cells, and the mean velocity of each.
@group(0) @binding(42) var<storage, read> turbulent_cells: array<u32>;
@group(0) @binding(43) var<storage, read> mean_velocity: array<f32>;
// Distance that the mean flow has travelled before an even and an odd step, 2^-16 cell: one is read, the other written.
@group(0) @binding(44) var<storage, read_write> travelled: array<u32, 2>;

// Cosine and sine of a phase, accurate to 1e-7: sin() of a device may be accurate to 5e-4 only.
fn turn(part: u32) -> vec2<f32> {
    let quarter = (part + 0x20000000u) >> 30u;
    let x = f32(i32(part - (quarter << 30u))) * 1.4629180792671596e-9;
    let y = x * x;
    let s = x * (1.0 + y * (-1.0 / 6.0 + y * (1.0 / 120.0 + y * (-1.0 / 5040.0 + y / 362880.0))));
    let c = 1.0 + y * (-0.5 + y * (1.0 / 24.0 + y * (-1.0 / 720.0 + y / 40320.0)));
    let even = select(vec2(s, c), vec2(c, s), (quarter & 1u) == 0u);
    return vec2(
        select(even.x, -even.x, quarter == 1u || quarter == 2u),
        select(even.y, -even.y, quarter >= 2u),
    );
}

@compute @workgroup_size(64)
fn feed_turbulence(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n >= arrayLength(&turbulent_cells)) {
        return;
    }
    let axis = turbulent_face.axis;
    let distance = travelled[cell_pass.odd];
    if (n == 0u) {
        travelled[1u - cell_pass.odd] = distance + turbulent_face.advance;
    }
    let moving = turbulent_cells[n];
    let cell = padded_cell(moving_cells[moving].cell);
    let lower = select(cell.x, cell.y, axis == 0u);
    let upper = select(cell.z, cell.y, axis == 2u);
    var u = vec3(0.0);
    var mean = 0.0;
    for (var m = 0u; m < MODES; m++) {
        let first = turbulent_face.modes[m].phase - turbulent_face.modes[m].normal * distance;
        let here = turn(first + turbulent_face.modes[m].lower * lower + turbulent_face.modes[m].upper * upper);
        u += turbulent_face.modes[m].a * here.x + turbulent_face.modes[m].b * here.y;
        mean += dot(turbulent_face.modes[m].mean, turn(first));
    }
    // No net flow through the face.
    u -= select(vec3(0.0), vec3(mean), vec3(0u, 1u, 2u) == vec3(axis));
    for (var a = 0u; a < 3u; a++) { // unroll
        wall_velocity[9u * moving + 3u * axis + a] = mean_velocity[3u * n + a] + turbulent_face.intensity * u[a];
    }
}
