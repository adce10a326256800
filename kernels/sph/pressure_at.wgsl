// Adami, Hu & Adams 2012, J. Comput. Phys. 231:7057, eq. 27: the pressure of the water around places that somebody asks
// about, continued to them as water at rest, and 0 where there is none; times the length of the step. On walls, water
// that covers only a part of the place presses in proportion.
// needs invocation, particle_grid, $runs, continued, wendland, clock, water_cells

@group(0) @binding(0) var<storage, read> particles: array<Particle>;
// Quanta; the bits of the fourth: 0.0 for the pressure of any water, else one over the share of the kernel that water covers
// where it covers all of the place.
@group(0) @binding(2) var<storage, read> places: array<vec4<i32>>;
@group(0) @binding(3) var<storage, read_write> pressures: array<f32>;
@group(0) @binding(4) var<storage, read> clock: Clock;

// The place.
var<private> here: vec3<i32>;

fn meet_water(j: u32) {
    let other = particles[j];
    let r = between(here, other.at);
    let square = dot(r, r);
    if (square < SUPPORT_SQUARED) {
        let w = weight(sqrt(square));
        add_pressure(w, r, other.excess);
    }
}

@compute @workgroup_size(64)
fn pressure_at(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n >= arrayLength(&places) || clock.step == 0.0) {
        return;
    }
    here = places[n].xyz;
    let cells = vec3(CELLS_X, CELLS_Y, CELLS_Z);
    let cell = cell_of(here);
    if (any(here < vec3(0)) || any(cell >= cells)) {
        return;
    }
    begin_pressure();
    around_water(n, here);
    let most = bitcast<f32>(places[n].w);
    let wet = select(1.0, min(most * weights, 1.0), most > 0.0);
    pressures[n] += clock.step * wet * end_pressure(vec3(0.0));
}
