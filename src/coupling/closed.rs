//! What the water in closed joints does to a block: the uplift diagram, linear from rim to rim.
//!
//! Water in a closed joint has the pressure of its rim. The lattice has it there only in the end, when what was in the full
//! cells has seeped out, and shows it as part of the whole load; for single faces and factors of safety the pressures beside
//! the wet faces at the rim are fitted by a plane, p = p̄ + g·(x − x̄), with the least squares over their cells, above what
//! the weight of the water makes of it; that acts on what of the block is dry. Nowhere there is it higher than at these
//! faces, or lower. The rim of a face is where two wet faces or more meet it, its own wet part among them; of one that is
//! deeper in, it is that of all joints of the block, through which the water comes to it.
//!
//! ```text
//!  p_heel  ┌───────┐          The mean of each wet face and, where all of it is wet, the slope along it that its
//!  ──────▶ │ block │ p_toe    moment shows: beside the heel and the toe these make the line between p_heel and
//!  ────────┴───────┴───────   p_toe.
//!           ╲▁▁▁▁▁▁
//! ```

use super::{Coupled, Felt, over::covered};
use crate::{
    block::{Form, Part, Shape},
    bodies::{Pose, outer},
    contact::Placed,
    immersed::{FaceLoad, corners},
};
use glam::{DMat3, DVec3};

/// Cells within which a block over a face leaves no cell of fluid between them.
const HEIGHTS: [f64; 3] = [0.0, 0.25, 1.0];
/// Share of a face that may stick out of the domain, or be dry without a joint, as the rounding of contacts and of
/// counting cells is.
const ROUGH: f64 = 0.1;
/// Least closed area, as a share of that of the face.
const SOME: f64 = 0.01;
/// Spread of places below which a direction has none, cells² a cell: far above the rounding of their sums, far below two
/// rows of cells.
const FLAT: f64 = 1e-3;

/// ∫ 1, r and r rᵀ over an area, r from the centroid of the block, m², m³, m⁴.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Moments {
    area: f64,
    first: DVec3,
    second: DMat3,
}

impl Moments {
    const ZERO: Self = Self {
        area: 0.0,
        first: DVec3::ZERO,
        second: DMat3::ZERO,
    };

    /// Of a convex plane polygon, r from `centre`.
    fn of(corners: &[DVec3], centre: DVec3) -> Self {
        let mut sum = Self::ZERO;
        for k in 2..corners.len() {
            let [a, b, c] = [corners[0], corners[k - 1], corners[k]].map(|x| x - centre);
            let area = 0.5 * (b - a).cross(c - a).length();
            let whole = a + b + c;
            let squares = [a, b, c, whole]
                .map(|r| outer(r, r))
                .into_iter()
                .sum::<DMat3>();
            sum = sum.plus(&Self {
                area,
                first: area / 3.0 * whole,
                second: squares * (area / 12.0),
            });
        }
        sum
    }

    fn plus(&self, other: &Self) -> Self {
        Self {
            area: self.area + other.area,
            first: self.first + other.first,
            second: self.second + other.second,
        }
    }

    fn times(&self, by: f64) -> Self {
        Self {
            area: by * self.area,
            first: by * self.first,
            second: self.second * by,
        }
    }

    /// Scaled to an area of at most `most` (m²).
    fn within(&self, most: f64) -> Self {
        self.times((most / self.area.max(f64::MIN_POSITIVE)).min(1.0))
    }
}

/// A face: what of it is closed, open and wet.
#[derive(Clone, Debug)]
struct Side<'a> {
    load: &'a FaceLoad,
    corners: Vec<DVec3>,
    closed: Moments,
    /// The rest of it, but for seams between the parts of a block.
    open: Moments,
}

/// ∫ p and ∫ p r over an area of these moments, N and N m.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Sample {
    over: Moments,
    force: f64,
    first: DVec3,
    /// Mean of the squares of places in one of its cells about the centre of that, m².
    cells: DMat3,
}

impl Sample {
    /// What it shows at the cut: all of it there, with the pressure that its slope has there.
    fn moved(&self, cut: Cut, cell: f64) -> Option<Self> {
        let plane = fit(&[*self], cell)?;
        let area = self.over.area;
        let foot = self.over.first / area;
        let spread = self.over.second * (1.0 / area) - outer(foot, foot);
        let onto = DMat3::IDENTITY - outer(cut.along, cut.along);
        let place = foot + cut.along * cut.along.dot(cut.place - foot);
        let spread = onto * spread * onto;
        let pressure = plane.at(place);
        Some(Self {
            over: Moments {
                area,
                first: area * place,
                second: (spread + outer(place, place)) * area,
            },
            force: area * pressure,
            first: area * (pressure * place + spread * plane.gradient),
            cells: onto * self.cells * onto,
        })
    }
}

/// A line across a face.
#[derive(Clone, Copy, Debug)]
struct Cut {
    place: DVec3,
    along: DVec3,
}

/// p = value + gradient·r, Pa.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Plane {
    value: f64,
    gradient: DVec3,
}

impl Plane {
    fn at(&self, r: DVec3) -> f64 {
        self.value + self.gradient.dot(r)
    }
}

/// The faces of a block with closed joints, and the pressure at the rim of each, r from the centroid of the block.
pub(super) struct Rim<'a> {
    sides: Vec<(Side<'a>, Plane)>,
}

impl<'a> Rim<'a> {
    /// Of the `loads` on all faces of a block at `pose`, beside the parts of others, in cells of so many m and under this
    /// weight of the fluid (N/m³). None of a block without closed joints or with spheres, and of one that sticks out of
    /// the domain.
    pub fn of(
        loads: &'a [FaceLoad],
        shape: &Shape,
        pose: &Pose,
        (others, cell, weight): (&[&Placed], f64, DVec3),
    ) -> Option<Self> {
        let parts = shape.parts();
        let sphere = |part: &Part| matches!(part.form, Form::Sphere { .. });
        if loads.is_empty() || parts.iter().any(sphere) {
            return None;
        }
        let own: Vec<Placed> = parts.iter().map(|part| Placed::of(part, pose)).collect();
        let side = |load: &'a FaceLoad| {
            let part = &parts[load.face.part];
            let own = own.iter().enumerate();
            let rest = own.filter(|(n, _)| *n != load.face.part);
            let rest: Vec<&Placed> = rest.map(|(_, part)| part).collect();
            Side::of(load, part, pose, (others, &rest, cell))
        };
        let sides: Vec<Side<'_>> = loads.iter().filter_map(side).collect();
        let whole = sides.len() == loads.len();
        if !whole || !sides.iter().any(Side::is_closed) {
            return None;
        }
        let centre = pose.centre;
        let closed: Vec<&Side<'_>> = sides.iter().filter(|side| side.is_closed()).collect();
        let plane = |around: &[&Side<'_>], over: &[&Side<'_>]| {
            // Where one joint is asked for, the wet part of its own face ends at its rim.
            let own = |side: &Side<'_>| matches!(over, [one] if std::ptr::eq(*one, side));
            let sample = |side: &&Side<'_>| {
                let sample = side.sample(centre, (weight, cell));
                let cut = side.cut().filter(|_| own(side));
                cut.and_then(|cut| sample.moved(cut, cell))
                    .unwrap_or(sample)
            };
            let samples: Vec<Sample> = around.iter().map(sample).collect();
            let dry = over.iter().flat_map(|side| side.dry_places(centre));
            let plane = limited(fit(&samples, cell)?, &samples, dry);
            Some(Plane {
                gradient: plane.gradient + weight,
                ..plane
            })
        };
        let all = plane(&at_rim(&sides, &closed), &closed)?;
        let own = |side: &Side<'_>| {
            let mut around = wet_beside(&sides, &[side]);
            let cut = side.cut();
            if let Some(cut) = cut {
                around.retain(|beside| {
                    std::ptr::eq(*beside, side) || side.meets_behind(beside, cut, centre)
                });
            }
            let known = around.len() > 1 || cut.is_some() && around.len() == 1;
            known.then(|| plane(&around, &[side])).flatten()
        };
        let planes: Vec<Plane> = sides.iter().map(|side| own(side).unwrap_or(all)).collect();
        Some(Self {
            sides: sides.into_iter().zip(planes).collect(),
        })
    }

    /// Force (N) and torque (N m) on the wet faces and of the pressure of the rim on the dry ones.
    fn push(&self) -> [DVec3; 2] {
        let add = |[force, torque]: [DVec3; 2], (side, plane): &(Side<'_>, Plane)| {
            let dry = side.dry(plane);
            [
                force + side.load.force + dry.force,
                torque + side.load.moment + dry.moment,
            ]
        };
        self.sides.iter().fold([DVec3::ZERO; 2], add)
    }
}

/// What the water in the closed joints of a face does to it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointLoad {
    /// Area without a cell of fluid beside it, m².
    pub area: f64,
    /// N; it has no shear.
    pub force: DVec3,
    /// Moment about the centroid of the block, N m.
    pub moment: DVec3,
}

impl Coupled {
    /// What the water in closed joints does to the faces of a block, in the order of [`Coupled::faces`]; none where
    /// [`Coupled::with_closed_joints`] has none.
    pub fn closed_joints(&self, block: usize) -> Vec<JointLoad> {
        let load = |rim: Rim<'_>| {
            let sides = rim.sides.iter();
            sides.map(|(side, plane)| side.dry(plane)).collect()
        };
        self.rim(block, load).unwrap_or_default()
    }

    /// Force (N) and torque about its centroid (N m) of the fluid on a block with closed joints, buoyancy included:
    /// what its wet faces feel, and in the joints the pressure of their rim, linear between the faces beside it. None
    /// where no probe asks for the loads on faces, before the first exchange, of a block without closed joints or with
    /// spheres, and of one that sticks out of the domain.
    pub fn with_closed_joints(&self, block: usize) -> Option<[DVec3; 2]> {
        let [force, torque] = self.rim(block, |rim| rim.push())?;
        let shape = &self.setup().setup.blocks[block].shape;
        let weight = self.wet.ambient.weight(self.blocks().poses()[block].centre);
        let Felt { buoyancy, .. } = self.felt()[block];
        // As in the load on a block: what the body force on the fluid in its place would be is not among the pressures
        // counted from the hydrostatic one.
        let entrained = weight * shape.volume();
        Some([
            force + entrained + buoyancy.force,
            torque + buoyancy.torque(),
        ])
    }

    /// What follows from the rim of the joints of a block, if it has one.
    fn rim<T>(&self, block: usize, of: impl FnOnce(Rim<'_>) -> T) -> Option<T> {
        let shape = &self.setup().setup.blocks[block].shape;
        let pose = self.blocks().poses()[block];
        let cell = self.immersed().frame().units.cell;
        let weight = self.wet.ambient.weight(pose.centre);
        let others = self.others(block, cell);
        let others: Vec<&Placed> = others.iter().collect();
        let rim = Rim::of(self.faces(block), shape, &pose, (&others, cell, weight));
        rim.map(of)
    }
}

impl<'a> Side<'a> {
    /// None where it sticks out of the domain and is not closed.
    fn of(
        load: &'a FaceLoad,
        part: &Part,
        pose: &Pose,
        (others, own, cell): (&[&Placed], &[&Placed], f64),
    ) -> Option<Self> {
        let Form::Convex(shape) = &part.form else {
            return None;
        };
        let corners = corners(shape, load.face.face, part.offset, pose);
        let whole = Moments::of(&corners, pose.centre);
        let heights = HEIGHTS.map(|height| height * cell);
        let under = |parts: &[&Placed]| {
            let each = parts.iter().map(|other| {
                let (corners, _) = covered(&corners, load.face.normal, other, heights);
                Moments::of(&corners, pose.centre)
            });
            each.fold(Moments::ZERO, |sum, one| sum.plus(&one))
        };
        // Where others lie over each other, or a gap is wet after all.
        let room = (whole.area - load.wetted).max(0.0);
        let seams = under(own).within(room);
        let closed = under(others).within(room - seams.area);
        if load.inside + seams.area + closed.area < (1.0 - ROUGH) * whole.area {
            return None;
        }
        Some(Self {
            load,
            corners,
            open: whole.plus(&closed.plus(&seams).times(-1.0)),
            closed,
        })
    }

    /// Where a line parts its open from its closed side, from the centroid of the block, and the direction in which the closed
    /// one lies; none where one of the two is all or lies around the other.
    fn cut(&self) -> Option<Cut> {
        let whole = self.open.plus(&self.closed);
        if self.open.area < SOME * whole.area || self.closed.area < SOME * whole.area {
            return None;
        }
        let [open, closed] = [&self.open, &self.closed].map(|part| part.first / part.area);
        let along = (closed - open).try_normalize()?;
        let heights = self.corners.iter().map(|x| along.dot(*x));
        let (least, most) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        // Of two parts beside each other the middles are half of both apart.
        let beside = (closed - open).length() > 0.4 * (most - least);
        let place = open.lerp(closed, self.open.area / whole.area);
        beside.then_some(Cut { place, along })
    }

    /// The corners of what is closed of it, from `centre`: of a part that a line cuts off those behind it, and a place on it.
    fn dry_places(&self, centre: DVec3) -> Vec<DVec3> {
        let corners = self.corners.iter().map(|x| x - centre);
        match self.cut() {
            None => corners.collect(),
            Some(Cut { place, along }) => corners
                .filter(|x| along.dot(*x - place) > 0.0)
                .chain([place])
                .collect(),
        }
    }

    fn is_closed(&self) -> bool {
        self.closed.area > SOME * self.load.face.area
    }

    /// Whether two faces have an edge in common.
    fn meets(&self, other: &Self) -> bool {
        let near = 1e-6 * self.load.face.area.sqrt();
        let shared = |x: &&DVec3| other.corners.iter().any(|y| x.distance(*y) < near);
        self.corners.iter().filter(shared).count() >= 2
    }

    /// Whether another face, with which it has an edge in common, has a corner of its closed part.
    fn meets_behind(&self, other: &Self, cut: Cut, centre: DVec3) -> bool {
        let near = 1e-6 * self.load.face.area.sqrt();
        let behind = |x: &&DVec3| cut.along.dot(**x - centre - cut.place) > 0.0;
        let mut corners = self.corners.iter().filter(behind);
        corners.any(|x| other.corners.iter().any(|y| x.distance(*y) < near))
    }

    /// What its wet part shows, r from `centre`, of the pressure less that of the `weight` of the fluid (N/m³), in cells of
    /// `cell` (m).
    fn sample(&self, centre: DVec3, (weight, cell): (DVec3, f64)) -> Sample {
        let load = self.load;
        let normal = load.face.normal;
        let force = -load.force.dot(normal) - load.shifted();
        // Of the forces at the feet of the cells about the mean of these: n × ∫ t × (τ − p n) = −∫ p t, t in the face.
        let couple = load.moment - (load.acts_at() - centre).cross(load.force);
        let foot = load.foot - centre;
        let over = Moments {
            area: load.wetted,
            first: load.wetted * foot,
            second: (load.spread + outer(foot, foot)) * load.wetted,
        };
        let first = force * foot - normal.cross(couple);
        Sample {
            over,
            force: force - weight.dot(over.first),
            first: first - over.second * weight,
            cells: (DMat3::IDENTITY - outer(normal, normal)) * (cell * cell / 12.0),
        }
    }

    /// What a pressure does to what of it is dry.
    fn dry(&self, pressure: &Plane) -> JointLoad {
        let share = 1.0 - self.load.wetted / self.open.area.max(f64::MIN_POSITIVE);
        let over = self.closed.plus(&self.open.times(share.max(0.0)));
        let normal = self.load.face.normal;
        let force = pressure.value * over.area + pressure.gradient.dot(over.first);
        let first = pressure.value * over.first + over.second * pressure.gradient;
        JointLoad {
            area: over.area,
            force: -force * normal,
            moment: normal.cross(first),
        }
    }
}

/// The wet ones of `sides` that have an edge in common with one of `closed`, or are it.
fn wet_beside<'a>(sides: &'a [Side<'a>], closed: &[&Side<'_>]) -> Vec<&'a Side<'a>> {
    let wet = |side: &&Side<'_>| side.load.wetted > SOME * side.load.face.area;
    let beside = |side: &&Side<'_>| {
        let mut closed = closed.iter();
        closed.any(|closed| std::ptr::eq(*closed, *side) || closed.meets(side))
    };
    sides.iter().filter(wet).filter(beside).collect()
}

/// The wet faces at the rims of closed joints, or all where these have none.
fn at_rim<'a>(sides: &'a [Side<'a>], closed: &[&Side<'_>]) -> Vec<&'a Side<'a>> {
    let beside = wet_beside(sides, closed);
    match beside.is_empty() {
        true => wet_beside(sides, &sides.iter().collect::<Vec<_>>()),
        false => beside,
    }
}

/// The plane of least squares through pressures in cells of `cell` m; level along directions along which there is but one
/// place. None without any.
fn fit(samples: &[Sample], cell: f64) -> Option<Plane> {
    let mut sum = Sample {
        over: Moments::ZERO,
        force: 0.0,
        first: DVec3::ZERO,
        cells: DMat3::ZERO,
    };
    for sample in samples {
        sum.over = sum.over.plus(&sample.over);
        sum.force += sample.force;
        sum.first += sample.first;
    }
    if sum.over.area <= 0.0 {
        return None;
    }
    let middle = sum.over.first / sum.over.area;
    let spread = sum.over.second - outer(middle, middle) * sum.over.area;
    let flat = DMat3::IDENTITY * (FLAT * cell * cell * sum.over.area);
    let gradient = (spread + flat).inverse() * (sum.first - sum.force * middle);
    Some(Plane {
        value: sum.force / sum.over.area - gradient.dot(middle),
        gradient,
    })
}

/// A plane made less steep about the middle of the samples where at some of `places` it would be beyond what it is at the
/// edges of these, and what it is there at least and at most: what is far from all of them is not known from slopes
/// between neighbouring cells.
fn limited(plane: Plane, samples: &[Sample], places: impl Iterator<Item = DVec3>) -> Plane {
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    let (mut middle, mut area) = (DVec3::ZERO, 0.0);
    for Sample { over, cells, .. } in samples {
        let foot = over.first / over.area;
        let spread = over.second * (1.0 / over.area) - outer(foot, foot);
        let spread = spread + *cells;
        // From the middle of a rectangle to its edges, along the gradient.
        let reach = (3.0 * plane.gradient.dot(spread * plane.gradient)).max(0.0);
        least = least.min(plane.at(foot) - reach.sqrt());
        most = most.max(plane.at(foot) + reach.sqrt());
        middle += over.first;
        area += over.area;
    }
    let middle = middle / area;
    let mean = plane.at(middle);
    let share = places.fold(1.0_f64, |share, r| {
        let more = plane.at(r) - mean;
        let room = if more > 0.0 {
            most - mean
        } else {
            mean - least
        };
        share.min(room.max(0.0) / more.abs().max(f64::MIN_POSITIVE))
    });
    let gradient = share * plane.gradient;
    Plane {
        value: mean - gradient.dot(middle),
        gradient,
    }
}
