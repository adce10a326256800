//! Exact volumes in f64: polyhedra by clipping of polygons, balls by sections.

use glam::{DVec2, DVec3};
use kit::{assert_near, assert_relative};
use riprap::geometry::HalfSpace;
use std::f64::consts::{FRAC_PI_2, PI};

/// A convex body clipped by planes, kept as its polygons, counter-clockwise seen from outside.
#[derive(Clone)]
pub struct Solid(Vec<Vec<DVec3>>);

impl Solid {
    /// The unit cube around `centre`.
    pub fn cell(centre: DVec3) -> Self {
        let corner = |x: f64, y: f64, z: f64| centre + DVec3::new(x, y, z) / 2.0;
        let mut faces = Vec::new();
        for side in [-1.0, 1.0] {
            // Around the axis, and reversed on the lower side.
            let ring = [(-side, -1.0), (side, -1.0), (side, 1.0), (-side, 1.0)];
            faces.push(ring.map(|(a, b)| corner(side, a, b)).to_vec());
            faces.push(ring.map(|(a, b)| corner(b, side, a)).to_vec());
            faces.push(ring.map(|(a, b)| corner(a, b, side)).to_vec());
        }
        Self(faces)
    }

    /// The part inside `plane`.
    pub fn cut(self, plane: &HalfSpace) -> Self {
        let mut rim = Vec::new();
        let mut kept = Vec::new();
        for ring in self.0 {
            let mut left = Vec::new();
            for (i, &a) in ring.iter().enumerate() {
                let b = ring[(i + 1) % ring.len()];
                let (ha, hb) = (plane.height(a), plane.height(b));
                if ha <= 0.0 {
                    left.push(a);
                }
                if (ha <= 0.0) != (hb <= 0.0) {
                    let on = a + (b - a) * (ha / (ha - hb));
                    left.push(on);
                    rim.push(on);
                }
            }
            if left.len() > 2 {
                kept.push(left);
            }
        }
        if rim.len() > 2 {
            let middle = rim.iter().sum::<DVec3>() / rim.len() as f64;
            let (u, v) = plane.normal.any_orthonormal_pair();
            let angle = |p: &DVec3| (*p - middle).dot(v).atan2((*p - middle).dot(u));
            rim.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
            if u.cross(v).dot(plane.normal) < 0.0 {
                rim.reverse();
            }
            kept.push(rim);
        }
        Self(kept)
    }

    pub fn volume(&self) -> f64 {
        let Some(origin) = self.0.first().map(|ring| ring[0]) else {
            return 0.0;
        };
        let mut six = 0.0;
        for ring in &self.0 {
            for pair in ring[1..].windows(2) {
                let [a, b, c] = [ring[0], pair[0], pair[1]].map(|p| p - origin);
                six += a.dot(b.cross(c));
            }
        }
        six / 6.0
    }
}

/// Fraction of the unit cell around `centre` inside all `faces`.
pub fn polyhedron_fraction(faces: &[HalfSpace], centre: DVec3) -> f64 {
    let solid = faces.iter().fold(Solid::cell(centre), Solid::cut);
    solid.volume()
}

/// Fraction of the unit cell around `centre` inside the ball around the origin: sections across z, whose area is exact, by
/// tanh-sinh quadrature (Takahasi & Mori 1974) between the heights at which the section changes its shape.
pub fn sphere_fraction(radius: f64, centre: DVec3) -> f64 {
    let (low, high) = (centre - 0.5, centre + 0.5);
    if DVec3::ZERO.clamp(low, high).length() >= radius {
        return 0.0;
    }
    let (bottom, top) = (low.z.max(-radius), high.z.min(radius));
    let mut heights = vec![bottom, top];
    for x in [0.0, low.x, high.x] {
        for y in [0.0, low.y, high.y] {
            let z = (radius * radius - x * x - y * y).max(0.0).sqrt();
            heights.extend([-z, z].into_iter().filter(|z| bottom < *z && *z < top));
        }
    }
    heights.sort_by(f64::total_cmp);
    let section = |z: f64| section(radius * radius - z * z, low, high);
    let part = |ends: &[f64]| tanh_sinh([ends[0], ends[1]], section);
    heights.windows(2).map(part).sum()
}

/// The integral of `f` between two ends, at which it may behave like a square root.
fn tanh_sinh([a, b]: [f64; 2], f: impl Fn(f64) -> f64) -> f64 {
    const STEP: f64 = 1.0 / 12.0;
    let half = 0.5 * (b - a);
    let sum = (-40..=40).map(|k| {
        let t = STEP * f64::from(k);
        let s = FRAC_PI_2 * t.sinh();
        // Distance from the nearer end.
        let away = half * (-s.abs()).exp() / s.cosh();
        let at = if s < 0.0 { a + away } else { b - away };
        FRAC_PI_2 * t.cosh() / s.cosh().powi(2) * f(at)
    });
    STEP * half * sum.sum::<f64>()
}

/// Area of the disc around the axis z with the squared radius `square`, within a rectangle: the sum over its edges of the disc
/// within the triangle of edge and axis.
fn section(square: f64, low: DVec3, high: DVec3) -> f64 {
    let corners = [
        DVec2::new(low.x, low.y),
        DVec2::new(high.x, low.y),
        DVec2::new(high.x, high.y),
        DVec2::new(low.x, high.y),
    ];
    let triangle = |k: usize| {
        let (p, q) = (corners[k], corners[(k + 1) % 4]);
        let along = q - p;
        let (length, at, cross) = (along.length_squared(), p.dot(along), p.perp_dot(q));
        let inside = (square * length - cross * cross).max(0.0).sqrt();
        let ends = [-at - inside, -at + inside].map(|t| (t / length).clamp(0.0, 1.0));
        let [enters, leaves] = ends.map(|t| p + t * along);
        let angle = |u: DVec2, v: DVec2| u.perp_dot(v).atan2(u.dot(v));
        let sectors = square * (angle(p, enters) + angle(leaves, q));
        0.5 * (sectors + (ends[1] - ends[0]) * cross)
    };
    (0..4).map(triangle).sum()
}

#[test]
fn cutting_is_exact() {
    let at = DVec3::new(3.0, -1.0, 2.0);
    let plane = |n: DVec3, d: f64| HalfSpace {
        normal: n.normalize(),
        distance: d / n.length() + n.normalize().dot(at),
    };
    let share = |planes: &[HalfSpace]| polyhedron_fraction(planes, at);
    assert_near(share(&[]), 1.0, 1e-15);
    // A corner, all except a corner, a wedge, a slab, nothing.
    let corner = plane(DVec3::ONE, -1.0);
    assert_near(share(&[corner]), 1.0 / 48.0, 1e-15);
    assert_near(share(&[plane(DVec3::ONE, 1.0)]), 47.0 / 48.0, 1e-15);
    let wedge = [plane(DVec3::X + DVec3::Y, 0.0), plane(DVec3::Y, 0.0)];
    assert_near(share(&wedge), 0.375, 1e-15);
    let slab = [plane(DVec3::X, 0.2), plane(DVec3::NEG_X, -0.1)];
    assert_near(share(&slab), 0.1, 1e-15);
    assert_eq!(
        share(&[plane(DVec3::X, 0.2), plane(DVec3::NEG_X, -0.3)]),
        0.0
    );
}

#[test]
fn shares_of_balls_are_exact() {
    let volume = |radius: f64| 4.0 / 3.0 * PI * radius.powi(3);
    let check = |found: f64, exact: f64| assert_near(found, exact, 1e-13);
    // Inside the cell, an octant, half, a cap of height 0.2, without the six caps beyond the faces.
    check(sphere_fraction(0.4, DVec3::ZERO), volume(0.4));
    check(sphere_fraction(0.8, DVec3::splat(0.5)), volume(0.8) / 8.0);
    check(
        sphere_fraction(0.3, DVec3::new(0.0, 0.5, 0.0)),
        volume(0.3) / 2.0,
    );
    let cap = |radius: f64, height: f64| PI * height * height * (radius - height / 3.0);
    for at in [DVec3::X, DVec3::NEG_Y, DVec3::Z] {
        check(sphere_fraction(0.5, 0.8 * at), cap(0.5, 0.2));
    }
    check(
        sphere_fraction(0.6, DVec3::ZERO),
        volume(0.6) - 6.0 * cap(0.6, 0.1),
    );
    // The sum over all cells is the ball.
    let at = DVec3::new(0.13, -0.31, 0.27);
    for radius in [0.55, 1.7, 3.2] {
        let range = || (-4..=4).map(f64::from);
        let cells = range().flat_map(|x| range().map(move |y| (x, y)));
        let cells = cells.flat_map(|(x, y)| range().map(move |z| DVec3::new(x, y, z)));
        let sum: f64 = cells.map(|cell| sphere_fraction(radius, cell + at)).sum();
        assert_relative(sum, volume(radius), 1e-13);
    }
    // So far from the centre that the surface is a plane up to 1 / 8R.
    let share = sphere_fraction(1e3, DVec3::new(0.0, 0.0, 1e3 - 0.1));
    let mean_sagitta = 1.0 / (6.0 * 2e3);
    assert_near(share, 0.6 - mean_sagitta, 1e-8);
}
