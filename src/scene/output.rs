//! What is written while the scene runs.

use schemars::JsonSchema;
use serde::Deserialize;

use super::Axis;

/// Files that a run writes.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Output {
    /// Time between VTI files, s. Default: only the last state.
    pub every: Option<f64>,
    /// Fields in the VTI files. Default velocity and pressure.
    pub fields: Vec<Field>,
    /// Pictures. Default none.
    pub slices: Vec<Slice>,
    /// Integrals over the fluid in time. Default none.
    pub histories: Vec<History>,
}

impl Default for Output {
    fn default() -> Self {
        Self {
            every: None,
            fields: vec![Field::Velocity, Field::Pressure],
            slices: Vec::new(),
            histories: Vec::new(),
        }
    }
}

/// A field on the cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Field {
    /// Velocity, m/s.
    Velocity,
    /// Pressure above the reference pressure, Pa.
    Pressure,
    /// Density, kg/m³.
    Density,
    /// Eddy viscosity, m²/s; needs `numerics.eddy_viscosity`.
    EddyViscosity,
    /// Q-criterion ½(|Ω|² − |S|²), 1/s².
    QCriterion,
    /// Vorticity, 1/s.
    Vorticity,
    /// 1 in solid cells, 0 in the fluid.
    Solid,
}

impl Field {
    /// Its name in scenes and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Velocity => "velocity",
            Self::Pressure => "pressure",
            Self::Density => "density",
            Self::EddyViscosity => "eddy_viscosity",
            Self::QCriterion => "q_criterion",
            Self::Vorticity => "vorticity",
            Self::Solid => "solid",
        }
    }

    /// 1 for a scalar, 3 for a vector.
    pub fn components(self) -> usize {
        match self {
            Self::Velocity | Self::Vorticity => 3,
            _ => 1,
        }
    }

    /// Its columns in a table: the name, for a vector with `_x`, `_y`, `_z`.
    pub fn columns(self) -> Vec<String> {
        match self.components() {
            1 => vec![self.name().into()],
            _ => Axis::ALL
                .map(|axis| format!("{}_{}", self.name(), axis.name()))
                .into(),
        }
    }
}

/// Scalar that a slice shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SliceField {
    /// Magnitude of the velocity, m/s.
    Speed,
    /// Pressure above the reference pressure, Pa.
    Pressure,
    /// Density, kg/m³.
    Density,
    /// Eddy viscosity, m²/s; needs `numerics.eddy_viscosity`.
    EddyViscosity,
    /// Q-criterion ½(|Ω|² − |S|²), 1/s².
    QCriterion,
    /// 1 in solid cells, 0 in the fluid.
    Solid,
}

/// A PNG picture of a plane of the domain.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Slice {
    /// Name of the files.
    pub name: String,
    /// Normal of the plane.
    pub axis: Axis,
    /// Where the plane cuts the axis, m. Default the middle of the domain.
    pub position: Option<f64>,
    /// What is shown.
    pub field: SliceField,
    /// Whether streamlines are drawn on top. Default false.
    #[serde(default)]
    pub streamlines: bool,
    /// Smallest and largest value of the colours, in the field's unit. Default those in the
    /// picture.
    pub range: Option<[f64; 2]>,
    /// Time between pictures, s. Default `output.every`.
    pub every: Option<f64>,
}

/// Curves over time, as CSV and PNG.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct History {
    /// The curves.
    pub quantities: Vec<Quantity>,
    /// Time between points, s. Default a 200th of the run.
    pub every: Option<f64>,
}

/// A number that sums up the whole fluid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// ∫ ½ρu² dV, J.
    KineticEnergy,
    /// ∫ ½ω² dV, m³/s².
    Enstrophy,
    /// ∫ ρ dV, kg.
    Mass,
    /// ∫ ρu_x dV, kg m/s.
    MomentumX,
    /// ∫ ρu_y dV, kg m/s.
    MomentumY,
    /// ∫ ρu_z dV, kg m/s.
    MomentumZ,
    /// Largest speed, m/s.
    MaxSpeed,
}
