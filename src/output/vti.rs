//! VTK ImageData files (VTK XML format, version 1.0): cell data, raw binary appended.

use super::replace::replace;
use super::xml::escape;
use super::{Array, Image};
use crate::{Error, Result};
use std::io::{self, Write};
use std::path::Path;

/// Bytes in front of each appended array: its length as UInt64.
const LENGTH_BYTES: usize = size_of::<u64>();

/// Values converted at a time: 64 KiB, enough to make the calls to the writer few.
const CHUNK: usize = 16 * 1024;

/// Writes `image` to `path` for ParaView, little endian, replacing an older file only when done.
///
/// # Errors
/// [`Error::File`] if an array does not fill the cells or the file cannot be written.
pub fn write_vti(path: impl AsRef<Path>, image: &Image) -> Result<()> {
    let path = path.as_ref();
    if let Some(fault) = image.fault() {
        return Err(Error::file(path, format!("cannot write: {fault}")));
    }
    replace(path, |writer| {
        writer.write_all(header(image).as_bytes())?;
        for array in &image.arrays {
            append(writer, array)?;
        }
        writer.write_all(b"\n  </AppendedData>\n</VTKFile>\n")
    })
}

fn header(image: &Image) -> String {
    let [nx, ny, nz] = image.cells;
    let [x, y, z] = image.origin;
    let h = image.spacing;
    let extent = format!("0 {nx} 0 {ny} 0 {nz}");
    let mut offset = 0;
    let mut arrays = String::new();
    for array in &image.arrays {
        arrays += &format!(
            "        <DataArray type=\"Float32\" Name=\"{}\" NumberOfComponents=\"{}\" \
             format=\"appended\" offset=\"{offset}\"/>\n",
            escape(&array.name),
            array.components
        );
        offset += LENGTH_BYTES + size_of_val(array.values.as_slice());
    }
    // Version 1.0 is the first that lets header_type be chosen; the old UInt32 ends at 4 GiB.
    format!(
        "<?xml version=\"1.0\"?>\n\
         <VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n\
         \x20 <ImageData WholeExtent=\"{extent}\" Origin=\"{x} {y} {z}\" Spacing=\"{h} {h} {h}\">\n\
         \x20   <Piece Extent=\"{extent}\">\n\
         \x20     <CellData>\n{arrays}      </CellData>\n\
         \x20   </Piece>\n\
         \x20 </ImageData>\n\
         \x20 <AppendedData encoding=\"raw\">\n_"
    )
}

fn append(writer: &mut dyn Write, array: &Array) -> io::Result<()> {
    let bytes = size_of_val(array.values.as_slice()) as u64;
    writer.write_all(&bytes.to_le_bytes())?;
    for chunk in array.values.chunks(CHUNK) {
        let little: Vec<u32> = chunk.iter().map(|value| value.to_bits().to_le()).collect();
        writer.write_all(bytemuck::cast_slice(&little))?;
    }
    Ok(())
}
