// Adami, Hu & Adams 2012, J. Comput. Phys. 231:7057, eq. 27: the pressure of the water at probes, extrapolated as in
// water at rest, and 0 without water, integrated over time. A wall probe that water covers only in part gets the
// proportional part of the pressure.
// needs invocation, cell_grid, $cell_ranges, extrapolated_pressure, wendland, clock, fluid_neighbours_cells

@group(0) @binding(0) var<storage, read> particles: array<Particle>;
// Position, quanta. The fourth component has the bits of a float: 0.0 for a probe in the water; for a wall probe, one over
// the fraction of the kernel that water in front of the wall can cover.
@group(0) @binding(2) var<storage, read> probes: array<vec4<i32>>;
@group(0) @binding(3) var<storage, read_write> pressures: array<f32>;
@group(0) @binding(4) var<storage, read> clock: Clock;

// The probe.
var<private> here: vec3<i32>;

fn visit_fluid(j: u32, counts: bool) {
    let other = particles[j];
    let r = separation(here, other.at);
    let square = dot(r, r);
    let inside = counts & (square < SUPPORT_SQUARED);
    if (is_added(inside)) {
        let w = select(0.0, weight(sqrt(square)), inside);
        add_pressure(w, r, other.excess);
    }
}

@compute @workgroup_size(64)
fn pressure_probes(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n >= arrayLength(&probes) || clock.step == 0.0) {
        return;
    }
    here = probes[n].xyz;
    let cells = vec3(CELLS_X, CELLS_Y, CELLS_Z);
    let cell = cell_of(here);
    if (any(here < vec3(0)) || any(cell >= cells)) {
        return;
    }
    reset_pressure();
    visit_fluid_neighbours(n, here);
    let full_weight = bitcast<f32>(probes[n].w);
    let covered = select(1.0, min(full_weight * weights, 1.0), full_weight > 0.0);
    pressures[n] += clock.step * covered * extrapolated_pressure(vec3(0.0));
}
