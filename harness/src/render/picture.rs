//! Finished pictures and animations.

use anyhow::{Context, Result, anyhow, bail};
use std::{path::Path, time::Duration};

/// Pixels, row by row from the upper left.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green, blue (sRGB) and opacity of each pixel.
    pub rgba: Vec<u8>,
}

impl Picture {
    /// Colour of the pixel at column `x` and row `y`; white outside.
    pub fn pixel(&self, x: u32, y: u32) -> [u8; 3] {
        let at = 4 * (y as usize * self.width as usize + x as usize);
        match self.rgba.get(at..at + 3) {
            Some(rgb) if x < self.width => [rgb[0], rgb[1], rgb[2]],
            _ => [u8::MAX; 3],
        }
    }

    /// Writes the picture as PNG without opacity, replacing an older file only when done.
    pub fn save(&self, path: &Path) -> Result<()> {
        crate::picture::canvas::write_png(path, [self.width, self.height], &self.rgb())
    }

    /// Reads a file written by [`Self::save`].
    pub fn load(path: &Path) -> Result<Self> {
        let place = || format!("{}: cannot read the picture", path.display());
        let file = std::fs::File::open(path).with_context(place)?;
        let decoder = png::Decoder::new(std::io::BufReader::new(file));
        let mut reader = decoder.read_info().with_context(place)?;
        let size = reader.output_buffer_size().with_context(place)?;
        let mut rgb = vec![0; size];
        let info = reader.next_frame(&mut rgb).with_context(place)?;
        if info.color_type != png::ColorType::Rgb || info.bit_depth != png::BitDepth::Eight {
            bail!("{}: not a picture of this program", path.display());
        }
        let opaque = |rgb: &[u8]| [rgb[0], rgb[1], rgb[2], u8::MAX];
        Ok(Self {
            width: info.width,
            height: info.height,
            rgba: rgb.chunks_exact(3).flat_map(opaque).collect(),
        })
    }

    /// Pixels without opacity.
    pub(super) fn rgb(&self) -> Vec<u8> {
        let pixels = self.rgba.chunks_exact(4);
        pixels.flat_map(|rgba| &rgba[..3]).copied().collect()
    }
}

/// Writes `count` frames of one size as an animated PNG file that loops forever, each frame shown for `delay`. Frames are
/// drawn one after the other, so that only their compressed bytes are kept in memory.
pub fn animate(
    path: &Path,
    count: u32,
    delay: Duration,
    frames: impl IntoIterator<Item = Result<Picture>>,
) -> Result<()> {
    let mut frames = frames.into_iter();
    let Some(first) = frames.next().transpose()? else {
        bail!("{}: an animation of no frames", path.display());
    };
    let milliseconds = u16::try_from(delay.as_millis())
        .map_err(|_| anyhow!("a frame for {delay:?}: at most 65 s are possible"))?;
    let place = || format!("{}: cannot encode the animation", path.display());
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, first.width, first.height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_animated(count, 0).with_context(place)?;
    encoder
        .set_frame_delay(milliseconds, 1000)
        .with_context(place)?;
    let mut writer = encoder.write_header().with_context(place)?;
    let size = [first.width, first.height];
    let mut drawn = 0;
    for frame in std::iter::once(Ok(first)).chain(frames) {
        let frame = frame?;
        drawn += 1;
        if [frame.width, frame.height] != size {
            bail!(
                "{}: frame {drawn} has {} × {} pixels, the first {} × {}",
                path.display(),
                frame.width,
                frame.height,
                size[0],
                size[1]
            );
        }
        if drawn > count {
            break;
        }
        writer.write_image_data(&frame.rgb()).with_context(place)?;
    }
    if drawn != count {
        bail!(
            "{}: {drawn} frames or more, {count} were announced",
            path.display()
        );
    }
    writer.finish().with_context(place)?;
    Ok(riprap::output::replace(path, |writer| {
        writer.write_all(&bytes)
    })?)
}
