// Clock with atomic fields, for kernels in which many invocations write to it.

struct ClockAtomic {
    step: f32,
    step_limit: f32,
    elapsed: f32,
    remaining: f32,
    steps: u32,
    invalid_particle: atomic<u32>,
    escaped: atomic<u32>,
    overflow: atomic<u32>,
    pending_step: f32,
    boundary_overflow: atomic<u32>,
    stale: u32,
    list_displacement: f32,
    max_body_speed: f32,
    escaped_at_sort: u32,
    sorts: u32,
    max_speed: f32,
    boundary_work: f32,
    penalty_work: f32,
}
