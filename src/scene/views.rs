//! Perspective pictures of the blocks and the fluid around them.

use schemars::JsonSchema;
use serde::Deserialize;

use super::rules::{direction, finite, interval, names, positive, refuse};
use super::{Axis, Scene, SliceField};
use crate::error::Result;

/// A camera: PNG pictures, a strip of them, and an animated PNG.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct View {
    /// Name of the files.
    pub name: String,
    /// Position of the camera, m. Default, without `to` too: seen along `direction`, as near as possible with all
    /// moving blocks of the first picture, all `slices` and, with `traces`, the whole domain in view.
    pub from: Option<[f64; 3]>,
    /// The point in the middle of the picture, m; requires `from`.
    pub to: Option<[f64; 3]>,
    /// The direction in which a camera without `from` looks. Default (−0.45, 0.8, −0.4).
    pub direction: Option<[f64; 3]>,
    /// The direction that is up in the picture. Default against gravity.
    pub up: Option<[f64; 3]>,
    /// Angle between the lower and the upper edge of the picture, degrees. Default 25.
    #[serde(default = "View::usual_field")]
    pub field_of_view: f64,
    /// Width and height, pixels. Default 1280 × 720.
    #[serde(default = "View::usual_size")]
    pub size: [u32; 2],
    /// Speed at the end of the colour scale, m/s: of blocks, or, if there are any, of traces and of slices of `speed`
    /// without a `range`. Default for blocks √(2gL), the speed after a fall through L, the largest extent of a block
    /// that moves; for the fluid the largest in the picture.
    pub speed: Option<f64>,
    /// Planes through the fluid that are shown among the blocks, which then have the colour of stone instead of that
    /// of their speed. Default none.
    #[serde(default)]
    pub slices: Vec<ViewSlice>,
    /// Largest number of streamlines, spread over all of the fluid and coloured by its speed; blocks then have the
    /// colour of stone. Default 0.
    #[serde(default)]
    pub traces: u32,
    /// Height of the ground that is drawn, m, along `up` from the origin. Default none.
    pub ground: Option<f64>,
    /// Time between pictures, s. Default `output.every`.
    pub every: Option<f64>,
    /// Number of pictures in the strip `NAME_strip.png`, spread evenly over the run; 0 for none.
    /// Default 4.
    #[serde(default = "View::usual_strip")]
    pub strip: u32,
    /// Whether all pictures are put into an animation, `NAME.png`. Default true.
    #[serde(default = "View::usual_animation")]
    pub animation: bool,
}

/// A plane through the fluid in a view; cells in static solids are left out.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct ViewSlice {
    /// Normal of the plane.
    pub axis: Axis,
    /// Where the plane cuts the axis, m. Default the middle of the domain.
    pub position: Option<f64>,
    /// Field of the plane; not `solid`.
    pub field: SliceField,
    /// Smallest and largest value of the colours, in the field's unit. Default those in the picture, so that colours
    /// change in an animation; slices of one field share them.
    pub range: Option<[f64; 2]>,
}

impl View {
    /// Largest number of streamlines: more would hide each other.
    pub const MOST_TRACES: u32 = 1000;

    /// Whether it shows the fluid.
    pub fn shows_fluid(&self) -> bool {
        !self.slices.is_empty() || self.traces > 0
    }

    /// Default direction of a camera without `from`.
    pub const USUAL_DIRECTION: [f64; 3] = [-0.45, 0.8, -0.4];

    fn usual_field() -> f64 {
        25.0
    }

    fn usual_size() -> [u32; 2] {
        [1280, 720]
    }

    fn usual_strip() -> u32 {
        4
    }

    fn usual_animation() -> bool {
        true
    }
}

/// Largest edge of a picture: a texture size that every adapter supports.
const LARGEST: u32 = 8192;
/// Smallest edge: anything less shows nothing.
const SMALLEST: u32 = 64;

impl Scene {
    pub(super) fn check_views(&self) -> Result<()> {
        // Slices come first: views must not use their file names.
        let slices = self.output.slices.iter().map(|slice| slice.name.as_str());
        let views = self.views.iter().map(|view| view.name.as_str());
        let count = self.output.slices.len();
        let numbered = slices.chain(views).enumerate();
        names(
            "views",
            numbered.map(|(i, name)| (i.saturating_sub(count), name)),
        )?;
        for (index, view) in self.views.iter().enumerate() {
            self.check_view(&format!("views[{index}]"), view)?;
        }
        Ok(())
    }

    fn check_view(&self, key: &str, view: &View) -> Result<()> {
        self.check_shown(key, view)?;
        let ahead = match (view.from, view.to) {
            (Some(from), Some(to)) => {
                finite(format!("{key}.from"), &from)?;
                finite(format!("{key}.to"), &to)?;
                if view.direction.is_some() {
                    return refuse(
                        format!("{key}.direction"),
                        "follows from `from` and `to`; remove it or them",
                    );
                }
                std::array::from_fn(|a| to[a] - from[a])
            }
            (None, None) => view.direction.unwrap_or(View::USUAL_DIRECTION),
            (Some(_), None) => {
                return refuse(
                    format!("{key}.from"),
                    "says where the camera stands and not where it looks; add `to`",
                );
            }
            (None, Some(_)) => {
                return refuse(
                    format!("{key}.to"),
                    "says where the camera looks and not where it stands; add `from`",
                );
            }
        };
        finite(format!("{key}.direction"), &ahead)?;
        if ahead == [0.0; 3] {
            return refuse(
                key,
                "the camera looks nowhere; give `from` and `to`, or a direction, that is not 0",
            );
        }
        if let Some(up) = &view.up {
            direction(format!("{key}.up"), up)?;
        }
        let up = self.up_of(view);
        let cross = glam::DVec3::from(up).cross(ahead.into()).length();
        let lengths = glam::DVec3::from(up).length() * glam::DVec3::from(ahead).length();
        if cross <= 1e-6 * lengths {
            return refuse(
                format!("{key}.up"),
                "the camera looks along it, so that nothing is up in the picture; give another \
                 direction, such as [0, 1, 0]",
            );
        }
        if !(1.0..=150.0).contains(&view.field_of_view) {
            return refuse(
                format!("{key}.field_of_view"),
                format!(
                    "is {} degrees; give an angle from 1 to 150, such as 35",
                    view.field_of_view
                ),
            );
        }
        for (axis, edge) in view.size.iter().enumerate() {
            if !(SMALLEST..=LARGEST).contains(edge) {
                return refuse(
                    format!("{key}.size[{axis}]"),
                    format!("is {edge} pixels; give {SMALLEST} to {LARGEST}"),
                );
            }
        }
        if let Some(speed) = view.speed {
            positive(format!("{key}.speed"), speed, "m/s")?;
        }
        if let Some(ground) = view.ground {
            finite(format!("{key}.ground"), &[ground])?;
        }
        interval(format!("{key}.every"), view.every)
    }

    /// Checks that the view shows something.
    fn check_shown(&self, key: &str, view: &View) -> Result<()> {
        if !self.has_blocks() && !self.has_particles() && !view.shows_fluid() {
            return refuse(
                key,
                "shows blocks, and there are none; remove it, give it `slices` or `traces` of the \
                 fluid, or add [[blocks]]",
            );
        }
        if !self.has_fluid() && view.shows_fluid() {
            let requested = if view.traces > 0 { "traces" } else { "slices" };
            return refuse(
                format!("{key}.{requested}"),
                "show the fluid, and there is none; remove them or add [fluid]",
            );
        }
        if view.traces > View::MOST_TRACES {
            return refuse(
                format!("{key}.traces"),
                format!(
                    "are {} lines, of which most would be hidden; give 0 to {}, such as 60",
                    view.traces,
                    View::MOST_TRACES
                ),
            );
        }
        for (index, slice) in view.slices.iter().enumerate() {
            let key = format!("{key}.slices[{index}]");
            if slice.field == SliceField::Solid {
                return refuse(
                    format!("{key}.field"),
                    "is `solid`, and slices in a view leave solid cells out; give another field, \
                     such as \"speed\", or use output.slices",
                );
            }
            self.check_plane(&key, slice.axis, slice.position, slice.field, slice.range)?;
        }
        Ok(())
    }

    /// The direction that is up in the picture of `view`: its own, or against gravity, or z.
    pub fn up_of(&self, view: &View) -> [f64; 3] {
        view.up.unwrap_or_else(|| self.up())
    }

    /// The direction against gravity, of any length; z without gravity.
    pub fn up(&self) -> [f64; 3] {
        match self.rock.gravity {
            [0.0, 0.0, 0.0] => [0.0, 0.0, 1.0],
            gravity => gravity.map(|g| -g),
        }
    }
}
