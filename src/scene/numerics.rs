//! Numerical settings of the flow.

use schemars::JsonSchema;
use serde::Deserialize;

use super::Scene;
use super::rules::{positive, refuse};
use crate::error::Result;

/// Collision, precision and time step.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[non_exhaustive]
pub struct Numerics {
    /// Collision operator. Default `hermite`.
    pub collision: Collision,
    /// Equilibrium. Default `product`.
    pub equilibrium: Equilibrium,
    /// Eddy viscosity. Default `none`.
    pub eddy_viscosity: EddyViscosity,
    /// C_w of Nicoud & Ducros (1999), no unit; 0.325 to 0.6 in the literature. Default 0.5.
    pub wale_constant: f64,
    /// Steps from one evaluation of the eddy viscosity to the next: 1 or 2. With 2, odd steps use that of the step
    /// before. Default 2.
    pub wale_interval: u32,
    /// Law of the wall for the friction of walls and solids at rest, and of blocks. It needs `eddy_viscosity = "wale"`. Default
    /// `none`.
    pub wall_model: WallModel,
    /// Whether it also acts on faces of blocks at an angle to the grid, and on edges; with `solid_operator = "holdych"` and
    /// `storage = "f32"`. Default `true` where that is so.
    pub sloping_faces: Option<bool>,
    /// Precision of the stored populations. Default `f32`.
    pub storage: Storage,
    /// Cells per invocation of a kernel: 1, 2 (`f16` only) or 4. Default: chosen
    /// for the adapter.
    pub lanes: Option<u32>,
    /// Time step, s. Default: from `mach`.
    pub time_step: Option<f64>,
    /// Mach number of the lattice at the velocity scale, from which the time step follows:
    /// errors of compressibility grow with its square. Default 0.1, unless `time_step` is given.
    pub mach: Option<f64>,
    /// Largest expected speed, m/s. Default: the largest one on the boundaries, during a run with a `duration`, otherwise at the time 0,
    /// and in the initial state.
    pub velocity_scale: Option<f64>,
    /// Magic parameter Λ next to bounce-back walls, no unit. Default 3/16, for which a wall of a channel lies half a
    /// cell beyond the last cell centre at any viscosity.
    pub wall_lambda: f64,
    /// One magic parameter Λ everywhere, for laminar scenes, no unit. Default: none.
    pub lambda: Option<f64>,
    /// Smallest relaxation rate that Λ may give to the odd moments, for stability at low
    /// viscosity; not applied to `lambda`. No unit. Default 0.8 from τ = 0.52 on; from there up to 1.6 next to walls and
    /// 1.2 next to blocks and exact terrain at τ = 0.5.
    pub odd_rate_floor: Option<f64>,
    /// Collision operator of the solid in partially saturated cells. Default `holdych`.
    pub solid_operator: SolidOperator,
    /// Weight of this operator in cells that blocks fill in part. Default: `exact` with `holdych`, otherwise `standard`.
    pub solid_weight: Option<SolidWeight>,
    /// Magic parameter Λ in cells with a block and next to them, no unit. Default 1/10, for which the drag depends
    /// least on the viscosity.
    pub solid_lambda: f64,
}

impl Default for Numerics {
    fn default() -> Self {
        Self {
            collision: Collision::default(),
            equilibrium: Equilibrium::default(),
            eddy_viscosity: EddyViscosity::default(),
            wale_constant: 0.5,
            wale_interval: 2,
            wall_model: WallModel::default(),
            sloping_faces: None,
            storage: Storage::default(),
            lanes: None,
            time_step: None,
            mach: None,
            velocity_scale: None,
            wall_lambda: 3.0 / 16.0,
            lambda: None,
            odd_rate_floor: None,
            solid_operator: SolidOperator::default(),
            solid_weight: None,
            solid_lambda: 0.1,
        }
    }
}

impl Numerics {
    /// Default Mach number: errors of compressibility stay near 1 %.
    pub const DEFAULT_MACH: f64 = 0.1;

    fn can_have_sloping_faces(&self) -> bool {
        self.wall_model != WallModel::None
            && self.solid_operator == SolidOperator::Holdych
            && self.storage == Storage::F32
    }

    /// Whether the wall model acts on faces of blocks at an angle to the grid, and on edges.
    pub fn has_sloping_faces(&self) -> bool {
        self.sloping_faces
            .unwrap_or_else(|| self.can_have_sloping_faces())
    }
}

/// Collision operator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Collision {
    /// Multiple relaxation times in Hermite moments; stable at rest at every viscosity.
    #[default]
    Hermite,
    /// Multiple relaxation times of Suga et al. (2015), for 4e-4 ≤ τ − ½ ≤ 0.059.
    Suga,
    /// One relaxation time.
    Bgk,
}

/// Operator of the solid in partially saturated cells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SolidOperator {
    /// Holdych (2003): the smallest error of the drag.
    #[default]
    Holdych,
    /// Noble & Torczynski (1998), as printed in Gardner & Sitar (2018).
    Noble,
    /// The second form of Noble & Torczynski (1998).
    Superposition,
}

/// Weight of the solid operator in partially saturated cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SolidWeight {
    /// Plane surfaces act at their true position at every viscosity; with `solid_operator = "holdych"`.
    Exact,
    /// B of Noble & Torczynski (1998), as in Gardner & Sitar (2018).
    Standard,
}

/// Equilibrium distribution.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Equilibrium {
    /// Full product form (Hermite order 6): Galilean invariant in shear.
    #[default]
    Product,
    /// Second order in the velocity.
    SecondOrder,
}

/// Subgrid-scale turbulence model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum EddyViscosity {
    /// No model.
    #[default]
    None,
    /// WALE (Nicoud & Ducros 1999).
    Wale,
}

/// Law of the wall for the friction of walls at rest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WallModel {
    /// None: no slip.
    #[default]
    None,
    /// Two power laws (Werner & Wengle 1991), for y⁺ of the fifth cell up to 2500.
    WernerWengle,
    /// Reichardt (1951), for any y⁺.
    Reichardt,
}

/// Precision of the stored populations; arithmetic is always f32.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Storage {
    /// 32 bits per population.
    #[default]
    F32,
    /// 16 bits per population: half the memory and traffic, relative rounding 1e-3.
    F16,
}

impl Scene {
    pub(super) fn check_numerics(&self) -> Result<()> {
        let n = &self.numerics;
        if n.time_step.is_some() && n.mach.is_some() {
            return refuse(
                "numerics.mach",
                "`time_step` and `mach` both fix the time step; keep one of them",
            );
        }
        let optional = [
            ("time_step", n.time_step, "s"),
            ("mach", n.mach, ""),
            ("velocity_scale", n.velocity_scale, "m/s"),
            ("lambda", n.lambda, ""),
            ("wall_lambda", Some(n.wall_lambda), ""),
            ("solid_lambda", Some(n.solid_lambda), ""),
        ];
        for (key, value, unit) in optional {
            if let Some(value) = value {
                positive(format!("numerics.{key}"), value, unit)?;
            }
        }
        if !(n.wale_constant.is_finite() && n.wale_constant >= 0.0) {
            return refuse(
                "numerics.wale_constant",
                format!("is {}; give a number from 0, such as 0.5", n.wale_constant),
            );
        }
        if !matches!(n.wale_interval, 1 | 2) {
            return refuse(
                "numerics.wale_interval",
                format!("is {}; give 1 or 2 steps", n.wale_interval),
            );
        }
        // A relaxation rate of 2 or more amplifies.
        if let Some(floor) = n.odd_rate_floor
            && !(0.0..2.0).contains(&floor)
        {
            return refuse(
                "numerics.odd_rate_floor",
                format!("is {floor}; a rate lies from 0 to below 2, such as 0.8"),
            );
        }
        if n.lambda.is_some() && n.collision != Collision::Hermite {
            return refuse(
                "numerics.lambda",
                "only `collision = \"hermite\"` has a magic parameter to set; remove `lambda` or \
                 choose hermite",
            );
        }
        if n.solid_weight == Some(SolidWeight::Exact) && n.solid_operator != SolidOperator::Holdych
        {
            return refuse(
                "numerics.solid_weight",
                "`exact` belongs to solid_operator = \"holdych\"; leave `solid_weight` out, or use \"standard\"",
            );
        }
        if n.wall_model != WallModel::None && n.eddy_viscosity == EddyViscosity::None {
            return refuse(
                "numerics.wall_model",
                "needs eddy_viscosity = \"wale\": walls whose friction is modelled have turbulent water before them; set it, \
                 or leave `wall_model` out",
            );
        }
        if n.sloping_faces == Some(true) && !n.can_have_sloping_faces() {
            return refuse(
                "numerics.sloping_faces",
                "needs a `wall_model`, solid_operator = \"holdych\" and storage = \"f32\"; set them, or leave it out",
            );
        }
        self.check_lanes()
    }

    /// Checks the roughness of a wall or solid, m.
    pub(super) fn check_roughness(&self, key: &str, roughness: f64) -> Result<()> {
        if roughness == 0.0 {
            return Ok(());
        }
        if self.numerics.wall_model == WallModel::None {
            return refuse(
                key,
                "walls without a wall model are smooth; set numerics.wall_model, or remove `roughness`",
            );
        }
        positive(key, roughness, "m")
    }

    fn check_lanes(&self) -> Result<()> {
        let key = "numerics.lanes";
        match (self.numerics.lanes, self.numerics.storage) {
            (None | Some(4), _) | (Some(1), Storage::F32) | (Some(2), Storage::F16) => Ok(()),
            (Some(1), Storage::F16) => refuse(
                key,
                "storage f16 packs two cells in a word and so needs lanes = 2 or 4; change \
                 `lanes`, leave it out, or use storage = \"f32\"",
            ),
            (Some(2), Storage::F32) => refuse(
                key,
                "lanes = 2 belongs to storage = \"f16\"; use lanes = 1 or 4, or leave it out",
            ),
            (Some(lanes), _) => refuse(key, format!("is {lanes}; possible are 1, 2 and 4")),
        }
    }
}
