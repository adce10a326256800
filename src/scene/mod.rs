//! Scenes: the input of a run, in SI units, checked.
//!
//! A scene is a TOML file. Every table is a type of this module, every key a public field;
//! [`Scene::schema`] is the same as a JSON schema.
//!
//! [`build`] converts a scene to the setups of the engines, in the units of [`Units::of`](crate::units::Units::of).
//!
//! ```
//! use riprap::{scene::{Scene, build::lattice_setup}, units::Units};
//!
//! # fn main() -> riprap::Result<()> {
//! let text = r#"
//!     domain = { size = [0.2, 0.1, 0.1], cell = 0.01 }
//!     fluid = { density = 1000, viscosity = 1e-3, acceleration = [0.01, 0, 0] }
//!     numerics.time_step = 0.001
//!     run.steps = 100
//!     [boundaries]
//!     z_min.kind = "wall"
//!     z_max.kind = "wall"
//! "#;
//! let scene = Scene::from_toml(text, ".".as_ref(), "channel.toml")?;
//! let setup = lattice_setup(&scene, &Units::of(&scene)?, None)?;
//! assert_eq!(setup.cells, [20, 10, 10]);
//!
//! // An error names the file, the line and the key.
//! let error = Scene::from_toml(&text.replace("1e-3", "-1"), ".".as_ref(), "channel.toml");
//! assert!(error.unwrap_err().to_string().starts_with("channel.toml:3:"));
//! # Ok(())
//! # }
//! ```

mod advice;
mod block_shape;
mod blocks;
mod boundaries;
pub mod build;
mod coupling;
mod deformable;
mod domain;
mod face;
mod fluid;
mod initial;
mod materials;
mod numerics;
mod output;
mod parse;
mod particles;
mod probes;
mod renamed;
mod rock;
mod rock_masses;
mod rules;
mod run;
mod sample;
mod series_files;
mod solid_fractions;
mod solids;
pub mod static_solids;
mod statistics;
mod suspicious_keys;
mod tagged;
mod views;

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::Deserialize;

use crate::error::Result;
use rules::refuse;

pub use advice::{Advice, HIGH_MACH, SUGA_EXCESS, Warning};
pub use block_shape::{BlockShape, PlaneFace};
pub use blocks::{Block, Motion, Part, Repeat, Rotation};
pub use boundaries::{Boundaries, Boundary, Turbulence};
pub use coupling::Coupling;
pub use deformable::{FixedPoint, PointLoad};
pub use domain::Domain;
pub use face::{Axis, Direction, Face};
pub use fluid::Fluid;
pub use initial::{Initial, InitialPressure};
pub use materials::{Material, MaterialPair};
pub use numerics::{
    Collision, EddyViscosity, Equilibrium, Numerics, SolidOperator, SolidWeight, Storage, WallModel,
};
pub use output::{Field, History, Output, Quantity, Slice, SliceField};
pub(crate) use particles::NOT_IN_PLANE;
pub use particles::{EquationOfState, Particles, Scheme, Water};
pub use probes::{Probe, ProbePlace};
pub use renamed::{RENAMED_KEYS, RenamedKey, Renaming, migrate, renamed_keys};
pub use rock::{BroadphaseBackend, Rock, Sleep};
pub use rock_masses::{Distribution, JointSet, Persistence, RockMass, Volume};
pub use run::{Kernels, Run};
pub use sample::{BodyForce, InitialFields, StartPressure};
pub use solid_fractions::SolidFractions;
pub use solids::{Shape, Solid, SolidSurface};
pub use statistics::Statistics;
pub use views::{View, ViewSlice};

/// A fluid, blocks of rock, or both, in SI units.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Scene {
    /// Title. Default the name of the file without its extension.
    #[serde(default)]
    pub title: String,
    /// The computed box. Without fluid it is optional, and required only by solids that are half-spaces, which it
    /// bounds.
    #[serde(default)]
    pub domain: Domain,
    /// The fluid. Default none: then there must be blocks, and they are dry.
    #[serde(default)]
    pub fluid: Fluid,
    /// Numerical settings of a fluid on a lattice. Default: see each key.
    #[serde(default)]
    pub numerics: Numerics,
    /// Settings of a fluid of particles, which has a free surface. Default none: the fluid is on a lattice and fills
    /// the domain.
    #[serde(default)]
    pub particles: Option<Particles>,
    /// Bodies of water at the time 0, made of particles. Default none.
    #[serde(default)]
    pub water: Vec<Water>,
    /// The faces of the domain. Default: all periodic.
    #[serde(default)]
    pub boundaries: Boundaries,
    /// Static solids, which are fixed blocks for other blocks. Default none.
    #[serde(default)]
    pub solids: Vec<Solid>,
    /// Settings of all blocks. Default: see each key.
    #[serde(default)]
    pub rock: Rock,
    /// Coupling of fluid and blocks. Default: see each key.
    #[serde(default)]
    pub coupling: Coupling,
    /// Materials of blocks and solids. Required if there are blocks.
    #[serde(default)]
    pub materials: Vec<Material>,
    /// Contact properties of pairs of materials that are not derived from each of them. Default none.
    #[serde(default)]
    pub material_pairs: Vec<MaterialPair>,
    /// Blocks. Default none.
    #[serde(default)]
    pub blocks: Vec<Block>,
    /// Volumes of rock that joints cut into blocks. Default none.
    #[serde(default)]
    pub rock_masses: Vec<RockMass>,
    /// The flow at the time 0. Default at rest, with hydrostatic pressure.
    #[serde(default)]
    pub initial: Initial,
    /// Length of the run.
    pub run: Run,
    /// Files, pictures and curves. Default: the last state as VTI.
    #[serde(default)]
    pub output: Output,
    /// Measurements. Default none.
    #[serde(default)]
    pub probes: Vec<Probe>,
    /// Means and fluctuations over time. Default none.
    #[serde(default)]
    pub statistics: Option<Statistics>,
    /// Perspective pictures of the blocks and of the fluid. Default none.
    #[serde(default)]
    pub views: Vec<View>,
    /// Directory to which the paths of meshes are relative.
    #[serde(skip)]
    dir: PathBuf,
}

impl Scene {
    /// Number of cells along x, y, z.
    pub fn cells(&self) -> [u32; 3] {
        self.domain.cells()
    }

    /// Centre of the cell `ijk`, counted from 0 at the lower corner, m.
    pub fn centre(&self, ijk: [u32; 3]) -> [f64; 3] {
        self.domain.centre(ijk)
    }

    /// Whether the scene has a fluid.
    pub fn has_fluid(&self) -> bool {
        self.fluid != Fluid::default()
    }

    /// Whether the fluid consists of particles.
    pub fn has_particles(&self) -> bool {
        self.particles.is_some()
    }

    /// Whether there are blocks, fixed ones and those of rock masses included.
    pub fn has_blocks(&self) -> bool {
        !self.blocks.is_empty() || !self.rock_masses.is_empty()
    }

    /// Whether a probe follows the block of this name.
    pub fn probes_block(&self, name: &str) -> bool {
        let of =
            |place: &ProbePlace| matches!(place, ProbePlace::Block { block, .. } if block == name);
        self.probes.iter().any(|probe| of(&probe.place))
    }

    /// Shortest time between two outputs of a kind, s; `None` if the scene has no outputs at intervals.
    pub fn shortest_interval(&self) -> Option<f64> {
        let histories = self.output.histories.iter().map(|history| history.every);
        let slices = self.output.slices.iter().map(|slice| slice.every);
        let probes = self.probes.iter().map(|probe| probe.every);
        let views = self.views.iter().map(|view| view.every);
        let all = histories.chain(slices).chain(probes).chain(views);
        let all = all.chain([self.output.every]).flatten();
        all.min_by(f64::total_cmp)
    }

    /// Directory to which the paths of meshes are relative.
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// The scene format as a JSON schema.
    pub fn schema() -> schemars::Schema {
        schemars::schema_for!(Self)
    }

    /// Checks that the values of the scene are valid and consistent.
    ///
    /// # Errors
    /// Names the first invalid key, the reason and a remedy.
    pub fn check(&self) -> Result<()> {
        if let (Some(_), false) = (&self.particles, self.has_fluid()) {
            return refuse(
                "particles",
                "need a fluid; add [fluid] with its density and acceleration",
            );
        }
        if !self.has_fluid() && !self.has_blocks() {
            return refuse(
                "fluid",
                "the scene has neither a fluid nor blocks; add [fluid], [[blocks]] or \
                 [[rock_masses]]",
            );
        }
        if !self.has_particles() {
            self.check_no_particles()?;
        }
        self.check_domain()?;
        if let Some(particles) = &self.particles {
            self.check_particles(particles)?;
        }
        if self.has_fluid() {
            self.check_fluid()?;
            self.check_numerics()?;
        } else {
            self.check_dry()?;
        }
        self.check_coupling()?;
        self.check_solids()?;
        self.check_initial()?;
        self.check_run()?;
        self.check_statistics()?;
        self.check_output()?;
        self.check_probes()?;
        self.check_rock()?;
        self.check_materials()?;
        self.check_blocks()?;
        self.check_rock_masses()?;
        self.check_views()?;
        // Last, since the balance of flows needs the solids.
        if self.has_particles() {
            self.check_particle_boundaries()?;
            return self.check_boundaries();
        }
        self.check_boundaries()?;
        self.check_balance()
    }
}
