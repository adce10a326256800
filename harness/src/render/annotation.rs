//! Title, time, colour bars and scale bar around a view, or around several views next to each other.

use super::camera::Camera;
use super::drawing::Drawing;
use super::picture::Picture;
use super::renderer::Renderer;
use super::scales::Scales;
use super::uniforms::round_down;
use crate::picture::canvas::{Anchor, Canvas};
use crate::picture::colour_bar::ColourBar;
use crate::picture::frame::{Frame, INK, TEXT, TITLE, fitting};
use crate::picture::{Axis, Scale};
use anyhow::{Result, bail};
use plotters::style::RGBColor;

/// Margin around text, pixels.
const MARGIN: f64 = 18.0;
/// Height of a colour bar relative to the view's.
const BAR: f64 = 0.7;
/// Largest width of the scale bar relative to the view's.
const SCALE_BAR: f64 = 0.2;
/// Half of the height of the scale bar's ends, pixels.
const SCALE_BAR_END: f64 = 5.0;
/// Smallest view, pixels.
const LEAST: f64 = 16.0;

/// Positions of the elements of a picture.
pub struct Layout {
    size: [u32; 2],
    /// Height above the view for the title.
    head: f64,
    /// Width next to the view for the colour bars.
    side: f64,
    bars: Vec<ColourBar>,
}

impl Layout {
    pub fn new(drawing: &Drawing<'_>, size: [u32; 2]) -> Result<Self> {
        let titled = !drawing.title.is_empty() || drawing.time.is_some();
        let head = if titled { 2.0 * MARGIN + TITLE } else { 0.0 };
        let [width, height] = size.map(f64::from);
        let bars: Vec<ColourBar> = Scales::of(drawing)?.bars().into_iter().cloned().collect();
        let side = bars_width(&bars, BAR * (height - head))?;
        let side = if bars.is_empty() {
            0.0
        } else {
            (side + MARGIN).ceil()
        };
        if width - side < LEAST || height - head < LEAST {
            bail!(
                "a picture of {width} × {height} pixels has no room for title and colour bars; \
                 give a larger one"
            );
        }
        Ok(Self {
            size,
            head,
            side,
            bars,
        })
    }

    /// Width and height of the view, pixels.
    pub fn view_size(&self) -> [u32; 2] {
        let [width, height] = self.size;
        [width - self.side as u32, height - self.head as u32]
    }

    /// Adds the annotations around and over the view.
    pub fn finish(
        &self,
        drawing: &Drawing<'_>,
        camera: &Camera,
        view: &Picture,
    ) -> Result<Picture> {
        let [width, height] = self.size;
        let mut canvas = Canvas::new(width, height);
        paste(&mut canvas, view, [0.0, self.head]);
        self.title(&mut canvas, drawing)?;
        draw_bars(&mut canvas, &self.bars, [0.0, self.head], self.view_size())?;
        if drawing.scale_bar {
            scale_bar(&mut canvas, camera, [0.0, self.head], self.view_size())?;
        }
        Ok(picture(&canvas, self.size))
    }

    /// Draws the title on the left and the time on the right.
    fn title(&self, canvas: &mut Canvas<'_>, drawing: &Drawing<'_>) -> Result<()> {
        let width = f64::from(self.size[0]);
        let middle = MARGIN + 0.5 * TITLE;
        let mut room = width - 2.0 * MARGIN;
        if let Some(time) = drawing.time {
            let text = time_stamp(time);
            let at = [width - MARGIN, middle];
            canvas.text(&text, at, TEXT, Anchor::Right, INK)?;
            room -= Canvas::text_width(&text, TEXT)? + MARGIN;
        }
        if !drawing.title.is_empty() && room > 0.0 {
            let size = fitting(&drawing.title, TITLE, room)?;
            canvas.text(&drawing.title, [MARGIN, middle], size, Anchor::Left, INK)?;
        }
        Ok(())
    }
}

/// Width of colour bars of this height next to a view, pixels.
fn bars_width(bars: &[ColourBar], height: f64) -> Result<f64> {
    let widths = bars.iter().map(|bar| bar.width(height));
    widths.sum()
}

/// Draws colour bars to the right of a view of this corner and size, from left to right.
fn draw_bars(
    canvas: &mut Canvas<'_>,
    bars: &[ColourBar],
    corner: [f64; 2],
    size: [u32; 2],
) -> Result<()> {
    let [width, height] = size.map(f64::from);
    let axis = Axis::new("", "", [0.0, 1.0], Scale::Linear);
    let high = (BAR * height).round();
    let mut map = Frame {
        corner: [corner[0], corner[1] + (0.5 * (height - high)).round()],
        size: [width, high],
        side: 0.0,
        x: axis.clone(),
        y: axis,
    };
    for bar in bars {
        bar.draw_beside(canvas, &map)?;
        map.size[0] += bar.width(high)?;
    }
    Ok(())
}

/// Copies a picture onto the canvas.
fn paste(canvas: &mut Canvas<'_>, picture: &Picture, [left, top]: [f64; 2]) {
    let [width, height] = [picture.width, picture.height].map(f64::from);
    canvas.shade([left, top], [left + width, top + height], |[x, y]| {
        let [r, g, b] = picture.pixel((x - left) as u32, (y - top) as u32);
        RGBColor(r, g, b)
    });
}

/// The canvas as a picture.
fn picture(canvas: &Canvas<'_>, [width, height]: [u32; 2]) -> Picture {
    let pixels = canvas.rgb();
    let pixels = pixels.chunks_exact(3);
    Picture {
        width,
        height,
        rgba: pixels.flat_map(|p| [p[0], p[1], p[2], u8::MAX]).collect(),
    }
}

/// Draws a bar in the lower left corner of a view, with its length in metres at the camera's target.
fn scale_bar(
    canvas: &mut Canvas<'_>,
    camera: &Camera,
    [left, top]: [f64; 2],
    [width, height]: [u32; 2],
) -> Result<()> {
    let (length, pixels) = scale(camera, [width, height]);
    let y = (top + f64::from(height) - MARGIN - SCALE_BAR_END).round();
    let [from, to] = [left + MARGIN, left + MARGIN + pixels];
    canvas.line(&[[from, y], [to, y]], 2.0, INK)?;
    for x in [from, to] {
        let ends = [[x, y - SCALE_BAR_END], [x, y + SCALE_BAR_END]];
        canvas.line(&ends, 2.0, INK)?;
    }
    let text = format!("{} m", decimal(length));
    let at = [0.5 * (from + to), y - SCALE_BAR_END - 0.6 * TEXT];
    canvas.text(&text, at, TEXT, Anchor::Centre, INK)
}

/// Length of the scale bar of a view, m and pixels.
fn scale(camera: &Camera, [width, height]: [u32; 2]) -> (f64, f64) {
    let pixels_per_metre = camera.pixels_per_metre(f64::from(height));
    let length = round_down(SCALE_BAR * f64::from(width) / pixels_per_metre);
    (length, length * pixels_per_metre)
}

/// A time as text.
fn time_stamp(time: f64) -> String {
    format!("t = {} s", crate::picture::short(time))
}

/// 1, 2 or 5 times a power of ten, without digits from rounding.
fn decimal(value: f64) -> String {
    let decimals = (-value.log10().floor()).max(0.0) as usize;
    format!("{value:.decimals$}")
}

/// Gap between frames and around text, pixels.
const GAP: f64 = 12.0;

impl Renderer {
    /// Drawings as the frames of one picture, `columns` in a row, each of the renderer's size with its time above; title,
    /// colour bars and scale bar are those of the first.
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
