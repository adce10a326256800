//! A plane cut out of an image.

use super::placed::{Placed, centres};
use anyhow::{Context, Result, bail};
use glam::DVec3;
use riprap::output::{Array, Image};

/// A plane normal to an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// The axis it is normal to: 0 for x, 1 for y, 2 for z.
    pub normal: usize,
    /// Where it cuts that axis, m.
    pub position: f64,
}

impl Plane {
    /// The axes that lie in it, in their order.
    pub fn others(&self) -> [usize; 2] {
        match self.normal {
            0 => [1, 2],
            1 => [0, 2],
            _ => [0, 1],
        }
    }
}

/// What is shown of an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity<'a> {
    /// The array of scalars of this name.
    Scalar(&'a str),
    /// The length of the vectors of the array of this name.
    Magnitude(&'a str),
}

/// Values on the cells that a plane passes through, the first axis running fastest.
#[derive(Clone, Debug)]
pub struct Section {
    /// Names of the two axes.
    pub axes: [&'static str; 2],
    /// Name of the axis that it is normal to.
    pub normal: &'static str,
    /// Number of cells along that axis in the image.
    pub layers: usize,
    /// Lower corner, m.
    pub origin: [f64; 2],
    /// Cell size, m.
    pub spacing: f64,
    /// Number of cells along both axes.
    pub cells: [usize; 2],
    /// The quantity, in its own unit.
    pub values: Vec<f64>,
    /// Solid cells.
    pub solid: Vec<bool>,
    /// Cells whose centres lie in blocks, of which there are none before [`Self::leave_out`].
    pub in_blocks: Vec<bool>,
    /// Velocity in the plane, m/s, if the image has an array `velocity`.
    pub velocity: Option<Vec<[f64; 2]>>,
}

impl Section {
    /// Cuts `image` by `plane`, cell values as they are.
    pub fn new(image: &Image, plane: Plane, quantity: Quantity<'_>) -> Result<Self> {
        if plane.normal > 2 {
            let axis = plane.normal;
            bail!("a plane cannot be normal to axis {axis}; give 0 (x), 1 (y) or 2 (z)");
        }
        let [a, b] = plane.others();
        let layer = layer(image, plane)?;
        let shown = array(image, quantity)?;
        let solid = image.array("solid");
        let moving = image
            .array("velocity")
            .filter(|array| array.values.len() == 3 * image.cell_count());
        let mut section = Self {
            axes: [AXES[a], AXES[b]],
            normal: AXES[plane.normal],
            layers: image.cells[plane.normal],
            origin: [image.origin[a], image.origin[b]],
            spacing: image.spacing,
            cells: [image.cells[a], image.cells[b]],
            values: Vec::new(),
            solid: Vec::new(),
            in_blocks: vec![false; image.cells[a] * image.cells[b]],
            velocity: moving.map(|_| Vec::new()),
        };
        for v in 0..image.cells[b] {
            for u in 0..image.cells[a] {
                let mut place = [layer; 3];
                (place[a], place[b]) = (u, v);
                let cell = image.cell_index(place[0], place[1], place[2]);
                let tuple = &shown.values[shown.components * cell..][..shown.components];
                section.values.push(match quantity {
                    Quantity::Scalar(_) => f64::from(tuple[0]),
                    Quantity::Magnitude(_) => tuple
                        .iter()
                        .map(|&x| f64::from(x).powi(2))
                        .sum::<f64>()
                        .sqrt(),
                });
                section.solid.push(
                    solid.is_some_and(|solid| solid.values.get(cell).is_some_and(|&s| s != 0.0)),
                );
                if let (Some(kept), Some(moving)) = (&mut section.velocity, moving) {
                    kept.push([a, b].map(|axis| f64::from(moving.values[3 * cell + axis])));
                }
            }
        }
        Ok(section)
    }

    /// The quantity in the fluid's cells.
    pub fn fluid(&self) -> impl Iterator<Item = f64> {
        let cells = (0..self.values.len()).filter(|cell| self.is_fluid(*cell));
        cells.map(|cell| self.values[cell])
    }

    /// Upper corner, m.
    pub fn opposite(&self) -> [f64; 2] {
        [0, 1].map(|axis| self.origin[axis] + self.spacing * self.cells[axis] as f64)
    }

    /// Number of the cell around `point` (m), if it lies inside.
    pub fn cell(&self, point: [f64; 2]) -> Option<usize> {
        let [u, v] = [0, 1].map(|axis| {
            let place = ((point[axis] - self.origin[axis]) / self.spacing).floor();
            (place >= 0.0 && place < self.cells[axis] as f64).then_some(place as usize)
        });
        Some(u? + self.cells[0] * v?)
    }

    /// Takes the cells whose centres lie in `blocks` out of the fluid; `plane` is the one that was cut by. What such a
    /// cell shows outside of its block is what the fluid beside it has: the mean of its neighbours, and without any it
    /// is not a number.
    pub fn leave_out(&mut self, blocks: &[Placed<'_>], plane: Plane) {
        let [a, b] = plane.others();
        for block in blocks {
            let [low, high] = block.bounds();
            if !(low[plane.normal]..=high[plane.normal]).contains(&plane.position) {
                continue;
            }
            let [us, vs] = [(0, a), (1, b)].map(|(along, axis)| {
                let ends = [low[axis], high[axis]];
                centres(self.origin[along], self.spacing, self.cells[along], ends)
            });
            for v in vs {
                for u in us.clone() {
                    let mut centre = DVec3::splat(plane.position);
                    (centre[a], centre[b]) = (
                        self.origin[0] + self.spacing * (u as f64 + 0.5),
                        self.origin[1] + self.spacing * (v as f64 + 0.5),
                    );
                    self.in_blocks[u + self.cells[0] * v] |= block.holds(centre);
                }
            }
        }
        for cell in (0..self.values.len()).filter(|cell| self.in_blocks[*cell]) {
            let around = self.around(cell).filter(|other| self.is_fluid(*other));
            let (sum, count) = around.fold((0.0, 0.0), |(sum, count), other| {
                (sum + self.values[other], count + 1.0)
            });
            self.values[cell] = sum / count;
        }
    }

    /// The cells that touch a cell, and the cell.
    fn around(&self, cell: usize) -> impl Iterator<Item = usize> {
        let [columns, rows] = self.cells;
        let near = |place: usize, count: usize| place.saturating_sub(1)..(place + 2).min(count);
        let us = near(cell % columns, columns);
        near(cell / columns, rows).flat_map(move |v| us.clone().map(move |u| u + columns * v))
    }

    /// Whether a cell is neither solid nor in a block.
    pub fn is_fluid(&self, cell: usize) -> bool {
        !self.solid[cell] && !self.in_blocks[cell]
    }

    /// Velocity (m/s) at `point` (m), bilinear between the centres of fluid cells; `None` in
    /// another cell, outside, or without velocity.
    pub fn velocity_at(&self, point: [f64; 2]) -> Option<[f64; 2]> {
        let velocity = self.velocity.as_ref()?;
        if !self.is_fluid(self.cell(point)?) {
            return None;
        }
        let mut lower = [0; 2];
        let mut part = [0.0; 2];
        for axis in 0..2 {
            let place = (point[axis] - self.origin[axis]) / self.spacing - 0.5;
            let place = place.clamp(0.0, (self.cells[axis] - 1) as f64);
            lower[axis] = place as usize;
            part[axis] = place - lower[axis] as f64;
        }
        let mut sum = [0.0; 2];
        let mut total = 0.0;
        for (u, v) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let weight = [1.0 - part[0], part[0]][u] * [1.0 - part[1], part[1]][v];
            let cell = lower[0] + u + self.cells[0] * (lower[1] + v);
            // A weight of zero also keeps out the cell beyond the last one.
            if weight > 0.0 && self.is_fluid(cell) {
                sum = [0, 1].map(|axis| sum[axis] + weight * velocity[cell][axis]);
                total += weight;
            }
        }
        (total > 0.0).then(|| sum.map(|sum| sum / total))
    }
}

const AXES: [&str; 3] = ["x", "y", "z"];

/// The array that `quantity` is taken from, once it is known to fit.
fn array<'a>(image: &'a Image, quantity: Quantity<'_>) -> Result<&'a Array> {
    let (Quantity::Scalar(name) | Quantity::Magnitude(name)) = quantity;
    let array = image.array(name).with_context(|| {
        let names = image.arrays.iter().map(|array| array.name.as_str());
        let names = names.collect::<Vec<_>>().join(", ");
        format!("the image has no array `{name}`; it has {names}")
    })?;
    if array.components == 0 || array.values.len() != array.components * image.cell_count() {
        bail!(
            "array `{name}` has {} values for {} cells of {} components; fill every cell",
            array.values.len(),
            image.cell_count(),
            array.components
        );
    }
    Ok(array)
}

/// The layer of cells that `plane` passes through; the last one also ends with the domain.
fn layer(image: &Image, plane: Plane) -> Result<usize> {
    let axis = plane.normal;
    let (low, cells) = (image.origin[axis], image.cells[axis]);
    let high = low + image.spacing * cells as f64;
    if !(low..=high).contains(&plane.position) || image.cell_count() == 0 {
        bail!(
            "the plane {} = {} m misses the domain, which goes from {low} to {high} m",
            AXES[axis],
            plane.position
        );
    }
    Ok((((plane.position - low) / image.spacing) as usize).min(cells - 1))
}
