//! Points of an affine body that are held in their places, along some axes or all.
//!
//! c + F X stays: linear in the unknowns and the same in each step, so that a projection of the accelerations
//! keeps it exactly, with no spring that would limit the step. Each axis of the world has a row
//! q = (c_k, F_k1, F_k2, F_k3) of its own with the mass matrix M = diag(m, S), and each point held along it
//! a condition b·q̈ = 0, b = (1, X).

use super::Affine;
use glam::{DMat3, DVec3};

/// A row of unknowns, or a condition on them.
type Row = (f64, DVec3);

/// Share of a condition that must be new for it to count: what is left of one that follows from the others is
/// rounding, 1e-16 of it and some.
const NEW: f64 = 1e-9;

/// The conditions along the three axes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Held {
    /// β with β_i M⁻¹ β_j = δ_ij, each with M⁻¹β; at most four an axis.
    rows: [Vec<[Row; 2]>; 3],
}

impl Held {
    /// Holds points X of `body` (m from the centroid, own frame), each along the axes of the world that are
    /// set. Those that follow from others change nothing.
    pub fn new(body: &Affine, points: impl IntoIterator<Item = (DVec3, [bool; 3])>) -> Self {
        let mut held = Self::default();
        for (point, axes) in points {
            for (axis, _) in axes.iter().enumerate().filter(|(_, set)| **set) {
                held.add(body, axis, (1.0, point));
            }
        }
        held
    }

    fn add(&mut self, body: &Affine, axis: usize, condition: Row) {
        let whole = dot(condition, body.over_mass(condition)).sqrt();
        let mut left = condition;
        // Twice: what rounding leaves of a direction after the first time goes in the second.
        for _ in 0..2 {
            for [known, moved] in &self.rows[axis] {
                left = less(left, dot(left, *moved), *known);
            }
        }
        let length = dot(left, body.over_mass(left)).sqrt();
        if length > NEW * whole {
            let unit = (left.0 / length, left.1 / length);
            self.rows[axis].push([unit, body.over_mass(unit)]);
        }
    }

    /// Whether nothing is held.
    pub fn is_empty(&self) -> bool {
        self.rows.iter().all(Vec::is_empty)
    }

    /// What the held points leave of accelerations c̈ and F̈; the same for velocities.
    pub fn project(&self, (centre, deformation): (DVec3, DMat3)) -> (DVec3, DMat3) {
        if self.is_empty() {
            return (centre, deformation);
        }
        let (mut centre, mut rows) = (centre, deformation.transpose());
        for (axis, conditions) in self.rows.iter().enumerate() {
            for [condition, moved] in conditions {
                let row = (centre[axis], rows.col(axis));
                let (c, f) = less(row, dot(*condition, row), *moved);
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
