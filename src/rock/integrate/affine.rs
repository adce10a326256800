//! A block that deforms as a whole (Shi 2001; Mikola & Sitar 2014, eqs. 1 and 7): every point X of it, from
//! its centroid, is at x = c + F X.
//!
//! m c̈ = Σ f + m g,  F̈ = (Σ f ⊗ X − V P) S⁻¹,  S = ∫ρ X Xᵀ dV,  P = F (λ tr E · 1 + 2μE + σ₀),
//! E = ½(FᵀF − 1).
//!
//! These are the twelve unknowns of DDA, with a mass matrix that is 4 × 4 and the same for each axis. The
//! strain is exact under rotation. F P ᵀ is symmetric, so that the central difference keeps the angular
//! momentum Ḟ S Fᵀ − F S Ḟᵀ up to rounding.
//!
//! Points of an affine body that are held in their places, along some axes or all.
//!
//! c + F X stays: linear in the unknowns and the same in each step, so that a projection of the accelerations
//! keeps it exactly, with no spring that would limit the step. Each axis of the world has a row
//! q = (c_k, F_k1, F_k2, F_k3) of its own with the mass matrix M = diag(m, S), and each point held along it
//! a condition b·q = const., b = (1, X).

use super::Principal;
use crate::{
    geometry::{axial, inner},
    rock::law::{Elastic, trace},
};
use glam::{DMat3, DQuat, DVec3};

/// Mass, elasticity and shape of an affine body: what stays of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Affine {
    /// kg.
    mass: f64,
    /// m³.
    volume: f64,
    elastic: Elastic,
    /// σ₀, own frame, Pa.
    initial_stress: DMat3,
    /// S, kg m².
    second_moment: DMat3,
    /// S⁻¹.
    inverse: DMat3,
    /// Smallest eigenvalue of S, kg m².
    smallest_moment: f64,
    /// ω² of its stiffest mode without strain, rad²/s².
    stiffest: f64,
}

/// Forces on an affine body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrench {
    /// Σ f, N.
    pub force: DVec3,
    /// Σ f ⊗ r, r from the centroid in the world, N m.
    pub moment: DMat3,
}

impl Affine {
    /// A body of `volume` (m³) and `density` (kg/m³), `inertia` its inertia tensor about the centroid for a
    /// density of one (m⁵), `initial_stress` σ₀ (Pa, symmetric, own frame) what it bears without strain.
    pub fn new(
        volume: f64,
        inertia: DMat3,
        density: f64,
        elastic: Elastic,
        initial_stress: DMat3,
    ) -> Self {
        // I = tr C · 1 − C, and tr I = 2 tr C.
        let second_moment = (DMat3::IDENTITY * (0.5 * trace(inertia)) - inertia) * density;
        let moments = Principal::of(second_moment).moments;
        Self {
            mass: density * volume,
            volume,
            elastic,
            initial_stress,
            second_moment,
            inverse: second_moment.inverse(),
            smallest_moment: moments.min_element(),
            stiffest: volume * stiffest(&elastic, moments),
        }
    }

    /// E of the deformation `f`.
    pub fn strain(&self, f: DMat3) -> DMat3 {
        (f.transpose() * f - DMat3::IDENTITY) * 0.5
    }

    /// Second Piola–Kirchhoff stress, own frame, Pa.
    fn inner_stress(&self, f: DMat3) -> DMat3 {
        self.elastic.stress(self.strain(f)) + self.initial_stress
    }

    /// Cauchy stress F S Fᵀ/det F, along the axes of the world, Pa; tension is positive.
    pub fn stress(&self, f: DMat3) -> DMat3 {
        f * self.inner_stress(f) * f.transpose() * f.determinant().recip()
    }

    /// Strain energy, J: ½E:C:E + σ₀:E over the volume.
    pub fn strain_energy(&self, f: DMat3) -> f64 {
        let strain = self.strain(f);
        self.volume * (self.elastic.energy(strain) + inner(self.initial_stress, strain))
    }

    /// Kinetic energy of the motion about the centroid, ½ tr Ḟ S Ḟᵀ, J.
    pub fn kinetic(&self, rate: DMat3) -> f64 {
        0.5 * inner(rate, rate * self.second_moment)
    }

    /// Angular momentum about the centroid, ∫ρ F X × Ḟ X dV, kg m²/s.
    pub fn angular_momentum(&self, f: DMat3, rate: DMat3) -> DVec3 {
        axial(rate * self.second_moment * f.transpose())
    }

    /// Accelerations c̈ (m/s²) and F̈ (1/s²) under `wrench` and its own stress.
    pub fn accelerations(&self, f: DMat3, wrench: &Wrench) -> (DVec3, DMat3) {
        // f ⊗ X with X = F⁻¹ r.
        let outer = wrench.moment * f.inverse().transpose();
        let stress = f * self.inner_stress(f) * self.volume;
        (wrench.force / self.mass, (outer - stress) * self.inverse)
    }

    /// Bound of ω² of its stiffest mode when deformed by `f`, rad²/s²; exact without strain.
    ///
    /// The stress follows FᵀδF, no longer than |F|² ≤ 1 + 2|E| of δF; what stress there is turns with δF
    /// and adds V|S| over the smallest second moment.
    pub fn frequency_squared(&self, f: DMat3) -> f64 {
        let strain = self.strain(f);
        let stress = self.inner_stress(f);
        let norm = |a: DMat3| inner(a, a).sqrt();
        self.stiffest * (1.0 + 2.0 * norm(strain))
            + self.volume * norm(stress) / self.smallest_moment
    }

    /// The longest step with which the central difference is stable without contacts and strain, 2/ω, s
    /// (Mikola & Sitar 2014, eq. 8).
    pub fn critical_step(&self) -> f64 {
        2.0 / self.frequency_squared(DMat3::IDENTITY).sqrt()
    }

    /// Smallest eigenvalue of S, kg m².
    pub fn smallest_moment(&self) -> f64 {
        self.smallest_moment
    }

    /// The arm (m) at which a spring would have, against the smallest moment, the frequency that it has at
    /// the point `x` (m, own frame): its square over that moment is xᵀ S⁻¹ x.
    pub fn lever(&self, x: DVec3) -> f64 {
        (self.smallest_moment * x.dot(self.inverse * x)).sqrt()
    }

    /// M⁻¹ b of a row (c, F) of the unknowns: b₀/m and S⁻¹ b.
    fn over_mass(&self, (centre, row): (f64, DVec3)) -> (f64, DVec3) {
        (centre / self.mass, self.inverse * row)
    }
}

/// ω² of the stiffest elastic mode per volume, with S diag(s) in its principal axes, in which an isotropic
/// body has the same law. The nine-by-nine problem K v = ω² M v of F falls apart there: a shear and a
/// rotation with ω² = μ(1/s_i + 1/s_j) and 0 for each pair of axes, and the three axial strains with
/// (λ + 2μ δ_ij)/√(s_i s_j).
fn stiffest(elastic: &Elastic, s: DVec3) -> f64 {
    let [lambda, mu] = elastic.lame();
    let entry = |i: usize, j: usize| {
        let own = if i == j { 2.0 * mu } else { 0.0 };
        (lambda + own) / (s[i] * s[j]).sqrt()
    };
    let column = |j| DVec3::new(entry(0, j), entry(1, j), entry(2, j));
    let axial = DMat3::from_cols(column(0), column(1), column(2));
    let shear = |i: usize, j: usize| mu * (s[i].recip() + s[j].recip());
    let shears = DVec3::new(shear(0, 1), shear(1, 2), shear(2, 0));
    let modes = Principal::of(axial).moments;
    modes.max(shears).max_element()
}

/// Most passes of [`polar`]: each doubles the digits, from a few passes on.
const PASSES: usize = 60;

/// The rotation R of F = R U, by Newton's iteration X ← ½(X + X⁻ᵀ) (Higham 1986); F must not be turned
/// inside out.
pub fn polar(f: DMat3) -> DQuat {
    let mut x = f;
    for _ in 0..PASSES {
        let next = (x + x.inverse().transpose()) * 0.5;
        let change = next - x;
        x = next;
        if inner(change, change) < 1e-30 {
            break;
        }
    }
    DQuat::from_mat3(&x).normalize()
}

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
