//! A fluid of particles: its numerical settings, its initial bodies of water, and checks of the other tables.

use schemars::JsonSchema;
use serde::Deserialize;

use super::rules::{finite, not_negative, positive, refuse};
use super::{
    Axis, BlockShape, Boundary, Face, Field, Initial, Numerics, ProbePlace, Quantity, Rotation,
    Scene, block_shape,
};
use crate::error::Result;

/// Refusal of a vector out of the plane of a scene.
pub(crate) const NOT_IN_PLANE: &str = "has a component along y, along which nothing moves in a plane scene \
                                       (particles.plane); set it to 0, or remove plane";

/// Settings of a fluid of particles (weakly compressible SPH). With this table the fluid has a free surface; its
/// initial bodies are in `water`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Particles {
    /// Distance Δx of particles at the start, m. Edges of the domain along periodic axes are whole multiples of it.
    pub spacing: f64,
    /// Smoothing length h in units of the spacing: 1.2 to 3. Particles interact within 2h. Default 2.
    #[serde(default = "Particles::usual_smoothing")]
    pub smoothing: f64,
    /// SPH scheme. Default `delta`.
    #[serde(default)]
    pub scheme: Scheme,
    /// Equation of state. Default `linear`.
    #[serde(default)]
    pub equation_of_state: EquationOfState,
    /// Largest expected speed U, m/s: the speed of sound is 10 U. Default √(2 g D), the speed after a fall through the height D
    /// of all water at the start, or a larger one: that of driven blocks during the run, of water that moves at the start, or
    /// of free blocks after a fall to the bottom of the water.
    pub largest_speed: Option<f64>,
    /// Stiffness k of the scheme `mueller`, p = k (ρ − ρ₀), m²/s²: the square of its speed of sound. The paper gives no value.
    /// Default 5 U², for which water at the bottom of a tank is denser by a tenth. A larger stiffness increases the attraction
    /// at the surface, where sums lack neighbours.
    pub stiffness: Option<f64>,
    /// Artificial viscosity α (Monaghan 1992), no unit, from 0: equivalent to a kinematic viscosity of α h c/10 in
    /// space and α h c/8 in a plane. Default 0.005.
    #[serde(default = "Particles::usual_viscosity")]
    pub artificial_viscosity: f64,
    /// Diffusion δ of density (Fourtakas et al. 2019), no unit, from 0. Default 0.1.
    #[serde(default = "Particles::usual_diffusion")]
    pub density_diffusion: f64,
    /// Acoustic time step in units of h over the speed of sound: above 0, at most 1. Default 0.7: the errors of the validated
    /// cases equal those of shorter steps; water in tanks stays calm up to 1.4.
    #[serde(default = "Particles::usual_courant")]
    pub courant: f64,
    /// Largest initial displacement of particles of still water from their lattice points along each axis, in units of the
    /// spacing, 0 to 0.25, the same in each run. Under pressure a regular lattice resists shear, and long waves travel too fast
    /// on it; disorder stirs still water. Default 0.04.
    #[serde(default = "Particles::usual_disorder")]
    pub disorder: f64,
    /// Whether the flow is plane: nothing varies along y, and one row of particles represents the whole width of the
    /// domain. Default false.
    #[serde(default)]
    pub plane: bool,
}

impl Particles {
    /// Settings with this spacing (m) and the defaults otherwise.
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

    /// Number of layers of particles inside solids, which fill the depth of 2h below the surface.
    pub fn layers(&self) -> u32 {
        // Rounding must not add a layer to a whole number.
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

/// SPH scheme.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Scheme {
    /// δ-SPH: continuity with diffusion of density, Wendland's C2 kernel, boundary particles in solids.
    #[default]
    Delta,
    /// The scheme of Mikola & Sitar (2014), for comparison: density by a sum, p = k (ρ − ρ₀), the kernels of
    /// Müller, Charypar & Gross (2003), walls and blocks as damped springs. Still water does not come to rest with it.
    /// Its viscosity is `fluid.viscosity`, or the equivalent of `artificial_viscosity` if that is 0.
    Mueller,
}

/// Equation of state for pressure p and density ρ, with the density at rest ρ₀ and the speed of sound c.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum EquationOfState {
    /// p = c² (ρ − ρ₀).
    #[default]
    Linear,
    /// p = ρ₀ c²/7 ((ρ/ρ₀)⁷ − 1), stiffer under compression.
    Tait,
}

/// A body of water at the time 0; blocks and solids in it displace it.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Water {
    /// The shape, in its own frame.
    #[serde(rename = "kind")]
    #[schemars(flatten)]
    pub shape: BlockShape,
    /// Position of the origin of that frame, m. Default (0, 0, 0).
    #[serde(default)]
    pub position: [f64; 3],
    /// Rotation about that origin. Default none.
    #[serde(default)]
    pub rotation: Rotation,
    /// Velocity, m/s. Default at rest.
    #[serde(default)]
    pub velocity: [f64; 3],
}

/// Tolerance of the number of particles along a periodic edge from an integer: far above the rounding of a
/// division, far below any intended fraction.
const WHOLE: f64 = 1e-6;
/// Range of the smoothing length in units of the spacing: below it the sum over neighbours does not approximate the integral,
/// above it a particle has a thousand neighbours.
const SMOOTHING: std::ops::RangeInclusive<f64> = 1.2..=3.0;
/// Largest acoustic time step: water in tanks stays calm up to 1.4 for any smoothing length, and becomes unstable at 1.8.
const MOST_COURANT: f64 = 1.0;

/// Largest disorder: with more, particles may start at the same point.
const MOST_DISORDER: f64 = 0.25;

impl Scene {
    /// Checks the keys of the table `particles`.
    pub(super) fn check_particles(&self, particles: &Particles) -> Result<()> {
        if !SMOOTHING.contains(&particles.smoothing) {
            return refuse(
                "particles.smoothing",
                format!(
                    "is {} of the spacing; give {} to {}, such as 2",
                    particles.smoothing,
                    SMOOTHING.start(),
                    SMOOTHING.end()
                ),
            );
        }
        if let Some(speed) = particles.largest_speed {
            positive("particles.largest_speed", speed, "m/s")?;
        }
        if let Some(stiffness) = particles.stiffness {
            positive("particles.stiffness", stiffness, "m²/s²")?;
            if particles.scheme != Scheme::Mueller {
                return refuse(
                    "particles.stiffness",
                    "belongs to scheme = \"mueller\"; remove it, or give largest_speed, from which the speed of sound \
                     follows",
                );
            }
        }
        let rates = [
            ("artificial_viscosity", particles.artificial_viscosity),
            ("density_diffusion", particles.density_diffusion),
            ("disorder", particles.disorder),
        ];
        for (key, value) in rates {
            not_negative(format!("particles.{key}"), value, "")?;
        }
        positive("particles.courant", particles.courant, "")?;
        if particles.courant > MOST_COURANT {
            return refuse(
                "particles.courant",
                format!(
                    "is {}, close to instability; give at most {MOST_COURANT}, such as 0.7",
                    particles.courant
                ),
            );
        }
        if particles.disorder > MOST_DISORDER {
            return refuse(
                "particles.disorder",
                format!(
                    "is {} of the spacing, and particles may start on each other; give at most {MOST_DISORDER}, such as 0.04",
                    particles.disorder
                ),
            );
        }
        self.check_water()?;
        self.check_of_lattice()?;
        self.check_particle_output()
    }

    /// Whether it is a plane scene of particles, in which nothing varies along y.
    pub(crate) fn is_plane(&self) -> bool {
        self.particles.as_ref().is_some_and(|p| p.plane)
    }

    /// Checks the domain of a fluid of particles.
    pub(super) fn check_particle_domain(&self, particles: &Particles) -> Result<()> {
        let domain = &self.domain;
        if !domain.is_given() {
            return refuse(
                "domain",
                "particles need a box that holds them; add [domain] with size",
            );
        }
        if domain.cell != 0.0 {
            return refuse(
                "domain.cell",
                "a fluid of particles has no cells; remove it, or [particles]",
            );
        }
        let spacing = particles.spacing;
        positive("particles.spacing", spacing, "m")?;
        finite("domain.origin", &domain.origin)?;
        for axis in Axis::ALL {
            let size = domain.size[axis.index()];
            let key = format!("domain.size[{}]", axis.index());
            positive(key.as_str(), size, "m")?;
            let periodic = *self.boundaries.face(Face::ALL[2 * axis.index()]) == Boundary::Periodic;
            // Nothing varies along y in a plane flow: its single row fits any width.
            if !periodic || particles.plane && axis == Axis::Y {
                continue;
            }
            let count = size / spacing;
            // Three cells of the neighbour search on the device, each as wide as the kernel radius.
            let fewest = 3 * particles.layers();
            let is_whole = (count - count.round()).abs() <= WHOLE;
            if is_whole && count.round() < f64::from(fewest) {
                return refuse(
                    key,
                    format!(
                        "{size} m along {}, which is periodic, hold {count:.0} particles {spacing} m apart, and the \
                         kernel needs at least {fewest}; make it longer, or use a smaller particles.spacing",
                        axis.name()
                    ),
                );
            }
            if !is_whole {
                return refuse(
                    key,
                    format!(
                        "{size} m along {}, which is periodic, holds {count:.6} particles {spacing} m apart; make \
                         it a whole number of spacings, at least {fewest}",
                        axis.name()
                    ),
                );
            }
        }
        Ok(())
    }

    fn check_water(&self) -> Result<()> {
        if self.water.is_empty() {
            return refuse(
                "water",
                "there are no particles without water; add [[water]] with a shape",
            );
        }
        for (index, water) in self.water.iter().enumerate() {
            let key = format!("water[{index}]");
            block_shape::check(&key, &water.shape)?;
            finite(format!("{key}.position"), &water.position)?;
            water.rotation.check(&format!("{key}.rotation"))?;
            finite(format!("{key}.velocity"), &water.velocity)?;
            if self.is_plane() && water.velocity[1] != 0.0 {
                return refuse(format!("{key}.velocity"), NOT_IN_PLANE);
            }
        }
        for (axis, formula) in self.fluid.acceleration.iter().enumerate() {
            if !formula.is_constant() {
                return refuse(
                    "fluid.acceleration",
                    format!(
                        "the {} component is `{formula}`; particles take three numbers",
                        Axis::ALL[axis].name()
                    ),
                );
            }
        }
        Ok(())
    }

    /// Refuses keys that apply only to a lattice.
    fn check_of_lattice(&self) -> Result<()> {
        let tables = [
            ("numerics", self.numerics != Numerics::default(), ""),
            (
                "initial",
                self.initial != Initial::default(),
                " ([[water]] have a `velocity`)",
            ),
            ("output.slices", !self.output.slices.is_empty(), ""),
        ];
        for (key, given, instead) in tables {
            if given {
                return refuse(
                    key,
                    format!(
                        "applies to a fluid on a lattice, and this scene has particles; remove it{instead}, or [particles]"
                    ),
                );
            }
        }
        if let Some(index) = self.solids.iter().position(|solid| solid.void) {
            return refuse(
                format!("solids[{index}].void"),
                "solids hold particles one by one, so none can have a hole; give several solids around it",
            );
        }
        Ok(())
    }

    fn check_particle_output(&self) -> Result<()> {
        let known =
            |field: &&Field| !matches!(field, Field::Velocity | Field::Pressure | Field::Density);
        let unknown = |field: &Field| {
            format!(
                "particles have no {}; there are velocity, pressure and density",
                field.name()
            )
        };
        if let Some(field) = self.output.fields.iter().find(known) {
            return refuse("output.fields", unknown(field));
        }
        self.refuse_quantities(
            |quantity| *quantity == Quantity::Enstrophy,
            |name| format!("particles have no {name}; leave it out"),
        )?;
        for (index, probe) in self.probes.iter().enumerate() {
            let key = format!("probes[{index}]");
            match &probe.place {
                ProbePlace::Point { .. } | ProbePlace::Line { .. } | ProbePlace::Box { .. } => {
                    if let Some(field) = probe.fields.iter().find(known) {
                        return refuse(format!("{key}.fields"), unknown(field));
                    }
                }
                ProbePlace::Block { faces: true, .. } => {
                    return refuse(
                        format!("{key}.faces"),
                        "faces measure the cells before them, and this scene has particles; leave it out",
                    );
                }
                ProbePlace::Gauge { .. }
                | ProbePlace::Sensor { .. }
                | ProbePlace::RunUp { .. }
                | ProbePlace::Block { .. } => {}
                _ => {
                    return refuse(
                        key,
                        "measures cells, and this scene has particles; give kind = \"point\", \"line\", \"box\", \"gauge\", \
                         \"sensor\", \"run_up\" or \"block\"",
                    );
                }
            }
        }
        for (index, view) in self.views.iter().enumerate() {
            if view.shows_fluid() {
                return refuse(
                    format!("views[{index}]"),
                    "slices and traces show a fluid on a lattice; remove them: particles are always shown",
                );
            }
        }
        Ok(())
    }

    /// Refuses keys that apply only to a fluid of particles.
    pub(super) fn check_no_particles(&self) -> Result<()> {
        if !self.water.is_empty() {
            return refuse(
                "water",
                "bodies of water are made of particles; add [particles] with a spacing, or remove them",
            );
        }
        for (face, boundary) in self.boundaries.iter() {
            if *boundary == Boundary::Open {
                return refuse(
                    format!("boundaries.{}", face.name()),
                    "only particles leave through an open face; use kind = \"pressure\", or add [particles]",
                );
            }
        }
        self.refuse_quantities(
            |quantity| quantity.is_of_particles(),
            |name| format!("only a fluid of particles has this quantity; leave {name} out"),
        )?;
        for (index, probe) in self.probes.iter().enumerate() {
            if matches!(
                probe.place,
                ProbePlace::Gauge { .. } | ProbePlace::Sensor { .. } | ProbePlace::RunUp { .. }
            ) {
                return refuse(
                    format!("probes[{index}]"),
                    "measures free water, which only particles represent; add [particles], or give another kind",
                );
            }
        }
        Ok(())
    }

    /// Checks the faces: wall, open or periodic.
    pub(super) fn check_particle_boundaries(&self) -> Result<()> {
        for (face, boundary) in self.boundaries.iter() {
            let key = format!("boundaries.{}", face.name());
            match boundary {
                Boundary::Velocity { .. } | Boundary::Pressure { .. } => {
                    return refuse(
                        key,
                        format!(
                            "particles do not support `{}`; use kind = \"wall\", \"free_slip\", \"open\" or \"periodic\"",
                            boundary.kind()
                        ),
                    );
                }
                Boundary::Wall { velocity, .. } if *velocity != [0.0; 3] => {
                    return refuse(
                        format!("{key}.velocity"),
                        "walls of a fluid of particles are at rest; for one that moves use a block with motion = \
                         \"driven\"",
                    );
                }
                _ => {}
            }
        }
        let open_side = [Face::YMin, Face::YMax]
            .into_iter()
            .find(|face| *self.boundaries.face(*face) == Boundary::Open);
        if let (Some(face), true) = (open_side, self.is_plane()) {
            return refuse(
                format!("boundaries.{}", face.name()),
                "nothing varies along y (particles.plane), so nothing leaves there; make it periodic, or free_slip",
            );
        }
        Ok(())
    }
}
