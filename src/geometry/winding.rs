//! Generalised winding number of a triangle mesh (Jacobson, Kavan & Sorkine-Hornung 2013); distant parts are
//! approximated by their dipole (Barill, Dickson, Schmidt, Levin & Jacobson 2018).
//!
//! ```text
//! w(q) = Σ_triangles Ω(q)/4π        Ω the signed solid angle
//!      ≈ N·(p − q)/(4π|p − q|³)     far off; N = Σ area·normal, p the centre of the area
//! ```

use super::{TriangleMesh, bounding_box};
use glam::DVec3;
use std::f64::consts::PI;

/// Distance, in radii of a part, beyond which its dipole is used (the value of Barill et al. 2018). The error of the
/// sum then stays below a tenth, compared with the ½ that decides.
const FAR: f64 = 2.0;
/// Number of triangles in a leaf; the exact sum over so few costs about as much as one level of the tree.
const LEAF: usize = 8;

/// A mesh prepared for many evaluations of its winding number.
pub struct WindingTree {
    /// Corners of the triangles in the order of the leaves, m.
    corners: Vec<[DVec3; 3]>,
    nodes: Vec<Node>,
}

struct Node {
    /// Centre p of the area, m.
    centre: DVec3,
    /// Σ area·normal, m².
    dipole: DVec3,
    /// Largest distance of a corner from the centre, m.
    radius: f64,
    /// Range of triangles.
    range: std::ops::Range<usize>,
    /// The second child; the first one follows its parent. None in a leaf.
    second: Option<usize>,
}

impl WindingTree {
    /// Prepares `mesh`.
    pub fn new(mesh: &TriangleMesh) -> Self {
        let mut tree = Self {
            corners: (0..mesh.triangles.len()).map(|i| mesh.corners(i)).collect(),
            nodes: Vec::new(),
        };
        tree.split(0..tree.corners.len());
        tree
    }

    /// Winding number at the point `q` in m: 1 inside a closed surface whose triangles run
    /// counter-clockwise seen from outside, 0 outside of it.
    pub fn at(&self, q: DVec3) -> f64 {
        self.below(0, q) / (4.0 * PI)
    }

    fn below(&self, index: usize, q: DVec3) -> f64 {
        let node = &self.nodes[index];
        let offset = node.centre - q;
        let distance = offset.length();
        if distance > FAR * node.radius {
            return node.dipole.dot(offset) / distance.powi(3);
        }
        match node.second {
            Some(second) => self.below(index + 1, q) + self.below(second, q),
            None => self.corners[node.range.clone()]
                .iter()
                .map(|corners| solid_angle(corners.map(|c| c - q)))
                .sum(),
        }
    }

    fn split(&mut self, range: std::ops::Range<usize>) {
        let index = self.nodes.len();
        self.nodes.push(self.summarise(range.clone()));
        if range.len() <= LEAF {
            return;
        }
        let part = &mut self.corners[range.clone()];
        let centroid = |[a, b, c]: &[DVec3; 3]| *a + *b + *c;
        let [min, max] = bounding_box(part.iter().map(centroid));
        let axis = (max - min).max_position();
        let half = part.len() / 2;
        part.select_nth_unstable_by(half, |a, b| centroid(a)[axis].total_cmp(&centroid(b)[axis]));
        self.split(range.start..range.start + half);
        self.nodes[index].second = Some(self.nodes.len());
        self.split(range.start + half..range.end);
    }

    fn summarise(&self, range: std::ops::Range<usize>) -> Node {
        let (mut dipole, mut weighted, mut area) = (DVec3::ZERO, DVec3::ZERO, 0.0);
        for [a, b, c] in &self.corners[range.clone()] {
            let vector = (*b - *a).cross(*c - *a) / 2.0;
            dipole += vector;
            area += vector.length();
            weighted += vector.length() * (*a + *b + *c) / 3.0;
        }
        let corners = || self.corners[range.clone()].iter().flatten();
        let centre = if area > 0.0 {
            weighted / area
        } else {
            corners().copied().next().unwrap_or_default()
        };
        Node {
            centre,
            dipole,
            radius: corners().map(|c| c.distance(centre)).fold(0.0, f64::max),
            range: range.clone(),
            second: None,
        }
    }
}

/// Signed solid angle of a triangle seen from the origin (Van Oosterom & Strackee 1983).
fn solid_angle([a, b, c]: [DVec3; 3]) -> f64 {
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    let volume = a.dot(b.cross(c));
    let edges = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    2.0 * volume.atan2(edges)
}
