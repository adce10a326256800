//! Length of the steps of a scene of particles, which take acoustic steps of their own.

use crate::scene::Scene;

/// Acoustic steps of a step of the scene at most: the water takes as many equal ones as it wants, so that rounding
/// wastes at most a tenth of them where nobody asks for shorter steps.
const ACOUSTIC_STEPS: f64 = 10.0;
/// How far from a whole number of steps the run may end, of a step: rounding.
const ROUNDING: f64 = 1e-6;

/// Length of a step of `scene`, s: at most ten acoustic steps of `acoustic` s, and so that as many whole ones as can be
/// make up the shortest interval of its outputs and its duration.
pub(crate) fn scene_step(scene: &Scene, acoustic: f64) -> f64 {
    let longest = ACOUSTIC_STEPS * acoustic;
    let step = match scene.shortest_interval() {
        // None is shorter than what sound wants.
        Some(every) if every < acoustic => every * (acoustic / every).floor(),
        Some(every) => every / (every / longest).ceil(),
        None => longest,
    };
    let Some(duration) = scene.run.duration else {
        return step;
    };
    let steps = duration / step;
    let whole = steps.round().max(1.0);
    match (steps - whole).abs() < ROUNDING * whole {
        true => duration / whole,
        // The run ends when it is said to.
        false => duration / steps.ceil(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step(duration: f64, every: &str) -> f64 {
        let text = format!(
            r#"domain.size = [2, 2, 2]
            fluid.acceleration = [0, 0, -9.81]
            particles.spacing = 0.1
            water = [{{ kind = "box", size = [1, 1, 0.5], position = [0.5, 0.5, 0.25] }}]
            run.duration = {duration}
            {every}"#
        );
        let scene = Scene::from_toml(&text, ".".as_ref(), "scene.toml").expect("a scene");
        scene_step(&scene, 1e-3)
    }

    #[test]
    fn outputs_come_when_they_are_asked_for() {
        let close = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
        // Nobody asks.
        assert!(close(step(1.0, ""), 0.01));
        assert!(close(step(1.005, ""), 1.005 / 101.0));
        // Every 25 ms in three steps, every 3 ms in one of them, every 0.4 ms as often as sound allows.
        assert!(close(step(1.0, "output.every = 0.025"), 0.025 / 3.0));
        assert!(close(step(3.0, "output.every = 0.003"), 0.003));
        assert!(close(step(1.0, "output.every = 0.0004"), 0.0008));
        // The run ends in time.
        assert!(close(step(1.0, "output.every = 0.003"), 1.0 / 334.0));
    }
}
