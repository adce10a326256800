//! What the user wrote, in SI, checked.
//!
//! A scene is a TOML file. Every table is a type of this module, every key a public field;
//! [`Scene::schema`] is the same as a JSON schema.

mod advice;
mod boundaries;
mod check;
mod domain;
mod face;
mod fluid;
mod initial;
mod numerics;
mod output;
mod parse;
mod probes;
mod run;
mod sample;
mod solids;
mod tagged;

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::Deserialize;

pub use advice::{Advice, SUGA_EXCESS, Warning};
pub use boundaries::{Boundaries, Boundary};
pub use domain::Domain;
pub use face::{Axis, Direction, Face};
pub use fluid::Fluid;
pub use initial::{Initial, InitialPressure};
pub use numerics::{Collision, EddyViscosity, Equilibrium, Numerics, Storage};
pub use output::{Field, History, Output, Quantity, Slice, SliceField};
pub use probes::{Probe, ProbePlace};
pub use run::Run;
pub use sample::{BodyForce, InitialFields};
pub use solids::{Shape, Solid};

/// A flow to compute, in SI units.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Title. Default the name of the file without its extension.
    #[serde(default)]
    pub title: String,
    /// The box that is computed.
    pub domain: Domain,
    /// What flows.
    pub fluid: Fluid,
    /// How it is computed. Default: see each key.
    #[serde(default)]
    pub numerics: Numerics,
    /// The faces of the domain. Default: all periodic.
    #[serde(default)]
    pub boundaries: Boundaries,
    /// Static solids. Default none.
    #[serde(default)]
    pub solids: Vec<Solid>,
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

    /// Directory to which the paths of meshes are relative.
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// The format as a JSON schema.
    pub fn schema() -> schemars::Schema {
        schemars::schema_for!(Self)
    }
}
