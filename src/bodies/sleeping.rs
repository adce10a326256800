//! Which blocks rest.

use super::{Body, Sleep, body::State};
use glam::DVec3;

impl State {
    /// Speed of its fastest point, m/s.
    pub fn fastest(&self, radius: f64) -> f64 {
        self.velocity.length() + self.spin.length() * radius
    }

    fn pulls(&self) -> [DVec3; 2] {
        [self.force + self.load, self.torque + self.load_torque]
    }

    /// Falls asleep, stays so or wakes at the end of a step of `dt` (s).
    pub fn drowse(&mut self, body: &Body, sleep: &Sleep, gravity: DVec3, dt: f64) {
        let radius = body.shape.radius();
        if self.asleep {
            let [force, torque] = self.pulls();
            let [slept, slept_torque] = self.slept;
            let weight = body.mass * gravity.length();
            let scale = if weight > 0.0 { weight } else { slept.length() };
            let changed = (force - slept).length() > sleep.change * scale
                || (torque - slept_torque).length() > sleep.change * scale * radius;
            if changed {
                self.asleep = false;
                self.slow = 0.0;
            }
            return;
        }
        if self.fastest(radius) >= sleep.speed {
            self.slow = 0.0;
            return;
        }
        self.slow += dt;
        if self.slow >= sleep.after {
            self.asleep = true;
            self.slept = self.pulls();
            self.velocity = DVec3::ZERO;
            self.momentum = DVec3::ZERO;
            self.spin = DVec3::ZERO;
        }
    }
}
