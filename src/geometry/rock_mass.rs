//! Fractured rock: convex volumes cut by joint sets into convex blocks.
//!
//! Successive subdivision (Gardner, Kolb & Sitar 2017, Comput. Geotech. 89:1, "SparkRocks"): each joint divides the
//! convex pieces that it crosses into two convex pieces. Pieces are independent of each other, so they are cut in
//! parallel; the result does not depend on the number of threads.

use super::{
    Compass, HalfSpace, JointSet, Polyhedron,
    cell::{Cell, ON},
    joint_set::Joints,
    min_max,
    polyhedron::{SLIVER, cell_of, unit},
};
use crate::{Error, Result};
use glam::DVec3;
use rayon::prelude::*;

/// Largest number of pieces: their polyhedra take about 2 kB each.
const MOST: usize = 10_000_000;

/// Radius of the smallest block, relative to the size of the mass; coordinates of the block are then accurate to 1e-6 of it.
const SPECK: f64 = 1e-6;

/// A rock mass to be cut.
///
/// ```
/// use glam::DVec3;
/// use riprap::geometry::{JointSet, Polyhedron, RockMass, Scatter};
///
/// # fn main() -> riprap::Result<()> {
/// // A cube of 4 m cut every 1 m by joints that fall by 60° to the east.
/// let cube = Polyhedron::cuboid(DVec3::splat(4.0))?;
/// let mass = RockMass {
///     joints: vec![JointSet {
///         dip: 60.0,
///         dip_direction: 90.0,
///         spacing: 1.0,
///         scatter: Scatter::None,
///         origin: DVec3::ZERO,
///         seed: 0,
///         persistence: None,
///     }],
///     ..RockMass::new(vec![cube.faces().to_vec()])
/// };
/// let cut = mass.cut()?;
/// assert_eq!(cut.blocks.len(), 6);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct RockMass {
    /// Convex volumes, each inside all of its faces (m); they should not overlap.
    pub volumes: Vec<Vec<HalfSpace>>,
    /// Further faces that bound all volumes, such as the slope or the ground surface.
    pub surfaces: Vec<HalfSpace>,
    /// The joint sets, cut in this order.
    pub joints: Vec<JointSet>,
    /// Reference directions of dip and dip direction.
    pub compass: Compass,
    /// Pieces smaller than this are slivers, m³; 0 for none.
    pub smallest_volume: f64,
    /// Pieces with a face nearer to the centroid than this fraction of the diameter (twice the radius) are slivers.
    /// Pieces below 1e-4, which contact cannot resolve, are always slivers, and so are pieces smaller than 1e-6 of
    /// the mass, for which rounding leaves too few digits.
    pub smallest_thickness: f64,
}

/// A rock mass in pieces. The volumes of blocks and slivers add up to that of the mass.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Fragments {
    /// The blocks, in an order that depends only on the rock mass.
    pub blocks: Vec<Fragment>,
    /// Pieces that are too small or too thin.
    pub slivers: Vec<Sliver>,
    /// Volume of the mass inside all surfaces, m³.
    pub volume: f64,
}

/// A block of a rock mass.
#[derive(Clone, Debug, PartialEq)]
pub struct Fragment {
    /// Its shape.
    pub shape: Polyhedron,
    /// Its centroid, m.
    pub centre: DVec3,
    /// The planes of the shape's faces, in their order, in the coordinates of the mass: bitwise those of the mass's
    /// faces and of the joints, and exactly opposite for the block on the other side.
    pub planes: Vec<HalfSpace>,
}

/// A piece that is too small or too thin for a block.
#[derive(Clone, Debug, PartialEq)]
pub struct Sliver {
    /// Volume, m³.
    pub volume: f64,
    /// Centroid, m.
    pub centre: DVec3,
    /// The piece as a block, if contact can resolve it.
    pub block: Option<Fragment>,
}

impl RockMass {
    /// A mass without joints, surfaces or limits for slivers; z up and y north.
    pub fn new(volumes: Vec<Vec<HalfSpace>>) -> Self {
        Self {
            volumes,
            surfaces: Vec::new(),
            joints: Vec::new(),
            compass: Compass::default(),
            smallest_volume: 0.0,
            smallest_thickness: 0.0,
        }
    }

    /// Cuts the mass.
    ///
    /// # Errors
    /// If a volume is not a block (see [`Polyhedron::from_half_spaces`]), a joint set or a limit for slivers is invalid, or
    /// there would be more than ten million pieces. Names the volume or the set.
    pub fn cut(&self) -> Result<Fragments> {
        if self.volumes.is_empty() {
            let message = "a rock mass needs a volume; give the faces of at least one";
            return Err(Error::argument("volumes", message));
        }
        for (name, least) in [
            ("smallest_volume", self.smallest_volume),
            ("smallest_thickness", self.smallest_thickness),
        ] {
            if !(least >= 0.0 && least.is_finite()) {
                let message = format!("is {least}; give a number from 0");
                return Err(Error::argument(name, message));
            }
        }
        // All planes, in the coordinates of the mass. Facets refer to them by index.
        let mut planes = Vec::new();
        let mut pieces = Vec::new();
        for (index, faces) in self.volumes.iter().enumerate() {
            let name = |e: Error| e.within(&format!("volumes[{index}]"));
            let all = [faces.as_slice(), &self.surfaces].concat();
            let faces = unit(&all).map_err(name)?;
            let mut cell = cell_of(&faces).map_err(name)?;
            for facet in &mut cell.facets {
                facet.source += planes.len() as u32;
            }
            planes.extend(faces);
            pieces.push(cell);
        }
        let middle = recentre(&mut pieces);
        let reach = pieces
            .iter()
            .flat_map(Cell::live)
            .map(|v| v.abs().max_element());
        let size = reach.fold(0.0, f64::max);
        pieces.iter_mut().for_each(Cell::compact);
        let volume = pieces.iter().map(|p| p.moments(DVec3::ZERO).volume).sum();
        for (index, set) in self.joints.iter().enumerate() {
            let joints = set
                .joints(&self.compass, |normal| {
                    let [low, high] = heights(&pieces, normal);
                    let offset = normal.dot(middle);
                    [low + offset, high + offset]
                })
                .map_err(|e| e.within(&format!("joints[{index}]")))?;
            let cutter = Cutter {
                local: joints
                    .planes
                    .iter()
                    .map(|(_, plane)| plane.seen_from(middle))
                    .collect(),
                joints,
                first: planes.len() as u32,
                middle,
                on: ON * size,
            };
            let most: usize = pieces.par_iter().map(|p| 1 + cutter.meets(p).len()).sum();
            if most > MOST {
                let message = format!(
                    "it would leave up to {most} pieces, {MOST} are the most; widen the spacing"
                );
                return Err(Error::argument(format!("joints[{index}].spacing"), message));
            }
            let cut = pieces.into_par_iter().flat_map_iter(|p| cutter.cut(p));
            pieces = cut.collect();
            planes.extend(cutter.joints.planes.iter().map(|(_, plane)| *plane));
        }
        let made: Vec<Piece> = pieces
            .into_par_iter()
            .map(|cell| self.finish(cell, &planes, middle, size))
            .collect();
        let mut fragments = Fragments {
            volume,
            ..Fragments::default()
        };
        for piece in made {
            match piece {
                Piece::Block(block) => fragments.blocks.push(block),
                Piece::Sliver(sliver) => fragments.slivers.push(sliver),
            }
        }
        Ok(fragments)
    }

    fn finish(&self, mut cell: Cell, planes: &[HalfSpace], middle: DVec3, size: f64) -> Piece {
        cell.compact();
        cell.settle();
        let Some(centroid) = cell.centroid() else {
            return Piece::Sliver(Sliver {
                volume: cell.moments(cell.vertices[0]).volume,
                centre: middle + cell.vertices[0],
                block: None,
            });
        };
        let own = |facet: &super::cell::Facet| {
            let plane = planes[facet.source as usize];
            let same = plane.normal.dot(facet.plane.normal) > 0.0;
            if same { plane } else { plane.opposite() }
        };
        let block = Fragment {
            planes: cell.facets.iter().map(own).collect(),
            shape: Polyhedron::unchecked(cell, centroid),
            centre: middle + centroid,
        };
        let volume = block.shape.volume();
        let thickness = block.shape.thickness();
        let possible = thickness >= SLIVER && block.shape.radius() >= SPECK * size;
        if possible && volume >= self.smallest_volume && thickness >= self.smallest_thickness {
            return Piece::Block(block);
        }
        Piece::Sliver(Sliver {
            volume,
            centre: block.centre,
            block: possible.then_some(block),
        })
    }
}

impl Fragments {
    /// Appends the slivers that contact can resolve to the blocks.
    pub fn keep_slivers(mut self) -> Self {
        let (kept, thin): (Vec<_>, Vec<_>) =
            self.slivers.into_iter().partition(|s| s.block.is_some());
        self.blocks.extend(kept.into_iter().filter_map(|s| s.block));
        self.slivers = thin;
        self
    }
}

enum Piece {
    Block(Fragment),
    Sliver(Sliver),
}

/// One joint set; `local` are its planes relative to the middle of the mass.
struct Cutter<'a> {
    joints: Joints<'a>,
    local: Vec<HalfSpace>,
    /// Index of its first plane among all planes of the mass.
    first: u32,
    middle: DVec3,
    on: f64,
}

impl Cutter<'_> {
    /// Indices of the joints that may cross a cell.
    fn meets(&self, cell: &Cell) -> std::ops::Range<usize> {
        let Some(normal) = self.local.first().map(|plane| plane.normal) else {
            return 0..0;
        };
        let [low, high] = heights(std::slice::from_ref(cell), normal);
        let start = self.local.partition_point(|p| p.distance <= low);
        start..self.local.partition_point(|p| p.distance < high)
    }

    /// The pieces into which the joints cut a cell.
    fn cut(&self, cell: Cell) -> Vec<Cell> {
        let mut pieces = Vec::new();
        let mut rest = cell;
        for k in self.meets(&rest) {
            let source = self.first + k as u32;
            let Some((below, above)) = rest.split(self.local[k], source, self.on) else {
                continue;
            };
            let number = self.joints.planes[k].0;
            if self.joints.open(number, self.middle + below.section()) {
                pieces.push(below);
                rest = above;
            }
        }
        pieces.push(rest);
        pieces
    }
}

impl Cell {
    /// Mean of the corners of the newest facet.
    fn section(&self) -> DVec3 {
        let ring = self.facets.last().map_or(&[][..], |facet| &facet.ring);
        let corners = ring.iter().map(|v| self.vertices[*v as usize]);
        corners.sum::<DVec3>() / ring.len() as f64
    }
}

/// Moves the cells so that the middle of their bounding box is the origin; returns its previous position.
fn recentre(cells: &mut [Cell]) -> DVec3 {
    let bounds = cells.iter().map(Cell::bounds);
    let all = bounds.reduce(|[a, b], [c, d]| [a.min(c), b.max(d)]);
    let middle = all.map_or(DVec3::ZERO, |[min, max]| (min + max) / 2.0);
    for cell in cells {
        cell.vertices.iter_mut().for_each(|v| *v -= middle);
        for facet in &mut cell.facets {
            facet.plane = facet.plane.seen_from(middle);
        }
    }
    middle
}

/// Lowest and highest point along `normal`, m.
fn heights(cells: &[Cell], normal: DVec3) -> [f64; 2] {
    min_max(cells.iter().flat_map(Cell::live).map(|v| normal.dot(v)))
}
