// See tight.wgsl.
// needs tight

fn tightness(share: f32) -> f32 {
    return clamp((share - (1.0 - OPENS)) / (OPENS - ROUGH), 0.0, 1.0);
}
