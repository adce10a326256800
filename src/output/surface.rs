//! VTK PolyData files (VTK XML format, version 1.0) of polygons.

use std::path::Path;

use super::appended::{Appended, Values, fault};
use super::{Array, replace};
use crate::{Error, Result};

/// Plane polygons, and quantities on each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// Corners of each polygon, m.
    pub polygons: Vec<Vec<[f64; 3]>>,
    /// The quantities, a value or vector for each polygon.
    pub arrays: Vec<Array>,
}

/// Writes `surface` to `path` for ParaView, replacing an older file only when done.
///
/// # Errors
/// [`Error::File`] if an array does not fill the polygons, or the file cannot be written.
pub fn write_surface(path: impl AsRef<Path>, surface: &Surface) -> Result<()> {
    let path = path.as_ref();
    let polygons = &surface.polygons;
    if let Some(fault) = fault(&surface.arrays, polygons.len(), "polygons") {
        return Err(Error::file(path, format!("cannot write: {fault}")));
    }
    let corners: Vec<f64> = polygons.iter().flatten().flatten().copied().collect();
    let points = corners.len() / 3;
    let mut appended = Appended::default();
    let mut xml = format!(
        "<Piece NumberOfPoints=\"{points}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" \
         NumberOfStrips=\"0\" NumberOfPolys=\"{}\">\n<Points>\n",
        polygons.len()
    );
    xml += &appended.declare("Points", 3, Values::Float64(corners));
    xml += "</Points>\n<Polys>\n";
    let each = (0..points as i64).collect();
    xml += &appended.declare("connectivity", 1, Values::Int64(each));
    let ends = polygons.iter().scan(0, |end, polygon| {
        *end += polygon.len() as i64;
        Some(*end)
    });
    xml += &appended.declare("offsets", 1, Values::Int64(ends.collect()));
    xml += "</Polys>\n<CellData>\n";
    xml += &appended.declare_all(&surface.arrays);
    xml += "</CellData>\n</Piece>\n";
    replace(path, |writer| appended.write(writer, "PolyData", &xml))
}
