//! Pictures of planes: `NAME_000123.png`.

use super::super::{
    engine::Engine,
    recorder::{Notes, Recorder},
    schedule::Schedule,
};
use super::Flow;
use crate::picture::{Plane, Quantity, Slice};
use anyhow::Result;
use riprap::{
    output::Image,
    probe::Layer,
    scene::{self, Field, SliceField},
};
use std::path::{Path, PathBuf};

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
    pub fn new(engine: &Flow, folder: &Path, last: u64, slice: &scene::Slice) -> Self {
        let simulation = &engine.simulation;
        let scene = simulation.scene();
        let axis = slice.axis.index();
        let position = slice.position.unwrap_or(scene.domain.middle()[axis]);
        let mut fields = vec![shown(slice.field).field];
        if slice.streamlines && slice.field != SliceField::Speed {
            fields.push(Field::Velocity);
        }
        if !simulation.solid().is_empty() && slice.field != SliceField::Solid {
            fields.push(Field::Solid);
        }
        let place = match scene.cells()[axis] {
            1 => String::new(),
            _ => format!(", {} = {position} m", slice.axis.name()),
        };
        Self {
            schedule: Schedule::new(slice.every.or(scene.output.every), simulation.units(), last),
            slice: slice.clone(),
            layer: Layer::new(scene, slice.axis, position),
            place,
            fields,
            folder: folder.to_owned(),
        }
    }
}

/// How a quantity is shown.
struct Shown {
    field: Field,
    label: &'static str,
    unit: &'static str,
}

fn shown(field: SliceField) -> Shown {
    let (field, label, unit) = match field {
        SliceField::Speed => (Field::Velocity, "speed", "m/s"),
        SliceField::Pressure => (Field::Pressure, "pressure", "Pa"),
        SliceField::Density => (Field::Density, "density", "kg/m³"),
        SliceField::EddyViscosity => (Field::EddyViscosity, "eddy viscosity", "m²/s"),
        SliceField::QCriterion => (Field::QCriterion, "Q", "s⁻²"),
        SliceField::Solid => (Field::Solid, "solid", ""),
    };
    Shown { field, label, unit }
}

impl Recorder<Flow> for Pictures {
    fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn record(&mut self, engine: &mut Flow, notes: &mut Notes) -> Result<()> {
        let (step, time) = (engine.simulation.step(), engine.simulation.time());
        let image = Image {
            arrays: engine.read(&self.fields, self.layer.cells())?,
            ..self.layer.frame()
        };
        let Shown { field, label, unit } = shown(self.slice.field);
        let title = format!("{}{}", engine.scene().title, self.place);
        let axis = self.slice.axis.index();
        let slice = Slice {
            title: &title,
            time,
            plane: Plane {
                normal: axis,
                position: image.origin[axis] + 0.5 * image.spacing,
            },
            quantity: match self.slice.field {
                SliceField::Speed => Quantity::Magnitude(field.name()),
                _ => Quantity::Scalar(field.name()),
            },
            label,
            unit,
            range: self.slice.range,
            streamlines: self.slice.streamlines,
            blocks: &[],
        };
        let path = self
            .folder
            .join(format!("{}_{step:06}.png", self.slice.name));
        let drawn = slice.draw(&image, &path);
        notes.picture(path, drawn);
        Ok(())
    }
}
