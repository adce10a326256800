//! The rims of the closed joints of a block.

use super::{kernel_deficit::KernelDeficit, rim_pressure::RimSample};
use crate::rock::contact::Placed;
use glam::DVec3;

/// Distance of a sample from the edge of a joint, spacings: particles approach rock to half a spacing.
const SAMPLE_DISTANCE: f64 = 1.0;
/// Clearance to rock that a sample needs, spacings; without it the joint continues.
const MIN_CLEARANCE: f64 = 0.45;
/// Offsets of candidate samples along the normal of the face, spacings: where rock continues above or below the joint, only
/// one side has clearance.
const NORMAL_OFFSETS: [f64; 3] = [0.0, -0.5, 0.5];
/// Distances to both sides at which rock is probed, spacings: between two sides less than two spacings apart the joint
/// continues.
const SIDE_PROBES: [f64; 2] = [0.75, 1.5];
/// Distance beyond an edge within which another patch continues the joint, spacings.
const PATCH_GAP: f64 = 0.1;
/// Length of rim per sample, spacings.
const SAMPLE_LENGTH: f64 = 3.0;
/// Most samples on an edge.
const MAX_SAMPLES: f64 = 8.0;

/// Pairs of a distance beyond an edge where rock is probed, and the length to which the rock then extends, smoothing lengths.
const EXTENT_PROBES: [[f64; 2]; 4] = [[0.125, 0.25], [0.375, 0.55], [0.75, 1.0], [1.25, 2.0]];
/// Depth below the face at which the rock of the face itself is probed, spacings.
const PROBE_DEPTH: f64 = 0.25;

/// A segment of the edge of a joint with water beyond it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RimEdge {
    /// Index of the patch that ends there.
    pub patch: usize,
    /// Midpoint, m.
    pub place: DVec3,
    /// Vector area that the edge loses (force per pressure), m²: its length times the lost width along the normal, and,
    /// where one of the two blocks extends farther, times the lost lateral width.
    pub loss: DVec3,
}

/// What [`find_rim`] needs besides the joint.
#[derive(Clone, Copy, Debug)]
pub(super) struct RimParams<'a> {
    /// m.
    pub spacing: f64,
    /// In a plane scene: y of the particles, m. All samples lie there.
    pub row: Option<f64>,
    pub deficit: &'a KernelDeficit,
}

/// Samples the rim of a joint: the edges of its closed patches (convex polygons with the outward normal `normal`) beyond which
/// there is neither rock of `solids` nor another patch. Adds the samples to `samples` and returns the edges.
pub(super) fn find_rim<'a>(
    samples: &mut Vec<RimSample>,
    patches: &[Vec<DVec3>],
    normal: DVec3,
    solids: impl Iterator<Item = &'a Placed> + Clone,
    params: RimParams<'_>,
) -> Vec<RimEdge> {
    let RimParams {
        spacing,
        row,
        deficit,
    } = params;
    let mut rim = Vec::new();
    let all = patches.iter().enumerate();
    let all =
        all.flat_map(|(n, patch)| edges(patch, normal).into_iter().map(move |edge| (n, edge)));
    for (patch, [from, edge, out]) in all {
        let length = edge.length();
        // Slivers where corners of blocks meet are no rim, and plane scenes have no ends along y.
        if length < 0.25 * spacing || row.is_some() && out.y.abs() > 0.5 {
            continue;
        }
        let count = (length / (SAMPLE_LENGTH * spacing))
            .round()
            .clamp(1.0, MAX_SAMPLES);
        for n in 0..count as u32 {
            let mut place = from + (f64::from(n) + 0.5) / count * edge;
            place.y = row.unwrap_or(place.y);
            let beyond = place + PATCH_GAP * spacing * out;
            if patches.iter().any(|other| contains(other, normal, beyond)) {
                continue;
            }
            let candidates = NORMAL_OFFSETS
                .map(|offset| place + spacing * (SAMPLE_DISTANCE * out + offset * normal));
            let clearance = |x: DVec3| {
                let heights = solids.clone().map(|part| distance(part, x));
                heights.fold(f64::INFINITY, f64::min)
            };
            let covered = |x: DVec3, side: f64| {
                let mut probes = SIDE_PROBES.iter();
                probes.any(|height| clearance(x + side * height * spacing * normal) <= 0.0)
            };
            let open = |x: &DVec3| {
                let continues = || covered(*x, 1.0) && covered(*x, -1.0);
                clearance(*x) > MIN_CLEARANCE * spacing && !continues()
            };
            let Some(outside) = candidates.into_iter().find(open) else {
                continue;
            };
            let length = length / count;
            samples.push(RimSample {
                place: outside,
                length,
                pressure: 0.0,
            });
            let h = 0.5 * deficit.support;
            let extent = |heights: &[f64]| {
                let is_rock = |[at, _]: &&[f64; 2]| {
                    let beyond = place + at * h * out;
                    let mut places = heights.iter().map(|height| beyond + height * normal);
                    places.any(|x| clearance(x) <= 0.0)
                };
                let last = EXTENT_PROBES.iter().take_while(is_rock).last();
                last.map_or(0.0, |[_, length]| length * h)
            };
            let [own, other] = [extent(&[-PROBE_DEPTH * spacing]), extent(&deficit.heights)];
            let loss = deficit.edge_loss(own.max(other));
            let lateral = deficit.edge_loss(0.0) - loss;
            let side = (own - other).total_cmp(&0.0) as i32;
            rim.push(RimEdge {
                patch,
                place,
                loss: length * (loss * normal + f64::from(side) * lateral * out),
            });
        }
    }
    rim
}

/// The edges of a convex polygon: start, edge vector, and outward unit vector in its plane.
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

/// Whether a convex polygon contains a place in its plane.
fn contains(polygon: &[DVec3], normal: DVec3, place: DVec3) -> bool {
    let mut edges = edges(polygon, normal).into_iter();
    !polygon.is_empty() && edges.all(|[from, _, out]| out.dot(place - from) <= 0.0)
}

/// A lower bound of the distance of `x` from a part, m; negative inside.
fn distance(part: &Placed, x: DVec3) -> f64 {
    let away = x - part.centre;
    if part.is_sphere() {
        return away.length() - part.radius;
    }
    let heights = part.faces.iter().map(|face| face.height(away));
    heights.fold(f64::NEG_INFINITY, f64::max)
}
