//! What lies over the faces of a block.

use crate::{
    block::Shape,
    bodies::{Load, Period, Pose, outer},
    contact::Placed,
    immersed::area_of,
};
use glam::DVec3;

/// The parts of the other blocks, solids and walls that may be within `far` (m) of a block, each with the number of its
/// block, next to it where the domain is periodic.
pub(super) fn others<'a>(
    shape: impl Fn(usize) -> &'a Shape,
    (poses, period): (&[Pose], Option<Period>),
    block: usize,
    far: f64,
) -> Vec<(usize, Placed)> {
    let mut found = Vec::new();
    for (other, pose) in poses.iter().enumerate().filter(|(n, _)| *n != block) {
        let near = shape(block).radius() + shape(other).radius() + far;
        let apart = pose.centre - poses[block].centre;
        let way = period.map_or(DVec3::ZERO, |period| period.nearest(apart));
        if (apart + way).length() <= near {
            let image = Pose {
                centre: pose.centre + way,
                ..*pose
            };
            let parts = shape(other).parts().iter();
            found.extend(parts.map(|part| (other, Placed::of(part, &image))));
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
        let mut under = part.clipped(polygon.iter().map(|x| x + way).collect());
        let area = area_of(&under).1.length();
        if area > most.1 {
            under.iter_mut().for_each(|x| *x -= way);
            most = (under, area);
        }
    }
    most
}

/// Adds a pressure on a polygon with the outward normal `normal` to the load on a block at `centre`: by three points a
/// triangle, exact for the moment of a linear pressure.
pub(super) fn press(
    load: &mut Load,
    corners: &[DVec3],
    normal: DVec3,
    centre: DVec3,
    pressure: impl Fn(DVec3) -> f64,
) {
    for pair in corners.windows(2).skip(1) {
        let [a, b, c] = [corners[0], pair[0], pair[1]];
        let third = (b - a).cross(c - a).length() / 6.0;
        let whole = a + b + c;
        for x in [a, b, c].map(|corner| (3.0 * corner + whole) / 6.0) {
            let force = -third * pressure(x) * normal;
            load.force += force;
            load.moment += outer(force, x - centre);
        }
    }
}
