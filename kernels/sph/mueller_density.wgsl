// Müller, Charypar & Gross 2003, eq. 3, and Geraili Mikola & Sitar 2014, eq. 12: density as a sum over neighbours.
// needs invocation, cell_grid, $cell_ranges, mueller_kernels, clock, $neighbours

@group(0) @binding(0) var<storage, read_write> particles: array<Particle>;
@group(0) @binding(5) var<storage, read> clock: Clock;

var<private> at: vec3<i32>;
var<private> density: f32;

fn visit_fluid(j: u32, counts: bool) {
    let r = separation(at, particles[j].at);
    let square = dot(r, r);
    let inside = counts & (square < SUPPORT_SQUARED);
    if (is_added(inside)) {
        density += select(0.0, poly6(square), inside);
    }
}

// This scheme has no boundary particles.
fn visit_boundary(j: u32, counts: bool) {}

@compute @workgroup_size(64)
fn mueller_density(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = particle_of(invocation(group, groups, local));
    if (n >= arrayLength(&particles) || clock.step == 0.0) {
        return;
    }
    at = particles[n].at;
    density = 0.0;
    if (at.x >= 0) {
        visit_neighbours(n, at);
        particles[n].excess = density - 1.0;
    }
}
