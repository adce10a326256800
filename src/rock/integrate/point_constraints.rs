//! Points of an affine body that are held in their places, along some axes or all.
//!
//! c + F X stays: linear in the unknowns and the same in each step, so that a projection of the accelerations
//! keeps it exactly, with no spring that would limit the step. Each axis of the world has a row
//! q = (c_k, F_k1, F_k2, F_k3) of its own with the mass matrix M = diag(m, S), and each point held along it
//! a condition b·q = const., b = (1, X).

use super::Affine;
use glam::{DMat3, DVec3};

/// A row of unknowns, or what a condition multiplies them by.
type Row = (f64, DVec3);

/// Share of a condition that must be new for it to count: what is left of one that follows from the others is
/// rounding, 1e-16 of it and some.
const NEW: f64 = 1e-9;

/// β·q = value.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Condition {
    /// β, with β_i M⁻¹ β_j = δ_ij.
    factors: Row,
    /// M⁻¹β.
    moved: Row,
    value: f64,
}

/// The conditions along the three axes, at most four each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointConstraints {
    conditions: [Vec<Condition>; 3],
}

impl PointConstraints {
    /// Holds points X of `body` (m from the centroid, own frame) where they are at `centre` (m) and
    /// `deformation`, each along the axes of the world that are set. Those that follow from others change
    /// nothing.
    pub fn new(
        body: &Affine,
        (centre, deformation): (DVec3, DMat3),
        points: impl IntoIterator<Item = (DVec3, [bool; 3])>,
    ) -> Self {
        let mut constraints = Self::default();
        for (point, axes) in points {
            for (axis, _) in axes.iter().enumerate().filter(|(_, set)| **set) {
                let now = (centre[axis], deformation.row(axis));
                constraints.conditions[axis].extend(constraints.next(
                    body,
                    axis,
                    (1.0, point),
                    now,
                ));
            }
        }
        constraints
    }

    /// What is new in a condition on an axis whose row is `now`.
    fn next(&self, body: &Affine, axis: usize, given: Row, now: Row) -> Option<Condition> {
        let whole = dot(given, body.over_mass(given)).sqrt();
        let mut left = given;
        // Twice: what rounding leaves of a direction after the first time goes in the second.
        for _ in 0..2 {
            for known in &self.conditions[axis] {
                left = less(left, dot(left, known.moved), known.factors);
            }
        }
        let length = dot(left, body.over_mass(left)).sqrt();
        let factors = (left.0 / length, left.1 / length);
        (length > NEW * whole).then(|| Condition {
            factors,
            moved: body.over_mass(factors),
            value: dot(factors, now),
        })
    }

    /// Whether nothing is held.
    pub fn is_empty(&self) -> bool {
        self.conditions.iter().all(Vec::is_empty)
    }

    /// What the held points leave of accelerations c̈ and F̈; the same for velocities.
    pub fn project(&self, rates: (DVec3, DMat3)) -> (DVec3, DMat3) {
        self.corrected(rates, |_| 0.0)
    }

    /// Puts the held points back where rounding has moved them from.
    pub fn place(&self, place: (DVec3, DMat3)) -> (DVec3, DMat3) {
        self.corrected(place, |condition| condition.value)
    }

    /// The unknowns nearest to those given, by M, for which each condition has the value that `wanted` says.
    fn corrected(
        &self,
        (centre, deformation): (DVec3, DMat3),
        wanted: impl Fn(&Condition) -> f64,
    ) -> (DVec3, DMat3) {
        if self.is_empty() {
            return (centre, deformation);
        }
        let (mut centre, mut rows) = (centre, deformation.transpose());
        for (axis, conditions) in self.conditions.iter().enumerate() {
            for condition in conditions {
                let row = (centre[axis], rows.col(axis));
                let off = dot(condition.factors, row) - wanted(condition);
                let (c, f) = less(row, off, condition.moved);
                centre[axis] = c;
                *rows.col_mut(axis) = f;
            }
        }
        (centre, rows.transpose())
    }
}

fn dot(a: Row, b: Row) -> f64 {
    a.0 * b.0 + a.1.dot(b.1)
}

/// a − s b.
fn less(a: Row, s: f64, b: Row) -> Row {
    (a.0 - s * b.0, a.1 - b.1 * s)
}
