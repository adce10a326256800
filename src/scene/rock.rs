//! What holds for all blocks together.

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
    /// Acceleration of gravity, m/s². Default (0, 0, −9.81): unless told otherwise, z points up.
    pub gravity: [f64; 3],
    /// Mass damping α, 1/s: every free block loses speed at this rate. Default 0.
    pub mass_damping: f64,
    /// Time step, s. Default: half of the largest that the stiffest contact and the elasticity of deformable
    /// blocks allow. A larger one is refused.
    pub time_step: Option<f64>,
    /// Distance by which blocks are grown when pairs that may touch are searched, m: a larger one
    /// makes searches rarer and lists longer. Default: chosen from the sizes of the blocks.
    pub skin: Option<f64>,
    /// When blocks that rest are left out of the computation until something reaches them. Default
    /// never.
    pub sleep: Option<Sleep>,
    /// Largest overlap of two blocks, as a part of the smaller one's least distance from centroid to
    /// face: beyond it the run ends. Default 0.1, as hard blocks have it; fast ones need more or a greater
    /// stiffness.
    pub largest_overlap: f64,
    /// Least area that a contact's stiffness counts with, as a part of the square of twice that distance:
    /// corners, whose area begins at zero, are soft without it. A quarter is what one of the four corners
    /// of a square face carries. Strength goes by the true area. From 0 to 1, default 0.
    pub corner_area: f64,
    /// Whether blocks that overlap at the start are pushed apart before the time 0. Default false:
    /// they are refused.
    pub relax: bool,
    /// Where pairs that may touch are searched. Default `auto`.
    pub broadphase: Search,
    /// Convex parts from which on `auto` searches on the device, as `riprap bench --device` measures it. Default 1000 on
    /// a GPU, never on a CPU.
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
            broadphase: Search::default(),
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
    /// How long it must have rested, s.
    pub time: f64,
}

/// Where pairs of blocks that may touch are searched; the pairs are the same, bit for bit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Search {
    /// On the host for fewer parts than `broadphase_crossover`, else on the device if there is one.
    #[default]
    Auto,
    /// On the host; needs no GPU.
    Host,
    /// On the device, as a fluid will need it.
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
        if rock.broadphase_crossover.is_some() && rock.broadphase != Search::Auto {
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
