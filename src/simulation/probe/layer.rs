//! A layer of cells that a plane cuts.

use super::cells::Cells;
use crate::{
    output::Image,
    scene::{Axis, Scene},
};

/// One layer of a scene's cells, as an image of its own.
#[derive(Clone, Debug)]
pub struct Layer {
    frame: Image,
    cells: Vec<u32>,
}

impl Layer {
    /// The layer normal to `axis` around `position` (m); on a face between two, the upper one.
    pub fn new(scene: &Scene, axis: Axis, position: f64) -> Self {
        let cells = Cells::new(scene, &[]);
        let number = cells.layer(axis, position);
        let mut counts = cells.counts.map(|n| n as usize);
        counts[axis.index()] = 1;
        let mut origin = scene.domain.origin;
        origin[axis.index()] += f64::from(number) * scene.domain.cell;
        Self {
            frame: Image {
                origin,
                spacing: scene.domain.cell,
                cells: counts,
                arrays: Vec::new(),
            },
            cells: cells
                .of_layer(axis, number)
                .map(|c| cells.index(c))
                .collect(),
        }
    }

    /// Its cells as places in an array over the domain, x fastest.
    pub fn cells(&self) -> &[u32] {
        &self.cells
    }

    /// The layer as an image without arrays, to be filled on [`Layer::cells`].
    pub fn frame(&self) -> Image {
        self.frame.clone()
    }
}
