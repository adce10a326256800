//! Moving pictures.

use super::picture::Picture;
use anyhow::{Context, Result, anyhow, bail};
use std::path::Path;
use std::time::Duration;

/// Writes `count` frames of one size as an animated PNG file that plays for ever, each frame shown for
/// `delay`. Frames are drawn one after the other, so that only their compressed bytes are held.
///
/// # Errors
/// Those of the frames; if they are not `count` or of different sizes; if the file cannot be written.
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
