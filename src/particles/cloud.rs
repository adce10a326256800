//! Particles for files.

use super::Water;
use crate::{
    output::{Array, Cloud},
    scene::Field,
};

/// The particles of `water` as points with `fields` (velocity in m/s, pressure in Pa, density in kg/m³; others
/// they do not have) and their ids.
pub fn cloud(water: &Water, fields: &[Field]) -> Cloud {
    let scalar = |values: &[f64]| values.iter().map(|v| *v as f32).collect();
    let array = |field: &Field| {
        let values: Vec<f32> = match field {
            Field::Velocity => water.velocities.iter().flat_map(|v| v.to_array()).collect(),
            Field::Pressure => scalar(&water.pressures),
            Field::Density => scalar(&water.densities),
            _ => return None,
        };
        Some(Array {
            name: field.name().into(),
            components: field.components(),
            values,
        })
    };
    let mut arrays: Vec<Array> = fields.iter().filter_map(array).collect();
    arrays.push(Array {
        name: "id".into(),
        components: 1,
        values: water.ids.iter().map(|id| *id as f32).collect(),
    });
    Cloud {
        points: water.positions.iter().map(|x| x.to_array()).collect(),
        arrays,
    }
}
