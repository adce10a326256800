//! PVD: the list of a run's images over time, the file to open in ParaView.

use super::replace::{failure, replace};
use super::vtk::{attribute, escape};
use crate::{Error, Result};
use std::fs;
use std::io::ErrorKind;
use std::path::{Component, Path, PathBuf};

/// A collection of files with their times, complete on disk after every [`Pvd::add`].
#[derive(Clone, Debug)]
pub struct Pvd {
    path: PathBuf,
    /// Time (s) and file, relative to the collection's folder, `/` between its parts.
    entries: Vec<(f64, String)>,
}

impl Pvd {
    /// Begins an empty collection at `path`, over an older one.
    ///
    /// # Errors
    /// [`Error::File`] if the file cannot be written.
    pub fn create(path: impl Into<PathBuf>) -> Result<Self> {
        let pvd = Self {
            path: path.into(),
            entries: Vec::new(),
        };
        pvd.write()?;
        Ok(pvd)
    }

    /// Continues the collection at `path` for a run that starts again at `time` (s): entries from
    /// then on are dropped, since the run writes them anew. Begins an empty one if there is none.
    ///
    /// # Errors
    /// [`Error::File`] if the file cannot be read, is not a collection written by this type, or
    /// cannot be written.
    pub fn resume(path: impl Into<PathBuf>, time: f64) -> Result<Self> {
        let path = path.into();
        let text = match fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == ErrorKind::NotFound => return Self::create(path),
            Err(error) => return Err(failure("read", &path, &error)),
        };
        let mut entries = Vec::new();
        for (number, line) in text.lines().enumerate() {
            if !line.trim_start().starts_with("<DataSet ") {
                continue;
            }
            let stamp = attribute(line, "timestep").and_then(|stamp| stamp.parse::<f64>().ok());
            let (Some(stamp), Some(file)) = (stamp, attribute(line, "file")) else {
                return Err(Error::file(
                    path,
                    format!(
                        "line {}: a DataSet needs a timestep and a file; \
                         move this collection away to begin a new one",
                        number + 1
                    ),
                ));
            };
            if stamp < time {
                entries.push((stamp, file));
            }
        }
        let pvd = Self { path, entries };
        pvd.write()?;
        Ok(pvd)
    }

    /// Adds `file` at `time` (s). A file already listed is listed once, at its new time.
    ///
    /// `file` lies below the collection's folder; it is given either with that folder in front,
    /// as it was written, or relative to it.
    ///
    /// # Errors
    /// [`Error::File`] if `file` lies elsewhere, or the collection cannot be written.
    pub fn add(&mut self, time: f64, file: impl AsRef<Path>) -> Result<()> {
        let file = self.relative(file.as_ref())?;
        self.entries.retain(|(_, listed)| *listed != file);
        self.entries.push((time, file));
        self.write()
    }

    /// Times (s) and files, in the order in which they were added.
    pub fn entries(&self) -> impl Iterator<Item = (f64, &str)> {
        self.entries
            .iter()
            .map(|(time, file)| (*time, file.as_str()))
    }

    fn relative(&self, file: &Path) -> Result<String> {
        let folder = self.path.parent().unwrap_or(Path::new(""));
        let below = file.strip_prefix(folder).unwrap_or(file);
        let parts: Option<Vec<_>> = below
            .components()
            .filter(|part| *part != Component::CurDir)
            .map(|part| match part {
                Component::Normal(name) => name.to_str(),
                _ => None,
            })
            .collect();
        parts.map(|parts| parts.join("/")).ok_or_else(|| {
            Error::file(
                file,
                format!(
                    "a collection lists files by UTF-8 paths below its own folder; \
                     write this one below {}",
                    folder.display()
                ),
            )
        })
    }

    fn write(&self) -> Result<()> {
        replace(&self.path, |writer| {
            writer.write_all(
                b"<?xml version=\"1.0\"?>\n\
                  <VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n\
                  \x20 <Collection>\n",
            )?;
            for (time, file) in &self.entries {
                let file = escape(file);
                writeln!(
                    writer,
                    "    <DataSet timestep=\"{time:?}\" part=\"0\" file=\"{file}\"/>"
                )?;
            }
            writer.write_all(b"  </Collection>\n</VTKFile>\n")
        })
    }
}
