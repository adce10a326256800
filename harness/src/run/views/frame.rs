//! Content of a picture at one time.

use super::fluid::Fluid;
use super::{super::scene_run::SceneRun, shown::each_shape};
use crate::{
    picture::{Palette, extremes},
    render::{Colours, Drawing, Instance},
};
use anyhow::Result;
use riprap::{geometry::Pose, rock::Motion};
use std::{collections::HashMap, sync::Arc};

/// The present state of the blocks of `run` and of its `fluid`, without the meshes of the blocks.
pub fn frame(run: &mut SceneRun, fluid: &Fluid) -> Result<Drawing<'static>> {
    let poses = run.poses();
    let planes = fluid.planes(run, &poses)?;
    let traces = fluid.traces(run, &poses)?;
    let drops = run.drops(fluid.speed())?;
    // Two colour scales for speeds in one picture would be confused.
    let coloured = planes.is_empty() && traces.is_none() && drops.is_none();
    Ok(Drawing {
        time: Some(run.time()),
        instances: bodies(run, &poses, coloured),
        planes,
        traces,
        drops,
        ..Drawing::default()
    })
}

/// The colours of planes and traces.
pub fn colours<'a>(frame: &'a mut Drawing<'_>) -> impl Iterator<Item = &'a mut Colours> {
    let planes = frame.planes.iter_mut().map(|plane| &mut plane.colours);
    planes.chain(frame.traces.iter_mut().map(|traces| &mut traces.colours))
}

/// Gives each quantity one range of colours over all `frames`, if it has none.
pub fn share_ranges(frames: &mut [Drawing<'_>]) {
    let mut reached: HashMap<String, [f64; 2]> = HashMap::new();
    let mut reach = |colours: &Colours, values: &mut dyn Iterator<Item = f64>| {
        if colours.range.is_none() {
            let ends = [f64::INFINITY, f64::NEG_INFINITY];
            let [low, high] = reached.entry(colours.label.clone()).or_insert(ends);
            for value in values.filter(|value| value.is_finite()) {
                (*low, *high) = (low.min(value), high.max(value));
            }
        }
    };
    for frame in frames.iter() {
        for plane in &frame.planes {
            let mut values = plane.values.iter().map(|value| f64::from(*value));
            reach(&plane.colours, &mut values);
        }
        if let Some(traces) = &frame.traces {
            let speeds = traces.lines.iter().flat_map(|line| &line.speeds);
            reach(&traces.colours, &mut speeds.copied());
        }
    }
    for colours in frames.iter_mut().flat_map(colours) {
        if colours.range.is_some() {
            continue;
        }
        let reached = reached.get(&colours.label).copied().unwrap_or_default();
        let [low, high] = extremes(reached.into_iter());
        colours.range = Some(match colours.label.as_str() {
            // Speeds are shown relative to zero.
            "speed" => [0.0, high],
            _ => Palette::fitting([low, high]).1,
        });
    }
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
