//! VTK PolyData files (VTK XML format, version 1.0) of points.

use std::path::Path;

use super::appended::{Appended, Values, fault};
use super::{Array, replace};
use crate::{Error, Result};

/// Points, and quantities on each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cloud {
    /// The points, m.
    pub points: Vec<[f64; 3]>,
    /// The quantities, a value or vector for each point.
    pub arrays: Vec<Array>,
}

/// Writes `cloud` to `path` for ParaView, each point as a vertex to be seen, replacing an older file
/// only when done.
///
/// # Errors
/// [`Error::File`] if an array does not fill the points, or the file cannot be written.
pub fn write_vtp(path: impl AsRef<Path>, cloud: &Cloud) -> Result<()> {
    let path = path.as_ref();
    let count = cloud.points.len();
    if let Some(fault) = fault(&cloud.arrays, count, "points") {
        return Err(Error::file(path, format!("cannot write: {fault}")));
    }
    let mut appended = Appended::default();
    let mut xml = format!(
        "<Piece NumberOfPoints=\"{count}\" NumberOfVerts=\"{count}\" NumberOfLines=\"0\" \
         NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<Points>\n"
    );
    let coordinates = cloud.points.iter().flatten().copied().collect();
    xml += &appended.declare("Points", 3, Values::Float64(coordinates));
    xml += "</Points>\n<Verts>\n";
    let each = 0..count as i64;
    xml += &appended.declare("connectivity", 1, Values::Int64(each.clone().collect()));
    let ends = each.map(|index| index + 1).collect();
    xml += &appended.declare("offsets", 1, Values::Int64(ends));
    xml += "</Verts>\n<PointData>\n";
    xml += &appended.declare_all(&cloud.arrays);
    xml += "</PointData>\n</Piece>\n";
    replace(path, |writer| appended.write(writer, "PolyData", &xml))
}
