//! Exact volumes in f64, by cutting polygons.

use glam::DVec3;
use riprap::block::HalfSpace;

/// What planes leave of a convex body, kept as its polygons, counter-clockwise seen from outside.
#[derive(Clone)]
pub struct Solid(Vec<Vec<DVec3>>);

impl Solid {
    /// The unit cube about `centre`.
    pub fn cell(centre: DVec3) -> Self {
        let corner = |x: f64, y: f64, z: f64| centre + DVec3::new(x, y, z) / 2.0;
        let mut faces = Vec::new();
        for side in [-1.0, 1.0] {
            // Around the axis, and backwards on the lower side.
            let ring = [(-side, -1.0), (side, -1.0), (side, 1.0), (-side, 1.0)];
            faces.push(ring.map(|(a, b)| corner(side, a, b)).to_vec());
            faces.push(ring.map(|(a, b)| corner(b, side, a)).to_vec());
            faces.push(ring.map(|(a, b)| corner(a, b, side)).to_vec());
        }
        Self(faces)
    }

    /// What is inside `plane`.
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

/// Share of the unit cell about `centre` inside all `faces`.
pub fn hull_share(faces: &[HalfSpace], centre: DVec3) -> f64 {
    let solid = faces.iter().fold(Solid::cell(centre), Solid::cut);
    solid.volume()
}

/// Share of the unit cell about `centre` inside the ball about the origin: columns of which the length
/// is exact, far more than any kernel takes.
pub fn ball_share(radius: f64, centre: DVec3) -> f64 {
    const N: usize = 200;
    let at = |i: usize| (i as f64 + 0.5) / N as f64 - 0.5;
    let mut sum = 0.0;
    for i in 0..N {
        for j in 0..N {
            let (x, y) = (centre.x + at(i), centre.y + at(j));
            let half = (radius * radius - x * x - y * y).max(0.0).sqrt();
            let (low, high) = (centre.z - 0.5, centre.z + 0.5);
            sum += (half.min(high) - (-half).max(low)).max(0.0);
        }
    }
    sum / (N * N) as f64
}

#[test]
fn cutting_is_exact() {
    let at = DVec3::new(3.0, -1.0, 2.0);
    let plane = |n: DVec3, d: f64| HalfSpace {
        normal: n.normalize(),
        distance: d / n.length() + n.normalize().dot(at),
    };
    let share = |planes: &[HalfSpace]| hull_share(planes, at);
    assert!((share(&[]) - 1.0).abs() < 1e-15);
    // A corner, all but a corner, a wedge, a slab, nothing.
    let corner = plane(DVec3::ONE, -1.0);
    assert!((share(&[corner]) - 1.0 / 48.0).abs() < 1e-15);
    assert!((share(&[plane(DVec3::ONE, 1.0)]) - 47.0 / 48.0).abs() < 1e-15);
    let wedge = [plane(DVec3::X + DVec3::Y, 0.0), plane(DVec3::Y, 0.0)];
    assert!((share(&wedge) - 0.375).abs() < 1e-15);
    let slab = [plane(DVec3::X, 0.2), plane(DVec3::NEG_X, -0.1)];
    assert!((share(&slab) - 0.1).abs() < 1e-15);
    assert_eq!(
        share(&[plane(DVec3::X, 0.2), plane(DVec3::NEG_X, -0.3)]),
        0.0
    );
    // A ball inside the cell.
    let ball = 4.0 / 3.0 * std::f64::consts::PI * 0.4f64.powi(3);
    assert!((ball_share(0.4, DVec3::ZERO) - ball).abs() < 1e-4 * ball);
}
