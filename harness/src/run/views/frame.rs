//! What a picture shows, at one time.

use super::fluid::Fluid;
use super::{super::scene_run::SceneRun, shown::each_shape};
use crate::{
    picture::{Palette, extremes},
    render::{Colours, Drops, FluidPlane, Instance, Traces},
};
use anyhow::Result;
use riprap::{geometry::Pose, rock::Motion};
use std::{collections::HashMap, sync::Arc};

/// Bodies and fluid at one time.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Time, s.
    pub time: f64,
    /// The blocks.
    pub bodies: Vec<Instance>,
    /// Planes through the fluid.
    pub planes: Vec<FluidPlane>,
    /// Lines along its flow.
    pub traces: Option<Traces>,
    /// Particles of water.
    pub drops: Option<Drops>,
}

impl Frame {
    /// What there is now of the blocks of `run`, and of its `fluid`.
    pub fn of(run: &mut SceneRun, fluid: &Fluid) -> Result<Self> {
        let poses = run.poses();
        let planes = fluid.planes(run, &poses)?;
        let traces = fluid.traces(run, &poses)?;
        let drops = run.drops(fluid.speed())?;
        // Two scales of colours for speeds in one picture would be mixed up.
        let coloured = planes.is_empty() && traces.is_none() && drops.is_none();
        Ok(Self {
            time: run.time(),
            bodies: bodies(run, &poses, coloured),
            planes,
            traces,
            drops,
        })
    }

    /// The colours of planes and traces.
    pub fn colours(&mut self) -> impl Iterator<Item = &mut Colours> {
        let planes = self.planes.iter_mut().map(|plane| &mut plane.colours);
        planes.chain(self.traces.iter_mut().map(|traces| &mut traces.colours))
    }

    /// Quantities whose colours have no range, with values that occur.
    fn unbounded(&self) -> Vec<(&str, [f64; 2])> {
        let planes = self.planes.iter().map(|plane| {
            let values = plane.values.iter().map(|value| f64::from(*value));
            (&plane.colours, least_and_largest(values))
        });
        let traces = self.traces.iter().map(|traces| {
            let speeds = traces.lines.iter().flat_map(|line| &line.speeds);
            (&traces.colours, least_and_largest(speeds.copied()))
        });
        let all = planes.chain(traces);
        all.filter(|(colours, _)| colours.range.is_none())
            .map(|(colours, ends)| (colours.label.as_str(), ends))
            .collect()
    }
}

/// Gives each quantity one range of colours over all `frames`, if it has none.
pub fn share_ranges(frames: &mut [Frame]) {
    let mut reached: HashMap<String, [f64; 2]> = HashMap::new();
    for (label, [low, high]) in frames.iter().flat_map(Frame::unbounded) {
        let range = reached.entry(label.to_owned()).or_insert([low, high]);
        *range = [range[0].min(low), range[1].max(high)];
    }
    for colours in frames.iter_mut().flat_map(Frame::colours) {
        if colours.range.is_some() {
            continue;
        }
        let reached = reached.get(&colours.label).copied().unwrap_or_default();
        let [low, high] = extremes(reached.into_iter());
        colours.range = Some(match colours.label.as_str() {
            // A length means something only against zero.
            "speed" => [0.0, high],
            _ => Palette::fitting([low, high]).1,
        });
    }
}

fn least_and_largest(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let finite = values.filter(|value| value.is_finite());
    finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
        [low.min(value), high.max(value)]
    })
}

/// The blocks at `poses`, each with the speed of its centroid if they are `coloured`.
fn bodies(run: &SceneRun, poses: &[Pose], coloured: bool) -> Vec<Instance> {
    let first = each_shape(run.blocks(), |_| {});
    let blocks = run.blocks().iter().zip(poses);
    let parts = blocks.flat_map(|(block, pose)| {
        let first = first[&Arc::as_ptr(&block.shape)];
        let parts = block.shape.parts().iter().enumerate();
        parts.map(move |(number, part)| Instance {
            mesh: first + number,
            centre: pose.point(part.offset),
            deformation: pose.deformation,
            value: coloured.then(|| pose.velocity.length()),
            fixed: block.motion == Motion::Fixed,
        })
    });
    parts.collect()
}
