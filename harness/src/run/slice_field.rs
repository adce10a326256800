//! What the fields of slices are called.

use crate::{picture::Quantity, render::Colours};
use riprap::scene::{Field, SliceField};

/// How a field of a slice is shown.
pub struct SliceQuantity {
    /// The field that it is taken from.
    pub field: Field,
    /// Its name.
    pub label: &'static str,
    /// Its unit.
    pub unit: &'static str,
}

impl SliceQuantity {
    /// How `field` is shown.
    pub fn of(field: SliceField) -> Self {
        let (field, label, unit) = match field {
            SliceField::Speed => (Field::Velocity, "speed", "m/s"),
            SliceField::Pressure => (Field::Pressure, "pressure", "Pa"),
            SliceField::Density => (Field::Density, "density", "kg/m³"),
            SliceField::EddyViscosity => (Field::EddyViscosity, "eddy viscosity", "m²/s"),
            SliceField::QCriterion => (Field::QCriterion, "Q", "s⁻²"),
            SliceField::Solid => (Field::Solid, "solid", ""),
        };
        Self { field, label, unit }
    }

    /// What is shown of the array of its field.
    pub fn quantity(&self) -> Quantity<'static> {
        match self.field {
            Field::Velocity => Quantity::Magnitude(self.field.name()),
            _ => Quantity::Scalar(self.field.name()),
        }
    }

    /// Its colours in space.
    pub fn colours(&self, range: Option<[f64; 2]>) -> Colours {
        Colours {
            label: self.label.into(),
            unit: self.unit.into(),
            range,
        }
    }
}
