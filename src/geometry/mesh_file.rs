//! STL and OBJ files.

use super::{bounding_box, mesh::Soup};
use glam::DVec3;
use std::{collections::HashMap, io::Cursor, path::Path};

pub(super) fn read_stl(mut bytes: Vec<u8>) -> Result<Soup, String> {
    let (bytes, origin) = if is_binary_stl(&bytes) {
        // Some programs begin binary headers with the word that marks text files.
        bytes[..HEADER].fill(0);
        (bytes, DVec3::ZERO)
    } else {
        recentred(plain_stl(bytes), "vertex")
    };
    let mesh = stl_io::read_stl(&mut Cursor::new(bytes))
        .map_err(|e| format!("not a valid STL file: {e}; export it again"))?;
    let vertex = |v: &stl_io::Vertex| origin + DVec3::from(v.0.map(f64::from));
    let vertices: Vec<DVec3> = mesh.vertices.iter().map(vertex).collect();
    check_rounding(&vertices, origin)?;
    Ok((
        vertices,
        mesh.faces
            .iter()
            .map(|f| f.vertices.map(|v| v as u32))
            .collect(),
    ))
}

/// A text STL in lower case, with a name, without a byte order mark and without normals, which follow from the order of the vertices
/// and some programs write as NaN; unchanged if it does not begin with `solid`.
fn plain_stl(bytes: Vec<u8>) -> Vec<u8> {
    let text = String::from_utf8_lossy(without_mark(&bytes)).to_ascii_lowercase();
    if !text.trim_start().starts_with("solid") {
        return bytes;
    }
    let lines = text.lines().map(|line| match line.trim() {
        "solid" => "solid mesh",
        line if line.starts_with("facet") => "facet normal 0 0 0",
        line => line,
    });
    lines
        .flat_map(|line| [line, "\n"])
        .collect::<String>()
        .into()
}

/// A text without a byte order mark.
fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes)
}

/// Bytes of free text before the number of triangles in binary STL.
const HEADER: usize = 80;

/// Whether the length matches the number of triangles (50 bytes each) in the header of a binary STL file.
fn is_binary_stl(bytes: &[u8]) -> bool {
    match bytes.get(HEADER..).and_then(|rest| rest.first_chunk::<4>()) {
        Some(count) => bytes.len() as u64 == 84 + 50 * u64::from(u32::from_le_bytes(*count)),
        None => false,
    }
}

/// Largest rounding of vertices, relative to the size of their mesh.
const ROUNDING: f64 = 1e-4;

/// Refuses a mesh that is small against the distance to its origin, whose vertices f32 rounds too much.
fn check_rounding(vertices: &[DVec3], origin: DVec3) -> Result<(), String> {
    let [low, high] = bounding_box(vertices.iter().map(|vertex| *vertex - origin));
    let size = (high - low).max_element();
    let farthest = high.max(-low).max_element();
    let rounding = 0.5 * f64::from(f32::EPSILON) * farthest;
    if rounding <= ROUNDING * size || !size.is_finite() || size <= 0.0 {
        return Ok(());
    }
    Err(format!(
        "a binary STL file has numbers of 32 bits: vertices {farthest:.3e} from the origin are rounded by up to {rounding:.1e}, and \
         the mesh is only {size:.3e} large; move its origin next to it, or export it as text or OBJ"
    ))
}

/// A text with its vertices, the lines that begin with `keyword`, relative to an origin near them, and that origin: the
/// crates read f32, which rounds coordinates of surveys to decimetres. The origin is 0 for a mesh that is next to it.
fn recentred(bytes: Vec<u8>, keyword: &str) -> (Vec<u8>, DVec3) {
    let text = String::from_utf8_lossy(&bytes);
    let vertex = |line: &str| {
        let rest = line.trim_start().strip_prefix(keyword)?;
        let rest = rest.strip_prefix([' ', '\t'])?;
        let mut words = rest.split_ascii_whitespace();
        let mut number = || words.next()?.parse::<f64>().ok();
        let place = DVec3::new(number()?, number()?, number()?);
        let more: Vec<&str> = words.collect();
        place.is_finite().then(|| (place, more.join(" ")))
    };
    let [low, high] = bounding_box(text.lines().filter_map(vertex).map(|(place, _)| place));
    // A power of two, so that differences have no rounding.
    let step = (4.0 * (high - low).max_element()).log2().ceil().exp2();
    let origin = (0.5 * (low + high) / step).round() * step;
    if origin == DVec3::ZERO || !origin.is_finite() {
        return (bytes, DVec3::ZERO);
    }
    let mut moved = String::with_capacity(text.len());
    for line in text.lines() {
        match vertex(line) {
            Some((place, more)) => {
                let [x, y, z] = (place - origin).to_array();
                moved += &format!("{keyword} {x} {y} {z} {more}\n");
            }
            None => moved += &format!("{line}\n"),
        }
    }
    (moved.into_bytes(), origin)
}

pub(super) fn read_obj(bytes: Vec<u8>) -> Result<Soup, String> {
    // A backslash continues a line.
    let text = String::from_utf8_lossy(without_mark(&bytes));
    let text = text.replace("\\\r\n", " ").replace("\\\n", " ");
    let (bytes, origin) = recentred(text.into_bytes(), "v");
    let options = tobj::LoadOptions {
        triangulate: true,
        ..Default::default()
    };
    // Materials do not affect the shape.
    let no_materials = |_: &Path| Ok((Vec::new(), HashMap::default()));
    let (models, _) = tobj::load_obj_buf(&mut Cursor::new(bytes), &options, no_materials)
        .map_err(|e| format!("not a valid OBJ file: {e}; export it again"))?;
    let mut vertices = Vec::new();
    let mut triangles = Vec::new();
    for model in models {
        let first = vertices.len() as u32;
        let (points, _) = model.mesh.positions.as_chunks::<3>();
        vertices.extend(
            points
                .iter()
                .map(|p| origin + DVec3::from(p.map(f64::from))),
        );
        let (faces, _) = model.mesh.indices.as_chunks::<3>();
        triangles.extend(faces.iter().map(|f| f.map(|v| v + first)));
    }
    Ok((vertices, triangles))
}
