//! Whether a mesh encloses a volume.

use std::collections::BTreeMap;

use super::{TriangleMesh, mesh::named};

impl TriangleMesh {
    /// Whether every edge is passed as often in one direction as in the other: then the surface has no
    /// boundary, and the winding number of every point off it is whole.
    ///
    /// # Errors
    /// Says how many edges offend, near which point, and how to mend the mesh, or which vertex is not there.
    pub fn closed(&self) -> Result<(), String> {
        named(&self.triangles, self.vertices.len())?;
        // How often an edge is used at all, and by how much one direction prevails. Sorted, so that the
        // message is the same every time.
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
}
