//! What lies over the faces of a block.

use crate::{
    block::{HalfSpace, Part, Shape},
    bodies::{Load, Period, Pose, outer},
    contact::Placed,
    immersed::area_of,
};
use glam::DVec3;

/// A part of a block beside another one.
#[derive(Clone, Debug)]
pub(super) struct Other {
    /// Number of its block.
    pub block: usize,
    /// By how much it is moved to be there, a number of periods, m.
    pub way: DVec3,
    pub part: Placed,
}

/// The parts of the other blocks, solids and walls that may be within `far` (m) of a block, in each period where they are,
/// and those of its own images.
pub(super) fn others<'a>(
    shape: impl Fn(usize) -> &'a Shape,
    (poses, period): (&[Pose], Option<Period>),
    block: usize,
    far: f64,
) -> Vec<Other> {
    let mut found = Vec::new();
    let (centre, reach) = (poses[block].centre, shape(block).radius() + far);
    for (other, pose) in poses.iter().enumerate() {
        let near = reach + shape(other).radius();
        let apart = pose.centre - centre;
        let ways = match period {
            Some(period) => period.ways(apart, near),
            None => vec![DVec3::ZERO],
        };
        for way in ways {
            let itself = other == block && way == DVec3::ZERO;
            if itself || (apart + way).length() > near {
                continue;
            }
            let image = Pose {
                centre: pose.centre + way,
                ..*pose
            };
            let within = |part: &&Part| {
                let apart = image.point(part.offset) - centre;
                apart.length() <= reach + part.form.radius()
            };
            let parts = shape(other).parts().iter().filter(within);
            found.extend(parts.map(|part| Other {
                block: other,
                way,
                part: Placed::of(part, &image),
            }));
        }
    }
    found
}

/// What of a plane polygon lies under a part at one of the `heights` (m) over it, where that is the most, and its area (m²).
pub(super) fn covered(
    polygon: &[DVec3],
    normal: DVec3,
    part: &Placed,
    heights: impl IntoIterator<Item = f64>,
) -> (Vec<DVec3>, f64) {
    let mut most = (Vec::new(), 0.0);
    for height in heights {
        let way = height * normal;
        let beside = |face: &HalfSpace| {
            let height = |x: &DVec3| face.height(*x + way - part.centre);
            polygon.iter().all(|x| height(x) >= 0.0)
        };
        if part.faces.iter().any(beside) {
            continue;
        }
        let mut under = part.clipped(polygon.iter().map(|x| x + way).collect());
        let area = area_of(&under).1.length();
        if area > most.1 {
            under.iter_mut().for_each(|x| *x -= way);
            most = (under, area);
        }
    }
    most
}

/// How often a triangle is cut in four where the pressure on it ends.
const CUTS: u32 = 3;

/// Adds a pressure on a polygon with the outward normal `normal` to the load on a block at `centre`: by three points a
/// triangle, exact for the moment of a linear pressure, and by more triangles where a part of one has none.
pub(super) fn press(
    load: &mut Load,
    corners: &[DVec3],
    normal: DVec3,
    centre: DVec3,
    pressure: impl Fn(DVec3) -> f64,
) {
    for pair in corners.windows(2).skip(1) {
        let triangle = [corners[0], pair[0], pair[1]];
        press_triangle(load, triangle, (normal, centre), &pressure, CUTS);
    }
}

fn press_triangle(
    load: &mut Load,
    [a, b, c]: [DVec3; 3],
    (normal, centre): (DVec3, DVec3),
    pressure: &impl Fn(DVec3) -> f64,
    cuts: u32,
) {
    let dry = [a, b, c].map(|x| pressure(x) == 0.0);
    if cuts > 0 && dry.contains(&true) && dry.contains(&false) {
        let [ab, bc, ca] = [0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)];
        for part in [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]] {
            press_triangle(load, part, (normal, centre), pressure, cuts - 1);
        }
        return;
    }
    let third = (b - a).cross(c - a).length() / 6.0;
    let whole = a + b + c;
    for x in [a, b, c].map(|corner| (3.0 * corner + whole) / 6.0) {
        let force = -third * pressure(x) * normal;
        load.force += force;
        load.moment += outer(force, x - centre);
    }
}
