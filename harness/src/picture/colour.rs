//! Colours that mean a value or tell curves apart.

use plotters::style::RGBColor;
use plotters::style::colors::colormaps::ViridisRGB;

/// Cells without fluid.
pub const SOLID: RGBColor = RGBColor(120, 120, 120);

/// Cells whose value is not a number: a colour that neither map has.
pub const NOT_A_NUMBER: RGBColor = RGBColor(255, 0, 255);

/// Colours for curves that also the colour-blind tell apart (Okabe and Ito, 2008), black first.
pub const CURVES: [RGBColor; 8] = [
    RGBColor(0, 0, 0),
    RGBColor(213, 94, 0),
    RGBColor(0, 114, 178),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(150, 140, 30),
];

/// How a value becomes a colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Palette {
    /// Viridis, dark blue to yellow, evenly lighter.
    Sequential,
    /// Pale over orange to dark red: for bodies under light, whose lowest value must not be black.
    FromPale,
    /// Blue over green to pale yellow: for water under light, which at rest must look like it.
    FromBlue,
    /// Blue over light grey to red, the middle being zero.
    Diverging,
}

impl Palette {
    /// The palette and range for values between the ends of `range`: around zero if both signs
    /// matter. A side below a tenth of the other would leave half of the colours unused.
    pub fn fitting([low, high]: [f64; 2]) -> (Self, [f64; 2]) {
        let largest = high.max(-low);
        if low < 0.0 && high > 0.0 && high.min(-low) >= 0.1 * largest {
            (Self::Diverging, [-largest, largest])
        } else {
            (Self::Sequential, [low, high])
        }
    }

    /// The colour at `fraction` of the range, its ends included.
    pub fn colour(self, fraction: f64) -> RGBColor {
        if !fraction.is_finite() {
            return NOT_A_NUMBER;
        }
        let fraction = fraction.clamp(0.0, 1.0);
        match self {
            Self::Sequential => ViridisRGB::get_color(fraction),
            Self::FromPale => between(&FROM_PALE, fraction),
            Self::FromBlue => between(&FROM_BLUE, fraction),
            Self::Diverging => diverging(fraction),
        }
    }

    /// The colour that lines over this palette have.
    pub fn line(self) -> RGBColor {
        match self {
            Self::Sequential => RGBColor(255, 255, 255),
            Self::FromPale | Self::FromBlue => RGBColor(0, 0, 0),
            Self::Diverging => RGBColor(40, 40, 40),
        }
    }
}

/// Brewer, 2003, ColorBrewer's OrRd in nine classes; darker with the value.
const FROM_PALE: [[u8; 3]; 9] = [
    [255, 247, 236],
    [254, 232, 200],
    [253, 212, 158],
    [253, 187, 132],
    [252, 141, 89],
    [239, 101, 72],
    [215, 48, 31],
    [179, 0, 0],
    [127, 0, 0],
];

/// Its YlGnBu in nine classes from the other end, without the two darkest, which have no shades left.
const FROM_BLUE: [[u8; 3]; 7] = [
    [34, 94, 168],
    [29, 145, 192],
    [65, 182, 196],
    [127, 205, 187],
    [199, 233, 180],
    [237, 248, 177],
    [255, 255, 217],
];

/// Straight between the `classes`, which are evenly spaced.
fn between(classes: &[[u8; 3]], fraction: f64) -> RGBColor {
    let place = fraction * (classes.len() - 1) as f64;
    let below = (place as usize).min(classes.len() - 2);
    let part = place - below as f64;
    let [r, g, b] = std::array::from_fn(|c| {
        let [low, high] = [below, below + 1].map(|class| f64::from(classes[class][c]));
        (low + part * (high - low)).round() as u8
    });
    RGBColor(r, g, b)
}

/// Moreland, 2009, "Diverging color maps for scientific visualization": even steps of lightness
/// from either end to the middle, along straight lines in the polar form of CIELAB (Msh).
fn diverging(fraction: f64) -> RGBColor {
    // Magnitude, saturation angle and hue angle of the ends and the middle: his table for the map
    // from (59, 76, 192) to (180, 4, 38). The hue turns on the way to grey, to stay vivid.
    const BLUE: [f64; 3] = [80.0, 1.08, -1.1];
    const BLUE_GREY: [f64; 3] = [88.0, 0.0, -1.661];
    const RED_GREY: [f64; 3] = [88.0, 0.0, 1.061];
    const RED: [f64; 3] = [80.0, 1.08, 0.5];
    let (from, to, part) = if fraction < 0.5 {
        (BLUE, BLUE_GREY, 2.0 * fraction)
    } else {
        (RED_GREY, RED, 2.0 * fraction - 1.0)
    };
    let mix = |index: usize| from[index] + part * (to[index] - from[index]);
    let (magnitude, saturation, hue) = (mix(0), mix(1), mix(2));
    rgb_of_lab(
        magnitude * saturation.cos(),
        magnitude * saturation.sin() * hue.cos(),
        magnitude * saturation.sin() * hue.sin(),
    )
}

/// CIELAB to sRGB, white point D65 (IEC 61966-2-1).
fn rgb_of_lab(lightness: f64, a: f64, b: f64) -> RGBColor {
    let y = (lightness + 16.0) / 116.0;
    let cube = |value: f64| {
        if value > 6.0 / 29.0 {
            value.powi(3)
        } else {
            3.0 * (6.0_f64 / 29.0).powi(2) * (value - 4.0 / 29.0)
        }
    };
    let (x, y, z) = (
        0.95047 * cube(y + a / 500.0),
        cube(y),
        1.08883 * cube(y - b / 200.0),
    );
    RGBColor(
        srgb_of_linear(3.2406 * x - 1.5372 * y - 0.4986 * z),
        srgb_of_linear(-0.9689 * x + 1.8758 * y + 0.0415 * z),
        srgb_of_linear(0.0557 * x - 0.2040 * y + 1.0570 * z),
    )
}

/// A channel of sRGB (IEC 61966-2-1) for a part of the most light.
pub fn srgb_of_linear(linear: f64) -> u8 {
    let value = if linear > 0.0031308 {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    } else {
        12.92 * linear
    };
    (255.0 * value.clamp(0.0, 1.0)).round() as u8
}

/// The part of the most light that a channel of sRGB stands for.
pub fn linear_of_srgb(channel: u8) -> f64 {
    let value = f64::from(channel) / 255.0;
    if value > 0.04045 {
        ((value + 0.055) / 1.055).powf(2.4)
    } else {
        value / 12.92
    }
}
