//! Where the closed joints of a block end.

use super::{across::Across, head::Sample};
use crate::contact::Placed;
use glam::DVec3;

/// How far out of a joint its pressure is looked at, spacings: water comes to half a spacing from rock.
const OUT: f64 = 1.0;
/// Room that the place must have around it, spacings; else the joint does not end there.
const ROOM: f64 = 0.45;
/// Where it is looked for in the direction of the face's normal, spacings: beside rock that goes on above the joint or
/// below there is room on one side only.
const BESIDE: [f64; 3] = [0.0, -0.5, 0.5];
/// Where rock is looked for on both sides, spacings: what is between two sides less than two of them apart is a joint that
/// goes on.
const THROUGH: [f64; 2] = [0.75, 1.5];
/// Within what another part of the same joint begins, spacings.
const SEAM: f64 = 0.1;
/// Length of rim for one place, spacings, and the most places on an edge.
const APART: f64 = 3.0;
const MOST: f64 = 8.0;

/// How far beyond an edge rock is looked for that goes on there, smoothing lengths, and how far it then goes on.
const ON: [[f64; 2]; 4] = [[0.125, 0.25], [0.375, 0.55], [0.75, 1.0], [1.25, 2.0]];
/// How deep it is looked for below the face, spacings.
const BELOW: f64 = 0.25;

/// A piece of the edge of a joint, beyond which there is water.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Edge {
    /// Which of the polygons ends there.
    pub polygon: usize,
    /// Its middle, m.
    pub place: DVec3,
    /// What it loses, times the pressure there: its length times the width that is not pressed, along the normal, and,
    /// where one of the two goes on, times the width that is not pressed aside, m².
    pub lost: DVec3,
}

/// Adds the places beside the edges of closed parts of a face, convex polygons with the outward normal `normal`, where there
/// is neither rock of `solids` nor another part of the joint, and returns the edges there. Where nothing varies along y they are
/// all at `row` (m).
pub(super) fn rim<'a>(
    found: &mut Vec<Sample>,
    (polygons, normal): (&[Vec<DVec3>], DVec3),
    solids: impl Iterator<Item = &'a Placed> + Clone,
    (spacing, row, across): (f64, Option<f64>, &Across),
) -> Vec<Edge> {
    let mut ends = Vec::new();
    let all = polygons.iter().enumerate();
    let all = all.flat_map(|(n, polygon)| {
        edges(polygon, normal)
            .into_iter()
            .map(move |edge| (n, edge))
    });
    for (polygon, [from, edge, out]) in all {
        let length = edge.length();
        // Slivers that are left where corners of blocks meet are no rim, and rows have no ends.
        if length < 0.25 * spacing || row.is_some() && out.y.abs() > 0.5 {
            continue;
        }
        let count = (length / (APART * spacing)).round().clamp(1.0, MOST);
        for n in 0..count as u32 {
            let mut place = from + (f64::from(n) + 0.5) / count * edge;
            place.y = row.unwrap_or(place.y);
            let beyond = place + SEAM * spacing * out;
            if polygons.iter().any(|other| holds(other, normal, beyond)) {
                continue;
            }
            let beside = BESIDE.map(|way| place + spacing * (OUT * out + way * normal));
            let nearest = |x: DVec3| {
                let heights = solids.clone().map(|part| outside(part, x));
                heights.fold(f64::INFINITY, f64::min)
            };
            let covered = |x: DVec3, way: f64| {
                let mut beyond = THROUGH.iter();
                beyond.any(|far| nearest(x + way * far * spacing * normal) <= 0.0)
            };
            let open = |x: &DVec3| {
                let goes_on = || covered(*x, 1.0) && covered(*x, -1.0);
                nearest(*x) > ROOM * spacing && !goes_on()
            };
            let Some(outside) = beside.into_iter().find(open) else {
                continue;
            };
            let length = length / count;
            found.push(Sample {
                place: outside,
                length,
                pressure: 0.0,
            });
            let h = 0.5 * across.reach;
            let goes_on = |heights: &[f64]| {
                let rock = |[at, _]: &&[f64; 2]| {
                    let beyond = place + at * h * out;
                    let mut places = heights.iter().map(|height| beyond + height * normal);
                    places.any(|x| nearest(x) <= 0.0)
                };
                let last = ON.iter().take_while(rock).last();
                last.map_or(0.0, |[_, far]| far * h)
            };
            let [own, other] = [goes_on(&[-BELOW * spacing]), goes_on(&across.heights)];
            let lost = across.lost(own.max(other));
            let aside = across.lost(0.0) - lost;
            let way = (own - other).total_cmp(&0.0) as i32;
            ends.push(Edge {
                polygon,
                place,
                lost: length * (lost * normal + f64::from(way) * aside * out),
            });
        }
    }
    ends
}

/// The edges of a convex polygon: from where, the way along it, and the unit vector out of it.
fn edges(polygon: &[DVec3], normal: DVec3) -> Vec<[DVec3; 3]> {
    let middle = polygon.iter().sum::<DVec3>() / polygon.len() as f64;
    let edge = |n: usize| {
        let from = polygon[n];
        let edge = polygon[(n + 1) % polygon.len()] - from;
        let out = edge.cross(normal).normalize_or_zero();
        [from, edge, out * out.dot(from - middle).signum()]
    };
    (0..polygon.len()).map(edge).collect()
}

/// Whether a place in its plane is in a convex polygon.
fn holds(polygon: &[DVec3], normal: DVec3, place: DVec3) -> bool {
    let mut edges = edges(polygon, normal).into_iter();
    !polygon.is_empty() && edges.all(|[from, _, out]| out.dot(place - from) <= 0.0)
}

/// How far `x` is from a part at least, m; negative inside.
fn outside(part: &Placed, x: DVec3) -> f64 {
    let away = x - part.centre;
    if part.is_sphere() {
        return away.length() - part.radius;
    }
    let heights = part.faces.iter().map(|face| face.height(away));
    heights.fold(f64::NEG_INFINITY, f64::max)
}
