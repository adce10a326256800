//! Frames side by side.

use super::annotation::{BAR, bars_width, draw_bars, paste, picture, scale_bar, time_stamp};
use super::drawing::Drawing;
use super::picture::Picture;
use super::renderer::Renderer;
use super::scales::Scales;
use crate::picture::canvas::{Anchor, Canvas};
use crate::picture::frame::{INK, TEXT, TITLE, fitting};
use anyhow::{Result, bail};

/// Between frames and around text, pixels.
const GAP: f64 = 12.0;

impl Renderer {
    /// Drawings as the frames of one picture, `columns` in a row, each of the renderer's size with its
    /// time above; title, colour bars and scale bar are those of the first.
    ///
    /// # Errors
    /// Those of [`Self::render`]; if there is no drawing or no column; if the drawings' colours mean
    /// different values.
    pub fn strip(&self, drawings: &[Drawing<'_>], columns: usize) -> Result<Picture> {
        let Some(first) = drawings.first().filter(|_| columns > 0) else {
            bail!("a strip of no frames or no columns; give one at least");
        };
        let scales = Scales::of(first)?;
        let bars: Vec<_> = scales.bars().into_iter().cloned().collect();
        for (index, drawing) in drawings.iter().enumerate() {
            if Scales::of(drawing)?.bars() != scales.bars() {
                bail!(
                    "frame {index} has other colours than the first: give all of them the same \
                     colours.range"
                );
            }
        }
        let size = self.size();
        let [frame_width, frame_height] = size.map(f64::from);
        let columns = columns.min(drawings.len());
        let rows = drawings.len().div_ceil(columns);
        let head = match first.title.is_empty() {
            true => 0.0,
            false => 2.0 * GAP + TITLE,
        };
        let timed = drawings.iter().any(|drawing| drawing.time.is_some());
        let label = if timed { TEXT + 1.5 * GAP } else { 0.0 };
        let width = columns as f64 * (frame_width + GAP) - GAP;
        let row = label + frame_height + GAP;
        let height = rows as f64 * row - GAP;
        let side = match bars.is_empty() {
            true => 0.0,
            false => (bars_width(&bars, BAR * height)? + GAP).ceil(),
        };
        let whole = [(width + side) as u32, (head + height) as u32];
        let mut canvas = Canvas::new(whole[0], whole[1]);
        if head > 0.0 {
            let text = fitting(&first.title, TITLE, f64::from(whole[0]) - 2.0 * GAP)?;
            let at = [GAP, GAP + 0.5 * TITLE];
            canvas.text(&first.title, at, text, Anchor::Left, INK)?;
        }
        for (index, drawing) in drawings.iter().enumerate() {
            let left = (index % columns) as f64 * (frame_width + GAP);
            let top = head + (index / columns) as f64 * row;
            let (camera, view) = self.view(drawing, size)?;
            paste(&mut canvas, &view, [left, top + label]);
            if let Some(time) = drawing.time {
                let at = [left + 0.5 * frame_width, top + 0.5 * label];
                canvas.text(&time_stamp(time), at, TEXT, Anchor::Centre, INK)?;
            }
            if index == 0 && drawing.scale_bar {
                scale_bar(&mut canvas, &camera, [left, top + label], size)?;
            }
        }
        draw_bars(
            &mut canvas,
            &bars,
            [0.0, head],
            [width as u32, height as u32],
        )?;
        Ok(picture(&canvas, whole))
    }
}
