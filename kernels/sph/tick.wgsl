// Monaghan 1992, Annu. Rev. Astron. Astrophys. 30:543, steps bounded by force and sound: the clock after a step, equal steps until the end of the exchange.
// needs clock

// The last of the limits: one number for all particles.
@group(0) @binding(0) var<storage, read> limits: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> clock: Clock;

@compute @workgroup_size(1)
fn tick() {
    if (clock.step == 0.0) {
        return;
    }
    clock.limit = limits[0].w;
    clock.elapsed += clock.step;
    clock.left -= clock.step;
    clock.steps += 1u;
    // The last of equal steps leaves nothing but rounding.
    let over = clock.left <= 1e-3 * clock.limit;
    let steps = max(ceil(clock.left / clock.limit), 1.0);
    clock.step = select(clock.left / steps, 0.0, over);
}
