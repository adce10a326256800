// Monaghan 1992, Annu. Rev. Astron. Astrophys. 30:543, step bounds by force and sound: the clock
// after a step. The steps to the end of the exchange are equal.
// needs clock

// Result of the reduction over all particles: largest speed, boundary work, penalty work, and longest step.
@group(0) @binding(0) var<storage, read> limits: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> clock: Clock;

// Skin of the neighbour lists beyond the support, spacings; negative: the lists are rebuilt in each step.
override SKIN: f32;

@compute @workgroup_size(1)
fn advance_clock() {
    if (clock.step == 0.0) {
        return;
    }
    clock.sorts += clock.stale;
    clock.step_limit = limits[0].w;
    let speed = limits[0].x;
    clock.max_speed = max(clock.max_speed, speed);
    let list_displacement = clock.list_displacement + clock.step * (speed + max(speed, clock.max_body_speed));
    let stale = list_displacement > SKIN || clock.escaped != clock.escaped_at_sort;
    clock.escaped_at_sort = clock.escaped;
    clock.stale = select(0u, 1u, stale);
    clock.list_displacement = select(list_displacement, 0.0, stale);
    clock.boundary_work += limits[0].y;
    clock.penalty_work += limits[0].z;
    clock.elapsed += clock.step;
    clock.remaining -= clock.step;
    clock.steps += 1u;
    // The remainder after the last step is rounding error.
    let over = clock.remaining <= 1e-3 * clock.step_limit;
    let steps = max(ceil(clock.remaining / clock.step_limit), 1.0);
    clock.step = select(clock.remaining / steps, 0.0, over);
}
