// Monaghan 1992, Annu. Rev. Astron. Astrophys. 30:543, steps bounded by force and sound: the clock after a step, equal steps until the end of the exchange.
// needs clock

// The last of the limits, for all particles: the highest speed, the works of bodies, and the longest step.
@group(0) @binding(0) var<storage, read> limits: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> clock: Clock;

// What lists of neighbours reach beyond the support; negative: they are made for each step.
override SKIN: f32 = -1.0;

@compute @workgroup_size(1)
fn tick() {
    if (clock.step == 0.0) {
        return;
    }
    clock.sorts += clock.stale;
    clock.limit = limits[0].w;
    let speed = limits[0].x;
    clock.fastest = max(clock.fastest, speed);
    let travel = clock.travel + clock.step * (speed + max(speed, clock.body_speed));
    let stale = travel > SKIN || clock.escaped != clock.missed;
    clock.missed = clock.escaped;
    clock.stale = select(0u, 1u, stale);
    clock.travel = select(travel, 0.0, stale);
    clock.pressed += limits[0].y;
    clock.pushed += limits[0].z;
    clock.elapsed += clock.step;
    clock.left -= clock.step;
    clock.steps += 1u;
    // The last of equal steps leaves nothing but rounding.
    let over = clock.left <= 1e-3 * clock.limit;
    let steps = max(ceil(clock.left / clock.limit), 1.0);
    clock.step = select(clock.left / steps, 0.0, over);
}
