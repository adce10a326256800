//! Triangle meshes from STL and OBJ files, and whether they enclose a volume.

#[cfg(feature = "mesh")]
use super::mesh_file;
use super::{bounding_box, cell::Moments};
use crate::error::{Error, Result};
use glam::DVec3;
use std::{
    collections::{BTreeMap, HashMap, HashSet},
    path::Path,
};

/// Vertices nearer to each other than this fraction of the mesh's diagonal are merged: STL repeats each vertex in
/// every triangle, with the rounding of f32 (6e-8).
const WELD: f64 = 1e-6;

/// A mesh of triangles with shared vertices.
#[derive(Clone, Debug, PartialEq)]
pub struct TriangleMesh {
    /// Vertices, m.
    pub vertices: Vec<DVec3>,
    /// Indices of vertices, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl TriangleMesh {
    /// The volume that a closed mesh encloses, m³; negative if its triangles are inside out.
    pub fn volume(&self) -> f64 {
        let (min, max) = self.bounds();
        let middle = (DVec3::from(min) + DVec3::from(max)) / 2.0;
        let triangles = 0..self.triangles.len();
        Moments::of(triangles.map(|t| self.corners(t).map(|c| c - middle))).volume
    }

    /// A mesh of `triangles` over `vertices` (m). Vertices that coincide are merged.
    ///
    /// Triangles that lose their area by this are dropped.
    ///
    /// # Errors
    /// If a triangle refers to a vertex that does not exist.
    pub fn new(vertices: &[DVec3], triangles: &[[u32; 3]]) -> Result<Self> {
        named(triangles, vertices.len())
            .map_err(|message| Error::argument("triangles", message))?;
        let (kept, of) = weld(vertices);
        let triangles = triangles
            .iter()
            .map(|corners| corners.map(|c| of[c as usize]))
            .filter(|[a, b, c]| a != b && b != c && c != a)
            .collect();
        Ok(Self {
            vertices: kept,
            triangles,
        })
    }

    /// Reads an STL or OBJ file whose unit is `scale` (m), and moves its origin to `translate` (m).
    ///
    /// # Errors
    /// If the file cannot be read, is neither STL nor OBJ, or contains no triangle.
    pub fn read(path: &Path, scale: f64, translate: [f64; 3]) -> Result<Self> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        let bytes = std::fs::read(path)
            .map_err(|e| Error::file(path, format!("cannot read the mesh: {e}; check the path")))?;
        if bytes.is_empty() {
            return Err(Error::file(
                path,
                "the file is empty; export the mesh again",
            ));
        }
        let (vertices, triangles) = match extension.as_deref() {
            #[cfg(feature = "mesh")]
            Some("stl") => mesh_file::read_stl(bytes),
            #[cfg(feature = "mesh")]
            Some("obj") => mesh_file::read_obj(bytes),
            #[cfg(not(feature = "mesh"))]
            Some("stl" | "obj") => no_files(bytes),
            _ => Err("a mesh is an .stl or an .obj file; convert it".into()),
        }
        .map_err(|message| Error::file(path, message))?;
        if triangles.is_empty() {
            return Err(Error::file(
                path,
                "the mesh has no triangles; export it again",
            ));
        }
        if let Some(bad) = vertices.iter().find(|v| !v.is_finite()) {
            return Err(Error::file(
                path,
                format!("a vertex is {bad}; repair the mesh"),
            ));
        }
        let place = |v: &DVec3| *v * scale + DVec3::from(translate);
        let placed: Vec<DVec3> = vertices.iter().map(place).collect();
        Self::new(&placed, &triangles).map_err(|error| Error::file(path, error))
    }

    /// Corners of the triangle `index`, m; NaN if the triangle or its vertices do not exist.
    pub fn corners(&self, index: usize) -> [DVec3; 3] {
        let corner = |c: u32| self.vertices.get(c as usize).copied().unwrap_or(DVec3::NAN);
        let triangle = self.triangles.get(index);
        triangle.map_or([DVec3::NAN; 3], |corners| corners.map(corner))
    }

    /// Lower and upper corner of the bounding box of the mesh, m.
    pub fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        let [min, max] = bounding_box(self.vertices.iter().copied());
        (min.into(), max.into())
    }

    /// Checks that the triangles use every edge equally often in both directions: then the surface has no boundary,
    /// and its winding number is an integer at every point off it.
    ///
    /// # Errors
    /// Names the number of invalid edges, the position of the first one and a remedy, or the vertex that does not exist.
    pub fn closed(&self) -> Result<(), String> {
        named(&self.triangles, self.vertices.len())?;
        // Number of uses of each edge, and the excess of one direction. Sorted, so that the message is deterministic.
        let mut edges: BTreeMap<(u32, u32), (u32, i32)> = BTreeMap::new();
        for [a, b, c] in &self.triangles {
            for (from, to) in [(*a, *b), (*b, *c), (*c, *a)] {
                let edge = edges.entry((from.min(to), from.max(to))).or_default();
                edge.0 += 1;
                edge.1 += if from < to { 1 } else { -1 };
            }
        }
        let middle = |(a, b): (u32, u32)| {
            let m = (self.vertices[a as usize] + self.vertices[b as usize]) / 2.0;
            format!("({:.6}, {:.6}, {:.6}) m", m.x, m.y, m.z)
        };
        let boundary: Vec<_> = edges
            .iter()
            .filter(|(_, (used, balance))| used % 2 == 1 && *balance != 0)
            .map(|(edge, _)| *edge)
            .collect();
        if let Some(first) = boundary.first() {
            if let Some([a, b, c]) = self.twice() {
                return Err(format!(
                    "the mesh has a triangle twice, near {}; remove the duplicates",
                    middle((a, b.max(c)))
                ));
            }
            return Err(format!(
                "the mesh is open: {} boundary edges, the first near {}; close its holes (in the \
                 scene's coordinates) or export it as a solid",
                boundary.len(),
                middle(*first)
            ));
        }
        let turned: Vec<_> = edges
            .iter()
            .filter(|(_, (_, balance))| *balance != 0)
            .collect();
        match turned.first() {
            None => Ok(()),
            Some((first, _)) => Err(format!(
                "triangles of the mesh face different ways across {} edges, the first near {}; \
                 recompute its normals outwards",
                turned.len(),
                middle(**first)
            )),
        }
    }

    /// A triangle that occurs twice with the same orientation, from its lowest vertex.
    fn twice(&self) -> Option<[u32; 3]> {
        let mut known = HashSet::new();
        let mut all = self.triangles.iter().copied().map(|mut corners| {
            let lowest = (0..3).min_by_key(|i| corners[*i]).unwrap_or(0);
            corners.rotate_left(lowest);
            corners
        });
        all.find(|corners| !known.insert(*corners))
    }
}

/// Checks that all corners of `triangles` are indices of one of so many `vertices`.
pub(super) fn named(triangles: &[[u32; 3]], vertices: usize) -> Result<(), String> {
    let all = triangles.iter().flatten();
    match all.max().filter(|corner| **corner as usize >= vertices) {
        None => Ok(()),
        Some(corner) => Err(format!(
            "a triangle names the vertex {corner}, and there are only {vertices}; count them from 0, or export the mesh again"
        )),
    }
}

/// Vertices and triangles of a file.
pub(super) type Soup = (Vec<DVec3>, Vec<[u32; 3]>);

#[cfg(not(feature = "mesh"))]
fn no_files(_: Vec<u8>) -> Result<Soup, String> {
    Err("this program reads no meshes; build it with the feature `mesh` of riprap".into())
}

/// The distinct points, and for each given point the index of its distinct point.
fn weld(points: &[DVec3]) -> (Vec<DVec3>, Vec<u32>) {
    let [min, max] = bounding_box(points.iter().copied());
    let reach = (WELD * min.distance(max)).max(f64::MIN_POSITIVE);
    let bin = |p: DVec3| ((p - min) / reach).floor().as_i64vec3().to_array();
    let mut bins: HashMap<[i64; 3], u32> = HashMap::new();
    let mut kept: Vec<DVec3> = Vec::new();
    let mut of = Vec::with_capacity(points.len());
    for p in points {
        let here = bin(*p);
        let near = (0..27).find_map(|n| {
            let shift = [n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1];
            let candidate = *bins.get(&std::array::from_fn(|a| here[a] + shift[a]))?;
            (kept[candidate as usize].distance(*p) <= reach).then_some(candidate)
        });
        of.push(near.unwrap_or_else(|| {
            let new = kept.len() as u32;
            kept.push(*p);
            bins.insert(here, new);
            new
        }));
    }
    (kept, of)
}
