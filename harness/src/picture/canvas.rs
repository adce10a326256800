//! A bitmap with text, drawn at three times the saved resolution without anti-aliasing; averaging on saving smooths the
//! edges. Alternatively, the same strokes and texts as SVG.

use anyhow::{Context, Result, anyhow, bail};
use plotters::coord::Shift;
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontTransform, register_font};
use std::path::Path;
use std::sync::LazyLock;

/// Drawn pixels per saved pixel, along each axis.
const OVERSAMPLING: u32 = 3;

/// The only font, DejaVu Sans; it is embedded in the program, so that pictures are the same on every machine. A page
/// shows the texts of an SVG in its own font of this name.
const FONT: &str = "sans-serif";

/// Downward shift of digits, relative to the font size: plotters centres a box that is lower than the letters it draws.
/// Measured on this font.
const SINKING: f64 = 0.17;

static FONT_REGISTERED: LazyLock<bool> =
    LazyLock::new(|| register_font(FONT, FontStyle::Normal, dejavu::sans::regular()).is_ok());

/// A picture being drawn; lengths and positions are pixels of the saved picture, y downwards.
pub struct Canvas<'a> {
    width: u32,
    height: u32,
    target: Target<'a>,
}

/// Output of a canvas.
enum Target<'a> {
    /// Red, green and blue of the drawn pixels.
    Bitmap(Vec<u8>),
    /// An SVG with a unit for each drawn pixel.
    Svg(DrawingArea<SVGBackend<'a>, Shift>),
}

/// Position of a text relative to its anchor point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// The point is the middle of the text's left end.
    Left,
    /// The point is the text's middle.
    Centre,
    /// The point is the middle of the text's right end.
    Right,
    /// The text reads upwards, and the point is its middle.
    Upwards,
}

impl<'a> Canvas<'a> {
    /// A white picture of `width` × `height` pixels.
    pub fn new(width: u32, height: u32) -> Self {
        let bytes = 3 * (width * OVERSAMPLING) as usize * (height * OVERSAMPLING) as usize;
        Self {
            width,
            height,
            target: Target::Bitmap(vec![u8::MAX; bytes]),
        }
    }

    /// A picture that is written to `text` as SVG, complete once the canvas is dropped.
    pub fn svg(text: &'a mut String, width: u32, height: u32) -> Self {
        let size = (width * OVERSAMPLING, height * OVERSAMPLING);
        let area = SVGBackend::with_string(text, size).into_drawing_area();
        Self {
            width,
            height,
            target: Target::Svg(area),
        }
    }

    /// Width of the picture, pixels.
    pub fn width(&self) -> f64 {
        f64::from(self.width)
    }

    /// Fills the rectangle between two corners.
    pub fn rectangle(&mut self, from: [f64; 2], to: [f64; 2], colour: RGBColor) -> Result<()> {
        let [from, to] = [pixel(from), pixel(to)];
        // Both corners of plotters' rectangle are inside it.
        let to = (to.0 - 1, to.1 - 1);
        self.draw(&Rectangle::new([from, to], colour.filled()))
    }

    /// Colours every drawn pixel of a bitmap between two corners by its position, given at its centre.
    pub fn shade(
        &mut self,
        from: [f64; 2],
        to: [f64; 2],
        mut colour: impl FnMut([f64; 2]) -> RGBColor,
    ) {
        let Target::Bitmap(pixels) = &mut self.target else {
            return;
        };
        let [from, to] = [pixel(from), pixel(to)];
        let row_bytes = 3 * (self.width * OVERSAMPLING) as usize;
        let clip = |value: i32, size: u32| value.clamp(0, (size * OVERSAMPLING) as i32) as usize;
        for y in clip(from.1, self.height)..clip(to.1, self.height) {
            for x in clip(from.0, self.width)..clip(to.0, self.width) {
                let centre = [x, y].map(|place| (place as f64 + 0.5) / f64::from(OVERSAMPLING));
                let RGBColor(r, g, b) = colour(centre);
                let start = y * row_bytes + 3 * x;
                pixels[start..start + 3].copy_from_slice(&[r, g, b]);
            }
        }
    }

    /// A line through `points` with round joins and ends.
    pub fn line(&mut self, points: &[[f64; 2]], width: f64, colour: RGBColor) -> Result<()> {
        let stroke = (width * f64::from(OVERSAMPLING)).round().max(1.0) as u32;
        let mut places: Vec<(i32, i32)> = points.iter().copied().map(pixel).collect();
        places.dedup();
        for pair in places.windows(2) {
            self.draw(&PathElement::new(pair, colour.stroke_width(stroke)))?;
        }
        // The joins of a stroke of the width of a saved pixel are not visible.
        if stroke > OVERSAMPLING {
            for &place in &places {
                self.draw(&Circle::new(place, stroke / 2, colour.filled()))?;
            }
        }
        Ok(())
    }

    /// A dashed line through `points`, with dashes and gaps of the given lengths.
    pub fn dashed(
        &mut self,
        points: &[[f64; 2]],
        width: f64,
        lengths: [f64; 2],
        colour: RGBColor,
    ) -> Result<()> {
        let [stroke, dash, gap] = [width, lengths[0], lengths[1]]
            .map(|length| (length * f64::from(OVERSAMPLING)).round() as u32);
        let places: Vec<(i32, i32)> = points.iter().copied().map(pixel).collect();
        let style = colour.stroke_width(stroke);
        self.draw(&DashedPathElement::new(places, dash, gap, style))
    }

    /// A filled disc.
    pub fn disc(&mut self, centre: [f64; 2], radius: f64, colour: RGBColor) -> Result<()> {
        let radius = (radius * f64::from(OVERSAMPLING)).round() as i32;
        self.draw(&Circle::new(pixel(centre), radius, colour.filled()))
    }

    /// A filled polygon.
    pub fn polygon(&mut self, corners: &[[f64; 2]], colour: RGBColor) -> Result<()> {
        let corners: Vec<(i32, i32)> = corners.iter().copied().map(pixel).collect();
        self.draw(&Polygon::new(corners, colour.filled()))
    }

    /// A line of text, `size` pixels high from the deepest to the highest letter.
    pub fn text(
        &mut self,
        text: &str,
        at: [f64; 2],
        size: f64,
        anchor: Anchor,
        colour: RGBColor,
    ) -> Result<()> {
        let horizontal = match anchor {
            Anchor::Left => HPos::Left,
            Anchor::Right => HPos::Right,
            Anchor::Centre | Anchor::Upwards => HPos::Center,
        };
        let mut font = font(size)?;
        if anchor == Anchor::Upwards {
            font = font.transform(FontTransform::Rotate270);
        }
        let style = TextStyle::from(font)
            .color(&colour)
            .pos(Pos::new(horizontal, VPos::Center));
        let drop = SINKING * size;
        let at = match anchor {
            Anchor::Upwards => [at[0] + drop, at[1]],
            _ => [at[0], at[1] + drop],
        };
        self.draw(&Text::new(text.to_owned(), pixel(at), style))
    }

    /// Width of `text` at `size`, pixels.
    pub fn text_width(text: &str, size: f64) -> Result<f64> {
        let (width, _) = font(size)?
            .box_size(text)
            .map_err(|error| anyhow!("{error}"))?;
        Ok(f64::from(width) / f64::from(OVERSAMPLING))
    }

    /// Writes the picture as PNG, replacing an older file only when done.
    pub fn save(&self, path: &Path) -> Result<()> {
        write_png(path, [self.width, self.height], &self.rgb())
    }

    /// Red, green and blue of the saved pixels of a bitmap.
    pub fn rgb(&self) -> Vec<u8> {
        let Target::Bitmap(pixels) = &self.target else {
            return Vec::new();
        };
        let factor = OVERSAMPLING as usize;
        let row_bytes = 3 * self.width as usize * factor;
        let mut saved = Vec::with_capacity(pixels.len() / (factor * factor));
        for rows in pixels.chunks(row_bytes * factor) {
            for x in 0..self.width as usize {
                for channel in 0..3 {
                    let mut sum = 0;
                    for row in 0..factor {
                        for column in 0..factor {
                            sum += u32::from(
                                rows[row * row_bytes + 3 * (x * factor + column) + channel],
                            );
                        }
                    }
                    saved.push((sum / (OVERSAMPLING * OVERSAMPLING)) as u8);
                }
            }
        }
        saved
    }

    fn draw<'e, E>(&mut self, element: &'e E) -> Result<()>
    where
        &'e E: plotters::element::PointCollection<'e, (i32, i32)>,
        for<'b> E: plotters::element::Drawable<BitMapBackend<'b>>
            + plotters::element::Drawable<SVGBackend<'b>>,
    {
        let failed = |error: &dyn std::fmt::Display| anyhow!("cannot draw: {error}");
        match &mut self.target {
            Target::Bitmap(pixels) => {
                let size = (self.width * OVERSAMPLING, self.height * OVERSAMPLING);
                let area = BitMapBackend::with_buffer(pixels, size).into_drawing_area();
                area.draw(element).map_err(|error| failed(&error))
            }
            Target::Svg(area) => area.draw(element).map_err(|error| failed(&error)),
        }
    }
}

fn font(size: f64) -> Result<FontDesc<'static>> {
    if !*FONT_REGISTERED {
        bail!("the built-in font {FONT} cannot be read");
    }
    let drawn = size * f64::from(OVERSAMPLING);
    Ok(FontDesc::new(
        FontFamily::Name(FONT),
        drawn,
        FontStyle::Normal,
    ))
}

/// Position of a saved pixel's corner among the drawn pixels.
fn pixel([x, y]: [f64; 2]) -> (i32, i32) {
    let scale = |value: f64| (value * f64::from(OVERSAMPLING)).round() as i32;
    (scale(x), scale(y))
}

/// Writes red, green and blue of `size` pixels, row by row, replacing an older file only when done.
pub fn write_png(path: &Path, size: [u32; 2], rgb: &[u8]) -> Result<()> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size[0], size[1]);
    encoder.set_color(png::ColorType::Rgb);
    encoder
        .write_header()
        .and_then(|mut writer| writer.write_image_data(rgb))
        .with_context(|| format!("{}: cannot encode the picture", path.display()))?;
    Ok(riprap::output::replace(path, |writer| {
        writer.write_all(&bytes)
    })?)
}
