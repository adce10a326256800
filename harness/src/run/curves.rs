//! The curves of a table over time, beside it: `NAME.png`.

use super::recorder::RunLog;
use crate::picture::{Chart, Track};
use anyhow::{Result, anyhow};
use riprap::{output::Table, scene::Scene};
use std::path::Path;

/// Draws `tracks` of the table at `path`; nothing where it has fewer than two moments, or no number in them.
pub fn draw(
    scene: &Scene,
    path: &Path,
    title: &str,
    tracks: &[Track<'_>],
    log: &mut RunLog,
) -> Result<()> {
    let table = Table::read(path)?;
    let is_empty = |name: &&str| {
        let values = table.column(name).unwrap_or_default();
        !values.iter().any(|value| value.is_finite())
    };
    let mut columns = tracks.iter().flat_map(|track| track.columns);
    if columns.all(is_empty) || table.column("time").is_none_or(|times| times.len() < 2) {
        return Ok(());
    }
    let picture = path.with_extension("png");
    let name = path.file_stem().and_then(|stem| stem.to_str());
    let mut views = scene.views.iter().filter(|view| view.animation);
    let drawn = match views.any(|view| Some(&*view.name) == name) {
        true => Err(anyhow!(
            "this file belongs to the view of the same name; give one of them another name"
        )),
        false => Chart::history(title, &table, tracks).and_then(|chart| chart.draw(&picture)),
    };
    log.picture(picture, drawn);
    Ok(())
}
