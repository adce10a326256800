//! A fluid of particles.

use schemars::JsonSchema;
use serde::Deserialize;

/// How a fluid of particles is computed (weakly compressible SPH): its presence makes the fluid one with a
/// free surface, whose bodies are those of `water`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Particles {
    /// Distance Δx of particles at the start, m. Edges of the domain along which it is periodic are whole
    /// numbers of it.
    pub spacing: f64,
    /// Smoothing length h, of the spacing: 1.2 to 3. Particles feel those nearer than 2h. Default 2.
    #[serde(default = "Particles::usual_smoothing")]
    pub smoothing: f64,
    /// The scheme. Default `delta`.
    #[serde(default)]
    pub scheme: Scheme,
    /// How pressure follows from density. Default `linear`.
    #[serde(default)]
    pub equation_of_state: EquationOfState,
    /// Largest speed U that is expected, m/s: the speed of sound is 10 U. Default √(2 g D), the speed
    /// after a fall through the height D of all water at the start, or more: that of driven blocks in the run, or of
    /// water that moves at the start and of free blocks after a fall to the bottom of the water.
    pub largest_speed: Option<f64>,
    /// Stiffness k of the scheme `mueller`, p = k (ρ − ρ₀), m²/s²: the square of its speed of sound. Its authors give
    /// none. Default 5 U², at which water is denser at the bottom of a tank by a tenth: the stiffer, the more the
    /// surface pulls, where sums lack neighbours.
    pub stiffness: Option<f64>,
    /// Artificial viscosity α (Monaghan 1992), no unit, from 0: a kinematic viscosity of
    /// α h c/10 in space and α h c/8 in a plane. Default 0.005.
    #[serde(default = "Particles::usual_viscosity")]
    pub artificial_viscosity: f64,
    /// Diffusion δ of density (Fourtakas et al. 2019), no unit, from 0. Default 0.1.
    #[serde(default = "Particles::usual_diffusion")]
    pub density_diffusion: f64,
    /// Acoustic time step, of h over the speed of sound: above 0, at most 1. Default 0.7: the errors of the validated
    /// cases are those of shorter steps, and up to 1.4 water in tanks stays calm.
    #[serde(default = "Particles::usual_courant")]
    pub courant: f64,
    /// How far from the points of their lattice particles of standing water start, of the spacing: along each axis up to so
    /// much, 0 to 0.25, the same in each run. Under pressure a regular lattice resists shear, and long waves travel too fast
    /// on it; disorder stirs still water. Default 0.04.
    #[serde(default = "Particles::usual_disorder")]
    pub disorder: f64,
    /// Whether nothing varies along y: one row of particles in the middle stands for the whole width of the
    /// domain. Default false.
    #[serde(default)]
    pub plane: bool,
}

impl Particles {
    /// Those of this spacing (m), the rest as it is by default.
    pub fn of(spacing: f64) -> Self {
        Self {
            spacing,
            smoothing: Self::usual_smoothing(),
            scheme: Scheme::default(),
            equation_of_state: EquationOfState::default(),
            largest_speed: None,
            stiffness: None,
            artificial_viscosity: Self::usual_viscosity(),
            density_diffusion: Self::usual_diffusion(),
            courant: Self::usual_courant(),
            disorder: Self::usual_disorder(),
            plane: false,
        }
    }

    /// Smoothing length h, m.
    pub fn smoothing_length(&self) -> f64 {
        self.smoothing * self.spacing
    }

    /// Layers of particles inside solids: what lies within 2h of the surface.
    pub fn layers(&self) -> u32 {
        // A whole number of layers stays one where rounding lifts it.
        (2.0 * self.smoothing - 1e-9).ceil() as u32
    }

    fn usual_smoothing() -> f64 {
        2.0
    }

    fn usual_viscosity() -> f64 {
        0.005
    }

    fn usual_diffusion() -> f64 {
        0.1
    }

    fn usual_courant() -> f64 {
        0.7
    }

    fn usual_disorder() -> f64 {
        0.04
    }
}

/// A scheme of particles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Scheme {
    /// δ-SPH: continuity with diffusion of density, Wendland's C2 kernel, dummy particles in solids.
    #[default]
    Delta,
    /// That of Geraili Mikola & Sitar (2014), to compare with: density by a sum, p = k (ρ − ρ₀), the kernels of
    /// Müller, Charypar & Gross (2003), walls and blocks as damped springs. Still water does not come to rest with it.
    /// Viscous by `fluid.viscosity`, or where that is 0 by what `artificial_viscosity` amounts to.
    Mueller,
}

/// How pressure p follows from density ρ, with the density at rest ρ₀ and the speed of sound c.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum EquationOfState {
    /// p = c² (ρ − ρ₀).
    #[default]
    Linear,
    /// p = ρ₀ c²/7 ((ρ/ρ₀)⁷ − 1), stiffer under compression.
    Tait,
}
