//! Colours of values and of curves.

use plotters::style::RGBColor;

/// Cells without fluid.
pub const SOLID: RGBColor = RGBColor(120, 120, 120);

/// Cells whose value is not a number: a colour that no palette contains.
pub const NOT_A_NUMBER: RGBColor = RGBColor(255, 0, 255);

/// Colours of curves that are distinguishable with colour blindness (Okabe and Ito, 2008), black first.
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

/// A map from values to colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Palette {
    /// Viridis, dark blue to yellow, with evenly increasing lightness.
    Sequential,
    /// Brewer's OrRd, pale over orange to dark red: for shaded bodies, whose lowest value must not be black.
    FromPale,
    /// Brewer's YlGnBu reversed, without the darkest quarter, which would hide the shading: for shaded water, which is blue
    /// at rest.
    FromBlue,
    /// Brewer's RdBu reversed, blue over light grey to red, with zero in the middle.
    Diverging,
}

impl Palette {
    /// The palette and range for values between the ends of `range`: diverging around zero if both signs matter. A side below
    /// a tenth of the other would leave half of the colours unused.
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
        let colour = match self {
            Self::Sequential => colorous::VIRIDIS.eval_continuous(fraction),
            Self::FromPale => colorous::ORANGE_RED.eval_continuous(fraction),
            Self::FromBlue => colorous::YELLOW_GREEN_BLUE.eval_continuous(0.75 * (1.0 - fraction)),
            Self::Diverging => colorous::RED_BLUE.eval_continuous(1.0 - fraction),
        };
        RGBColor(colour.r, colour.g, colour.b)
    }

    /// The colour of lines over this palette.
    pub fn line(self) -> RGBColor {
        match self {
            Self::Sequential => RGBColor(255, 255, 255),
            Self::FromPale | Self::FromBlue => RGBColor(0, 0, 0),
            Self::Diverging => RGBColor(40, 40, 40),
        }
    }
}

/// The sRGB channel (IEC 61966-2-1) of a linear intensity from 0 to 1.
pub fn srgb_of_linear(linear: f64) -> u8 {
    let value = if linear > 0.0031308 {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    } else {
        12.92 * linear
    };
    (255.0 * value.clamp(0.0, 1.0)).round() as u8
}

/// The linear intensity from 0 to 1 of an sRGB channel.
pub fn linear_of_srgb(channel: u8) -> f64 {
    let value = f64::from(channel) / 255.0;
    if value > 0.04045 {
        ((value + 0.055) / 1.055).powf(2.4)
    } else {
        value / 12.92
    }
}
