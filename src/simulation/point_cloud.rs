//! The particles of water as points for files.

use crate::{
    output::{Array, Cloud},
    scene::Field,
    sph::Water,
};

/// The particles of `water` as points with their ids and `fields`: velocity (m/s), pressure (Pa) and density (kg/m³).
/// Particles carry no other field.
pub fn point_cloud(water: &Water, fields: &[Field]) -> Cloud {
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
