//! VTK UnstructuredGrid files (VTK XML format, version 1.0) of polyhedra.

use std::path::Path;

use super::appended::{Appended, Values, fault};
use super::{Array, replace};
use crate::{Error, Result};

/// VTK's number for a polyhedron.
const POLYHEDRON: u8 = 42;

/// Polyhedra, and quantities on each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polyhedra {
    /// Corners of all, m.
    pub points: Vec<[f64; 3]>,
    /// For each polyhedron its faces, each as the indices of its corners.
    pub cells: Vec<Vec<Vec<u32>>>,
    /// The quantities, a value or vector for each polyhedron.
    pub arrays: Vec<Array>,
}

/// Writes `polyhedra` to `path` for ParaView, replacing an older file only when done.
///
/// # Errors
/// [`Error::File`] if an array does not fill the cells, a face names a point that is not there, or
/// the file cannot be written.
pub fn write_vtu(path: impl AsRef<Path>, polyhedra: &Polyhedra) -> Result<()> {
    let path = path.as_ref();
    let Polyhedra {
        points,
        cells,
        arrays,
    } = polyhedra;
    let stray = cells.iter().flatten().flatten();
    let stray = stray.copied().find(|&point| point as usize >= points.len());
    let stray = stray.map(|point| format!("a face names point {point} of {}", points.len()));
    if let Some(fault) = stray.or_else(|| fault(arrays, cells.len(), "polyhedra")) {
        return Err(Error::file(path, format!("cannot write: {fault}")));
    }
    let mut appended = Appended::default();
    let coordinates = points.iter().flatten().copied().collect();
    let (mut connectivity, mut offsets) = (Vec::new(), Vec::new());
    let (mut faces, mut face_offsets) = (Vec::new(), Vec::new());
    for cell in cells {
        let mut corners: Vec<u32> = cell.iter().flatten().copied().collect();
        corners.sort_unstable();
        corners.dedup();
        connectivity.extend(corners.into_iter().map(i64::from));
        offsets.push(connectivity.len() as i64);
        // VTK's list: number of faces, then for each the number of its corners and these.
        faces.push(cell.len() as i64);
        for face in cell {
            faces.push(face.len() as i64);
            faces.extend(face.iter().copied().map(i64::from));
        }
        face_offsets.push(faces.len() as i64);
    }
    let types = vec![POLYHEDRON; cells.len()];
    let mut xml = format!(
        "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<Points>\n",
        points.len(),
        cells.len()
    );
    xml += &appended.declare("Points", 3, Values::Float64(coordinates));
    xml += "</Points>\n<Cells>\n";
    for (name, values) in [
        ("connectivity", Values::Int64(connectivity)),
        ("offsets", Values::Int64(offsets)),
        ("types", Values::UInt8(types)),
        ("faces", Values::Int64(faces)),
        ("faceoffsets", Values::Int64(face_offsets)),
    ] {
        xml += &appended.declare(name, 1, values);
    }
    xml += "</Cells>\n<CellData>\n";
    xml += &appended.declare_all(arrays);
    xml += "</CellData>\n</Piece>\n";
    replace(path, |writer| {
        appended.write(writer, "UnstructuredGrid", &xml)
    })
}
