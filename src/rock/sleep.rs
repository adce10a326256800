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

    /// Wakes a sleeper whose forces have changed. It has been at rest up to now, so that the rest of the
    /// step moves it as it would have moved a block that was awake.
    pub fn wake(&mut self, body: &Body, sleep: &Sleep, gravity: DVec3) {
        let [force, torque] = self.pulls();
        let [slept, slept_torque] = self.slept;
        let weight = body.mass * gravity.length();
        let scale = if weight > 0.0 { weight } else { slept.length() };
        let changed = (force - slept).length() > sleep.change * scale
            || (torque - slept_torque).length() > sleep.change * scale * body.radius;
        if self.asleep && changed {
            self.asleep = false;
            self.slow = 0.0;
        }
    }

    /// Falls asleep at the end of a step of `dt` (s), if it has been slow for long enough.
    pub fn update_sleep(&mut self, body: &Body, sleep: &Sleep, dt: f64) {
        if self.asleep {
            return;
        }
        if self.fastest(body.radius) >= sleep.speed {
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
