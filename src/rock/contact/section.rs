//! Section of the overlap: area, mean thickness, and pressure centre.

use super::{
    centre::overlap,
    pair::Row,
    polygon::{Polygon, Polygons, spread},
};
use glam::{DMat3, DVec2, DVec3};

/// A section, lengths in units of L and positions relative to the analytic centre.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Section {
    pub normal: DVec3,
    pub overlap: f64,
    pub area: f64,
    pub pressure_centre: DVec3,
    pub width: f64,
    /// ∫ x xᵀ dA/A about the centroid.
    pub spread: DMat3,
}

/// Cosines of 10° and 5°: two faces at an angle of more than 10° touch with an edge, and of less than 5° they lie flat
/// on each other. In between, the two sections are blended, so that the contact is continuous.
pub(super) const FLAT_FACES: [f64; 2] = [0.984_807_753_012_208, 0.996_194_698_091_745_5];

/// The same for the share of the tightest face in Σ 1/t, t the slacks of a block's faces at the analytic centre:
/// almost 1 if the face lies on one of the other block, one half at a blunt edge or for two parallel edges, which
/// belong equally to two pairs of faces.
const SHARE: [f64; 2] = [0.6, 0.8];

/// The overlap around its analytic centre.
pub(super) struct Overlap<'a> {
    pub rows: &'a [Row],
    /// Slacks at the analytic centre, in L.
    pub slacks: &'a [f64],
    /// Number of rows of the first block.
    pub split: usize,
    /// Contact normal, from the first to the second block.
    pub normal: DVec3,
}

impl Overlap<'_> {
    /// The section on which the force acts. `level`: rotate the normal to that of the faces if they lie flat
    /// on each other.
    pub fn section(&self, polygons: &mut Polygons, level: bool) -> Section {
        let (i, share_i) = self.tightest(0, self.split);
        let (j, share_j) = self.tightest(self.split, self.rows.len());
        let cosine = -self.rows[i].normal.dot(self.rows[j].normal);
        let flatness = ramp(cosine, FLAT_FACES).min(ramp(share_i.min(share_j), SHARE));
        if flatness == 0.0 {
            return self.cut(polygons);
        }
        let Some((flat, evenness)) = self.between(&mut polygons.section, i, j) else {
            return self.cut(polygons);
        };
        let normal = if level {
            let share = flatness * evenness;
            self.normal.lerp(flat.normal, share).normalize()
        } else {
            self.normal
        };
        let flat = Section { normal, ..flat };
        if flatness == 1.0 {
            return flat;
        }
        let cut = self.cut(polygons);
        let mix = |a: f64, b: f64| a + flatness * (b - a);
        Section {
            normal,
            overlap: mix(cut.overlap, flat.overlap),
            area: mix(cut.area, flat.area),
            pressure_centre: cut.pressure_centre.lerp(flat.pressure_centre, flatness),
            width: mix(cut.width, flat.width),
            spread: cut.spread + (flat.spread - cut.spread) * flatness,
        }
    }

    /// The section through the analytic centre, perpendicular to the normal. Its pressure is proportional to the length
    /// of the overlap along the normal.
    fn cut(&self, polygons: &mut Polygons) -> Section {
        let plane = self.slice(&mut polygons.section, self.normal, DVec3::ZERO);
        let Polygons {
            section,
            cell,
            bounds,
        } = polygons;
        let mut sums = section.moments(|_| 0.0);
        let (own, other) = self.rows.split_at(self.split);
        let (own_slacks, other_slacks) = self.slacks.split_at(self.split);
        for (rows, slacks, out) in [
            (own, own_slacks, self.normal),
            (other, other_slacks, -self.normal),
        ] {
            let rows = rows.iter().zip(slacks).map(|(row, slack)| Bound {
                slack: *slack,
                gradient: plane.gradient(row.normal),
                rate: row.normal.dot(out),
            });
            bounds.clear();
            bounds.extend(rows.filter(|bound| bound.rate > 0.0));
            let (volume, first) = depth(section, cell, bounds);
            sums.volume += volume;
            sums.first += first;
        }
        Section {
            normal: self.normal,
            overlap: overlap(self.rows, self.slacks, self.split, self.normal),
            area: sums.area,
            pressure_centre: plane.lift(ratio(sums.first, sums.volume)),
            width: section.width(),
            spread: plane.spread(section),
        }
    }

    /// The section half-way between the faces i and j, over the area with a positive thickness between
    /// them. Its overlap is the mean thickness, and its pressure centre that of an elastic bed
    /// (Winkler): with the analytic centre, rocking would be too soft. `None` if the faces do not face each
    /// other there. The number is the ratio of the smallest to the largest thickness.
    fn between(&self, polygon: &mut Polygon, i: usize, j: usize) -> Option<(Section, f64)> {
        let difference = self.rows[i].normal - self.rows[j].normal;
        let normal = difference.normalize();
        let away = self.slacks[i] - self.slacks[j];
        let origin = difference * (away / difference.length_squared());
        let plane = self.slice(polygon, normal, origin);
        let rate = 2.0 / self.rows[i].normal.dot(normal);
        let slack = self.slacks[i] - self.rows[i].normal.dot(origin);
        let gradient = plane.gradient(self.rows[i].normal);
        let thickness = |x: DVec2| rate * (slack - gradient.dot(x)).max(0.0);
        let moments = polygon.moments(thickness);
        let thicknesses = polygon.corners.iter().map(|x| thickness(*x));
        let (least, most) = thicknesses.fold((f64::INFINITY, 0.0), |(l, m): (f64, f64), u| {
            (l.min(u), m.max(u))
        });
        let found = moments.area > 0.0 && moments.volume > 0.0;
        found.then(|| {
            let section = Section {
                normal,
                overlap: moments.volume / moments.area,
                area: moments.area,
                pressure_centre: plane.lift(ratio(moments.first, moments.volume)),
                width: polygon.width(),
                spread: plane.spread(polygon),
            };
            (section, least / most)
        })
    }

    /// Clips the plane through `origin` (from the analytic centre) by all rows.
    fn slice(&self, polygon: &mut Polygon, normal: DVec3, origin: DVec3) -> Plane {
        let (x, y) = normal.any_orthonormal_pair();
        let plane = Plane { origin, x, y };
        // The smaller block lies within half a unit of its centroid, hence within one unit of any of its points.
        polygon.reset(1.0);
        for (row, slack) in self.rows.iter().zip(self.slacks) {
            let slack = slack - row.normal.dot(origin);
            polygon.clip(plane.gradient(row.normal), slack);
        }
        plane
    }

    /// The tightest of the rows `from..to`, and its share of their Σ 1/t.
    fn tightest(&self, from: usize, to: usize) -> (usize, f64) {
        let (mut tightest, mut sum) = (from, 0.0);
        for k in from..to {
            sum += self.slacks[k].recip();
            if self.slacks[k] < self.slacks[tightest] {
                tightest = k;
            }
        }
        (tightest, (self.slacks[tightest] * sum).recip())
    }
}

/// A plane with its own axes.
struct Plane {
    origin: DVec3,
    x: DVec3,
    y: DVec3,
}

impl Plane {
    fn lift(&self, p: DVec2) -> DVec3 {
        self.origin + self.x * p.x + self.y * p.y
    }

    /// ∫ x xᵀ dA/A about the centroid of a polygon in the plane; 0 without area.
    fn spread(&self, polygon: &Polygon) -> DMat3 {
        polygon.second_moments().map_or(DMat3::ZERO, |of| {
            let axis = self.x * of.axis.x + self.y * of.axis.y;
            let other = self.y * of.axis.x - self.x * of.axis.y;
            spread([axis, other], of.principal.map(|second| second / of.area))
        })
    }

    fn gradient(&self, normal: DVec3) -> DVec2 {
        DVec2::new(self.x.dot(normal), self.y.dot(normal))
    }
}

/// Smooth step from 0 at the first bound to 1 at the second.
pub(super) fn ramp(x: f64, [low, high]: [f64; 2]) -> f64 {
    let s = ((x - low) / (high - low)).clamp(0.0, 1.0);
    s * s * (3.0 - 2.0 * s)
}

/// First moment divided by the whole; the origin if the whole is zero.
fn ratio(first: DVec2, whole: f64) -> DVec2 {
    if whole > 0.0 {
        first / whole
    } else {
        DVec2::ZERO
    }
}

/// A face above the polygon's plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bound {
    /// Distance of the face from the polygon's origin.
    pub slack: f64,
    /// Decrease of this distance along the polygon's axes.
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

/// ∫ u dA and ∫ u x dA over `section`, which contains its origin, u the height to the lowest of the faces.
///
/// A quadrature over the corners is not sufficient: below a steep face, the height falls to zero within a narrow
/// strip along the edge of the face, all corners lie in such strips, and a strip appears or vanishes if the
/// face rotates by the last bit. The section is therefore divided into the cells below each face.
pub(super) fn depth(section: &Polygon, cell: &mut Polygon, faces: &[Bound]) -> (f64, DVec2) {
    let (mut volume, mut first) = (0.0, DVec2::ZERO);
    // Most cells are empty after clipping by the face above the origin.
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
        // For a nearly vertical face only rounding is left of the height and of the cell.
        let moments = cell.moments(|x| face.height(x).min(faces[nearest].height(x)));
        volume += moments.volume;
        first += moments.first;
    }
    (volume, first)
}
