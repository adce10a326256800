//! STL and OBJ files.

use super::mesh::Soup;
use glam::DVec3;
use std::{collections::HashMap, io::Cursor, path::Path};

pub(super) fn read_stl(mut bytes: Vec<u8>) -> Result<Soup, String> {
    if is_binary_stl(&bytes) {
        // Some programs begin binary headers with the word that marks text files.
        bytes[..HEADER].fill(0);
    }
    let mesh = stl_io::read_stl(&mut Cursor::new(bytes))
        .map_err(|e| format!("not a valid STL file: {e}; export it again"))?;
    let vertex = |v: &stl_io::Vertex| DVec3::from(v.0.map(f64::from));
    Ok((
        mesh.vertices.iter().map(vertex).collect(),
        mesh.faces
            .iter()
            .map(|f| f.vertices.map(|v| v as u32))
            .collect(),
    ))
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

pub(super) fn read_obj(bytes: Vec<u8>) -> Result<Soup, String> {
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
        vertices.extend(points.iter().map(|p| DVec3::from(p.map(f64::from))));
        let (faces, _) = model.mesh.indices.as_chunks::<3>();
        triangles.extend(faces.iter().map(|f| f.map(|v| v + first)));
    }
    Ok((vertices, triangles))
}
