//! Safety against toppling.

use super::factor;
use glam::{DVec2, DVec3};

/// The base of a block.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Base {
    /// Unit normal into the block.
    pub normal: DVec3,
    /// Corners of the contacts, m, in any order; the block topples over the edges of their hull.
    pub corners: Vec<DVec3>,
}

/// A load on a block, reduced to the centroid of the block.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench {
    /// Force, N.
    pub force: DVec3,
    /// Torque about the centroid, N m.
    pub torque: DVec3,
}

impl Wrench {
    /// Moment about an axis (unit vector) by the true line of action, N m; `arm` (m) leads from the axis to the centroid.
    fn moment(&self, arm: DVec3, axis: DVec3) -> f64 {
        (arm.cross(self.force) + self.torque).dot(axis)
    }
}

/// Safety against toppling over an edge of the base: ΣM⁺/ΣM⁻, the stabilising over the overturning moments about the edge
/// (Novak, Moffat, Nalluri & Narayanan 2007, Hydraulic Structures, §3.2). The result is the smallest factor of all edges that
/// are `open`, a function that returns whether the block may rotate about an axis (unit vector) through a point (m).
///
/// The `weight` (N) acts at the `centroid` (m). Its components along and across the normal of the base enter separately,
/// and each of the `loads` enters with its moment about the edge; the sign of a moment decides whether it is stabilising or
/// overturning. The thrust and the uplift of a fluid are overturning, and uplift is not subtracted from the weight. The
/// contributions to one load, such as water on a sloping face, are netted.
///
/// Infinite without an overturning moment, 0 for a base of one point, NaN without a base.
pub fn toppling(
    weight: DVec3,
    loads: &[Wrench],
    centroid: DVec3,
    base: &Base,
    open: impl Fn(DVec3, DVec3) -> bool,
) -> f64 {
    let n = base.normal;
    let hull = hull(&base.corners, n);
    match hull.len() {
        0 => return f64::NAN,
        1 => return 0.0,
        _ => {}
    }
    let along = weight.dot(n) * n;
    let parts = [along, weight - along].map(|force| Wrench {
        force,
        ..Wrench::default()
    });
    let all: Vec<Wrench> = parts.iter().chain(loads).copied().collect();
    let mut least = f64::INFINITY;
    for (k, a) in hull.iter().enumerate() {
        let b = hull[(k + 1) % hull.len()];
        // A positive rotation about the axis moves the top of the block outwards.
        let axis = (b - a).normalize_or_zero();
        if !open(axis, *a) {
            continue;
        }
        let arm = centroid - a;
        let sum = |sign: f64| -> f64 {
            let moments = all.iter().map(|load| sign * load.moment(arm, axis));
            moments.map(|m| m.max(0.0)).sum()
        };
        let sizes = all
            .iter()
            .map(|load| load.force.length() * arm.length() + load.torque.length());
        least = least.min(factor(sum(-1.0), sum(1.0), sizes.sum()));
    }
    least
}

/// Corners of the hull of points in a plane, counter-clockwise about the normal (Andrew 1979); two for collinear points.
fn hull(points: &[DVec3], normal: DVec3) -> Vec<DVec3> {
    let (u, v) = normal.any_orthonormal_pair();
    // Makes u, v and the normal right-handed.
    let v = v * u.cross(v).dot(normal).signum();
    let mut flat: Vec<(DVec2, DVec3)> = points
        .iter()
        .map(|x| (DVec2::new(x.dot(u), x.dot(v)), *x))
        .collect();
    flat.sort_by(|(a, _), (b, _)| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let size = match (flat.first(), flat.last()) {
        (Some((a, _)), Some((b, _))) => (*b - *a).length(),
        _ => return Vec::new(),
    };
    // Merges corners closer than rounding.
    let tiny = 1e-9 * size;
    flat.dedup_by(|(a, _), (b, _)| (*a - *b).length() <= tiny);
    if flat.len() < 3 {
        return flat.into_iter().map(|(_, x)| x).collect();
    }
    let half = |points: &mut dyn Iterator<Item = &(DVec2, DVec3)>| {
        let mut kept: Vec<(DVec2, DVec3)> = Vec::new();
        for point in points {
            while let [.., a, b] = kept[..] {
                if (b.0 - a.0).perp_dot(point.0 - b.0) > tiny * size {
                    break;
                }
                kept.pop();
            }
            kept.push(*point);
        }
        kept.pop();
        kept
    };
    let lower = half(&mut flat.iter());
    let upper = half(&mut flat.iter().rev());
    lower.into_iter().chain(upper).map(|(_, x)| x).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    /// A block of width b and mean height h on an incline of angle β that falls along x.
    fn incline(b: f64, h: f64, beta: f64) -> (DVec3, Base) {
        let turn = DQuat::from_rotation_y(beta);
        let corner = |(x, y)| turn * DVec3::new(x * b / 2.0, y * 0.7, 0.0);
        let corners = [
            (1.0, 1.0),
            (-1.0, 1.0),
            (1.0, -1.0),
            (-1.0, -1.0),
            (0.1, 0.3),
        ]
        .map(corner);
        let base = Base {
            normal: turn * DVec3::Z,
            corners: corners.into(),
        };
        (turn * DVec3::Z * h / 2.0, base)
    }

    fn factor(weight: DVec3, torque: DVec3, (centroid, base): &(DVec3, Base)) -> f64 {
        let load = Wrench {
            torque,
            ..Wrench::default()
        };
        toppling(weight, &[load], *centroid, base, |_, _| true)
    }

    /// A force (N) at a point (m), reduced to the centroid (m).
    fn at(point: DVec3, force: DVec3, centroid: DVec3) -> Wrench {
        Wrench {
            force,
            torque: (point - centroid).cross(force),
        }
    }

    /// A dam b = 8 m wide and H = 10 m high of 2400 kg/m³, 1 m of it, with water to its crest: W = 1883.52 kN at b/2,
    /// thrust ½ρgH² = 490.5 kN at H/3, uplift of a triangle from ρgH at the heel, ½ρgHb = 392.4 kN, at 2b/3 from the toe.
    /// By hand 7534.08/(1635 + 2092.8) = 2.02105.
    #[test]
    fn a_gravity_dam_with_uplift() {
        let (b, h, gravity) = (8.0, 10.0, 9.81);
        let corner = |(x, y)| DVec3::new(x, y, 0.0);
        let base = Base {
            normal: DVec3::Z,
            corners: [(0.0, 0.0), (b, 0.0), (b, 1.0), (0.0, 1.0)]
                .map(corner)
                .into(),
        };
        let centroid = DVec3::new(b / 2.0, 0.5, h / 2.0);
        let weight = -2400.0 * gravity * b * h * DVec3::Z;
        let thrust = 0.5 * 1000.0 * gravity * h * h * DVec3::X;
        let uplift = 0.5 * 1000.0 * gravity * h * b * DVec3::Z;
        let thrust = at(DVec3::new(0.0, 0.5, h / 3.0), thrust, centroid);
        let uplift = at(DVec3::new(b / 3.0, 0.5, 0.0), uplift, centroid);
        let whole = Wrench {
            force: thrust.force + uplift.force,
            torque: thrust.torque + uplift.torque,
        };
        let exact = 7534.08 / (1635.0 + 2092.8);
        for loads in [vec![thrust, uplift], vec![whole]] {
            let found = toppling(weight, &loads, centroid, &base, |_, _| true);
            assert!((found / exact - 1.0).abs() < 1e-12, "{found} {exact}");
        }
    }

    /// A low thrust is not split into a force at the centroid and a stabilising torque: for a thrust P at a quarter of the
    /// height h, the factor is W b/2 over P h/4.
    #[test]
    fn a_low_thrust_counts_with_its_own_arm() {
        let (centroid, base) = incline(2.0, 3.0, 0.0);
        let thrust = at(DVec3::Z * 0.75, 0.5 * DVec3::X, centroid);
        let found = toppling(-DVec3::Z, &[thrust], centroid, &base, |_, _| true);
        assert!((found - 1.0 / 0.375).abs() < 1e-14, "{found}");
    }

    #[test]
    fn on_an_incline_it_is_b_over_h_over_tan_beta() {
        for (b, h, beta) in [(1.0, 3.0, 10f64), (1.0, 2.0, 30.0), (0.2, 2.5, 5.0)] {
            let on = incline(b, h, beta.to_radians());
            let exact = b / h / beta.to_radians().tan();
            let found = factor(-5.0 * DVec3::Z, DVec3::ZERO, &on);
            assert!((found - exact).abs() < 1e-13, "{found} {exact}");
            // Less gravity reduces stabilising and overturning moments equally.
            let wet = factor(-3.0 * DVec3::Z, DVec3::ZERO, &on);
            assert!((wet - exact).abs() < 1e-13);
        }
    }

    #[test]
    fn on_the_level_it_takes_a_push_or_a_torque() {
        let on = incline(2.0, 3.0, 0.0);
        assert_eq!(factor(-DVec3::Z, DVec3::ZERO, &on), f64::INFINITY);
        // W b/2 over P h/2.
        let pushed = factor(DVec3::new(0.25, 0.0, -1.0), DVec3::ZERO, &on);
        assert!((pushed - 1.0 / 0.375).abs() < 1e-14);
        // Rounding is not an overturning moment.
        let still = factor(-DVec3::Z, 1e-17 * DVec3::Y, &on);
        assert_eq!(still, f64::INFINITY);
        // About the other edge, this torque is stabilising.
        let turned = factor(-DVec3::Z, 0.5 * DVec3::Y, &on);
        assert!((turned - 2.0).abs() < 1e-14);
        let lifted = factor(DVec3::Z, DVec3::ZERO, &on);
        assert_eq!(lifted, 0.0);
    }

    #[test]
    fn edges_that_neighbours_hold_do_not_count() {
        let (centroid, base) = incline(2.0, 3.0, 0.0);
        let force = DVec3::new(0.25, 0.1, -1.0);
        let along_x = |axis: DVec3, _| axis.y.abs() < 0.5;
        let found = toppling(force, &[], centroid, &base, along_x);
        assert!((found - 0.7 / 0.15).abs() < 1e-14, "{found}");
    }

    #[test]
    fn on_an_edge_a_point_and_nothing() {
        let standing = |corners: &[DVec3]| {
            let base = Base {
                normal: DVec3::Z,
                corners: corners.into(),
            };
            toppling(DVec3::new(0.1, 0.0, -1.0), &[], DVec3::Z, &base, |_, _| {
                true
            })
        };
        assert_eq!(standing(&[DVec3::Y, -DVec3::Y]), 0.0);
        assert_eq!(standing(&[DVec3::ZERO]), 0.0);
        assert!(standing(&[]).is_nan());
    }
}
