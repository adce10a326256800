//! Pictures of the blocks.

use schemars::JsonSchema;
use serde::Deserialize;

/// A camera: PNG pictures, a strip of them, and an animated PNG.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct View {
    /// Name of the files.
    pub name: String,
    /// Where the camera stands, m.
    pub from: [f64; 3],
    /// The point in the middle of the picture, m.
    pub to: [f64; 3],
    /// The direction that is up in the picture. Default against gravity.
    pub up: Option<[f64; 3]>,
    /// Angle between the lower and the upper edge of the picture, degrees. Default 35.
    #[serde(default = "View::usual_field")]
    pub field_of_view: f64,
    /// Width and height, pixels. Default 1280 × 720.
    #[serde(default = "View::usual_size")]
    pub size: [u32; 2],
    /// Speed of the last colour, m/s. Default √(2gL), the speed after a fall through L, the largest
    /// extent of a block that moves.
    pub speed: Option<f64>,
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

impl View {
    fn usual_field() -> f64 {
        35.0
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
