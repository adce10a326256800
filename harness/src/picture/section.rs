//! A plane section of an image.

use super::placed::{Placed, cells_in};
use anyhow::{Context, Result, bail};
use riprap::output::{Array, ImageData};

/// A plane normal to an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// The axis it is normal to: 0 for x, 1 for y, 2 for z.
    pub normal: usize,
    /// Its coordinate along that axis, m.
    pub position: f64,
}

impl Plane {
    /// The axes that lie in the plane, in their order.
    pub fn others(&self) -> [usize; 2] {
        match self.normal {
            0 => [1, 2],
            1 => [0, 2],
            _ => [0, 1],
        }
    }
}

/// The quantity taken from an array.
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
    plane: Plane,
    /// The layer of cells that the plane passes through; its array `solid` marks all cells without fluid.
    layer: ImageData,
}

impl Section {
    /// Cuts `image` by `plane`, without interpolation of cell values.
    pub fn new(image: &ImageData, plane: Plane, quantity: Quantity<'_>) -> Result<Self> {
        if plane.normal > 2 {
            let axis = plane.normal;
            bail!("a plane cannot be normal to axis {axis}; give 0 (x), 1 (y) or 2 (z)");
        }
        let [a, b] = plane.others();
        let layer = layer(image, plane)?;
        let shown = array(image, quantity)?;
        let cells = (0..image.cells[b]).flat_map(|v| (0..image.cells[a]).map(move |u| [u, v]));
        let cells: Vec<usize> = cells
            .map(|[u, v]| {
                let mut place = [layer; 3];
                (place[a], place[b]) = (u, v);
                image.cell_index(place[0], place[1], place[2])
            })
            .collect();
        let tuple = |cell: &usize| &shown.values[shown.components * cell..][..shown.components];
        let value = |cell: &usize| match quantity {
            Quantity::Scalar(_) => f64::from(tuple(cell)[0]),
            Quantity::Magnitude(_) => {
                let squares = tuple(cell).iter().map(|&x| f64::from(x).powi(2));
                squares.sum::<f64>().sqrt()
            }
        };
        let mut thin = ImageData {
            origin: image.origin,
            spacing: image.spacing,
            cells: image.cells,
            arrays: Vec::new(),
        };
        thin.cells[plane.normal] = 1;
        thin.origin[plane.normal] += layer as f64 * image.spacing;
        let flow = image.array("velocity");
        if let Some(flow) = flow.filter(|flow| flow.values.len() == 3 * image.cell_count()) {
            let vectors = cells.iter().map(|cell| &flow.values[3 * cell..][..3]);
            thin.arrays.push(Array {
                name: "velocity".into(),
                components: 3,
                values: vectors.flatten().copied().collect(),
            });
        }
        let mut section = Self {
            axes: [AXES[a], AXES[b]],
            normal: AXES[plane.normal],
            layers: image.cells[plane.normal],
            origin: [image.origin[a], image.origin[b]],
            spacing: image.spacing,
            cells: [image.cells[a], image.cells[b]],
            values: cells.iter().map(value).collect(),
            solid: cells.iter().map(|cell| image.is_solid(*cell)).collect(),
            in_blocks: vec![false; cells.len()],
            plane,
            layer: thin,
        };
        section.mark_solid();
        Ok(section)
    }

    /// Marks cells without fluid, so that their velocity does not enter that of neighbouring cells.
    fn mark_solid(&mut self) {
        self.layer.arrays.retain(|array| array.name != "solid");
        let solid = (0..self.values.len()).map(|cell| f32::from(!self.is_fluid(cell)));
        self.layer.arrays.push(Array {
            name: "solid".into(),
            components: 1,
            values: solid.collect(),
        });
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

    /// Index of the cell around `point` (m), if it lies inside.
    pub fn cell(&self, point: [f64; 2]) -> Option<usize> {
        let [u, v] = [0, 1].map(|axis| {
            let place = ((point[axis] - self.origin[axis]) / self.spacing).floor();
            (place >= 0.0 && place < self.cells[axis] as f64).then_some(place as usize)
        });
        Some(u? + self.cells[0] * v?)
    }

    /// Takes the cells whose centres lie in `blocks` out of the fluid. The part of such a cell outside of its block shows the
    /// mean of the neighbouring fluid cells, and NaN if there are none.
    pub fn leave_out(&mut self, blocks: &[Placed<'_>]) {
        self.in_blocks = cells_in(&self.layer, blocks);
        self.mark_solid();
        for cell in (0..self.values.len()).filter(|cell| self.in_blocks[*cell]) {
            let around = self.around(cell).filter(|other| self.is_fluid(*other));
            let (sum, count) = around.fold((0.0, 0.0), |(sum, count), other| {
                (sum + self.values[other], count + 1.0)
            });
            self.values[cell] = sum / count;
        }
    }

    /// The cells that touch a cell, and the cell itself.
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

    /// Velocity (m/s) at `point` (m), bilinear between the centres of fluid cells; `None` in another cell, outside, or
    /// without velocity.
    pub fn velocity_at(&self, point: [f64; 2]) -> Option<[f64; 2]> {
        if !self.is_fluid(self.cell(point)?) {
            return None;
        }
        let [a, b] = self.plane.others();
        let mut place = [self.plane.position; 3];
        (place[a], place[b]) = (point[0], point[1]);
        let velocity = self.layer.sample("velocity", place)?;
        Some([velocity[a], velocity[b]])
    }
}

const AXES: [&str; 3] = ["x", "y", "z"];

/// The array of `quantity`, after a check that it fits.
fn array<'a>(image: &'a ImageData, quantity: Quantity<'_>) -> Result<&'a Array> {
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
fn layer(image: &ImageData, plane: Plane) -> Result<usize> {
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
