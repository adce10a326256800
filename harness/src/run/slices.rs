//! Pictures of planes: `NAME_000123.png`.

use super::{
    recorder::{Recorder, RunLog, Schedule},
    scene_run::SceneRun,
    views::immersed,
};
use crate::{
    picture::{Plane, Quantity, Slice},
    render::Colours,
};
use riprap::{
    output::ImageData,
    scene::{self, Field, SliceField},
    simulation::probe::Layer,
};
use std::path::Path;

/// The recorder of the pictures of `slice` until the step `last`.
pub fn recorder(
    run: &SceneRun,
    folder: &Path,
    last: u64,
    slice: &scene::Slice,
) -> Box<dyn Recorder> {
    let scene = run.scene();
    let axis = slice.axis.index();
    let position = slice.position.unwrap_or(scene.domain.middle()[axis]);
    let shown = SliceQuantity::of(slice.field);
    let mut fields = vec![shown.field];
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
    let title = format!("{}{place}", scene.title);
    let layer = Layer::new(scene, slice.axis, position);
    let schedule = Schedule::new(slice.every.or(scene.output.every), run.time_step(), last);
    let (folder, slice) = (folder.to_owned(), slice.clone());
    let record = move |run: &mut SceneRun, log: &mut RunLog| {
        if shown.field.is_statistical() && run.simulation.samples() == 0 {
            return Ok(());
        }
        let image = ImageData {
            arrays: run.read(&fields, layer.cells())?,
            ..layer.frame()
        };
        let poses = run.poses();
        let drawn = Slice {
            title: &title,
            time: run.time(),
            plane: Plane {
                normal: axis,
                position: image.origin[axis] + 0.5 * image.spacing,
            },
            quantity: shown.quantity(),
            label: shown.label,
            unit: shown.unit,
            range: slice.range,
            streamlines: slice.streamlines,
            blocks: &immersed(run, &poses),
        };
        let path = folder.join(format!("{}_{:06}.png", slice.name, run.step()));
        let drawn = drawn.draw(&image, &path);
        log.picture(path, drawn);
        Ok(())
    };
    Box::new((schedule, record))
}

/// How a field of a slice is drawn.
pub struct SliceQuantity {
    /// The field of the lattice from which it is computed.
    pub field: Field,
    /// Its name.
    pub label: &'static str,
    /// Its unit.
    pub unit: &'static str,
}

impl SliceQuantity {
    /// The quantity of `field`.
    pub fn of(field: SliceField) -> Self {
        let (label, unit) = match field {
            SliceField::Speed => ("speed", "m/s"),
            SliceField::Pressure => ("pressure", "Pa"),
            SliceField::Density => ("density", "kg/m³"),
            SliceField::EddyViscosity => ("eddy viscosity", "m²/s"),
            SliceField::QCriterion => ("Q", "s⁻²"),
            SliceField::Solid => ("solid", ""),
            SliceField::MeanSpeed => ("mean speed", "m/s"),
            SliceField::MeanPressure => ("mean pressure", "Pa"),
            SliceField::PressureRms => ("RMS of pressure", "Pa"),
            SliceField::TurbulentKineticEnergy => ("turbulent kinetic energy", "m²/s²"),
        };
        Self {
            field: field.field(),
            label,
            unit,
        }
    }

    /// The quantity as computed from the array of its field.
    pub fn quantity(&self) -> Quantity<'static> {
        match self.field.components() {
            3 => Quantity::Magnitude(self.field.name()),
            _ => Quantity::Scalar(self.field.name()),
        }
    }

    /// Its colours in views.
    pub fn colours(&self, range: Option<[f64; 2]>) -> Colours {
        Colours {
            label: self.label.into(),
            unit: self.unit.into(),
            range,
        }
    }
}
