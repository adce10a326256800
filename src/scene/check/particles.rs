//! A fluid of particles has what it needs, and nothing that belongs to a lattice.

use super::rules::{finite, not_negative, positive, refuse};
use crate::error::Result;
use crate::scene::{
    Axis, Boundary, Face, Field, Initial, Numerics, Particles, ProbePlace, Quantity, Scene, Scheme,
};

/// How far from whole the number of particles along a periodic edge may be: far above the rounding of a
/// division, far below anything that a user could mean.
const WHOLE: f64 = 1e-6;
/// Range of the smoothing length, of the spacing: below it the sum over neighbours is no integral any more,
/// above it a particle has a thousand of them.
const SMOOTHING: std::ops::RangeInclusive<f64> = 1.2..=3.0;
/// Largest acoustic time step: water in tanks stays calm up to 1.4, whatever its smoothing, and blows up at 1.8.
const MOST_COURANT: f64 = 1.0;

/// Largest disorder: farther off, particles may start on each other.
const MOST_DISORDER: f64 = 0.25;

impl Scene {
    /// What the keys of particles say of themselves.
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
                    "is {}, near what blows up; give at most {MOST_COURANT}, such as 0.7",
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

    /// The box of a fluid of particles.
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
            // Along y nothing varies in a plane: its one row fits any width.
            if !periodic || particles.plane && axis == Axis::Y {
                continue;
            }
            let count = size / spacing;
            // Three cells of the device, each as wide as the kernel reaches.
            let fewest = 3 * particles.layers();
            let is_whole = (count - count.round()).abs() <= WHOLE;
            if is_whole && count.round() < f64::from(fewest) {
                return refuse(
                    key,
                    format!(
                        "{size} m along {}, which is periodic, hold {count:.0} particles {spacing} m apart, and the \
                         kernel wants {fewest} at least; make it longer, or use a smaller particles.spacing",
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
            super::blocks::shape(&key, &water.shape)?;
            finite(format!("{key}.position"), &water.position)?;
            super::blocks::turn(&format!("{key}.rotation"), &water.rotation)?;
            finite(format!("{key}.velocity"), &water.velocity)?;
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

    /// What says something about the cells of a lattice.
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
                        "is of a fluid on a lattice, and here are particles; remove it{instead}, or [particles]"
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
        for (index, history) in self.output.histories.iter().enumerate() {
            if history.quantities.contains(&Quantity::Enstrophy) {
                return refuse(
                    format!("output.histories[{index}].quantities"),
                    "particles have no enstrophy; leave it out",
                );
            }
        }
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
                        "faces measure the cells before them, and here are particles; leave it out",
                    );
                }
                ProbePlace::Gauge { .. }
                | ProbePlace::Sensor { .. }
                | ProbePlace::RunUp { .. }
                | ProbePlace::Block { .. } => {}
                _ => {
                    return refuse(
                        key,
                        "measures cells, and here are particles; give kind = \"point\", \"line\", \"box\", \"gauge\", \
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

    /// What only a fluid of particles has.
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
        for (index, history) in self.output.histories.iter().enumerate() {
            let of_particles = |quantity: &&Quantity| quantity.is_of_particles();
            if let Some(quantity) = history.quantities.iter().find(of_particles) {
                return refuse(
                    format!("output.histories[{index}].quantities"),
                    format!(
                        "only particles have one of these; leave {} out",
                        quantity.name()
                    ),
                );
            }
        }
        for (index, probe) in self.probes.iter().enumerate() {
            if matches!(
                probe.place,
                ProbePlace::Gauge { .. } | ProbePlace::Sensor { .. } | ProbePlace::RunUp { .. }
            ) {
                return refuse(
                    format!("probes[{index}]"),
                    "measures free water, which only particles are; add [particles], or give another kind",
                );
            }
        }
        Ok(())
    }

    /// The faces that hold particles, let them go, or hand them on.
    pub(super) fn check_particle_boundaries(&self) -> Result<()> {
        for (face, boundary) in self.boundaries.iter() {
            let key = format!("boundaries.{}", face.name());
            match boundary {
                Boundary::Velocity { .. } | Boundary::Pressure { .. } => {
                    return refuse(
                        key,
                        format!(
                            "particles know no `{}`; use kind = \"wall\", \"free_slip\", \"open\" or \"periodic\"",
                            boundary.kind()
                        ),
                    );
                }
                Boundary::Wall { velocity } if *velocity != [0.0; 3] => {
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
        if let (Some(face), true) = (open_side, self.particles.as_ref().is_some_and(|p| p.plane)) {
            return refuse(
                format!("boundaries.{}", face.name()),
                "nothing varies along y (particles.plane), so nothing leaves there; make it periodic, or free_slip",
            );
        }
        Ok(())
    }
}
