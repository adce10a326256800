//! Two parts that face each other over a thin gap, and the shape of their facing surfaces.

use super::{
    Placed,
    closed_form::sphere_polyhedron,
    polygon::Polygon,
    section::{FLAT_FACES, ramp},
};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// Cosine between the line to a sphere and the normal of the face below it, up to rounding.
const OVER_FACE: f64 = 1.0 - 1e-9;

/// A thin gap between two parts. Vectors are in world axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinGap {
    /// Unit normal from the first part to the second.
    pub normal: DVec3,
    /// Middle of the facing surfaces, half-way between the parts, m.
    pub point: DVec3,
    /// Width of the gap there, m; 0 if the parts touch within rounding.
    pub gap: f64,
    /// Shape of the facing surfaces.
    pub shape: GapShape,
}

/// Shape of the surfaces that face a thin gap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GapShape {
    /// Two spheres, or a sphere and a face.
    Round {
        /// R₁R₂/(R₁ + R₂), the radius of the equivalent sphere over a plane, m.
        radius: f64,
    },
    /// Two faces.
    Flat {
        /// Area that faces the gap, m².
        area: f64,
        /// Second moments of this area about each axis, m⁴.
        moments: [f64; 2],
        /// Torsion constant J of the area that faces the gap, m⁴: πR⁴/2 for a disc.
        torsion: f64,
        /// Axes in the plane about which the gap may tilt.
        axes: [DVec3; 2],
        /// The corresponding constant for a tilt about each axis, m⁶: πR⁶/8 for a disc.
        tilts: [f64; 2],
        /// 1 if the faces are parallel within 5°, 0 above 10°.
        flatness: f64,
    },
}

impl ThinGap {
    /// The gap between `first` and `second`, which do not overlap, if it is narrower than `range` (m) and each of its
    /// sides is a face or a sphere. At an edge or a corner the walls diverge at a finite slope: the resistance
    /// stays finite as the gap closes, and is neglected.
    pub fn between(first: &Placed, second: &Placed, range: f64) -> Option<Self> {
        let apart = second.centre - first.centre;
        if apart.length() >= first.radius + second.radius + range {
            return None;
        }
        let found = match (first.faces.is_empty(), second.faces.is_empty()) {
            (true, true) => Some(balls(first, second)),
            (false, true) => sphere_over_face(first, second),
            (true, false) => sphere_over_face(second, first).map(Self::swapped),
            (false, false) => faces(first, second, range),
        };
        found.filter(|gap| gap.gap < range)
    }

    /// One of the two axes about which a gap between faces may tilt; zero if one side is a sphere.
    pub fn axis(&self, k: usize) -> DVec3 {
        match &self.shape {
            GapShape::Round { .. } => DVec3::ZERO,
            GapShape::Flat { axes, .. } => axes[k],
        }
    }

    fn swapped(self) -> Self {
        Self {
            normal: -self.normal,
            ..self
        }
    }
}

fn balls(a: &Placed, b: &Placed) -> ThinGap {
    let between = b.centre - a.centre;
    let gap = (between.length() - a.radius - b.radius).max(0.0);
    let normal = between.normalize_or(DVec3::X);
    ThinGap {
        normal,
        point: a.centre + normal * (a.radius + 0.5 * gap),
        gap,
        shape: GapShape::Round {
            radius: a.radius * b.radius / (a.radius + b.radius),
        },
    }
}

/// A sphere near a polyhedron, unless it is over an edge or a corner.
fn sphere_over_face(block: &Placed, ball: &Placed) -> Option<ThinGap> {
    let near = sphere_polyhedron(block, ball);
    let normal = near.contact.normal;
    let over = |face: &crate::geometry::HalfSpace| face.normal.dot(normal) > OVER_FACE;
    let gap = near.gap.max(0.0);
    block.faces.iter().any(over).then(|| ThinGap {
        normal,
        point: near.contact.point + normal * (0.5 * gap),
        gap,
        shape: GapShape::Round {
            radius: ball.radius,
        },
    })
}

/// Two opposite faces, and the polygon of the first that lies over the second.
pub(super) struct FacePair {
    /// Whether the first of the two faces belongs to the second part.
    pub flipped: bool,
    /// Normals of the two faces.
    pub out: DVec3,
    opposite: DVec3,
    /// Axes in the plane of the first face.
    pub x: DVec3,
    pub y: DVec3,
    /// Origin of the coordinates of the polygon, m.
    origin: DVec3,
    pub polygon: Polygon,
    /// Distance along `out` to the other face, `gap` + `slope` · X, m.
    pub gap: f64,
    pub slope: DVec2,
    /// 1 if the faces are parallel within 5°, 0 above 10°.
    pub flatness: f64,
}

impl FacePair {
    /// Unit normal from the first part to the second.
    pub fn normal(&self) -> DVec3 {
        let normal = (self.out - self.opposite).normalize();
        if self.flipped { -normal } else { normal }
    }

    /// A point in the plane of the first face, m.
    pub fn lift(&self, at: DVec2) -> DVec3 {
        self.origin + self.x * at.x + self.y * at.y
    }

    /// Components of a vector along the plane.
    pub fn flat(&self, v: DVec3) -> DVec2 {
        DVec2::new(self.x.dot(v), self.y.dot(v))
    }
}

/// The opposite faces of two polyhedra, if their gap is less than `range` (m).
pub(super) fn face_pair(first: &Placed, second: &Placed, range: f64) -> Option<FacePair> {
    // The face from which the other part is farthest separates the two; no such distance exceeds the gap.
    let of_first = beyond(first, second, range)?;
    let of_second = beyond(second, first, range)?;
    let flipped = of_second.1 > of_first.1;
    let (own, other, f) = match flipped {
        false => (first, second, of_first.0),
        true => (second, first, of_second.0),
    };
    let out = own.faces[f].normal;
    let cosine = |k: &usize| other.faces[*k].normal.dot(out);
    let g = (0..other.faces.len()).min_by(|a, b| cosine(a).total_cmp(&cosine(b)))?;
    let flatness = ramp(-cosine(&g), FLAT_FACES);
    if flatness == 0.0 {
        return None;
    }
    let (x, y) = out.any_orthonormal_pair();
    let flat = |n: DVec3| DVec2::new(x.dot(n), y.dot(n));
    // Origin: the smaller part's centroid, projected onto the plane of the face, from the centroid of `own`.
    let shift = other.centre - own.centre;
    let small = if other.radius < own.radius {
        shift
    } else {
        DVec3::ZERO
    };
    let origin = small - out * own.faces[f].height(small);
    let mut polygon = Polygon::default();
    polygon.reset(own.radius.min(other.radius) + range);
    for (_, face) in own.faces.iter().enumerate().filter(|(k, _)| *k != f) {
        polygon.clip(flat(face.normal), -face.height(origin));
    }
    // Distance along the normal to the other face: t₀ + t₁ · X.
    let opposite = other.faces[g];
    let slope = opposite.normal.dot(out);
    let t0 = -opposite.height(origin - shift) / slope;
    let t1 = -flat(opposite.normal) / slope;
    for (_, face) in other.faces.iter().enumerate().filter(|(k, _)| *k != g) {
        let along = face.normal.dot(out);
        polygon.clip(
            flat(face.normal) + along * t1,
            -face.height(origin - shift) - along * t0,
        );
    }
    polygon.clip(t1, range - t0);
    Some(FacePair {
        flipped,
        out,
        opposite: opposite.normal,
        x,
        y,
        origin: own.centre + origin,
        polygon,
        gap: t0,
        slope: t1,
        flatness,
    })
}

/// The gap between the opposite faces of two polyhedra.
fn faces(first: &Placed, second: &Placed, range: f64) -> Option<ThinGap> {
    let face_pair = face_pair(first, second, range)?;
    let seconds = face_pair.polygon.second_moments()?;
    let gap = (face_pair.gap + face_pair.slope.dot(seconds.centre)).max(0.0);
    let area = seconds.area;
    let [large, least] = seconds.principal;
    // The ellipse of the same area and ratio of axes; a strip as narrow as rounding has none.
    let ratio = (large / least).sqrt();
    let square = area / PI;
    let [a2, b2] = [square * ratio, square / ratio];
    if !(area > 0.0 && least > 0.0 && ratio.is_finite()) {
        return None;
    }
    let tilt = |long: f64, short: f64| {
        PI * long.powi(2) * (long * short).sqrt() * short / (6.0 * short + 2.0 * long)
    };
    let along = face_pair.x * seconds.axis.x + face_pair.y * seconds.axis.y;
    Some(ThinGap {
        normal: face_pair.normal(),
        point: face_pair.lift(seconds.centre) + face_pair.out * (0.5 * gap),
        gap,
        shape: GapShape::Flat {
            area,
            moments: [large, least],
            // St. Venant's A⁴/(4π² I_p), exact for ellipses, 8 % too large for a square, 9 % too small for a strip.
            torsion: area.powi(4) / (4.0 * PI * PI * (large + least)),
            axes: [face_pair.out.cross(along), along],
            tilts: [tilt(a2, b2), tilt(b2, a2)],
            flatness: face_pair.flatness,
        },
    })
}

/// The face of `own` from which `other` is farthest, and this distance, m; `None` if it is `range` or more.
fn beyond(own: &Placed, other: &Placed, range: f64) -> Option<(usize, f64)> {
    let apart = other.centre - own.centre;
    let mut most = (0, f64::NEG_INFINITY);
    for (k, face) in own.faces.iter().enumerate() {
        let base = face.height(apart);
        let heights = other.vertices.iter().map(|v| face.normal.dot(*v));
        let height = base + heights.fold(f64::INFINITY, f64::min);
        if height >= range {
            return None;
        }
        if height > most.1 {
            most = (k, height);
        }
    }
    Some(most)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Form, Part, Polyhedron, Pose};
    use glam::DQuat;

    fn cuboid(size: DVec3, at: DVec3, turn: DQuat) -> Placed {
        let part = Part {
            form: Form::Convex(Polyhedron::cuboid(size).unwrap()),
            offset: DVec3::ZERO,
        };
        Placed::of(&part, &Pose::at_rest(at, turn))
    }

    fn ball(radius: f64, at: DVec3) -> Placed {
        let mut placed = Placed::default();
        let pose = Pose::at_rest(at, DQuat::IDENTITY);
        placed.update_sphere(radius, DVec3::ZERO, &pose);
        placed
    }

    #[test]
    fn two_cubes_face_each_other_where_they_overlap_in_plan() {
        let below = cuboid(DVec3::new(4.0, 2.0, 1.0), DVec3::ZERO, DQuat::IDENTITY);
        let above = cuboid(DVec3::ONE * 2.0, DVec3::new(1.5, 0.0, 1.6), DQuat::IDENTITY);
        let found = ThinGap::between(&below, &above, 0.2).unwrap();
        // x from 0.5 to 2, y from −1 to 1, z from 0.5 to 0.6.
        assert!((found.normal - DVec3::Z).length() < 1e-12, "{found:?}");
        assert!(
            (found.point - DVec3::new(1.25, 0.0, 0.55)).length() < 1e-12,
            "{found:?}"
        );
        assert!((found.gap - 0.1).abs() < 1e-12);
        let GapShape::Flat {
            area,
            moments,
            torsion,
            axes,
            tilts,
            flatness,
        } = found.shape
        else {
            panic!("{found:?}");
        };
        let polar = (1.5 * 8.0 + 2.0 * 1.5f64.powi(3)) / 12.0;
        assert!((area - 3.0).abs() < 1e-12);
        // About x, along which the area is short, and about y.
        assert!((moments[0] - 1.0).abs() < 1e-12 && (moments[1] - 0.5625).abs() < 1e-12);
        assert!((torsion - 81.0 / (4.0 * PI * PI * polar)).abs() < 1e-12);
        assert_eq!(flatness, 1.0);
        // The longer side is along y: a tilt about x is resisted most.
        assert!(
            axes[0].x.abs() > 1.0 - 1e-12 && tilts[0] > tilts[1],
            "{axes:?} {tilts:?}"
        );
        let swapped = ThinGap::between(&above, &below, 0.2).unwrap();
        assert!((swapped.normal + DVec3::Z).length() < 1e-12);
        assert!((swapped.point - found.point).length() < 1e-12);
        assert!(ThinGap::between(&below, &above, 0.09).is_none());
    }

    #[test]
    fn of_a_wedge_counts_what_is_within_range_and_of_an_edge_nothing() {
        let floor = cuboid(DVec3::new(8.0, 8.0, 1.0), -0.5 * DVec3::Z, DQuat::IDENTITY);
        let tilted = |degrees: f64| {
            let turn = DQuat::from_rotation_y(degrees.to_radians());
            let lowest = 0.5
                * (turn * DVec3::ONE)
                    .z
                    .abs()
                    .max((turn * DVec3::new(-1.0, 1.0, 1.0)).z.abs());
            cuboid(DVec3::ONE, DVec3::Z * (lowest + 0.01), turn)
        };
        let parallel = ThinGap::between(&floor, &tilted(0.0), 0.05).unwrap();
        let wedge = ThinGap::between(&floor, &tilted(4.0), 0.05).unwrap();
        let (
            GapShape::Flat { torsion: whole, .. },
            GapShape::Flat {
                torsion, flatness, ..
            },
        ) = (parallel.shape, wedge.shape)
        else {
            panic!("faces");
        };
        // The strip over which the gap is within the range.
        let width = 0.04 / 4f64.to_radians().tan();
        let polar = (width.powi(3) + width) / 12.0;
        assert!(
            (torsion / (width.powi(4) / (4.0 * PI * PI * polar)) - 1.0).abs() < 0.02,
            "{torsion}"
        );
        assert!(torsion < whole && flatness == 1.0);
        assert!((wedge.gap - 0.03).abs() < 1e-3);
        assert!(ThinGap::between(&floor, &tilted(30.0), 0.05).is_none());
    }

    #[test]
    fn a_disc_of_many_corners_is_one() {
        let corners: Vec<DVec3> = (0..64)
            .flat_map(|k| {
                let (sin, cos) = (PI * f64::from(k) / 32.0).sin_cos();
                [-0.1, 0.1].map(|z| DVec3::new(cos, sin, z))
            })
            .collect();
        let (disc, _) = Polyhedron::from_vertices(&corners).unwrap();
        let at = |z: f64| {
            let part = Part {
                form: Form::Convex(disc.clone()),
                offset: DVec3::ZERO,
            };
            Placed::of(&part, &Pose::at_rest(DVec3::Z * z, DQuat::IDENTITY))
        };
        let found = ThinGap::between(&at(0.0), &at(0.25), 0.1).unwrap();
        let GapShape::Flat { torsion, tilts, .. } = found.shape else {
            panic!("{found:?}");
        };
        assert!((torsion / (0.5 * PI) - 1.0).abs() < 0.01, "{torsion}");
        assert!((tilts[0] / (PI / 8.0) - 1.0).abs() < 0.01, "{tilts:?}");
    }

    #[test]
    fn balls_and_faces() {
        let found =
            ThinGap::between(&ball(1.0, DVec3::ZERO), &ball(3.0, DVec3::X * 4.1), 0.2).unwrap();
        assert!((found.gap - 0.1).abs() < 1e-12 && found.normal == DVec3::X);
        assert_eq!(found.shape, GapShape::Round { radius: 0.75 });
        let cube = cuboid(DVec3::ONE * 2.0, DVec3::ZERO, DQuat::IDENTITY);
        let found = ThinGap::between(&ball(1.0, DVec3::Z * 2.1), &cube, 0.2).unwrap();
        assert!((found.normal + DVec3::Z).length() < 1e-12);
        assert!((found.point - DVec3::Z * 1.05).length() < 1e-12);
        let diagonal = DVec3::new(1.0, 0.0, 1.0) + DVec3::new(1.0, 0.0, 1.0).normalize() * 1.05;
        assert!(ThinGap::between(&ball(1.0, diagonal), &cube, 0.2).is_none());
    }
}
