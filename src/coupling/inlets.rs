//! Blocks that lie where fluid enters.

use super::Coupled;
use crate::scene::{Advice, Boundary, Face, Scene, Warning};
use crate::units::Units;

/// A block on the centres of cells at a face whose velocity is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AtInlet {
    pub block: usize,
    pub face: Face,
    /// How many cells, and the first of them.
    pub cells: usize,
    pub first: [u32; 3],
    /// Largest velocity through them, in the unit of what was asked.
    pub speed: f64,
}

impl Coupled {
    /// The blocks in cells of velocity faces through which something flows; `through` has the velocity of each cell
    /// of such a face along its normal, lower axis fastest.
    pub(crate) fn at_inlets(&self, through: &[(Face, Vec<f64>)]) -> Vec<AtInlet> {
        let mut all: Vec<AtInlet> = Vec::new();
        if through.is_empty() {
            return all;
        }
        let (cells, _) = self.immersed().domain();
        for near in self.near(0.0) {
            let at = near.near.cell;
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
                let known = |found: &&mut AtInlet| found.block == near.block && found.face == *face;
                match all.iter_mut().find(known) {
                    Some(found) => {
                        found.cells += 1;
                        found.speed = found.speed.max(speed);
                    }
                    None => all.push(AtInlet {
                        block: near.block,
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

    /// What is wrong with a block at an inlet, and what to do; `speed` in m/s.
    pub(crate) fn inlet_trouble(&self, found: &AtInlet, speed: f64) -> [String; 2] {
        let [x, y, z] = found.first;
        let (name, face) = (self.blocks().name(found.block), found.face.name());
        [
            format!(
                "the block {name} lies in {} cells of the velocity face {face}, the first of them cell ({x}, {y}, {z}): \
                 up to {speed:.3e} m/s enter there and cannot go on",
                found.cells
            ),
            format!(
                "keep the block a cell or more away from {face}, or give boundaries.{face} a velocity formula that is 0 \
                 where the block is"
            ),
        ]
    }

    /// The blocks that now lie where fluid enters at the start, in the middle or at the end of the run.
    pub(super) fn will_be_at_inlets(&self, scene: &Scene, units: &Units) -> Vec<AtInlet> {
        let length = scene.run.duration(units);
        let given = |(face, boundary): (Face, &Boundary)| {
            matches!(boundary, Boundary::Velocity { .. }).then_some(face)
        };
        // The largest one of each cell; a formula that is not finite later on is refused when its time comes.
        let largest = |face: Face| {
            let mut all: Vec<f64> = Vec::new();
            for time in [0.0, 0.5 * length, length] {
                let velocity = scene.face_velocity(face, time).unwrap_or_default();
                let along = velocity.into_iter().map(|u| u[face.axis().index()].abs());
                match all.is_empty() {
                    true => all = along.collect(),
                    false => all.iter_mut().zip(along).for_each(|(a, b)| *a = a.max(b)),
                }
            }
            (face, all)
        };
        let faces = scene.boundaries.iter().filter_map(given);
        let through: Vec<_> = faces
            .map(largest)
            .filter(|(_, all)| !all.is_empty())
            .collect();
        self.at_inlets(&through)
    }

    /// Warns of blocks that lie where fluid enters.
    pub(super) fn warn_of_inlets(&self, advice: &mut Advice) {
        for found in &self.began {
            let [cause, remedy] = self.inlet_trouble(found, found.speed);
            advice.push(Warning {
                place: format!("boundaries.{}", found.face.name()),
                message: format!("{cause}, and the run may diverge; {remedy}"),
            });
        }
    }

    /// The first block that lay where fluid enters at the start.
    pub(crate) fn began_at_inlet(&self) -> Option<[String; 2]> {
        let found = self.began.first()?;
        let [cause, remedy] = self.inlet_trouble(found, found.speed);
        Some([format!("at the start {cause}"), remedy])
    }
}
