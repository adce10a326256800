//! The rims of the closed joints of a block, and the pressure field in the joints, fitted to the pressure at their rims.

use super::{joint_faces::NeighbourPart, kernel_deficit::KernelDeficit};
use crate::{geometry::outer, rock::contact::Placed};
use glam::{DMat3, DVec3};

/// Distance of a sample from the edge of a joint, spacings: particles approach rock to half a spacing.
const SAMPLE_DISTANCE: f64 = 1.0;
/// Clearance to rock that a sample needs, spacings; without it the joint continues.
const MIN_CLEARANCE: f64 = 0.45;
/// Offsets of candidate samples along the normal of the face, spacings: if rock continues above or below the joint, only
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

/// Parameters of [`find_rim`] other than the joint.
#[derive(Clone, Copy, Debug)]
pub(super) struct RimParams<'a> {
    /// Particle spacing, m.
    pub spacing: f64,
    /// In a plane scene: y of the particles and of all samples, m.
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
        // Slivers at the corners of blocks are not rims, and plane scenes have no ends along y.
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

/// Whether a convex polygon contains a point in its plane.
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

/// The pressure of the water at a point on the rim of a joint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct RimSample {
    /// Position, m.
    pub place: DVec3,
    /// Length of rim that the sample represents, m.
    pub length: f64,
    /// Pressure, Pa; 0 if the rim is dry.
    pub pressure: f64,
}

/// A linear pressure field, fitted to the rims of joints by least squares. Dry rims enter the fit if water at rest would
/// reach them. In directions without samples, as across a joint that is open on one side only, the gradient is hydrostatic.
/// The head is clamped to the range of the rims.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct RimPressure {
    /// Centroid of the rims, m.
    pub place: DVec3,
    /// Pressure there, Pa.
    pub pressure: f64,
    /// Pressure gradient less the hydrostatic gradient, Pa/m.
    pub slope: DVec3,
    /// ρ g, Pa/m.
    pub weight: DVec3,
    /// Range of the head, as hydrostatic pressures at `place`, Pa.
    pub range: [f64; 2],
}

impl RimPressure {
    /// Pressure at `x` (m), Pa; not negative.
    pub fn at(&self, x: DVec3) -> f64 {
        let r = x - self.place;
        let [low, high] = self.range;
        let head = (self.pressure + self.slope.dot(r)).max(low).min(high);
        (head + self.weight.dot(r)).max(0.0)
    }

    /// Fits the field to samples; `None` if all are dry. Distances below `support` (m) do not determine slopes.
    pub fn fit(samples: &[RimSample], support: f64, weight: DVec3) -> Option<Self> {
        let wet = samples.iter().filter(|sample| sample.pressure > 0.0);
        let (level, wet_length) = wet.fold((0.0, 0.0), |(level, length), sample| {
            let head = sample.pressure - weight.dot(sample.place);
            (level + sample.length * head, length + sample.length)
        });
        if wet_length <= 0.0 {
            return None;
        }
        let counts = |sample: &&RimSample| {
            sample.pressure > 0.0 || level / wet_length + weight.dot(sample.place) > 0.0
        };
        let used = || samples.iter().filter(counts);
        let length: f64 = used().map(|sample| sample.length).sum();
        let place = used().map(|sample| sample.length * sample.place);
        let place = place.sum::<DVec3>() / length;
        let head = |sample: &RimSample| sample.pressure - weight.dot(sample.place - place);
        let pressure = used().map(|sample| sample.length * head(sample));
        let pressure = pressure.sum::<f64>() / length;
        let mut variance = DMat3::from_diagonal(DVec3::splat(support.powi(2) / 12.0));
        let (mut covariance, mut range) = (DVec3::ZERO, [f64::INFINITY, f64::NEG_INFINITY]);
        for sample in used() {
            let (fraction, r) = (sample.length / length, sample.place - place);
            variance += fraction * outer(r, r);
            covariance += fraction * (head(sample) - pressure) * r;
            range = [range[0].min(head(sample)), range[1].max(head(sample))];
        }
        Some(Self {
            place,
            pressure,
            slope: variance.inverse() * covariance,
            weight,
            range,
        })
    }
}

impl LinearField for RimPressure {
    fn translated(self, offset: DVec3) -> Self {
        Self {
            place: self.place + offset,
            ..self
        }
    }

    fn mean(fields: &[Self]) -> Self {
        let Self { place, weight, .. } = fields[0];
        let factor = 1.0 / fields.len() as f64;
        let mut mean = Self {
            place,
            weight,
            range: [f64::INFINITY, f64::NEG_INFINITY],
            ..Self::default()
        };
        for field in fields {
            let r = place - field.place;
            mean.pressure += factor * (field.pressure + (field.slope + weight).dot(r));
            mean.slope += factor * field.slope;
            let [low, high] = field.range.map(|end| end + weight.dot(r));
            mean.range = [mean.range[0].min(low), mean.range[1].max(high)];
        }
        mean
    }
}

/// A linear pressure field.
pub(super) trait LinearField: Copy {
    /// The field translated by `offset` (m).
    fn translated(self, offset: DVec3) -> Self;

    /// The mean of at least one field.
    fn mean(fields: &[Self]) -> Self;
}

/// Two blocks with a joint between them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Contiguity {
    pub block: usize,
    pub other: usize,
    /// Periodic offset of the other block, m.
    pub offset: DVec3,
}

impl Contiguity {
    /// The contiguity of a block and a part of a neighbour.
    pub fn of(block: usize, part: &NeighbourPart) -> Self {
        Self {
            block,
            other: part.block,
            offset: part.offset,
        }
    }
}

/// Propagates the fields of blocks to blocks without one that `may_have` one. Inside a jointed mass all sides of a block are
/// joints, and their water is connected with the joints of the neighbours: a block takes the mean of the fields of its
/// neighbours, and this repeats from block to block.
pub(super) fn propagate<T: LinearField>(
    known: &[Option<T>],
    may_have: impl Fn(usize) -> bool,
    joints: &[Contiguity],
) -> Vec<Option<T>> {
    let mut fields = known.to_vec();
    loop {
        let mut neighbours = vec![Vec::new(); fields.len()];
        for joint in joints {
            if fields[joint.block].is_none() && may_have(joint.block) {
                let field = fields[joint.other].map(|field| field.translated(joint.offset));
                neighbours[joint.block].extend(field);
            }
        }
        let mut changed = false;
        for (field, neighbours) in fields.iter_mut().zip(&neighbours) {
            if !neighbours.is_empty() {
                *field = Some(T::mean(neighbours));
                changed = true;
            }
        }
        if !changed {
            return fields;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(places: &[DVec3], pressure: impl Fn(DVec3) -> f64) -> Vec<RimSample> {
        let sample = |&place: &DVec3| RimSample {
            place,
            length: 1.0,
            pressure: pressure(place).max(0.0),
        };
        places.iter().map(sample).collect()
    }

    #[test]
    fn hydrostatic_pressure_is_fitted_exactly_for_any_wet_part() {
        let weight = DVec3::new(1.0, 0.0, -10.0);
        let still = |x: DVec3| 100.0 + weight.dot(x);
        // Rims on one side, on two sides, and partly above the water.
        for places in [
            vec![
                DVec3::X,
                DVec3::new(1.0, 0.0, 3.0),
                DVec3::new(1.0, 2.0, -1.0),
            ],
            vec![DVec3::new(2.0, 1.0, 5.0), DVec3::ZERO],
            vec![
                DVec3::ZERO,
                DVec3::new(3.0, 1.0, 12.0),
                DVec3::new(-9.0, 1.0, 20.0),
            ],
        ] {
            let head = RimPressure::fit(&samples(&places, still), 4.0, weight).unwrap();
            for x in [DVec3::new(-3.0, 1.0, -2.0), DVec3::Z * 4.0] {
                assert!((head.at(x) - still(x)).abs() < 1e-9, "{}", head.at(x));
            }
            assert_eq!(head.at(DVec3::Z * 1e3), 0.0);
        }
        assert_eq!(
            RimPressure::fit(&samples(&[DVec3::Z * 99.0], still), 4.0, weight),
            None
        );
    }

    #[test]
    fn the_mean_of_hydrostatic_fields_is_hydrostatic() {
        let still = |x: DVec3| 100.0 - 10.0 * x.z;
        let weight = DVec3::Z * -10.0;
        let at = |x: f64, z: f64| {
            let places = [DVec3::new(x, 0.0, z), DVec3::new(x + 1.0, 2.0, z + 3.0)];
            RimPressure::fit(&samples(&places, still), 4.0, weight).unwrap()
        };
        let translated = at(-7.0, 1.0).translated(DVec3::X * 7.0);
        let mean = RimPressure::mean(&[at(0.0, 0.0), at(5.0, -4.0), translated]);
        for x in [DVec3::new(-3.0, 1.0, -2.0), DVec3::Z * 4.0] {
            assert!((mean.at(x) - still(x)).abs() < 1e-9, "{}", mean.at(x));
        }
        assert_eq!(mean.at(DVec3::Z * 1e3), 0.0);
    }

    /// A dam, 60 wide, between two levels, and with a dry toe. Beyond the rims the head is clamped.
    #[test]
    fn uplift_falls_linearly_between_two_levels() {
        let places = [-30.0, 30.0].map(|x| DVec3::X * x);
        for (up, down) in [(65.0, 35.0), (65.0, 0.0)] {
            let level = |x: DVec3| if x.x < 0.0 { up } else { down };
            let head = RimPressure::fit(&samples(&places, level), 4.0, DVec3::NEG_Z).unwrap();
            let between = 0.5 * (up + down);
            for (x, expected) in [(-30.0, up), (0.0, between), (30.0, down), (-90.0, up)] {
                let found = head.at(DVec3::X * x);
                assert!((found - expected).abs() < 0.1, "{found} at {x}");
            }
        }
    }

    impl LinearField for f64 {
        fn translated(self, offset: DVec3) -> Self {
            self + offset.x
        }

        fn mean(fields: &[Self]) -> Self {
            fields.iter().sum::<f64>() / fields.len() as f64
        }
    }

    #[test]
    fn fields_propagate_to_the_middle_of_a_row_but_not_through_excluded_blocks() {
        let known = [Some(1.0), None, None, None, Some(5.0), None, None];
        let joint = |block, other, offset| Contiguity {
            block,
            other,
            offset,
        };
        let row = |n: usize| joint(n, n + 1, DVec3::ZERO);
        let mut joints: Vec<_> = (0..6).map(row).collect();
        joints.extend((0..6).map(|n| joint(n + 1, n, 0.5 * DVec3::X)));
        let found = propagate(&known, |n| n != 5, &joints);
        let middle = 0.5 * (1.5 + 0.5 + 5.0);
        assert_eq!(
            found,
            [
                Some(1.0),
                Some(1.5),
                Some(middle),
                Some(5.0),
                Some(5.0),
                None,
                None
            ]
        );
    }
}
