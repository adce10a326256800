//! How deep a polygon is below faces: ∫ min_k u_k dA of linear functions u_k, exactly.

use super::polygon::Polygon;
use glam::DVec2;

/// A face above the polygon's plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bound {
    /// Distance of the face from the polygon's origin.
    pub slack: f64,
    /// What it loses along the polygon's axes.
    pub gradient: DVec2,
    /// Cosine between the face's normal and that of the plane, greater than 0.
    pub rate: f64,
}

impl Bound {
    /// Height from the plane to the face along the plane's normal.
    fn height(&self, x: DVec2) -> f64 {
        (self.slack - self.gradient.dot(x)).max(0.0) / self.rate
    }
}

/// ∫ u dA and ∫ u x dA over `section`, which holds its origin, u the height to the first of the faces.
///
/// A quadrature over the corners will not do: where a face is steep, the height falls to zero within a narrow
/// strip along the edge that it makes, all corners lie in such strips, and the strip comes or goes when the
/// face turns by the last bit. So the section is divided into the cells below each face.
pub(super) fn depth(section: &Polygon, cell: &mut Polygon, faces: &[Bound]) -> (f64, DVec2) {
    let (mut volume, mut first) = (0.0, DVec2::ZERO);
    // Most cells are gone once they are cut by that of the origin.
    let height = |k: &usize| faces[*k].slack / faces[*k].rate;
    let nearest = (0..faces.len()).min_by(|a, b| height(a).total_cmp(&height(b)));
    let Some(nearest) = nearest else {
        return (volume, first);
    };
    for (k, face) in faces.iter().enumerate() {
        cell.corners.clone_from(&section.corners);
        let others = (0..faces.len()).filter(|&j| j != nearest);
        for j in std::iter::once(nearest).chain(others) {
            if j == k {
                continue;
            }
            let other = &faces[j];
            let gradient = other.gradient * face.rate - face.gradient * other.rate;
            cell.clip(gradient, other.slack * face.rate - face.slack * other.rate);
            if cell.corners.len() < 3 {
                break;
            }
        }
        if cell.corners.len() < 3 {
            continue;
        }
        // Of a face as good as upright only rounding is left, of the height as of the cell.
        let moments = cell.moments(|x| face.height(x).min(faces[nearest].height(x)));
        volume += moments.volume;
        first += moments.first;
    }
    (volume, first)
}
