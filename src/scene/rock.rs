//! Settings of all blocks.

use schemars::JsonSchema;
use serde::Deserialize;

use super::Scene;
use super::rules::{finite, not_negative, positive, refuse};
use crate::error::Result;

/// Gravity, damping and time step of the blocks.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[non_exhaustive]
pub struct Rock {
    /// Acceleration of gravity, m/s². Default (0, 0, −9.81): z points up.
    pub gravity: [f64; 3],
    /// Mass damping α, 1/s: every free block loses speed at this rate. Default 0.
    pub mass_damping: f64,
    /// Time step, s. Default: half of the largest that the stiffest contact and the elasticity of deformable
    /// blocks allow. A larger one is refused.
    pub time_step: Option<f64>,
    /// Distance by which blocks are enlarged in the broadphase, m: with a larger one the broadphase runs less often
    /// and its lists are longer. Default: chosen from the sizes of the blocks.
    pub skin: Option<f64>,
    /// When resting blocks are left out of the computation until something reaches them. Default never.
    pub sleep: Option<Sleep>,
    /// Largest overlap of two blocks, as a fraction of the smaller one's smallest distance from centroid to face: the
    /// run ends if it is exceeded. Default 0.1, which suits stiff blocks; fast blocks need a larger one or a greater
    /// stiffness.
    pub largest_overlap: f64,
    /// Smallest area used for the stiffness of a contact, as a fraction of the square of twice the smallest distance
    /// from centroid to face: without it corners, whose contact area begins at zero, are soft. A quarter is the share
    /// of one of the four corners of a square face. Strength uses the true area. From 0 to 1, default 0.
    pub corner_area: f64,
    /// Whether blocks that overlap at the start are pushed apart before the time 0. Default false:
    /// they are refused.
    pub relax: bool,
    /// Where the broadphase runs. Default `auto`.
    pub broadphase: BroadphaseBackend,
    /// Number of convex parts from which `auto` uses the device, as measured by `riprap bench --device`. Default 1000 on a GPU,
    /// never on a CPU.
    pub broadphase_crossover: Option<usize>,
}

impl Default for Rock {
    fn default() -> Self {
        Self {
            gravity: [0.0, 0.0, -9.81],
            mass_damping: 0.0,
            time_step: None,
            skin: None,
            sleep: None,
            largest_overlap: 0.1,
            corner_area: 0.0,
            relax: false,
            broadphase: BroadphaseBackend::default(),
            broadphase_crossover: None,
        }
    }
}

/// When a block falls asleep.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sleep {
    /// Speed below which a block counts as resting, m/s; for its spin, that of its farthest point.
    pub speed: f64,
    /// Time for which it must have rested, s.
    pub time: f64,
}

/// Where the broadphase, the search for pairs that may touch, runs; the pairs are bitwise the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BroadphaseBackend {
    /// On the host for fewer parts than `broadphase_crossover`, else on the device if there is one.
    #[default]
    Auto,
    /// On the host; needs no GPU.
    Host,
    /// On the device.
    Device,
}

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
        if rock.broadphase_crossover.is_some() && rock.broadphase != BroadphaseBackend::Auto {
            return refuse(
                "rock.broadphase_crossover",
                "belongs to broadphase = \"auto\"; leave one of them out",
            );
        }
        if let Some(sleep) = &rock.sleep {
            positive("rock.sleep.speed", sleep.speed, "m/s")?;
            positive("rock.sleep.time", sleep.time, "s")?;
        }
        Ok(())
    }
}
