//! A quantity on a plane through the flow, as a colour map.

use super::axis::{Axis, Scale};
use super::canvas::{Anchor, Canvas};
use super::colour::{Palette, SOLID};
use super::colour_bar::ColourBar;
use super::field_lines::arrows;
use super::frame::{self, FOOT, Frame, INK, TEXT, TITLE};
use super::placed::Placed;
use super::section::{Plane, Quantity, Section};
use super::streamlines::streamlines;
use anyhow::Result;
use riprap::output::ImageData;
use std::path::Path;

/// Width of the picture, pixels.
const WIDTH: f64 = 1400.0;
/// Largest height of the map, pixels; a higher one would not fit a page or a screen.
const HIGHEST: f64 = 1000.0;
/// Space around everything, pixels.
const MARGIN: f64 = 16.0;
/// Ratio of height to width below which the colour bar is under the map instead of next to it.
const FLAT: f64 = 0.35;
/// Distance between streamlines relative to the map's longer edge; about 35 across it.
const SEPARATION: f64 = 1.0 / 35.0;
/// Width of the outline of a block, pixels.
const OUTLINE: f64 = 2.0;
/// Distance between arrow heads on a streamline, in distances between streamlines.
const ARROWS: f64 = 10.0;

/// Content and labels of a slice.
#[derive(Clone, Debug)]
pub struct Slice<'a> {
    /// Title above the map; the plane and the time are added to it.
    pub title: &'a str,
    /// Time of the image, s.
    pub time: f64,
    /// The plane.
    pub plane: Plane,
    /// The quantity on the plane.
    pub quantity: Quantity<'a>,
    /// Name of the quantity at the colour bar.
    pub label: &'a str,
    /// Unit of the quantity.
    pub unit: &'a str,
    /// Range of the colours in that unit, diverging if the ends are equal and opposite; the fluid's extremes if `None`.
    pub range: Option<[f64; 2]>,
    /// Whether to draw streamlines of the velocity in the plane.
    pub streamlines: bool,
    /// Blocks whose sections are drawn over the fluid.
    pub blocks: &'a [Placed<'a>],
}

impl Slice<'_> {
    /// Draws the slice of `image` into a PNG file.
    pub fn draw(&self, image: &ImageData, path: &Path) -> Result<()> {
        let mut section = Section::new(image, self.plane, self.quantity)?;
        section.leave_out(self.blocks);
        let length = matches!(self.quantity, Quantity::Magnitude(_));
        let bar = ColourBar::fitting(self.label, self.unit, self.range, section.fluid(), length)?;
        let (mut canvas, map) = self.layout(&section, &bar)?;
        let opposite = map.opposite();
        // A cell covers many pixels.
        let colour = |cell: usize| {
            // Blocks have their own outlines, also if the image marks their cells as solid.
            if !section.solid[cell] || section.in_blocks[cell] {
                bar.colour(section.values[cell])
            } else {
                SOLID
            }
        };
        let colours: Vec<_> = (0..section.values.len()).map(colour).collect();
        canvas.shade(map.corner, opposite, |place| {
            let cell = section.cell(map.values(place));
            cell.map_or(SOLID, |cell| colours[cell])
        });
        if self.streamlines {
            draw_streamlines(&mut canvas, &map, &section, bar.palette)?;
        }
        for block in self.blocks {
            if let Some(outline) = block.outline(self.plane) {
                draw_block(&mut canvas, &map, &section, &outline)?;
            }
        }
        map.draw(&mut canvas, true)?;
        canvas.save(path)
    }

    /// A canvas with title and colour bar, and the frame of the map on it.
    fn layout(&self, section: &Section, bar: &ColourBar) -> Result<(Canvas<'static>, Frame)> {
        let [x, y] = [0, 1].map(|axis| {
            let range = [section.origin[axis], section.opposite()[axis]];
            Axis::new(section.axes[axis], "m", range, Scale::Linear)
        });
        let ratio = section.cells[1] as f64 / section.cells[0] as f64;
        let flat = ratio < FLAT;
        let head = MARGIN + TITLE + MARGIN;
        let left = (MARGIN + frame::side(&y, HIGHEST)?).ceil();
        let right = if flat {
            // Half of a number extends beyond the end of the axis.
            MARGIN + 2.0 * TEXT
        } else {
            (bar.width(HIGHEST)? + MARGIN).ceil()
        };
        let mut width = WIDTH - left - right;
        let mut height = width * ratio;
        if height > HIGHEST {
            (width, height) = (HIGHEST / ratio, HIGHEST);
        }
        // Whole pixels make edges sharp; the ratio is off by less than one of them.
        let [width, height] = [width, height].map(|length| length.round().max(1.0));
        let plane = match section.layers {
            // A two-dimensional flow has a single plane.
            1 => String::new(),
            _ => format!(", {} = {} m", section.normal, short(self.plane.position)),
        };
        let title = format!("{}{plane}, t = {} s", self.title, short(self.time));
        let shortest = Canvas::text_width(&title, TITLE)? + 2.0 * MARGIN;
        let whole = (left + width + right).max(shortest.min(WIDTH));
        let corner = [(left + 0.5 * (whole - left - width - right)).round(), head];
        let foot = if flat { FOOT + bar.height() } else { FOOT };
        let mut canvas = Canvas::new(whole as u32, (head + height + foot + MARGIN) as u32);
        let size = frame::fitting(&title, TITLE, whole - 2.0 * MARGIN)?;
        let middle = [0.5 * whole, MARGIN + 0.5 * TITLE];
        canvas.text(&title, middle, size, Anchor::Centre, INK)?;
        let map = Frame {
            corner,
            size: [width, height],
            side: left - MARGIN,
            x,
            y,
        };
        if flat {
            bar.draw_below(&mut canvas, &map)?;
        } else {
            bar.draw_beside(&mut canvas, &map)?;
        }
        Ok((canvas, map))
    }
}

/// Draws the section of a block, clipped to the map.
fn draw_block(
    canvas: &mut Canvas<'_>,
    map: &Frame,
    section: &Section,
    outline: &[[f64; 2]],
) -> Result<()> {
    let inside = clipped(outline, section.origin, section.opposite());
    let corners: Vec<[f64; 2]> = inside.iter().map(|&point| map.place(point)).collect();
    let Some(&first) = corners.first() else {
        return Ok(());
    };
    canvas.polygon(&corners, SOLID)?;
    let closed = [&corners[..], &[first]].concat();
    canvas.line(&closed, OUTLINE, INK)
}

/// A convex polygon clipped to the box from `low` to `high` (Sutherland and Hodgman, 1974).
fn clipped(polygon: &[[f64; 2]], low: [f64; 2], high: [f64; 2]) -> Vec<[f64; 2]> {
    let mut left = polygon.to_vec();
    for (axis, sign, edge) in [
        (0, 1.0, low[0]),
        (1, 1.0, low[1]),
        (0, -1.0, high[0]),
        (1, -1.0, high[1]),
    ] {
        let depth = |point: [f64; 2]| sign * (point[axis] - edge);
        let corners = std::mem::take(&mut left);
        let next = corners.iter().cycle().skip(1);
        for (&from, &to) in corners.iter().zip(next) {
            let (here, there) = (depth(from), depth(to));
            if here >= 0.0 {
                left.push(from);
            }
            if (here >= 0.0) != (there >= 0.0) {
                let part = here / (here - there);
                left.push([0, 1].map(|axis| from[axis] + part * (to[axis] - from[axis])));
            }
        }
    }
    left
}

fn draw_streamlines(
    canvas: &mut Canvas<'_>,
    map: &Frame,
    section: &Section,
    palette: Palette,
) -> Result<()> {
    let longest = section.cells[0].max(section.cells[1]) as f64 * section.spacing;
    // Lines closer than two cells would show the grid, not the flow.
    let separation = (SEPARATION * longest).max(2.0 * section.spacing);
    let colour = palette.line();
    for line in streamlines(section, separation) {
        let places: Vec<[f64; 2]> = line.iter().map(|&point| map.place(point)).collect();
        canvas.line(&places, 1.3, colour)?;
        let apart = ARROWS * separation * map.size[0] / (section.opposite()[0] - section.origin[0]);
        for arrow in arrows(&places, apart) {
            let ([x, y], [u, v]) = (places[arrow.point], arrow.towards);
            // Pixels from the middle to the tip, and to either side.
            let (tip, side) = (7.0, 4.5);
            let corners = [
                [x + tip * u, y + tip * v],
                [x - tip * u - side * v, y - tip * v + side * u],
                [x - tip * u + side * v, y - tip * v - side * u],
            ];
            let fluid = |place: &[f64; 2]| {
                let cell = section.cell(map.values(*place));
                cell.is_some_and(|cell| section.is_fluid(cell))
            };
            if corners.iter().all(fluid) {
                canvas.polygon(&corners, colour)?;
            }
        }
    }
    Ok(())
}

/// A number in a title: four digits, without trailing zeros.
pub fn short(value: f64) -> String {
    if value != 0.0 && !(1e-3..1e6).contains(&value.abs()) {
        return format!("{value:.3e}");
    }
    let before = value.abs().max(1.0).log10() as usize;
    let text = format!("{value:.0$}", 3_usize.saturating_sub(before));
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}
