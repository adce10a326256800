//! Many small balls: particles of water.

use super::drawing::{Colours, check_finite};
use super::scales::Scales;
use crate::picture::Palette;
use crate::picture::colour_bar::ColourBar;
use bytemuck::{Pod, Zeroable};
use glam::DVec3;
use riprap::Result;

/// Balls of one size, each with a colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Drops {
    /// The balls.
    pub drops: Vec<Drop>,
    /// Radius of each, m; they are drawn at least as large as a pixel.
    pub radius: f64,
    /// Meaning of their colours.
    pub colours: Colours,
}

/// A small ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drop {
    /// Its centre, m.
    pub centre: DVec3,
    /// The value shown by its colour, in the unit of [`Drops::colours`].
    pub value: f64,
}

/// A ball, as in drop.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Dot {
    /// Centre and radius.
    ball: [f32; 4],
    colour: [u8; 4],
}

impl Drops {
    pub(super) fn bar(&self) -> Result<ColourBar> {
        let values = self.drops.iter().map(|drop| drop.value);
        self.colours.bar("drops", values, Palette::FromBlue, true)
    }

    pub(super) fn check(&self) -> std::result::Result<(), String> {
        check_finite(self.drops.iter().map(|drop| &drop.centre))?;
        if !(self.radius.is_finite() && self.radius > 0.0) {
            return Err(format!(
                "a radius of {} m; give a positive one",
                self.radius
            ));
        }
        match self.drops.iter().find(|drop| !drop.value.is_finite()) {
            Some(drop) => Err(format!("its value is {}; give a finite one", drop.value)),
            None => Ok(()),
        }
    }

    /// The balls relative to `target` (m).
    pub(super) fn dots(&self, target: DVec3, scales: &Scales) -> impl Iterator<Item = Dot> {
        self.drops.iter().map(move |drop| {
            let centre = (drop.centre - target).as_vec3();
            let [r, g, b] = scales.drop(drop.value);
            Dot {
                ball: [centre.x, centre.y, centre.z, self.radius as f32],
                colour: [r, g, b, u8::MAX],
            }
        })
    }
}
