//! Safety against toppling.

use super::factor;
use glam::{DVec2, DVec3};

/// What a block stands on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Base {
    /// Unit normal into the block.
    pub normal: DVec3,
    /// Corners of its contacts, m, in any order; it topples over the edges of their hull.
    pub corners: Vec<DVec3>,
}

/// Safety against toppling over an edge of the base: of the resultant `force` (N) of weight, loads and fluid at the
/// `centroid` (m), its part along the normal and the one across it, and the `torque` of fluid and loads about the centroid
/// (N m), the sum of the moments about the edge that hold the block down over that of those that turn it over; the
/// least of those of all edges that are `open`, which says whether a block may turn about an axis (unit vector)
/// through a point (m). Infinite where nothing turns it, 0 on a point, NaN on nothing.
pub fn toppling(
    force: DVec3,
    torque: DVec3,
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
    let along = force.dot(n) * n;
    let mut least = f64::INFINITY;
    for (k, a) in hull.iter().enumerate() {
        let b = hull[(k + 1) % hull.len()];
        // The block's top goes outwards.
        let axis = (b - a).normalize_or_zero();
        if !open(axis, *a) {
            continue;
        }
        let arm = centroid - a;
        let moments = [
            arm.cross(along).dot(axis),
            arm.cross(force - along).dot(axis),
            torque.dot(axis),
        ];
        let sum = |sign: f64| moments.iter().map(|m| (sign * m).max(0.0)).sum::<f64>();
        let whole = force.length() * arm.length() + torque.length();
        least = least.min(factor(sum(-1.0), sum(1.0), whole));
    }
    least
}

/// Corners of the hull of points in a plane, counter-clockwise about the normal (Andrew 1979); two for points of a
/// line.
fn hull(points: &[DVec3], normal: DVec3) -> Vec<DVec3> {
    let (u, v) = normal.any_orthonormal_pair();
    // u, v and the normal may be left-handed.
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
    // Corners closer than rounding are one.
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

    /// A block b wide and h high at its middle, on an incline of β that falls along x.
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

    fn factor(force: DVec3, torque: DVec3, (centroid, base): &(DVec3, Base)) -> f64 {
        toppling(force, torque, *centroid, base, |_, _| true)
    }

    #[test]
    fn on_an_incline_it_is_b_over_h_over_tan_beta() {
        for (b, h, beta) in [(1.0, 3.0, 10f64), (1.0, 2.0, 30.0), (0.2, 2.5, 5.0)] {
            let on = incline(b, h, beta.to_radians());
            let exact = b / h / beta.to_radians().tan();
            let found = factor(-5.0 * DVec3::Z, DVec3::ZERO, &on);
            assert!((found - exact).abs() < 1e-13, "{found} {exact}");
            // Still water takes from what holds and what drives alike.
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
        // Rounding turns nothing.
        let still = factor(-DVec3::Z, 1e-17 * DVec3::Y, &on);
        assert_eq!(still, f64::INFINITY);
        // About the other edge this torque holds.
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
        let found = toppling(force, DVec3::ZERO, centroid, &base, along_x);
        assert!((found - 0.7 / 0.15).abs() < 1e-14, "{found}");
    }

    #[test]
    fn on_an_edge_a_point_and_nothing() {
        let standing = |corners: &[DVec3]| {
            let base = Base {
                normal: DVec3::Z,
                corners: corners.into(),
            };
            toppling(
                DVec3::new(0.1, 0.0, -1.0),
                DVec3::ZERO,
                DVec3::Z,
                &base,
                |_, _| true,
            )
        };
        assert_eq!(standing(&[DVec3::Y, -DVec3::Y]), 0.0);
        assert_eq!(standing(&[DVec3::ZERO]), 0.0);
        assert!(standing(&[]).is_nan());
    }
}
