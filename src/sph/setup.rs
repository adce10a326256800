//! Setup of a particle simulation, and the equations of state of weakly compressible water.
//!
//! The kernel function is Wendland's C2 (Wendland 1995; Dehnen & Aly 2012, table 1).

use super::Solid;
use crate::{Error, Result};
use glam::{DMat3, DVec3};
use std::f64::consts::PI;

/// Largest Courant number at which water in tanks stays stable for every smoothing length.
const MAX_COURANT: f64 = 1.4;

/// Boundary condition of a face of the domain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// Particles re-enter at the opposite face, which must be periodic too.
    Periodic,
    /// Boundary particles hold the water.
    #[default]
    Wall,
    /// Particles leave the domain; they are counted.
    Open,
}

/// Equations of the water.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Scheme {
    /// δ-SPH with boundary particles in walls and bodies: Monaghan (1992), Adami, Hu & Adams (2012), Fourtakas et al.
    /// (2019).
    #[default]
    Delta,
    /// The scheme of Geraili Mikola & Sitar (2014), after Müller, Charypar & Gross (2003), with penalty walls. It is
    /// kept for comparison; still water does not come to rest with it.
    Mueller {
        /// Kinematic viscosity, m²/s.
        viscosity: f64,
    },
}

/// Neighbour search. Both methods give the same sums up to rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NeighbourSearch {
    /// Searches the cells for each sum. Needs no memory; the choice for GPUs.
    #[default]
    Cells,
    /// Verlet lists, reused for several steps. The choice for CPU adapters, where pairs beyond the support cost as
    /// much as neighbours.
    Lists,
}

/// A wall or block with its boundary particles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Body {
    /// Positions of its boundary particles relative to its centroid, in its own frame, m.
    pub boundary: Vec<DVec3>,
    /// Its convex parts in its own frame, which repel particles inside them by a penalty force. The scheme of Geraili
    /// Mikola & Sitar has no other walls. With boundary particles only fixed bodies use them, against particles that
    /// have passed between boundary particles.
    pub solids: Vec<Solid>,
    /// Whether it moves.
    pub moves: bool,
    /// Whether the load on it is computed.
    pub loaded: bool,
    /// Whether its acceleration enters the pressure of its boundary particles. For a body that the water moves this
    /// would be an explicit added mass, which is unstable for light bodies.
    pub accelerates: bool,
    /// Whether viscous water slips along it.
    pub free_slip: bool,
    /// The symmetric part of Σ A n ⊗ r of each of its boundary particles, from the faces on which it stands for the area A, m³:
    /// the strain of a deformable body follows from their pressures. Empty for a rigid body.
    pub strain_areas: Vec<DMat3>,
}

/// Domain, fluid properties and numerical parameters, SI. Create it with [`Setup::tank`], then change fields.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct Setup {
    /// Lower corner of the domain, m.
    pub origin: DVec3,
    /// Size of the domain, m; a whole number of spacings along periodic axes.
    pub size: DVec3,
    /// Boundary conditions by axis, lower face first.
    pub faces: [[Side; 2]; 3],
    /// Initial particle spacing Δx, m.
    pub spacing: f64,
    /// Smoothing length over spacing, h/Δx.
    pub smoothing: f64,
    /// Speed of sound c₀, m/s.
    pub sound_speed: f64,
    /// Reference density ρ₀, kg/m³.
    pub density: f64,
    /// Gravity, m/s².
    pub gravity: DVec3,
    /// Kinematic viscosity ν, m²/s; at 0 only the artificial viscosity acts.
    pub laminar_viscosity: f64,
    /// Artificial viscosity α.
    pub artificial_viscosity: f64,
    /// Density diffusion δ.
    pub density_diffusion: f64,
    /// Courant number C of the acoustic step, at most 1.4, beyond which the scheme may become unstable.
    pub courant: f64,
    /// Pressure as a function of density.
    pub equation_of_state: EquationOfState,
    /// Whether the flow is planar (nothing varies along y): each particle represents the whole width of the domain.
    pub plane: bool,
    /// Equations of the water.
    pub scheme: Scheme,
    /// Neighbour search.
    pub neighbours: NeighbourSearch,
    /// Whether an invocation loads four neighbours before it adds the first one, and adds without branches. GPUs otherwise
    /// wait for each load; CPU adapters are faster with one neighbour at a time. The sums are the same.
    pub batched_neighbours: bool,
    /// Walls and blocks.
    pub bodies: Vec<Body>,
}

impl Setup {
    /// A tank with walls on all sides, of `size` (m), its lower corner at the origin, with the particle spacing (m),
    /// the speed of sound (m/s), the default parameters and no bodies.
    pub fn tank(size: DVec3, spacing: f64, sound_speed: f64) -> Self {
        Self {
            origin: DVec3::ZERO,
            size,
            faces: [[Side::Wall; 2]; 3],
            spacing,
            smoothing: 2.0,
            sound_speed,
            density: 1000.0,
            gravity: DVec3::new(0.0, 0.0, -9.81),
            laminar_viscosity: 0.0,
            artificial_viscosity: 0.005,
            density_diffusion: 0.1,
            courant: 0.7,
            equation_of_state: EquationOfState::Linear,
            plane: false,
            scheme: Scheme::Delta,
            neighbours: NeighbourSearch::Cells,
            batched_neighbours: false,
            bodies: Vec::new(),
        }
    }

    /// Speed of sound over the largest speed: density then varies by about a hundredth.
    pub const SOUND_RATIO: f64 = 10.0;

    /// Stiffness of the scheme `mueller` over the square of the largest speed.
    pub const STIFFNESS_RATIO: f64 = 5.0;

    /// Layers of boundary particles that fill the support of the kernel behind a wall.
    pub fn layers(&self) -> u32 {
        (2.0 * self.smoothing).ceil() as u32
    }

    /// Largest flow speed within the default Mach number, m/s.
    pub fn largest_speed(&self) -> f64 {
        let ratio = match self.scheme {
            Scheme::Delta => Self::SOUND_RATIO,
            Scheme::Mueller { .. } => Self::STIFFNESS_RATIO.sqrt(),
        };
        self.sound_speed / ratio
    }

    /// Time in which sound travels one spacing, s.
    pub(super) fn unit_time(&self) -> f64 {
        self.spacing / self.sound_speed
    }

    /// The kernel function.
    pub fn kernel(&self) -> Wendland {
        let h = self.smoothing * self.spacing;
        if self.plane {
            Wendland::plane(h)
        } else {
            Wendland::space(h)
        }
    }

    /// Mass of a particle, kg.
    pub fn particle_mass(&self) -> f64 {
        let depth = if self.plane {
            self.size.y
        } else {
            self.spacing
        };
        self.density * self.spacing * self.spacing * depth
    }

    /// Kinematic viscosity equivalent to the artificial viscosity, m²/s: α h c/10, in a plane α h c/8 (Monaghan 2005).
    pub fn viscosity(&self) -> f64 {
        let h = self.smoothing * self.spacing;
        let divisor = if self.plane { 8.0 } else { 10.0 };
        self.artificial_viscosity * h * self.sound_speed / divisor
    }

    /// Longest step at flow speeds up to a tenth of the speed of sound, s: the bound of Monaghan (1992) without the
    /// viscous term of the artificial viscosity.
    pub fn acoustic_step(&self) -> f64 {
        let by_sound = self.courant * self.smoothing * self.unit_time();
        by_sound.min(self.viscous_step())
    }

    /// Longest step that laminar viscosity allows, s: h²/8ν (Morris, Fox & Zhu 1997); infinite without viscosity.
    pub fn viscous_step(&self) -> f64 {
        (self.smoothing * self.spacing).powi(2) / (8.0 * self.laminar_viscosity)
    }

    /// Checks the parameters and bodies.
    ///
    /// # Errors
    /// [`Error::Argument`] naming the first value that is out of range.
    pub(super) fn check(&self) -> Result<()> {
        let positive = [
            ("spacing", self.spacing),
            ("smoothing", self.smoothing),
            ("sound_speed", self.sound_speed),
            ("density", self.density),
            ("courant", self.courant),
            ("size.x", self.size.x),
            ("size.y", self.size.y),
            ("size.z", self.size.z),
        ];
        for (name, value) in positive {
            if !(value > 0.0 && value.is_finite()) {
                let message = format!("is {value}; give a positive number");
                return Err(Error::argument(name, message));
            }
        }
        if self.courant > MAX_COURANT {
            let message = format!(
                "is {}, and the scheme may become unstable beyond {MAX_COURANT}; give less, such as 0.7",
                self.courant
            );
            return Err(Error::argument("courant", message));
        }
        let mueller = match self.scheme {
            Scheme::Delta => 0.0,
            Scheme::Mueller { viscosity } => viscosity,
        };
        let not_negative = [
            ("laminar_viscosity", self.laminar_viscosity),
            ("scheme.viscosity", mueller),
            ("artificial_viscosity", self.artificial_viscosity),
            ("density_diffusion", self.density_diffusion),
        ];
        for (key, value) in not_negative {
            if !(value >= 0.0 && (value as f32).is_finite()) {
                let message = format!("is {value}; give a number from 0");
                return Err(Error::argument(key, message));
            }
        }
        if !(self.gravity.is_finite() && self.origin.is_finite()) {
            return Err(Error::argument("gravity, origin", "must be finite"));
        }
        if self.plane && self.gravity.y != 0.0 {
            let message = "gravity has a component along y, and a planar scene (particles.plane) has no motion along \
                           y; set the component to 0, or remove plane";
            return Err(Error::argument("gravity", message));
        }
        let mut bodies = self.bodies.iter().enumerate();
        bodies.try_for_each(|(index, body)| body.check(&format!("bodies[{index}]"), self.spacing))
    }

    /// Checks that the equation of state has a positive density at the pressure (Pa) of particle `id`.
    ///
    /// # Errors
    /// [`Error::Argument`] if not.
    pub(super) fn check_pressure(&self, id: usize, pressure: f64) -> Result<()> {
        let excess = self.excess(pressure) as f32;
        if excess.is_finite() && excess > -1.0 {
            return Ok(());
        }
        let least = self.pressure(-1.0);
        let message = format!(
            "particle {id} has {pressure} Pa, at which it has no density; give more than {least:.3e} Pa, the pressure at \
             zero density"
        );
        Err(Error::argument("positions", message))
    }

    /// Pressure (Pa) at the density excess ρ/ρ₀ − 1.
    pub fn pressure(&self, excess: f64) -> f64 {
        let unit = self.density * self.sound_speed.powi(2);
        match self.equation_of_state {
            EquationOfState::Linear => unit * excess,
            EquationOfState::Tait => unit * ((1.0 + excess).powi(7) - 1.0) / 7.0,
        }
    }

    /// Specific compression energy (J/kg) at the density excess ρ/ρ₀ − 1: ∫ p/ρ² dρ.
    pub fn compression(&self, excess: f64) -> f64 {
        let ratio = 1.0 + excess;
        self.sound_speed.powi(2)
            * match self.equation_of_state {
                // ln(1 + s) − s/(1 + s), whose first terms cancel.
                EquationOfState::Linear => excess.ln_1p() - excess / ratio,
                EquationOfState::Tait => (ratio.powi(6) / 6.0 + 1.0 / ratio - 7.0 / 6.0) / 7.0,
            }
    }

    /// Density excess ρ/ρ₀ − 1 at a pressure (Pa).
    pub fn excess(&self, pressure: f64) -> f64 {
        let p = pressure / (self.density * self.sound_speed.powi(2));
        match self.equation_of_state {
            EquationOfState::Linear => p,
            EquationOfState::Tait => (1.0 + 7.0 * p).powf(1.0 / 7.0) - 1.0,
        }
    }
}

impl Setup {
    /// Whether a body deforms.
    pub(super) fn deforms(&self) -> bool {
        self.bodies.iter().any(Body::deforms)
    }
}

impl Body {
    /// Whether it deforms.
    pub(crate) fn deforms(&self) -> bool {
        !self.strain_areas.is_empty()
    }

    /// Checks that all coordinates are finite in device units.
    fn check(&self, key: &str, spacing: f64) -> Result<()> {
        let refuse = |list: &str, index: usize| {
            let message = "is not finite; give coordinates and lengths in m";
            Err(Error::argument(format!("{key}.{list}[{index}]"), message))
        };
        let is_finite = |x: DVec3| (x / spacing).as_vec3().is_finite();
        if let Some(bad) = self.boundary.iter().position(|x| !is_finite(*x)) {
            return refuse("boundary", bad);
        }
        if ![0, self.boundary.len()].contains(&self.strain_areas.len()) {
            let message = format!(
                "has {} entries for {} boundary particles; give one for each, or none",
                self.strain_areas.len(),
                self.boundary.len()
            );
            return Err(Error::argument(format!("{key}.strain_areas"), message));
        }
        let is_solid_finite = |solid: &Solid| match solid {
            Solid::Sphere { centre, radius } => is_finite(*centre) && is_finite(DVec3::X * *radius),
            Solid::Faces(faces) => {
                let mut planes = faces.exposed.iter().chain(&faces.internal);
                is_finite(faces.centre)
                    && is_finite(DVec3::X * faces.radius)
                    && planes
                        .all(|face| face.normal.is_finite() && is_finite(DVec3::X * face.distance))
            }
        };
        match self.solids.iter().position(|solid| !is_solid_finite(solid)) {
            Some(bad) => refuse("solids", bad),
            None => Ok(()),
        }
    }
}

/// Pressure as a function of density.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EquationOfState {
    /// p = c₀² (ρ − ρ₀).
    #[default]
    Linear,
    /// p = ρ₀ c₀²/7 ((ρ/ρ₀)⁷ − 1), Cole (1948).
    Tait,
}

/// W(r) = a (1 − r/2h)⁴ (1 + 2r/h) for r < 2h, normalised to the integral one over space or over a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wendland {
    /// Smoothing length h, m.
    pub smoothing_length: f64,
    /// W(0): 21/(16 π h³) in space, 1/m³, and 7/(4 π h²) in a plane, 1/m².
    pub peak: f64,
}

impl Wendland {
    /// The three-dimensional function with the smoothing length `h` (m).
    pub fn space(h: f64) -> Self {
        Self {
            smoothing_length: h,
            peak: 21.0 / (16.0 * PI * h.powi(3)),
        }
    }

    /// The two-dimensional function with the smoothing length `h` (m).
    pub fn plane(h: f64) -> Self {
        Self {
            smoothing_length: h,
            peak: 7.0 / (4.0 * PI * h * h),
        }
    }

    /// Radius of the support 2h, m.
    pub fn support(&self) -> f64 {
        2.0 * self.smoothing_length
    }

    /// W(r) at the distance `r` (m).
    pub fn at(&self, r: f64) -> f64 {
        let q = r / self.smoothing_length;
        let rest = (1.0 - 0.5 * q).max(0.0);
        self.peak * rest.powi(4) * (1.0 + 2.0 * q)
    }
}
