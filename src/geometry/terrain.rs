//! Height surfaces on a grid, from surveys.

#[cfg(feature = "mesh")]
use super::terrain_file;
use super::{Form, Part, Polyhedron, Shape};
use crate::{Error, Result};
use glam::DVec3;
use std::path::Path;

/// Largest number of triangles of a surface for contact with blocks: each is a convex part.
const MOST_PRISMS: usize = 200_000;
/// Numbers of files that stand for no height, whether the file declares them or not: those of surveys, and of programs that
/// write the least or largest number.
const NO_DATA: [f64; 4] = [-9999.0, -99999.0, -32768.0, -32767.0];
const NO_HEIGHT: f64 = 1e6;

/// Heights along z on a grid in x and y. Each rectangle of the grid is divided into two triangles by the diagonal from its
/// lower to its upper corner. The volume below is solid.
#[derive(Clone, Debug, PartialEq)]
pub struct Terrain {
    /// Node with the smallest x and y, m.
    pub(super) origin: [f64; 2],
    /// Distance between nodes along x and y, m.
    pub(super) spacing: [f64; 2],
    /// Number of nodes along x and y, at least two each.
    pub(super) nodes: [usize; 2],
    /// Height of each node, m, x fastest; NaN where there is none.
    pub(super) heights: Vec<f64>,
}

impl Terrain {
    /// A terrain from the heights (m, x fastest, NaN where there is none) of `nodes` along x and y that are `spacing` (m)
    /// apart; the node with the smallest x and y is at `origin` (m).
    ///
    /// # Errors
    /// If there are fewer than two nodes along an axis, another number of heights, or origin or spacing are invalid.
    pub fn new(
        origin: [f64; 2],
        spacing: [f64; 2],
        nodes: [usize; 2],
        heights: Vec<f64>,
    ) -> Result<Self> {
        let made = Self {
            origin,
            spacing,
            nodes,
            heights,
        };
        let made = made.checked();
        made.map_err(|message| Error::argument("heights", message))
    }

    fn checked(self) -> Result<Self, String> {
        let [nx, ny] = self.nodes;
        if nx < 2 || ny < 2 || nx.checked_mul(ny) != Some(self.heights.len()) {
            return Err(format!(
                "it has {} heights for {nx} × {ny} nodes; a surface needs two along x and y",
                self.heights.len()
            ));
        }
        let positive = |spacing: &f64| *spacing > 0.0 && spacing.is_finite();
        if !(self.spacing.iter().all(positive) && self.origin.iter().all(|x| x.is_finite())) {
            let ([x, y], [dx, dy]) = (self.origin, self.spacing);
            return Err(format!(
                "its nodes begin at ({x}, {y}) and are {dx} and {dy} apart; give finite numbers and positive distances"
            ));
        }
        Ok(self)
    }

    /// Reads an XYZ file of a regular grid, an ESRI ASCII grid or a GeoTIFF whose unit is `scale` (m), and moves its origin to
    /// `translate` (m). Where the file has its no-data value, −9999, −99999, −32767, −32768, or a number from 1e6, it has no height.
    ///
    /// # Errors
    /// If the file cannot be read, is none of these, or has no rectangle of heights.
    pub fn read(path: &Path, scale: f64, translate: [f64; 3]) -> Result<Self> {
        let refused = |message: String| Error::file(path, message);
        let bytes = std::fs::read(path)
            .map_err(|e| refused(format!("cannot read the terrain: {e}; check the path")))?;
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        let read: Result<Self, String> = match extension.as_deref() {
            #[cfg(feature = "mesh")]
            Some("tif" | "tiff") => terrain_file::read_tiff(bytes),
            #[cfg(feature = "mesh")]
            Some("asc" | "grd") => terrain_file::read_ascii_grid(&bytes),
            #[cfg(feature = "mesh")]
            Some("xyz" | "txt" | "csv") => terrain_file::read_xyz(&bytes),
            #[cfg(not(feature = "mesh"))]
            Some("tif" | "tiff" | "asc" | "grd" | "xyz" | "txt" | "csv") => {
                let _ = bytes;
                Err("files of terrain need the feature `mesh` of riprap".into())
            }
            _ => Err("a terrain is an .xyz, .asc or .tif file; convert it".into()),
        };
        let mut made = read.and_then(Self::checked).map_err(refused)?;
        for a in 0..2 {
            made.origin[a] = made.origin[a] * scale + translate[a];
            made.spacing[a] *= scale;
        }
        for height in &mut made.heights {
            let none = NO_DATA.contains(height) || height.abs() >= NO_HEIGHT;
            *height = if none {
                f64::NAN
            } else {
                *height * scale + translate[2]
            };
        }
        Ok(made)
    }

    /// Position of the node i, j, m.
    fn node(&self, i: usize, j: usize) -> DVec3 {
        DVec3::new(
            self.origin[0] + i as f64 * self.spacing[0],
            self.origin[1] + j as f64 * self.spacing[1],
            self.heights[i + self.nodes[0] * j],
        )
    }

    /// The rectangles that lie at least partly between two corners in x and y (m), each with its nodes counter-clockwise.
    fn rectangles(&self, min: [f64; 2], max: [f64; 2]) -> impl Iterator<Item = [DVec3; 4]> + '_ {
        let range = |a: usize| {
            // Float to integer casts saturate, so that what lies outside drops out.
            let at = |x: f64| (x - self.origin[a]) / self.spacing[a];
            let last = (self.nodes[a] - 1).min(at(max[a]).ceil().max(0.0) as usize);
            at(min[a]).floor() as usize..last
        };
        let (across, along) = (range(0), range(1));
        along.flat_map(move |j| {
            across.clone().map(move |i| {
                [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[di, dj]| self.node(i + di, j + dj))
            })
        })
    }

    /// The triangles of the surface that lie at least partly between two corners in x and y (m), counter-clockwise seen from
    /// above, without those that have a node without a height.
    pub fn triangles(&self, min: [f64; 2], max: [f64; 2]) -> Vec<[DVec3; 3]> {
        let halves = |[a, b, c, d]: [DVec3; 4]| [[a, b, c], [a, c, d]];
        let all = self.rectangles(min, max).flat_map(halves);
        all.filter(|corners| corners.iter().all(|p| p.z.is_finite()))
            .collect()
    }

    /// The height at x and y (m); `None` outside the surface and where it has no height.
    pub fn height(&self, x: f64, y: f64) -> Option<f64> {
        let [u, v] = [(x, 0), (y, 1)].map(|(x, a)| (x - self.origin[a]) / self.spacing[a]);
        let inside = |u: f64, a: usize| u >= 0.0 && u <= (self.nodes[a] - 1) as f64;
        if !(inside(u, 0) && inside(v, 1)) {
            return None;
        }
        let cell = |u: f64, a: usize| (u as usize).min(self.nodes[a] - 2);
        let (i, j) = (cell(u, 0), cell(v, 1));
        let (u, v) = (u - i as f64, v - j as f64);
        let [a, b, c, d] =
            [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[di, dj]| self.node(i + di, j + dj).z);
        let height = match u >= v {
            true => a + u * (b - a) + v * (c - b),
            false => a + v * (d - a) + u * (c - d),
        };
        height.is_finite().then_some(height)
    }

    /// The shape that blocks touch between two corners in x and y (m), and its centroid (m): a prism below each triangle, and
    /// one prism below a plane rectangle. All end at the height `bottom` (m), or below the lowest point if that is not lower.
    ///
    /// # Errors
    /// If no rectangle with heights lies there, or the shape would have too many prisms.
    pub(crate) fn shape(
        &self,
        min: [f64; 2],
        max: [f64; 2],
        bottom: f64,
    ) -> Result<(Shape, DVec3)> {
        let size = |[a, b, c, d]: [DVec3; 4]| (c - a).length().max((d - b).length());
        let corners = self.rectangles(min, max);
        let depths = corners.flat_map(|corners| corners.map(|p| p.z - size(corners)));
        let base = depths.filter(|z| z.is_finite()).fold(bottom, f64::min);
        let mut parts = Vec::new();
        let refused = |message: String| Err(Error::argument("file", message));
        for corners in self.rectangles(min, max) {
            let [a, b, c, d] = corners;
            let flat = (a.z - b.z + c.z - d.z).abs() < 1e-9 * size(corners);
            let halves = [[a, b, c, c], [a, c, d, d]];
            let pieces = if flat { &[corners][..] } else { &halves[..] };
            for top in pieces
                .iter()
                .filter(|top| top.iter().all(|p| p.z.is_finite()))
            {
                if parts.len() == MOST_PRISMS {
                    return refused(format!(
                        "the terrain has over {MOST_PRISMS} triangles in the domain, too many for blocks to touch; resample it \
                         to a coarser grid"
                    ));
                }
                let below = top.iter().map(|p| DVec3::new(p.x, p.y, base));
                let points: Vec<DVec3> = top.iter().copied().chain(below).collect();
                let (form, offset) = Polyhedron::from_vertices(&points)?;
                parts.push(Part {
                    form: Form::Convex(form),
                    offset,
                });
            }
        }
        if parts.is_empty() {
            return refused("no rectangle of the terrain with heights lies in the domain".into());
        }
        Ok(Shape::disjoint(parts))
    }
}
