//! Pictures as PNG files.

use anyhow::{Context, Result};
use std::path::Path;

/// Writes red, green and blue of `size` pixels, row by row, replacing an older file only when done.
///
/// # Errors
/// If the file cannot be written.
pub fn write(path: &Path, size: [u32; 2], rgb: &[u8]) -> Result<()> {
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
