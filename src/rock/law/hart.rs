//! Hart, Cundall & Lemos 1988 (Int. J. Rock Mech. Min. Sci. 25:117–125): springs over the contact
//! area, Coulomb friction, dashpots.
//!
//! f_n = k_n A u_n, f_s ← f_s − k_s A Δu_s, |f_s| ≤ F = cA + f_n tan φ, c_n = 2ζ√(m* k_n A).
//!
//! The springs act at the pressure centre, the point of action of the resultant pressure over the face. Shear over the face also
//! resists a twist about the normal: T ← T − k_s A ρ² Δθ, where ρ² = tr S, and S = ∫ x xᵀ dA/A about the centroid of the section.
//! Sliding and twist share the friction: (|f_s|/F)² + (|T|/T_max)ⁿ ≤ 1. T_max = d F is the moment of friction under uniform pressure,
//! and d the mean distance of the points of the section from its middle: that of the rectangle with the same area and ρ, a quarter of
//! the length of an edge on which a block stands. n = 1 + 0.7 (s + s²), s = e·S e/ρ² with the direction e of f_s, agrees with the
//! limit surfaces of rectangles of any sides under uniform pressure (Howe & Cutkosky 1996, Int. J. Robot. Res. 15:557, who have
//! n = 2) within 3 % of the load.
//!
//! The dashpots are distributed over the face like the springs: 3DEC has them in every sub-contact. At a single point they
//! would not damp rocking, since the pressure centre of a rocking block moves with the angle:
//! the damping would be of second order in it, and a stack would never come to rest. Their moments
//! are c_n n × S (n × ω) for rocking and c_s ρ² for twist. If two bodies touch with several parts, these share the damping: each
//! has the share k_n A/Σ k_n A of the mass m*. A sphere touches at a point: nothing resists its twist. It rolls on its contact
//! instead of rocking: the contact moves with it, the springs dissipate nothing, and no dashpot resists the rolling.
//!
//! A bond is a contact whose springs also carry tension: it keeps its initial area, and bends over it as an elastic
//! bed. It breaks permanently if its tension reaches σ_t at a corner, or if it has slipped by σ_t/k_s, the distance by
//! which it opens before it breaks. A broken bond is a contact without tension.
//!
//! The longest stable step follows from an upper bound of the highest frequency (Hart, Cundall & Lemos 1988).
//!
//! ω² = max over the blocks of 2·max(Σ(k_n + k_s) A/m, Σ(k_n + k_s) A (|r|² + w²/4)/I_min), r from the
//! block's centroid to the contact, w the width of its section; Δt ≤ share · 2/ω.

use crate::{Error, Result};
use glam::{DMat3, DQuat, DVec3};

/// History of a contact from step to step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct History {
    /// Shear force of the spring on the second block, N, in the first block's frame.
    pub shear: DVec3,
    /// Normal when `shear` was stored, in the first block's frame.
    pub normal: DVec3,
    /// Moment T of the shear springs on the second block about the normal, N m.
    pub torsion: f64,
    /// Whether the bond is intact.
    pub bonded: bool,
    /// Slip of a bond, m.
    pub slip: f64,
}

/// Geometry of the overlap of two blocks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// Unit normal from the first to the second block.
    pub normal: DVec3,
    /// u_n, m; negative if a bond is open.
    pub overlap: f64,
    /// A, m².
    pub area: f64,
    /// Area of springs and dashpots, m²: A, or more if A is the area of a corner.
    pub elastic_area: f64,
    /// S = ∫ x xᵀ dA/A about the centroid of the section, m².
    pub spread: DMat3,
    /// Whether one of the two parts is a sphere, which rolls.
    pub rolls: bool,
    /// Opening of a bond at its widest corner less the opening at its middle, m: 0 without bending.
    pub opening: f64,
}

/// Motion of the second block relative to the first at their contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Displacement of the pressure centre in this step, m.
    pub displacement: DVec3,
    /// Velocity of the pressure centre, m/s.
    pub velocity: DVec3,
    /// Spin, rad/s.
    pub spin: DVec3,
    /// Rotation of the first block.
    pub frame: DQuat,
    /// Time step, s.
    pub time_step: f64,
    /// Reduced mass m*, kg: m₁m₂/(m₁ + m₂), or the mass of the only free block; if there are several contacts, the share of this
    /// one.
    pub mass: f64,
}

impl Motion {
    /// The motion for a contact with this share in the stiffness of all contacts of its bodies: c = 2ζ√(share m* k).
    pub fn damped_by(self, share: f64) -> Self {
        Self {
            mass: self.mass * share,
            ..self
        }
    }
}

/// Action of a contact on the second block; the first gets the opposite.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "checkpoint", derive(serde::Serialize, serde::Deserialize))]
pub struct Force {
    /// Force of the springs, N.
    pub spring: DVec3,
    /// Force of the dashpots, N.
    pub dashpot: DVec3,
    /// Moment of the dashpots about the pressure centre, N m.
    pub moment: DVec3,
    /// Moment of the shear springs about the normal, N m.
    pub torsion: DVec3,
    /// Moment of the springs of a bond about the middle of its area, N m.
    pub bending: DVec3,
    /// Work dissipated by friction in this step, J.
    pub friction: f64,
    /// State at the start of the next step.
    pub history: History,
}

impl Force {
    /// Force of springs and dashpots, N.
    pub fn total(&self) -> DVec3 {
        self.spring + self.dashpot
    }

    /// Moment of springs and dashpots, N m.
    pub fn couple(&self) -> DVec3 {
        self.moment + self.torsion + self.bending
    }
}

/// The force of a contact after a step.
pub fn force(joint: &Joint, section: &Section, motion: &Motion, history: &History) -> Force {
    let Section {
        normal,
        overlap,
        area,
        elastic_area,
        spread,
        rolls,
        opening,
    } = *section;
    let normal_stiffness = joint.normal_stiffness * elastic_area;
    let shear_stiffness = joint.shear_stiffness * elastic_area;
    let tan_phi = joint.friction_angle.tan();

    let pressing = normal_stiffness * overlap;
    let opening_rate = motion.velocity.dot(normal);
    let mut bonded = history.bonded;
    let pulled = pressing - dashpot(joint.damping, motion.mass, normal_stiffness) * opening_rate;
    // A bond breaks at its largest tension: under bending, before the mean reaches σ_t.
    let least = if bonded {
        normal_stiffness * opening - joint.tensile_strength * area
    } else {
        0.0
    };
    bonded &= pulled >= least;
    let pressed = pulled.max(least);

    // The friction limit uses the total normal force, which presses the faces together.
    let strength = joint.cohesion * area + pressed.max(0.0) * tan_phi;
    let tangential = motion.displacement - normal * motion.displacement.dot(normal);
    let twist = motion.spin.dot(normal);
    // The overlap of a sphere is far wider than its contact, which is a point.
    let polar = match rolls && !bonded {
        true => 0.0,
        false => spread.x_axis.x + spread.y_axis.y + spread.z_axis.z,
    };
    let torsional_stiffness = shear_stiffness * polar;
    let arm = mean_arm(area, polar);
    let limit = Limit {
        force: strength,
        torsion: arm * strength,
        spread,
        polar,
    };
    let stored = Friction {
        force: turned(history, normal, motion),
        torsion: history.torsion,
    };
    let added = Friction {
        force: -shear_stiffness * tangential,
        torsion: -torsional_stiffness * twist * motion.time_step,
    };
    let trial = stored.plus(added);
    // If the face shrinks, what exceeds one limit does not reduce the other part.
    let held = stored.each_within(&limit).plus(added).within(&limit);
    // Slip is the part of the displacement that the spring does not take; the force is the mean over the slip.
    let slip = (trial.force - held.force) / shear_stiffness;
    let turned_by = match torsional_stiffness {
        0.0 => 0.0,
        stiffness => (trial.torsion - held.torsion) / stiffness,
    };
    let friction = slip.dot(held.force) + turned_by * held.torsion;
    let slip = history.slip + slip.length().hypot(arm * turned_by);
    bonded &= slip * joint.shear_stiffness <= joint.tensile_strength;

    let sliding = motion.velocity - normal * opening_rate;
    let mass = motion.mass;
    let viscosity = dashpot(joint.damping, mass, shear_stiffness);
    let damping = Friction {
        force: -viscosity * sliding,
        torsion: -viscosity * polar * twist,
    };
    let damped = held.plus(damping).within(&limit);

    let rocking = match rolls {
        true => DVec3::ZERO,
        false => motion.spin - normal * twist,
    };
    let lever = spread * normal.cross(rocking);
    let rock = dashpot(joint.damping, mass, normal_stiffness) * lever.cross(normal);
    // Pressure cannot pull: the resultant stays in the face, within half the side of a rectangle, √(3 l·S l), l across the axis.
    let across = normal.cross(rock).normalize_or_zero();
    let reach = (3.0 * across.dot(spread * across)).max(0.0).sqrt();
    let grip = if bonded {
        pressed - least
    } else {
        pressed.max(0.0)
    };
    let moment = normal * (damped.torsion - held.torsion) - capped(rock, reach * grip);

    let inward = motion.frame.conjugate();
    Force {
        spring: normal * pressing + held.force,
        dashpot: normal * (pressed - pressing) + (damped.force - held.force),
        moment,
        torsion: normal * held.torsion,
        bending: DVec3::ZERO,
        friction,
        history: History {
            shear: inward * held.force,
            normal: inward * normal,
            torsion: held.torsion,
            bonded,
            slip: if bonded { slip } else { 0.0 },
        },
    }
}

/// Mean distance, m, of the points of a rectangle from its middle: the arm of friction against a twist. `area`, m², and
/// `polar`, ρ² in m², determine its sides; a rounder section than a square has the ratio of the square.
fn mean_arm(area: f64, polar: f64) -> f64 {
    // (a + b)² and (a − b)² of the sides a and b: a b = A, a² + b² = 12 ρ².
    let squares = 12.0 * polar;
    let [sum, difference] = [2.0, -2.0].map(|n| (squares + n * area).max(0.0).sqrt());
    let long = 0.25 * (sum + difference);
    let short = (0.25 * area / long).min(long);
    if short <= 1e-6 * long {
        return 0.5 * long;
    }
    let diagonal = long.hypot(short);
    let of_side = |a: f64, b: f64| a * a / b * (b / a).asinh();
    let mean = diagonal / 3.0 + (of_side(long, short) + of_side(short, long)) / 6.0;
    mean * (3.0 * polar).sqrt() / diagonal
}

/// Friction of a face: a force along it, N, and a moment about its normal, N m.
#[derive(Clone, Copy, Default)]
struct Friction {
    force: DVec3,
    torsion: f64,
}

/// Limits of friction over a section: of a force alone, N, and of a moment alone, N m, with its S and ρ², m².
struct Limit {
    force: f64,
    torsion: f64,
    spread: DMat3,
    polar: f64,
}

impl Friction {
    fn plus(self, other: Self) -> Self {
        Self {
            force: self.force + other.force,
            torsion: self.torsion + other.torsion,
        }
    }

    /// Force and moment, each within its own limit.
    fn each_within(self, limit: &Limit) -> Self {
        Self {
            force: capped(self.force, limit.force),
            torsion: self.torsion.min(limit.torsion).max(-limit.torsion),
        }
    }

    /// The friction in the same proportion within the limit.
    fn within(self, limit: &Limit) -> Self {
        let relative = |part: f64, most: f64| if part == 0.0 { 0.0 } else { part / most };
        let length = self.force.length();
        let force = relative(length, limit.force);
        let torsion = relative(self.torsion.abs(), limit.torsion);
        // n is at least 1.
        if force * force + torsion <= 1.0 {
            return self;
        }
        let most = force.max(torsion);
        if most.is_infinite() {
            return Self::default();
        }
        let [force, torsion] = [force / most, torsion / most];
        let mut part = 1.0;
        if torsion > 0.0 && force > 0.0 {
            let along = self.force / length;
            let share = along.dot(limit.spread * along) / limit.polar;
            let exponent = 1.0 + 0.7 * (share + share * share);
            // Newton's method for (part · force)² + (part · torsion)ⁿ = 1 from above: the left side is convex.
            for _ in 0..20 {
                let [f, t] = [(part * force).powi(2), (part * torsion).powf(exponent)];
                let change = (f + t - 1.0) * part / (2.0 * f + exponent * t);
                part -= change;
                if change <= 1e-15 {
                    break;
                }
            }
        }
        let part = (part / most).min(1.0);
        Self {
            force: self.force * part,
            torsion: self.torsion * part,
        }
    }
}

/// 2ζ√(m* k), N s/m.
fn dashpot(damping: f64, mass: f64, stiffness: f64) -> f64 {
    2.0 * damping * (mass * stiffness).sqrt()
}

fn capped(force: DVec3, most: f64) -> DVec3 {
    let length = force.length();
    if length > most {
        force * (most / length)
    } else {
        force
    }
}

/// The stored shear force, rotated with the normal by the shortest arc and about it by the mean spin of
/// the two blocks. It is stored in the first block's frame, so that half the relative spin remains to be applied.
fn turned(history: &History, normal: DVec3, motion: &Motion) -> DVec3 {
    if history.shear == DVec3::ZERO {
        return DVec3::ZERO;
    }
    let before = motion.frame * history.normal;
    let arc = DQuat::from_rotation_arc(before.normalize(), normal);
    let angle = 0.5 * motion.spin.dot(normal) * motion.time_step;
    let shear = DQuat::from_axis_angle(normal, angle) * (arc * (motion.frame * history.shear));
    // Removes the rounding error along the normal.
    shear - normal * shear.dot(normal)
}

/// Stiffness and strength of the joint between two faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    /// k_n, Pa/m.
    pub normal_stiffness: f64,
    /// k_s, Pa/m.
    pub shear_stiffness: f64,
    /// φ, rad.
    pub friction_angle: f64,
    /// c, Pa.
    pub cohesion: f64,
    /// σ_t, Pa, of the faces that touch at the start, until their bond breaks.
    pub tensile_strength: f64,
    /// ζ, as a share of the critical damping of the two blocks on the contact's springs.
    pub damping: f64,
}

impl Default for Joint {
    /// Dry rock: 1 GPa/m in both directions, 30°, ζ = 0.1.
    fn default() -> Self {
        Self {
            normal_stiffness: 1e9,
            shear_stiffness: 1e9,
            friction_angle: 30f64.to_radians(),
            cohesion: 0.0,
            tensile_strength: 0.0,
            damping: 0.1,
        }
    }
}

impl Joint {
    /// The default joint of two materials: the harmonic mean of the stiffnesses (springs in series), the lower of
    /// the strengths, the mean of the damping ratios. Two faces of the same material have the joint of that material.
    pub fn between(a: &Self, b: &Self) -> Self {
        let series = |a: f64, b: f64| 2.0 / (1.0 / a + 1.0 / b);
        Self {
            normal_stiffness: series(a.normal_stiffness, b.normal_stiffness),
            shear_stiffness: series(a.shear_stiffness, b.shear_stiffness),
            friction_angle: a.friction_angle.min(b.friction_angle),
            cohesion: a.cohesion.min(b.cohesion),
            tensile_strength: a.tensile_strength.min(b.tensile_strength),
            damping: 0.5 * (a.damping + b.damping),
        }
    }

    /// Checks the numbers.
    ///
    /// # Errors
    /// [`Error::Argument`] at `place`, naming the number and its range.
    pub fn check(&self, place: &str) -> Result<()> {
        let refuse = |name: &str, value: f64, range: &str| {
            Err(Error::argument(
                format!("{place}.{name}"),
                format!("{value} must be {range}"),
            ))
        };
        for (name, value) in [
            ("normal_stiffness", self.normal_stiffness),
            ("shear_stiffness", self.shear_stiffness),
        ] {
            if !(value > 0.0 && value.is_finite()) {
                return refuse(name, value, "greater than 0 Pa/m");
            }
        }
        for (name, value) in [
            ("cohesion", self.cohesion),
            ("tensile_strength", self.tensile_strength),
        ] {
            if !(value >= 0.0 && value.is_finite()) {
                return refuse(name, value, "0 Pa or more");
            }
        }
        if !(0.0..std::f64::consts::FRAC_PI_2).contains(&self.friction_angle) {
            return refuse(
                "friction_angle",
                self.friction_angle,
                "at least 0 and less than π/2 rad (90°)",
            );
        }
        if !(0.0..=1.0).contains(&self.damping) {
            return refuse("damping", self.damping, "between 0 and 1");
        }
        Ok(())
    }
}

/// Default ratio of the step to 2/ω.
pub const USUAL_SHARE: f64 = 0.1;
/// Largest ratio of the step to 2/ω.
pub const LARGEST_SHARE: f64 = 0.2;

/// Sums over the springs that act on one block.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stiffness {
    /// Σ(k_n + k_s) A, N/m.
    pub translation: f64,
    /// Σ(k_n + k_s) A (|r|² + w²/4), N m.
    pub rotation: f64,
}

impl Stiffness {
    /// Adds a contact of `area` (m²) and `width` (m) at `arm` (m) from the centroid.
    pub fn add(&mut self, joint: &Joint, area: f64, arm: DVec3, width: f64) {
        let k = (joint.normal_stiffness + joint.shear_stiffness) * area;
        self.translation += k;
        self.rotation += k * (arm.length_squared() + 0.25 * width * width);
    }

    /// ω² of a block of `mass` (kg) and smallest moment of inertia `moment` (kg m²), rad²/s².
    pub fn frequency_squared(&self, mass: f64, moment: f64) -> f64 {
        2.0 * (self.translation / mass).max(self.rotation / moment)
    }
}

/// `share` of 2/ω, s; infinite without springs.
pub fn longest_step(share: f64, frequency_squared: f64) -> f64 {
    share * 2.0 / frequency_squared.sqrt()
}
