//! Output files: VTI, VTU, VTP and PVD for ParaView, CSV for probes.
//!
//! A run fills an [`ImageData`] with cell data and passes it to [`write_vti`]; a [`Pvd`] collects the
//! images over time, a [`Csv`] the values of a probe. An image or a collection replaces its
//! predecessor only when complete. [`Pvd::resume`] and [`Csv::resume`] continue after a
//! restart as if the run had not been interrupted.
//!
//! ```
//! use riprap::output::{Array, ImageData, write_vti};
//! let folder = std::env::temp_dir().join(format!("riprap_doc_{}", std::process::id()));
//! std::fs::create_dir_all(&folder).expect("a temporary folder");
//! let image = ImageData {
//!     origin: [0.0; 3],
//!     spacing: 0.5,
//!     cells: [2, 1, 1],
//!     arrays: vec![Array { name: "pressure".into(), components: 1, values: vec![1.0, 3.0] }],
//! };
//! assert_eq!(image.sample("pressure", [0.5, 0.25, 0.25]), Some(vec![2.0]));
//! write_vti(folder.join("flow.vti"), &image)?;
//! # std::fs::remove_dir_all(&folder).expect("the folder made above");
//! # Ok::<(), riprap::Error>(())
//! ```

mod csv;
mod image;
mod series;
mod vtk;

pub use csv::{Csv, Table};
pub use image::{Array, ImageData, VelocityQuantities};
pub use series::Series;
pub use vtk::{Cloud, Polyhedra, Pvd, Surface, write_surface, write_vti, write_vtp, write_vtu};

use crate::{Error, Result};
use std::{
    fs::{self, File},
    io::{self, BufWriter, ErrorKind, Write},
    path::{Path, PathBuf},
};

/// Writes `path` with `content`: first to a file next to it, which is renamed when complete, so that
/// a killed run or a full disk leaves the old file and never a part of the new one.
///
/// # Errors
/// [`Error::File`] with the system's reason and a remedy.
pub fn replace(path: &Path, content: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    // A device or a pipe cannot be replaced by a rename, and has no former content to keep.
    if fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir()) {
        return File::options()
            .write(true)
            .open(path)
            .and_then(|file| fill(&file, content))
            .map_err(|error| failure("write", path, &error));
    }
    let draft = draft_of(path);
    let written = File::create(&draft)
        .and_then(|file| {
            fill(&file, content)?;
            // Some file systems report a full disk only here.
            file.sync_all()
        })
        .and_then(|()| fs::rename(&draft, path));
    written.map_err(|error| {
        // The incomplete draft is removed; it may not exist.
        let _ = fs::remove_file(&draft);
        failure("write", path, &error)
    })
}

fn fill(file: &File, content: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut writer = BufWriter::new(file);
    content(&mut writer)?;
    writer.flush()
}

/// Name of the incomplete file for `path`: in the same folder, since a rename cannot cross file systems.
fn draft_of(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(".part");
    path.with_file_name(name)
}

/// The error for `path`, with a remedy.
pub(crate) fn failure(action: &str, path: &Path, error: &io::Error) -> Error {
    let remedy = match error.kind() {
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded => {
            "free some space, write less often, or choose a folder on another disk"
        }
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
            "choose a folder that this user may write to"
        }
        ErrorKind::NotFound if action == "read" => {
            "there is no such file: check the spelling of the path"
        }
        ErrorKind::NotFound => "create its folder first, or check the spelling of the path",
        ErrorKind::NotADirectory => {
            "a part of the path is a file, not a folder; choose another path"
        }
        ErrorKind::IsADirectory => "this is a folder; add a file name",
        _ => "check the path and the disk",
    };
    Error::file(path, format!("cannot {action}: {error}; {remedy}"))
}
