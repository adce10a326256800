//! Gravity, damping and time step are numbers that can be used.

use super::rules::{finite, not_negative, positive, refuse};
use crate::error::Result;
use crate::scene::Scene;

impl Scene {
    pub(super) fn check_rock(&self) -> Result<()> {
        let rock = &self.rock;
        finite("rock.gravity", &rock.gravity)?;
        not_negative("rock.mass_damping", rock.mass_damping, "1/s")?;
        positive("rock.largest_overlap", rock.largest_overlap, "")?;
        if !(0.0..=1.0).contains(&rock.corner_area) {
            let message = format!("is {}; give a number from 0 to 1", rock.corner_area);
            return refuse("rock.corner_area", message);
        }
        if let Some(time_step) = rock.time_step {
            positive("rock.time_step", time_step, "s")?;
        }
        if let Some(skin) = rock.skin {
            positive("rock.skin", skin, "m")?;
        }
        if let Some(sleep) = &rock.sleep {
            positive("rock.sleep.speed", sleep.speed, "m/s")?;
            positive("rock.sleep.time", sleep.time, "s")?;
        }
        Ok(())
    }
}
