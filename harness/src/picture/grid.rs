//! Grids of coloured and labelled squares: maps over two lists of values.

use super::canvas::{Anchor, Canvas};
use super::frame::{INK, TITLE, border, fitting};
use anyhow::Result;
use plotters::style::RGBColor;
use std::path::Path;

/// Height of the text next to squares, pixels.
const TEXT: f64 = 16.0;
/// Height of the text in squares, pixels.
const LABEL: f64 = 14.0;
/// Size of a square, pixels: room for a word of seven letters.
const SQUARE: [f64; 2] = [70.0, 27.0];
/// Space around everything and between panels, pixels.
const MARGIN: f64 = 18.0;
/// Largest width of panels in a row, pixels: the width of a screen.
const WIDEST: f64 = 1700.0;

/// A picture of one or more grids over the same two lists.
#[derive(Clone, Debug)]
pub struct ColourGrid {
    /// Title above all panels.
    pub title: String,
    /// What varies along the columns, with its unit.
    pub x: String,
    /// What varies along the rows, with its unit.
    pub y: String,
    /// Meaning of the texts in the squares.
    pub quantity: String,
    /// The values of the columns, from left to right.
    pub columns: Vec<String>,
    /// The values of the rows, from top to bottom.
    pub rows: Vec<String>,
    /// The grids.
    pub panels: Vec<GridPanel>,
    /// Names of the colours.
    pub key: Vec<(String, RGBColor)>,
}

/// One grid.
#[derive(Clone, Debug)]
pub struct GridPanel {
    /// Name above the grid; may be empty.
    pub title: String,
    /// Row by row; `None` for unknown values.
    pub squares: Vec<Option<Square>>,
}

/// A square.
#[derive(Clone, Debug)]
pub struct Square {
    /// Its colour.
    pub colour: RGBColor,
    /// The text in it.
    pub label: String,
    /// Whether its corner is marked by a dot.
    pub marked: bool,
    /// Whether it has a thick frame.
    pub framed: bool,
}

impl ColourGrid {
    /// Draws the grids into a PNG file.
    pub fn draw(&self, path: &Path) -> Result<()> {
        // Row names, and the vertical name of the axis next to them.
        let side = self.widest_row()? + TEXT + 3.0 * 6.0;
        let size = [
            side + self.columns.len() as f64 * SQUARE[0] + MARGIN,
            self.rows.len() as f64 * SQUARE[1] + 4.0 * TEXT + MARGIN,
        ];
        let across = ((WIDEST / size[0]) as usize).clamp(1, self.panels.len().max(1));
        let down = self.panels.len().div_ceil(across);
        let foot = 2.0 * TEXT + MARGIN;
        let quantity = Canvas::text_width(&self.quantity, TEXT)?;
        let key: f64 = self
            .key
            .iter()
            .map(|(text, _)| Ok(Canvas::text_width(text, TEXT)? + 3.5 * TEXT))
            .sum::<Result<f64>>()?;
        let least = quantity.max(key) + 2.0 * MARGIN;
        let width = (across as f64 * size[0] + MARGIN).max(least);
        let height = 2.0 * MARGIN + TITLE + down as f64 * size[1] + foot;
        let mut canvas = Canvas::new(width.ceil() as u32, height.ceil() as u32);
        let title = fitting(&self.title, TITLE, canvas.width() - 2.0 * MARGIN)?;
        let at = [0.5 * canvas.width(), MARGIN + 0.5 * TITLE];
        canvas.text(&self.title, at, title, Anchor::Centre, INK)?;
        for (number, panel) in self.panels.iter().enumerate() {
            let corner = [
                MARGIN + side + (number % across) as f64 * size[0],
                2.0 * MARGIN + TITLE + 1.5 * TEXT + (number / across) as f64 * size[1],
            ];
            self.panel(&mut canvas, panel, corner)?;
        }
        self.legend(&mut canvas, height - foot)?;
        canvas.save(path)
    }

    /// Width of the longest name of a row, pixels.
    fn widest_row(&self) -> Result<f64> {
        let mut widths = self.rows.iter().map(|row| Canvas::text_width(row, TEXT));
        widths.try_fold(0.0, |widest, width| Ok(f64::max(widest, width?)))
    }

    /// A panel whose upper left square begins at `corner`.
    fn panel(&self, canvas: &mut Canvas<'_>, panel: &GridPanel, corner: [f64; 2]) -> Result<()> {
        let count = [self.columns.len(), self.rows.len()];
        let place = |column: usize, row: usize| {
            [
                (corner[0] + column as f64 * SQUARE[0]).round(),
                (corner[1] + row as f64 * SQUARE[1]).round(),
            ]
        };
        let middle = 0.5 * count[0] as f64 * SQUARE[0];
        let above = [corner[0] + middle, corner[1] - 0.8 * TEXT];
        canvas.text(&panel.title, above, TEXT, Anchor::Centre, INK)?;
        for (number, square) in panel.squares.iter().enumerate() {
            let Some(square) = square else { continue };
            let (column, row) = (number % count[0], number / count[0]);
            self.square(
                canvas,
                square,
                place(column, row),
                place(column + 1, row + 1),
            )?;
        }
        for (column, name) in self.columns.iter().enumerate() {
            let [x, y] = place(column, count[1]);
            let at = [x + 0.5 * SQUARE[0], y + 0.8 * TEXT];
            let size = fitting(name, TEXT, SQUARE[0])?;
            canvas.text(name, at, size, Anchor::Centre, INK)?;
        }
        for (row, name) in self.rows.iter().enumerate() {
            let [x, y] = place(0, row);
            let at = [x - 6.0, y + 0.5 * SQUARE[1]];
            canvas.text(name, at, TEXT, Anchor::Right, INK)?;
        }
        let below = [corner[0] + middle, place(0, count[1])[1] + 2.1 * TEXT];
        let size = fitting(&self.x, TEXT, 2.0 * (middle + MARGIN))?;
        canvas.text(&self.x, below, size, Anchor::Centre, INK)?;
        let beside = corner[0] - self.widest_row()? - 12.0 - 0.5 * TEXT;
        let along = count[1] as f64 * SQUARE[1];
        let size = fitting(&self.y, TEXT, along)?;
        let at = [beside, corner[1] + 0.5 * along];
        canvas.text(&self.y, at, size, Anchor::Upwards, INK)
    }

    fn square(
        &self,
        canvas: &mut Canvas<'_>,
        square: &Square,
        from: [f64; 2],
        to: [f64; 2],
    ) -> Result<()> {
        canvas.rectangle(from, to, square.colour)?;
        border(canvas, from, to)?;
        if square.framed {
            let [a, b] = [from.map(|x| x + 2.0), to.map(|x| x - 2.0)];
            let corners = [a, [b[0], a[1]], b, [a[0], b[1]], a];
            canvas.line(&corners, 3.0, INK)?;
        }
        if square.marked {
            canvas.disc([to[0] - 7.0, from[1] + 7.0], 2.5, INK)?;
        }
        if square.label.is_empty() {
            return Ok(());
        }
        let size = fitting(&square.label, LABEL, SQUARE[0] - 8.0)?;
        let at = [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])];
        canvas.text(&square.label, at, size, Anchor::Centre, INK)
    }

    fn legend(&self, canvas: &mut Canvas<'_>, top: f64) -> Result<()> {
        let mut x = MARGIN;
        for (text, colour) in &self.key {
            let from = [x, top];
            canvas.rectangle(from, [x + 1.5 * TEXT, top + TEXT], *colour)?;
            border(canvas, from, [x + 1.5 * TEXT, top + TEXT])?;
            let at = [x + 2.0 * TEXT, top + 0.5 * TEXT];
            canvas.text(text, at, TEXT, Anchor::Left, INK)?;
            x += Canvas::text_width(text, TEXT)? + 3.5 * TEXT;
        }
        let at = [MARGIN, top + 1.8 * TEXT];
        canvas.text(&self.quantity, at, TEXT, Anchor::Left, INK)
    }
}
