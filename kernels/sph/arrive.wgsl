// Where a particle is at the end of a step, and what becomes of one that is nowhere or has left.
// needs particle_grid, $runs, clock_shared

@group(0) @binding(5) var<storage, read_write> moved: array<Particle>;
@group(0) @binding(6) var<storage, read_write> clock: ClockShared;

// Where a particle is still in the domain or not yet through a wall, quanta.
override KEPT_FROM_X: i32 = 0;
override KEPT_FROM_Y: i32 = 0;
override KEPT_FROM_Z: i32 = 0;
override KEPT_TO_X: i32 = 0;
override KEPT_TO_Y: i32 = 0;
override KEPT_TO_Z: i32 = 0;

// `particle` has its new velocity and density, and is where it was.
fn arrive(n: u32, particle: Particle) {
    var here = particle;
    // Exponents of all ones: neither infinite nor undefined numbers may become places.
    let bits = bitcast<vec4<u32>>(vec4(here.velocity, here.excess)) & vec4(0x7f800000u);
    if (any(bits == vec4(0x7f800000u))) {
        atomicMax(&clock.fault, here.id + 1u);
        moved[n] = Particle(here.at, here.id, vec3(0.0), 0.0);
        return;
    }
    let at = wrapped(here.at + vec3<i32>(round(clock.step * here.velocity / QUANTUM)));
    let from_ = vec3(KEPT_FROM_X, KEPT_FROM_Y, KEPT_FROM_Z);
    let to = vec3(KEPT_TO_X, KEPT_TO_Y, KEPT_TO_Z);
    if (any(at < from_) || any(at >= to)) {
        atomicAdd(&clock.escaped, 1u);
        // With the energy that it had.
        here.at = vec3(-1 - max(at.x, 0), at.y, at.z);
        moved[n] = here;
        return;
    }
    here.at = at;
    moved[n] = here;
}
