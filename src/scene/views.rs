//! Pictures in space: of the blocks, and of the fluid around them.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{Axis, SliceField};

/// A camera: PNG pictures, a strip of them, and an animated PNG.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct View {
    /// Name of the files.
    pub name: String,
    /// Where the camera stands, m. Default, without `to` too: as near as all blocks that move are in
    /// the first picture, with all of the `slices`, and of the domain where there are `traces`, seen
    /// along `direction`.
    pub from: Option<[f64; 3]>,
    /// The point in the middle of the picture, m; with `from` only.
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
    /// Speed of the last colour, m/s: of blocks, or of traces and of slices of `speed` without a
    /// `range` if there are any. Default for blocks √(2gL), the speed after a fall through L, the
    /// largest extent of a block that moves; for the fluid the largest in the picture.
    pub speed: Option<f64>,
    /// Planes through the fluid that are shown among the blocks, which then have the colour of stone
    /// and not of their speed. Default none.
    #[serde(default)]
    pub slices: Vec<ViewSlice>,
    /// Largest number of lines along the flow, spread over all of the fluid and coloured by its
    /// speed; blocks then have the colour of stone. Default 0.
    #[serde(default)]
    pub traces: u32,
    /// Height of the ground that is drawn, m along up from the origin. Default none.
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
pub struct ViewSlice {
    /// Normal of the plane.
    pub axis: Axis,
    /// Where the plane cuts the axis, m. Default the middle of the domain.
    pub position: Option<f64>,
    /// What is shown, but for `solid`.
    pub field: SliceField,
    /// Smallest and largest value of the colours, in the field's unit. Default those in the picture,
    /// which keeps no colour over an animation; slices of one field share them.
    pub range: Option<[f64; 2]>,
}

impl View {
    /// Most lines along the flow: more would hide each other.
    pub const MOST_TRACES: u32 = 1000;

    /// Whether it shows the fluid.
    pub fn shows_fluid(&self) -> bool {
        !self.slices.is_empty() || self.traces > 0
    }

    /// The direction in which a camera looks that is not told where it stands.
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
