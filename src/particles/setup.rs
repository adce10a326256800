//! What particles of water want to know.

use super::Solid;
use crate::scene;
use glam::DVec3;

/// A face of the domain, as particles meet it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// What leaves comes in at the opposite face, which is periodic too.
    Periodic,
    /// Shell particles hold the water.
    #[default]
    Wall,
    /// What leaves is lost, and counted.
    Open,
}

/// Pressure of a density.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StateEquation {
    /// p = c₀² (ρ − ρ₀).
    #[default]
    Linear,
    /// p = ρ₀ c₀²/7 ((ρ/ρ₀)⁷ − 1), Cole (1948).
    Tait,
}

/// Equations of the water.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Scheme {
    /// δ-SPH with dummy particles in walls and bodies: Monaghan (1992), Adami, Hu & Adams (2012), Fourtakas et al.
    /// (2019).
    #[default]
    Delta,
    /// That of Geraili Mikola & Sitar (2014), after Müller, Charypar & Gross (2003), walls being springs: kept to
    /// compare with. Still water does not come to rest with it.
    Mueller {
        /// Kinematic viscosity, m²/s.
        viscosity: f64,
    },
}

/// How the sums over neighbours find them; the sums are the same up to rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Neighbours {
    /// From their cells, each time: takes no memory, for GPUs.
    #[default]
    Cells,
    /// From lists, made once for several steps: for CPU adapters, where the pairs that are too far apart cost as
    /// much as the others.
    Lists,
}

/// A wall or block that water meets, by the particles of its shell.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Body {
    /// Places of its particles from its centroid, in its own frame, m.
    pub shell: Vec<DVec3>,
    /// Its convex parts in its own frame, which push out what is in them: all that the scheme of Geraili Mikola & Sitar
    /// has for walls, and what shells of bodies that do not move need where pressures alone leave water in them.
    pub solids: Vec<Solid>,
    /// Whether it moves at all.
    pub moves: bool,
    /// Whether somebody wants to know what the water does to it.
    pub loaded: bool,
    /// Whether its acceleration counts in the pressure beside it. That of a body which the water itself pushes
    /// would be an explicit added mass, which is unstable for light bodies.
    pub accelerates: bool,
    /// Whether viscous water slides along it instead of clinging to it.
    pub slips: bool,
}

/// The domain, the water's constants and the numbers of the scheme, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup {
    /// Lower corner of the domain, m.
    pub origin: DVec3,
    /// Its edges, m; along periodic axes whole numbers of spacings.
    pub size: DVec3,
    /// Its faces, by axis, lower one first.
    pub faces: [[Side; 2]; 3],
    /// Distance of particles at the start Δx, m.
    pub spacing: f64,
    /// h/Δx.
    pub smoothing: f64,
    /// Speed of sound c₀, m/s.
    pub sound_speed: f64,
    /// Reference density ρ₀, kg/m³.
    pub density: f64,
    /// m/s².
    pub gravity: DVec3,
    /// Kinematic viscosity ν, m²/s; 0: none but the artificial one.
    pub laminar_viscosity: f64,
    /// α.
    pub artificial_viscosity: f64,
    /// δ.
    pub density_diffusion: f64,
    /// Courant number C of the acoustic step, at most 1.4: beyond, water may blow up.
    pub courant: f64,
    /// Pressure of a density.
    pub state: StateEquation,
    /// Whether nothing varies along y: each particle stands for the whole width of the domain.
    pub plane: bool,
    /// Equations of the water.
    pub scheme: Scheme,
    /// How neighbours are found.
    pub neighbours: Neighbours,
    /// Walls and blocks.
    pub bodies: Vec<Body>,
}

impl Setup {
    /// A box with walls (edges `size` in m, lower corner at the origin) and water of the speed of sound `sound_speed`
    /// (m/s), the numbers of the scheme as usual; no bodies yet.
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
            state: StateEquation::Linear,
            plane: false,
            scheme: Scheme::Delta,
            neighbours: Neighbours::Cells,
            bodies: Vec::new(),
        }
    }

    /// Layers of shell particles that a wall needs: as many as the support of the kernel function reaches.
    pub fn layers(&self) -> u32 {
        (2.0 * self.smoothing).ceil() as u32
    }

    /// Largest speed for which the speed of sound is usual, m/s.
    pub fn largest_speed(&self) -> f64 {
        let usual = match self.scheme {
            Scheme::Delta => scene::Particles::SOUND,
            Scheme::Mueller { .. } => scene::Particles::STIFFNESS.sqrt(),
        };
        self.sound_speed / usual
    }

    /// A time in which sound passes a spacing, s.
    pub(super) fn unit_time(&self) -> f64 {
        self.spacing / self.sound_speed
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

    /// Kinematic viscosity that the artificial viscosity amounts to, m²/s: α h c/10, in a plane α h c/8
    /// (Monaghan 2005).
    pub fn viscosity(&self) -> f64 {
        let h = self.smoothing * self.spacing;
        let share = if self.plane { 8.0 } else { 10.0 };
        self.artificial_viscosity * h * self.sound_speed / share
    }

    /// Longest step of water that moves at most at a tenth of the speed of sound, s: the bound of
    /// Monaghan (1992) without the share of viscosity.
    pub fn acoustic_step(&self) -> f64 {
        let by_sound = self.courant * self.smoothing * self.unit_time();
        by_sound.min(self.friction_step())
    }

    /// Longest step that laminar viscosity allows, s: h²/8ν (Morris, Fox & Zhu 1997); infinite without it.
    pub fn friction_step(&self) -> f64 {
        (self.smoothing * self.spacing).powi(2) / (8.0 * self.laminar_viscosity)
    }
}
