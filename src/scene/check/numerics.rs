//! The numerics do not contradict each other.

use super::rules::{positive, refuse};
use crate::error::Result;
use crate::scene::{Collision, Scene, Storage};

impl Scene {
    pub(super) fn check_numerics(&self) -> Result<()> {
        let n = &self.numerics;
        if n.time_step.is_some() && n.mach.is_some() {
            return refuse(
                "numerics.mach",
                "`time_step` and `mach` both fix the time step; keep one of them",
            );
        }
        let optional = [
            ("time_step", n.time_step, "s"),
            ("mach", n.mach, ""),
            ("velocity_scale", n.velocity_scale, "m/s"),
            ("lambda", n.lambda, ""),
            ("wall_lambda", Some(n.wall_lambda), ""),
            ("solid_lambda", Some(n.solid_lambda), ""),
        ];
        for (key, value, unit) in optional {
            if let Some(value) = value {
                positive(format!("numerics.{key}"), value, unit)?;
            }
        }
        if !(n.wale_constant.is_finite() && n.wale_constant >= 0.0) {
            return refuse(
                "numerics.wale_constant",
                format!("is {}; give a number from 0, such as 0.5", n.wale_constant),
            );
        }
        // A relaxation rate of 2 or more amplifies.
        if !(0.0..2.0).contains(&n.odd_rate_floor) {
            return refuse(
                "numerics.odd_rate_floor",
                format!(
                    "is {}; a rate lies from 0 to below 2, such as 0.8",
                    n.odd_rate_floor
                ),
            );
        }
        if n.lambda.is_some() && n.collision != Collision::Hermite {
            return refuse(
                "numerics.lambda",
                "only `collision = \"hermite\"` has a magic parameter to set; remove `lambda` or \
                 choose hermite",
            );
        }
        self.check_lanes()
    }

    fn check_lanes(&self) -> Result<()> {
        let key = "numerics.lanes";
        match (self.numerics.lanes, self.numerics.storage) {
            (None | Some(4), _) | (Some(1), Storage::F32) | (Some(2), Storage::F16) => Ok(()),
            (Some(1), Storage::F16) => refuse(
                key,
                "storage f16 packs two cells in a word and so needs lanes = 2 or 4; change \
                 `lanes`, leave it out, or use storage = \"f32\"",
            ),
            (Some(2), Storage::F32) => refuse(
                key,
                "lanes = 2 belongs to storage = \"f16\"; use lanes = 1 or 4, or leave it out",
            ),
            (Some(lanes), _) => refuse(key, format!("is {lanes}; possible are 1, 2 and 4")),
        }
    }
}
