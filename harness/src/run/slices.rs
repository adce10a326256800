//! Pictures of planes: `NAME_000123.png`.

use super::{
    recorder::{Recorder, RunLog},
    scene_run::SceneRun,
    schedule::Schedule,
    slice_field::SliceQuantity,
    views::immersed,
};
use crate::picture::{Plane, Slice};
use anyhow::Result;
use riprap::{
    output::Image,
    scene::{self, Field, SliceField},
    simulation::probe::Layer,
};
use std::path::{Path, PathBuf};

/// The pictures of a slice.
pub struct Pictures {
    schedule: Schedule,
    slice: scene::Slice,
    layer: Layer,
    /// Added to the title: where the plane is, if the flow has three dimensions.
    place: String,
    fields: Vec<Field>,
    folder: PathBuf,
}

impl Pictures {
    /// The pictures of `slice` until the step `last`.
    pub fn new(run: &SceneRun, folder: &Path, last: u64, slice: &scene::Slice) -> Self {
        let scene = run.scene();
        let axis = slice.axis.index();
        let position = slice.position.unwrap_or(scene.domain.middle()[axis]);
        let mut fields = vec![SliceQuantity::of(slice.field).field];
        if slice.streamlines && slice.field != SliceField::Speed {
            fields.push(Field::Velocity);
        }
        if !scene.solids.is_empty() && slice.field != SliceField::Solid {
            fields.push(Field::Solid);
        }
        let place = match scene.cells()[axis] {
            1 => String::new(),
            _ => format!(", {} = {position} m", slice.axis.name()),
        };
        Self {
            schedule: Schedule::new(slice.every.or(scene.output.every), run.time_step(), last),
            slice: slice.clone(),
            layer: Layer::new(scene, slice.axis, position),
            place,
            fields,
            folder: folder.to_owned(),
        }
    }
}

impl Recorder for Pictures {
    fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn record(&mut self, run: &mut SceneRun, log: &mut RunLog) -> Result<()> {
        let (step, time) = (run.step(), run.time());
        let image = Image {
            arrays: run.read(&self.fields, self.layer.cells())?,
            ..self.layer.frame()
        };
        let shown = SliceQuantity::of(self.slice.field);
        let poses = run.poses();
        let title = format!("{}{}", run.scene().title, self.place);
        let axis = self.slice.axis.index();
        let slice = Slice {
            title: &title,
            time,
            plane: Plane {
                normal: axis,
                position: image.origin[axis] + 0.5 * image.spacing,
            },
            quantity: shown.quantity(),
            label: shown.label,
            unit: shown.unit,
            range: self.slice.range,
            streamlines: self.slice.streamlines,
            blocks: &immersed(run, &poses),
        };
        let path = self
            .folder
            .join(format!("{}_{step:06}.png", self.slice.name));
        let drawn = slice.draw(&image, &path);
        log.picture(path, drawn);
        Ok(())
    }
}
