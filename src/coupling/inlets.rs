//! Blocks in inflow cells.

use super::Coupled;
use crate::scene::{Advice, Boundary, Face, Scene, Warning};
use crate::units::Units;

/// A block that covers the centres of cells at a velocity face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BlockAtInlet {
    pub block: usize,
    pub face: Face,
    /// Number of cells.
    pub cells: usize,
    /// The first of them.
    pub first: [u32; 3],
    /// Largest normal velocity through them, in the unit of the given velocities.
    pub speed: f64,
}

impl Coupled<'_> {
    /// The blocks in cells of velocity faces with a velocity other than zero; `through` has the velocity of each cell
    /// of such a face along its normal, lower axis fastest.
    pub(crate) fn at_inlets(&self, through: &[(Face, Vec<f64>)]) -> Vec<BlockAtInlet> {
        let mut all: Vec<BlockAtInlet> = Vec::new();
        if through.is_empty() {
            return all;
        }
        let (cells, _) = self.solid_cells().domain();
        for found in self.cells_near_blocks(0.0) {
            let at = found.cell.index;
            let ijk = [
                at % cells[0],
                at / cells[0] % cells[1],
                at / (cells[0] * cells[1]),
            ];
            for (face, velocity) in through {
                let axis = face.axis();
                let end = if face.is_max() {
                    cells[axis.index()] - 1
                } else {
                    0
                };
                if ijk[axis.index()] != end {
                    continue;
                }
                let [low, high] = axis.others().map(|other| other.index());
                let speed = velocity[(ijk[low] + cells[low] * ijk[high]) as usize].abs();
                if speed == 0.0 {
                    continue;
                }
                let known = |at: &&mut BlockAtInlet| at.block == found.block && at.face == *face;
                match all.iter_mut().find(known) {
                    Some(known) => {
                        known.cells += 1;
                        known.speed = known.speed.max(speed);
                    }
                    None => all.push(BlockAtInlet {
                        block: found.block,
                        face: *face,
                        cells: 1,
                        first: ijk,
                        speed,
                    }),
                }
            }
        }
        all
    }

    /// Cause and remedy of a block at an inlet; `speed` in m/s.
    pub(crate) fn inlet_message(&self, found: &BlockAtInlet, speed: f64) -> [String; 2] {
        let [x, y, z] = found.first;
        let (name, face) = (self.blocks().name(found.block), found.face.name());
        [
            format!(
                "the block {name} lies in {} cells of the velocity face {face}, the first of them cell ({x}, {y}, {z}): \
                 it blocks an inflow of up to {speed:.3e} m/s",
                found.cells
            ),
            format!(
                "keep the block a cell or more away from {face}, or give boundaries.{face} a velocity formula that is 0 \
                 where the block is"
            ),
        ]
    }

    /// The blocks in inflow cells at their present poses, with the velocities at the start, in the middle and at the end
    /// of the run.
    pub(super) fn blocks_at_inlets(&self, scene: &Scene, units: &Units) -> Vec<BlockAtInlet> {
        let length = scene.run.duration(units);
        let velocity_face = |(face, boundary): (Face, &Boundary)| {
            matches!(boundary, Boundary::Velocity { .. }).then_some(face)
        };
        // The largest speed of each cell. A formula that is not finite at a later time is an error at that time.
        let largest = |face: Face| {
            let mut all: Vec<f64> = Vec::new();
            for time in [0.0, 0.5 * length, length] {
                let velocity = scene.face_velocity(face, time).unwrap_or_default();
                let speeds = velocity.into_iter().map(|u| u[face.axis().index()].abs());
                if all.is_empty() {
                    all = speeds.collect();
                } else {
                    all.iter_mut().zip(speeds).for_each(|(a, b)| *a = a.max(b));
                }
            }
            (face, all)
        };
        let faces = scene.boundaries.iter().filter_map(velocity_face);
        let through: Vec<_> = faces
            .map(largest)
            .filter(|(_, all)| !all.is_empty())
            .collect();
        self.at_inlets(&through)
    }

    /// Adds warnings about blocks in inflow cells.
    pub(super) fn warn_of_inlets(&self, advice: &mut Advice) {
        for found in &self.coupling.initial_inlet_blocks {
            let [cause, remedy] = self.inlet_message(found, found.speed);
            advice.push(Warning {
                place: format!("boundaries.{}", found.face.name()),
                message: format!("{cause}, and the run may diverge; {remedy}"),
            });
        }
    }

    /// Cause and remedy of the first block in inflow cells at the start.
    pub(crate) fn initial_inlet_message(&self) -> Option<[String; 2]> {
        let found = self.coupling.initial_inlet_blocks.first()?;
        let [cause, remedy] = self.inlet_message(found, found.speed);
        Some([format!("at the start {cause}"), remedy])
    }
}
