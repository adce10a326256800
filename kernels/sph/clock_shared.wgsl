// The clock where many write to it: the same fields as Clock.

struct ClockShared {
    step: f32,
    limit: f32,
    elapsed: f32,
    left: f32,
    steps: u32,
    fault: atomic<u32>,
    escaped: atomic<u32>,
    crowd: atomic<u32>,
    held: f32,
    shell_crowd: atomic<u32>,
    stale: u32,
    travel: f32,
    body_speed: f32,
    missed: u32,
    sorts: u32,
    fastest: f32,
    pressed: f32,
    pushed: f32,
}
