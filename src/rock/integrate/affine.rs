//! A block with a homogeneous deformation (Shi 2001; Mikola & Sitar 2014, eqs. 1 and 7): a material point X,
//! relative to the centroid, is at x = c + F X.
//!
//! m c̈ = Σ f + m g,  F̈ = (Σ f ⊗ X − V P) S⁻¹,  S = ∫ρ X Xᵀ dV,  P = F (λ tr E · 1 + 2μE + σ₀),
//! E = ½(FᵀF − 1).
//!
//! These are the twelve unknowns of DDA, with a 4 × 4 mass matrix that is the same for each axis. The strain
//! is exact under rotation. F P ᵀ is symmetric, so that the central difference conserves the angular
//! momentum Ḟ S Fᵀ − F S Ḟᵀ up to rounding.
//!
//! Points of an affine body may be fixed along some or all axes.
//!
//! A fixed point has a constant c + F X. This condition is linear in the unknowns and the same in each step, so that a
//! projection of the accelerations satisfies it exactly, without a spring that would limit the step. Each world axis has
//! its own row q = (c_k, F_k1, F_k2, F_k3) of unknowns with the mass matrix M = diag(m, S), and each point fixed along it
//! adds a condition b·q = const., b = (1, X).

use super::Principal;
use crate::{
    geometry::{axial, inner},
    rock::law::{Elastic, trace},
};
use glam::{DMat3, DQuat, DVec3};

/// Constants of an affine body: mass, elasticity and shape.
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
    /// Σ f ⊗ r, r from the centroid in world axes, N m.
    pub moment: DMat3,
}

impl Affine {
    /// A body of `volume` (m³) and `density` (kg/m³). `inertia`: inertia tensor about the centroid for a density
    /// of one (m⁵). `initial_stress`: stress σ₀ at zero strain (Pa, symmetric, own frame).
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

    /// Strain E of the deformation `f`.
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

    /// Accelerations c̈ (m/s²) and F̈ (1/s²) under `wrench` and the stress of the body.
    pub fn accelerations(&self, f: DMat3, wrench: &Wrench) -> (DVec3, DMat3) {
        // f ⊗ X with X = F⁻¹ r.
        let outer = wrench.moment * f.inverse().transpose();
        let stress = f * self.inner_stress(f) * self.volume;
        (wrench.force / self.mass, (outer - stress) * self.inverse)
    }

    /// Stress in the body per second of retardation at the deformation rate `rate`, F C:Ė, with Ė = ½(ḞᵀF + FᵀḞ): a Kelvin–Voigt
    /// body with the retardation time β has the stress F (C:(E + βĖ) + σ₀), which does not damp rotations.
    fn retarded_stress(&self, f: DMat3, rate: DMat3) -> DMat3 {
        let half = f.transpose() * rate * 0.5;
        f * self.elastic.stress(half + half.transpose())
    }

    /// F̈ by the viscous stress, per second of retardation, 1/s³.
    pub fn retarding(&self, f: DMat3, rate: DMat3) -> DMat3 {
        self.retarded_stress(f, rate) * -self.volume * self.inverse
    }

    /// Power that the viscous stress dissipates, per second of retardation, W/s.
    pub fn retarded_power(&self, f: DMat3, rate: DMat3) -> f64 {
        self.volume * inner(self.retarded_stress(f, rate), rate)
    }

    /// Retardation time of strains under a load that is constant over `interval` (s), s: zero for an interval of zero, and critical
    /// damping of the stiffest mode once it is not resolved, ω `interval` > 2.
    pub fn retardation(&self, interval: f64) -> f64 {
        let omega = self.stiffest.sqrt();
        let turned = 0.5 * omega * interval;
        2.0 / omega * turned.powi(2).min(1.0)
    }

    /// Upper bound of ω² of the stiffest mode at the deformation `f`, rad²/s²; exact without strain.
    ///
    /// The change of stress depends on FᵀδF, whose square is at most |F|² ≤ 1 + 2|E| times that of δF. The present
    /// stress rotates with δF and adds V|S| over the smallest second moment.
    pub fn frequency_squared(&self, f: DMat3) -> f64 {
        let strain = self.strain(f);
        let stress = self.inner_stress(f);
        let norm = |a: DMat3| inner(a, a).sqrt();
        self.stiffest * (1.0 + 2.0 * norm(strain))
            + self.volume * norm(stress) / self.smallest_moment
    }

    /// Longest step for which the central difference is stable without contacts and strain, 2/ω, s
    /// (Mikola & Sitar 2014, eq. 8).
    pub fn critical_step(&self) -> f64 {
        2.0 / self.frequency_squared(DMat3::IDENTITY).sqrt()
    }

    /// Smallest eigenvalue of S, kg m².
    pub fn smallest_moment(&self) -> f64 {
        self.smallest_moment
    }

    /// Equivalent lever arm (m) of a spring at the point `x` (m, own frame): with it and the smallest moment, the spring
    /// has the same frequency. Its square over that moment is xᵀ S⁻¹ x.
    pub fn lever(&self, x: DVec3) -> f64 {
        (self.smallest_moment * x.dot(self.inverse * x)).sqrt()
    }

    /// M⁻¹ b of a row (c, F) of the unknowns: b₀/m and S⁻¹ b.
    fn over_mass(&self, (centre, row): (f64, DVec3)) -> (f64, DVec3) {
        (centre / self.mass, self.inverse * row)
    }
}

/// ω² of the stiffest elastic mode per volume, with S = diag(s) in its principal axes, in which an isotropic
/// body has the same law. The nine-by-nine problem K v = ω² M v of F decouples there: a shear and a
/// rotation with ω² = μ(1/s_i + 1/s_j) and 0 for each pair of axes, and the three axial strains with the matrix
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

/// Largest number of iterations of [`polar`]; after the first few, each doubles the number of correct digits.
const PASSES: usize = 60;

/// Rotation R of the polar decomposition F = R U, by Newton's iteration X ← ½(X + X⁻ᵀ) (Higham 1986). det F must be
/// positive.
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

/// A row of unknowns, or the coefficients of a condition on them.
type Row = (f64, DVec3);

/// Share of a condition that must be independent of the others for it to count. A redundant condition leaves only
/// rounding, a little more than 1e-16 of it.
const NEW: f64 = 1e-9;

/// A condition β·q = value.
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
    /// Fixes points X of `body` (m from the centroid, own frame) at their positions for `centre` (m) and
    /// `deformation`, each along the world axes that are set. Redundant conditions are dropped.
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

    /// The part of a condition that is independent of the known ones, on an axis whose present row is `now`; `None` if
    /// the condition is redundant.
    fn next(&self, body: &Affine, axis: usize, given: Row, now: Row) -> Option<Condition> {
        let whole = dot(given, body.over_mass(given)).sqrt();
        let mut left = given;
        // Twice: the second pass removes what rounding leaves after the first.
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

    /// Whether no point is fixed.
    pub fn is_empty(&self) -> bool {
        self.conditions.iter().all(Vec::is_empty)
    }

    /// Projects accelerations c̈ and F̈, or velocities, onto the motions that the fixed points allow.
    pub fn project(&self, rates: (DVec3, DMat3)) -> (DVec3, DMat3) {
        self.corrected(rates, |_| 0.0)
    }

    /// Moves the fixed points back to their positions, which rounding has changed.
    pub fn place(&self, place: (DVec3, DMat3)) -> (DVec3, DMat3) {
        self.corrected(place, |condition| condition.value)
    }

    /// The unknowns nearest to the given ones, in the norm of M, for which each condition has the value of `wanted`.
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
