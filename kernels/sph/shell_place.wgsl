// Adami, Hu & Adams 2012, J. Comput. Phys. 231:7057: the dummy particles of walls and bodies, where these are now.
// needs invocation, particle_grid, $runs, bodies, clock

@group(0) @binding(0) var<storage, read> homes: array<Home>;
@group(0) @binding(1) var<storage, read> motions: array<Motion>;
@group(0) @binding(2) var<storage, read> clock: Clock;
@group(0) @binding(3) var<storage, read_write> unsorted: array<Particle>;
// In the order of their last sort, which is kept.
@group(0) @binding(4) var<storage, read> shell: array<Particle>;

@compute @workgroup_size(64)
fn shell_place(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let n = invocation(group, groups, local);
    if (n >= arrayLength(&homes) || clock.step == 0.0) {
        return;
    }
    let id = shell[n].id;
    let home = homes[id];
    let motion = motions[home.body];
    let velocity = velocity_at(motion, home.place);
    let offset = lever(motion, home.place) + clock.elapsed * velocity;
    let at = wrapped(motion.centre + vec3<i32>(round(offset / QUANTUM)));
    let cells = vec3(CELLS_X, CELLS_Y, CELLS_Z);
    let inside = all(at >= vec3(0)) && all(cell_of(at) < cells);
    unsorted[n] = Particle(select(vec3(-1), at, inside), id, velocity, 0.0);
}
