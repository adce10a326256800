// See joint_gap.wgsl.
// needs joint_gap

fn joint_closure(fraction: f32) -> f32 {
    return clamp((fraction - (1.0 - OPEN_GAP)) / (OPEN_GAP - CLOSED_GAP), 0.0, 1.0);
}
