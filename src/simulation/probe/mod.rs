//! Measurements of a scene's probes: the cells that they read, and the rows computed from them.
//!
//! A [`Gauge`] is a [`Probe`] placed on the cells of its scene. It lists the [fields](Gauge::fields)
//! that it needs and their [cells](Gauge::cells), so that only these are read back from the device
//! ([`Simulation::read`](crate::simulation::Simulation::read)), and computes rows of a table from them.
//!
//! Every table begins with `step,time` (time in s). These columns follow, all in SI:
//!
//! | kind | columns | rows per measurement |
//! |---|---|---|
//! | point | the fields | 1 |
//! | line | `s`, the distance from its first point; `x,y,z`; the fields | its `count` |
//! | plane | `x,y,z` of the cell's centre; the fields | one per cell of the layer that it cuts, the lower axis fastest |
//! | box | `_mean,_min,_max` of each column of the fields | 1 |
//! | face | `area,pressure_mean,pressure_min,pressure_max,force,x_of_max,y_of_max,z_of_max` | 1 |
//!
//! The columns of a field are its name, or for a vector its name with `_x`, `_y` and `_z`.
//!
//! - With particles, values without water are `NaN`: the level of a dry gauge, the place of a run-up, the fields of
//!   points and boxes.
//! - Values at points are interpolated trilinearly between cell centres. Between the last centres and a wall, the
//!   velocity is interpolated to that of the wall, and the pressure has the gradient of the fluid at rest under a constant
//!   acceleration; other fields are constant there, as all fields are towards other faces. Solid cells have no weight, and
//!   the pressure next to them has the same gradient. A value is `NaN` if all cells around a point are solid, and in
//!   the solid cells of a plane. `solid` is the value of the cell around the point.
//! - A `face` has `area` in m², `force` in N on the solid, along −normal, Σ p Δx² over its cells,
//!   and the centre of the cell face with the largest pressure: the stagnation point. The pressure at the solid has the
//!   gradient of the fluid at rest from the centre of the cell to its face. Of a solid with an exact surface these are the
//!   faces of its full cells.

mod cells;
mod points;

pub use points::Layer;

use crate::{
    Error, Result,
    output::{Array, ImageData},
    scene::{Field, Probe, ProbePlace, Scene},
};
use cells::Cells;
use points::{Face, Points, box_rows};

/// A probe placed on the cells of a scene.
#[derive(Clone, Debug)]
pub struct Gauge {
    columns: Vec<String>,
    coordinates: usize,
    fields: Vec<Field>,
    cells: Vec<u32>,
    place: Place,
}

/// How rows are computed from the values on the cells.
#[derive(Clone, Debug)]
enum Place {
    Points(Points),
    Box,
    Face(Face),
}

impl Gauge {
    /// Places `probe` in `scene`; `solid` marks the solid cells, x fastest, and is empty if there
    /// are none.
    ///
    /// # Errors
    /// If the probe measures free water or a block, or has no fluid cell: a face needs one in front of a solid.
    pub fn new(scene: &Scene, solid: &[bool], probe: &Probe) -> Result<Self> {
        let cells = Cells::new(scene, solid);
        let (coordinates, place, chosen) = match &probe.place {
            ProbePlace::Point { at } => {
                let (points, chosen) = Points::single(&cells, *at);
                (vec![], Place::Points(points), chosen)
            }
            ProbePlace::Line { .. } => {
                let (points, chosen) = Points::line(&cells, probe.place.stations());
                (vec!["s", "x", "y", "z"], Place::Points(points), chosen)
            }
            ProbePlace::Plane { axis, position } => {
                let (points, chosen) = Points::plane(&cells, *axis, *position);
                (vec!["x", "y", "z"], Place::Points(points), chosen)
            }
            ProbePlace::Box { min, max } => {
                let chosen = cells.fluid_in(*min, *max);
                (vec![], Place::Box, chosen)
            }
            ProbePlace::Face { min, max, normal } => {
                let (face, chosen) = Face::new(&cells, *min, *max, *normal);
                (Face::COLUMNS.to_vec(), Place::Face(face), chosen)
            }
            ProbePlace::Gauge { .. } | ProbePlace::Sensor { .. } | ProbePlace::RunUp { .. } => {
                return Err(Error::scene(
                    format!("probes.{}", probe.name),
                    "it measures free water, and a lattice has none; give another kind",
                ));
            }
            ProbePlace::Block { block, .. } => {
                return Err(Error::scene(
                    format!("probes.{}", probe.name),
                    format!("it follows the block `{block}` and has no place in the fluid"),
                ));
            }
        };
        if chosen.is_empty() {
            return Err(Error::scene(
                format!("probes.{}", probe.name),
                match &probe.place {
                    ProbePlace::Face { normal, .. } => format!(
                        "no fluid cell in its box has a solid cell on the side opposite to its \
                         normal {}; the box must hold at least one layer of fluid cells, {} m \
                         thick, in front of the solid",
                        normal.name(),
                        scene.domain.cell
                    ),
                    ProbePlace::Box { .. } => format!(
                        "its box holds no centre of a fluid cell; cells are {} m wide: make the \
                         box larger or move it out of the solid",
                        scene.domain.cell
                    ),
                    _ => "all cells that it looks at are solid; move it into the fluid".into(),
                },
            ));
        }
        let fields = match place {
            Place::Face(_) => vec![Field::Pressure],
            _ => probe.fields.clone(),
        };
        let count = match place {
            Place::Points(_) => coordinates.len(),
            Place::Box | Place::Face(_) => 0,
        };
        let mut columns: Vec<String> = coordinates.into_iter().map(Into::into).collect();
        for field in &fields {
            match &place {
                Place::Points(_) => columns.extend(field.columns()),
                Place::Box => columns.extend(field.columns().into_iter().flat_map(|column| {
                    ["mean", "min", "max"].map(|what| format!("{column}_{what}"))
                })),
                Place::Face(_) => {}
            }
        }
        Ok(Self {
            columns,
            coordinates: count,
            fields,
            cells: chosen,
            place,
        })
    }

    /// Names of the columns after `step` and `time`.
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// Number of leading columns that hold the position of a row.
    pub fn coordinates(&self) -> usize {
        self.coordinates
    }

    /// The fields that it needs.
    pub fn fields(&self) -> &[Field] {
        &self.fields
    }

    /// The cells whose values it needs, as indices into an array over the domain, x fastest.
    pub fn cells(&self) -> &[u32] {
        &self.cells
    }

    /// The rows of a measurement from `arrays` of [`Gauge::fields`] on [`Gauge::cells`].
    ///
    /// # Errors
    /// If an array is missing or has another length.
    pub fn rows(&self, arrays: &[Array]) -> Result<Vec<Vec<f64>>> {
        let find = |field: &Field| {
            let found = arrays.iter().find(|array| array.name == field.name());
            found
                .filter(|array| {
                    array.components == field.components()
                        && array.values.len() == self.cells.len() * array.components
                })
                .ok_or_else(|| {
                    Error::scene(
                        "probe",
                        format!(
                            "it needs `{}` on {} cells; read all of its fields on all of its cells",
                            field.name(),
                            self.cells.len()
                        ),
                    )
                })
        };
        let arrays = self.fields.iter().map(find).collect::<Result<Vec<_>>>()?;
        Ok(match &self.place {
            Place::Points(points) => points.rows(&self.fields, &arrays),
            Place::Box => box_rows(&arrays),
            Place::Face(face) => face.rows(&arrays),
        })
    }

    /// The rows of a measurement from an image of the whole domain.
    ///
    /// # Errors
    /// If the image lacks a field or has another size.
    pub fn measure(&self, image: &ImageData) -> Result<Vec<Vec<f64>>> {
        let taken: Vec<Array> = image
            .arrays
            .iter()
            .filter(|array| {
                self.fields.iter().any(|f| f.name() == array.name)
                    && array.values.len() == array.components * image.cell_count()
            })
            .map(|array| Array {
                name: array.name.clone(),
                components: array.components,
                values: self
                    .cells
                    .iter()
                    .filter_map(|&cell| {
                        let at = cell as usize * array.components;
                        array.values.get(at..at + array.components)
                    })
                    .flatten()
                    .copied()
                    .collect(),
            })
            .collect();
        self.rows(&taken)
    }
}
