//! VTK ImageData files (VTK XML format, version 1.0): cell data, raw binary appended.

use super::Image;
use super::appended::{Appended, Values};
use super::replace::replace;
use crate::{Error, Result};
use std::path::Path;

/// Writes `image` to `path` for ParaView, little endian, replacing an older file only when done.
///
/// # Errors
/// [`Error::File`] if an array does not fill the cells or the file cannot be written.
pub fn write_vti(path: impl AsRef<Path>, image: &Image) -> Result<()> {
    let path = path.as_ref();
    if let Some(fault) = image.fault() {
        return Err(Error::file(path, format!("cannot write: {fault}")));
    }
    let mut appended = Appended::default();
    let mut elements = String::new();
    for array in &image.arrays {
        let values = Values::Float32(&array.values);
        elements += "        ";
        elements += &appended.declare(&array.name, array.components, values);
    }
    let header = header(image, &elements);
    replace(path, |writer| {
        writer.write_all(header.as_bytes())?;
        appended.write_arrays(writer)?;
        writer.write_all(b"\n  </AppendedData>\n</VTKFile>\n")
    })
}

/// What stands before the arrays that `elements` announce.
fn header(image: &Image, elements: &str) -> String {
    let [nx, ny, nz] = image.cells;
    let [x, y, z] = image.origin;
    let h = image.spacing;
    let extent = format!("0 {nx} 0 {ny} 0 {nz}");
    // Version 1.0 is the first that lets header_type be chosen; the old UInt32 ends at 4 GiB.
    format!(
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
         \x20 <ImageData WholeExtent=\"{extent}\" Origin=\"{x} {y} {z}\" Spacing=\"{h} {h} {h}\">\n\
         \x20   <Piece Extent=\"{extent}\">\n\
         \x20     <CellData>\n{elements}      </CellData>\n\
         \x20   </Piece>\n\
         \x20 </ImageData>\n\
         \x20 <AppendedData encoding=\"raw\">\n_"
    )
}
