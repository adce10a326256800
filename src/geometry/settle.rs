//! The vertices of a finished cell, each from those of its planes that fix it best.

use super::HalfSpace;
use super::cell::{Cell, PARALLEL};
use glam::DVec3;

impl Cell {
    /// Moves each vertex of a compact cell to where three of its planes meet, chosen to span the most.
    /// While a cell is cut, a vertex stays where the first three met, however flat the angle.
    pub(super) fn settle(&mut self) {
        let count = self.vertices.len();
        let mut ends = vec![0_usize; count + 1];
        for v in self.facets.iter().flat_map(|f| &f.ring) {
            ends[*v as usize + 1] += 1;
        }
        for v in 0..count {
            ends[v + 1] += ends[v];
        }
        let mut next = ends.clone();
        let mut planes = vec![0_usize; ends[count]];
        for (index, facet) in self.facets.iter().enumerate() {
            for v in &facet.ring {
                planes[next[*v as usize]] = index;
                next[*v as usize] += 1;
            }
        }
        for v in 0..count {
            let plane = |i: &usize| self.facets[*i].plane;
            let own: Vec<HalfSpace> = planes[ends[v]..ends[v + 1]].iter().map(plane).collect();
            if let Some(best) = widest(&own) {
                self.vertices[v] = meet(best, self.vertices[v]).unwrap_or(self.vertices[v]);
            }
        }
    }
}

/// The two planes at the widest angle and the third that spans the most with them.
fn widest(planes: &[HalfSpace]) -> Option<[HalfSpace; 3]> {
    if let [p, q, r] = planes {
        return Some([*p, *q, *r]);
    }
    let pairs = planes.iter().enumerate().flat_map(|(i, p)| {
        let later = planes[i + 1..].iter();
        later.map(move |q| (p.normal.cross(q.normal), p, q))
    });
    let (across, p, q) =
        pairs.max_by(|(a, ..), (b, ..)| a.length_squared().total_cmp(&b.length_squared()))?;
    let span = |r: &HalfSpace| across.dot(r.normal).abs();
    let third = planes.iter().max_by(|a, b| span(a).total_cmp(&span(b)))?;
    Some([*p, *q, *third])
}

/// Where three planes meet, from a point `near` it so that distances are small; none if they are nearly
/// parallel to one line.
pub(super) fn meet([p, q, r]: [HalfSpace; 3], near: DVec3) -> Option<DVec3> {
    let across = p.normal.cross(q.normal);
    let det = across.dot(r.normal);
    if det.abs() < PARALLEL {
        return None;
    }
    let [hp, hq, hr] = [p, q, r].map(|plane| plane.height(near));
    let sum = q.normal.cross(r.normal) * hp + r.normal.cross(p.normal) * hq + across * hr;
    Some(near - sum / det)
}
