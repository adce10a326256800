//! VTK XML files (format version 1.0) of cells, points, polygons and polyhedra: raw binary arrays appended after the XML.

use super::{Array, ImageData, failure, replace};
use crate::{Error, Result};
use std::{
    fmt::Write as _,
    fs,
    io::{self, ErrorKind, Write},
    path::{Component, Path, PathBuf},
};

/// Writes `image` to `path` for ParaView, little endian, replacing an older file only when complete.
///
/// # Errors
/// [`Error::File`] if an array does not fill the cells or the file cannot be written.
pub fn write_vti(path: impl AsRef<Path>, image: &ImageData) -> Result<()> {
    let path = path.as_ref();
    if let Some(fault) = image.fault() {
        return Err(Error::file(path, format!("cannot write: {fault}")));
    }
    let [nx, ny, nz] = image.cells;
    let [x, y, z] = image.origin;
    let h = image.spacing;
    let extent = format!("0 {nx} 0 {ny} 0 {nz}");
    let grid = format!(" WholeExtent=\"{extent}\" Origin=\"{x} {y} {z}\" Spacing=\"{h} {h} {h}\"");
    let mut appended = Appended::default();
    let mut xml = format!("<Piece Extent=\"{extent}\">\n<CellData>\n");
    xml += &appended.declare_all(&image.arrays);
    xml += "</CellData>\n</Piece>\n";
    replace(path, |writer| {
        appended.write(writer, "ImageData", &grid, &xml)
    })
}

/// VTK's number for a polyhedron.
const POLYHEDRON: u8 = 42;

/// Polyhedra, and quantities on each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polyhedra {
    /// Corners of all polyhedra, m.
    pub points: Vec<[f64; 3]>,
    /// For each polyhedron its faces, each as the indices of its corners.
    pub cells: Vec<Vec<Vec<u32>>>,
    /// The quantities, a value or vector for each polyhedron.
    pub arrays: Vec<Array>,
}

/// Writes `polyhedra` to `path` for ParaView, replacing an older file only when complete.
///
/// # Errors
/// [`Error::File`] if an array does not fill the cells, a face refers to a missing point, or
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
        appended.write(writer, "UnstructuredGrid", "", &xml)
    })
}

/// Points, and quantities on each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cloud {
    /// The points, m.
    pub points: Vec<[f64; 3]>,
    /// The quantities, a value or vector for each point.
    pub arrays: Vec<Array>,
}

/// Writes `cloud` to `path` for ParaView, each point as a visible vertex, replacing an older
/// file only when complete.
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
    replace(path, |writer| appended.write(writer, "PolyData", "", &xml))
}

/// Plane polygons, and quantities on each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// Corners of each polygon, m.
    pub polygons: Vec<Vec<[f64; 3]>>,
    /// The quantities, a value or vector for each polygon.
    pub arrays: Vec<Array>,
}

/// Writes `surface` to `path` for ParaView, replacing an older file only when complete.
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
    replace(path, |writer| appended.write(writer, "PolyData", "", &xml))
}

/// Bytes in front of each appended array: its length as UInt64.
const LENGTH_BYTES: u64 = size_of::<u64>() as u64;
/// Number of values converted at a time: 64 KiB, so that the writer is called rarely.
const CHUNK: usize = 8 * 1024;

/// Values of one of VTK's types.
enum Values<'a> {
    Float32(&'a [f32]),
    Float64(Vec<f64>),
    Int64(Vec<i64>),
    UInt8(Vec<u8>),
}

impl Values<'_> {
    fn kind(&self) -> &'static str {
        match self {
            Self::Float32(_) => "Float32",
            Self::Float64(_) => "Float64",
            Self::Int64(_) => "Int64",
            Self::UInt8(_) => "UInt8",
        }
    }

    fn bytes(&self) -> u64 {
        match self {
            Self::Float32(values) => size_of_val(*values) as u64,
            Self::Float64(values) => size_of_val(values.as_slice()) as u64,
            Self::Int64(values) => size_of_val(values.as_slice()) as u64,
            Self::UInt8(values) => values.len() as u64,
        }
    }

    fn write(&self, writer: &mut dyn Write) -> io::Result<()> {
        match self {
            Self::Float32(values) => little(writer, values, |v| v.to_le_bytes()),
            Self::Float64(values) => little(writer, values, |v| v.to_le_bytes()),
            Self::Int64(values) => little(writer, values, |v| v.to_le_bytes()),
            Self::UInt8(values) => writer.write_all(values),
        }
    }
}

fn little<T: Copy, const N: usize>(
    writer: &mut dyn Write,
    values: &[T],
    bytes: impl Fn(T) -> [u8; N],
) -> io::Result<()> {
    for chunk in values.chunks(CHUNK) {
        let chunk: Vec<u8> = chunk.iter().flat_map(|value| bytes(*value)).collect();
        writer.write_all(&chunk)?;
    }
    Ok(())
}

/// The arrays that follow the XML of a file.
#[derive(Default)]
struct Appended<'a> {
    arrays: Vec<Values<'a>>,
    offset: u64,
}

impl<'a> Appended<'a> {
    /// The element that declares `values`.
    fn declare(&mut self, name: &str, components: usize, values: Values<'a>) -> String {
        let element = format!(
            "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{components}\" \
             format=\"appended\" offset=\"{}\"/>\n",
            values.kind(),
            escape(name),
            self.offset
        );
        self.offset += LENGTH_BYTES + values.bytes();
        self.arrays.push(values);
        element
    }

    /// The elements that declare the quantities of points or cells.
    fn declare_all(&mut self, arrays: &'a [Array]) -> String {
        let mut elements = String::new();
        for array in arrays {
            let values = Values::Float32(&array.values);
            // Writing to a String cannot fail.
            let _ = write!(
                elements,
                "{}",
                self.declare(&array.name, array.components, values)
            );
        }
        elements
    }

    /// Writes a little-endian file of `kind`, whose element has these `attributes` and the content `xml`, followed by the
    /// arrays, each after its length.
    fn write(
        &self,
        writer: &mut dyn Write,
        kind: &str,
        attributes: &str,
        xml: &str,
    ) -> io::Result<()> {
        // Version 1.0 is the first with a choice of header_type; the old UInt32 is limited to 4 GiB.
        write!(
            writer,
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\" \
             header_type=\"UInt64\">\n<{kind}{attributes}>\n{xml}</{kind}>\n\
             <AppendedData encoding=\"raw\">\n_"
        )?;
        for values in &self.arrays {
            writer.write_all(&values.bytes().to_le_bytes())?;
            values.write(writer)?;
        }
        writer.write_all(b"\n</AppendedData>\n</VTKFile>\n")
    }
}

/// Describes the first array whose size is not `count` tuples; `None` if all sizes are valid.
fn fault(arrays: &[Array], count: usize, of: &str) -> Option<String> {
    arrays.iter().find_map(|array| {
        let wants = count * array.components;
        (array.values.len() != wants).then(|| {
            format!(
                "array {} has {} values; {count} {of} of {} components need {wants}",
                array.name,
                array.values.len(),
                array.components
            )
        })
    })
}

/// Escapes `text` for a quoted attribute.
fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

/// Inverse of [`escape`].
fn unescape(text: &str) -> String {
    text.replace("&quot;", "\"")
        .replace("&gt;", ">")
        .replace("&lt;", "<")
        .replace("&amp;", "&")
}

/// The value of `attribute` in `tag`, an element as [`Pvd`](super::Pvd) writes it.
fn attribute(tag: &str, attribute: &str) -> Option<String> {
    let (_, rest) = tag.split_once(&format!(" {attribute}=\""))?;
    let (value, _) = rest.split_once('"')?;
    Some(unescape(value))
}

/// A collection of files with their times, complete on disk after every [`Pvd::add`].
#[derive(Clone, Debug)]
pub struct Pvd {
    path: PathBuf,
    /// Time (s) and file, relative to the collection's folder, `/` between its parts.
    entries: Vec<(f64, String)>,
}

impl Pvd {
    /// Begins an empty collection at `path`, replacing an older one.
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

    /// Continues the collection at `path` for a run that restarts at `time` (s): entries from
    /// then on are dropped, since the run writes them again. Begins an empty one if there is none.
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
    /// `file` lies below the collection's folder. Its path either includes that folder, as when the
    /// file was written, or is relative to it.
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
