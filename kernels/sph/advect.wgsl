// Position of a particle at the end of a step. Marks particles with a non-finite state and particles that leave the domain.
// needs cell_grid, $cell_ranges, clock_atomic

@group(0) @binding(5) var<storage, read_write> moved: array<Particle>;
@group(0) @binding(6) var<storage, read_write> clock: ClockAtomic;

// Half-open range of coordinates of particles that have not escaped, quanta.
override KEPT_FROM_X: i32;
override KEPT_FROM_Y: i32;
override KEPT_FROM_Z: i32;
override KEPT_TO_X: i32;
override KEPT_TO_Y: i32;
override KEPT_TO_Z: i32;

// `particle` has its new velocity and density, and its old position.
fn advect(n: u32, particle: Particle) {
    var here = particle;
    // An exponent of all ones: infinite or NaN.
    let bits = bitcast<vec4<u32>>(vec4(here.velocity, here.excess)) & vec4(0x7f800000u);
    if (any(bits == vec4(0x7f800000u))) {
        atomicMax(&clock.invalid_particle, here.id + 1u);
        moved[n] = Particle(here.at, here.id, vec3(0.0), 0.0);
        return;
    }
    let unwrapped = here.at + vec3<i32>(round(clock.step * here.velocity / QUANTUM));
    let at = wrapped(unwrapped);
    if (any(unwrapped != at)) {
        let crossing = sign(unwrapped - at);
        atomicAdd(&clock.crossings_x, crossing.x);
        atomicAdd(&clock.crossings_y, crossing.y);
        atomicAdd(&clock.crossings_z, crossing.z);
    }
    let from_ = vec3(KEPT_FROM_X, KEPT_FROM_Y, KEPT_FROM_Z);
    let to = vec3(KEPT_TO_X, KEPT_TO_Y, KEPT_TO_Z);
    if (any(at < from_) || any(at >= to)) {
        atomicAdd(&clock.escaped, 1u);
        // The sign marks the particle as escaped; its state stays for the energy ledger.
        here.at = vec3(-1 - max(at.x, 0), at.y, at.z);
        moved[n] = here;
        return;
    }
    here.at = at;
    moved[n] = here;
}
