//! Output of a run.

use schemars::JsonSchema;
use serde::Deserialize;

use super::rules::{distinct, finite, inside, interval, names, refuse};
use super::{Axis, EddyViscosity, Scene};
use crate::error::Result;

/// Files that a run writes.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[non_exhaustive]
pub struct Output {
    /// Time between VTI files of the fluid, or VTP files of its particles, and VTU files of the blocks, s. Default: only the last
    /// state.
    pub every: Option<f64>,
    /// Fields in the files of the fluid; particles have velocity, pressure and density. Default velocity and
    /// pressure.
    pub fields: Vec<Field>,
    /// Pictures. Default none.
    pub slices: Vec<Slice>,
    /// Integrals over the fluid and the blocks as time histories. Default none.
    pub histories: Vec<History>,
    /// Whether the contacts of the blocks are written too, as a cloud of points with force, normal
    /// and overlap. Default true.
    pub contacts: bool,
}

impl Default for Output {
    fn default() -> Self {
        Self {
            every: None,
            fields: vec![Field::Velocity, Field::Pressure],
            slices: Vec::new(),
            histories: Vec::new(),
            contacts: true,
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
    /// Solid fraction: 1 in solid cells and in cells whose centres a block covers, 0 in the fluid, and in between in cells cut
    /// by an exact surface.
    Solid,
    /// Mean of the velocity over time, m/s; this field and those below need `statistics`, and are NaN before its first sample.
    MeanVelocity,
    /// Mean of the pressure over time, Pa.
    MeanPressure,
    /// Root mean square of the fluctuations of the pressure, Pa.
    PressureRms,
    /// Mean products of the fluctuations of the velocity, xx, yy, zz, xy, yz and xz, m²/s².
    ReynoldsStress,
    /// Half the trace of the Reynolds stress, m²/s².
    TurbulentKineticEnergy,
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
            Self::MeanVelocity => "mean_velocity",
            Self::MeanPressure => "mean_pressure",
            Self::PressureRms => "pressure_rms",
            Self::ReynoldsStress => "reynolds_stress",
            Self::TurbulentKineticEnergy => "turbulent_kinetic_energy",
        }
    }

    /// 1 for a scalar, 3 for a vector, 6 for a symmetric tensor.
    pub fn components(self) -> usize {
        match self {
            Self::Velocity | Self::Vorticity | Self::MeanVelocity => 3,
            Self::ReynoldsStress => 6,
            _ => 1,
        }
    }

    /// Its columns in a table: the name, for a vector with `_x`, `_y`, `_z`, for a tensor with `_xx` to `_xz`.
    pub fn columns(self) -> Vec<String> {
        let with = |parts: &[&str]| {
            parts
                .iter()
                .map(|part| format!("{}_{part}", self.name()))
                .collect()
        };
        match self.components() {
            1 => vec![self.name().into()],
            3 => with(&["x", "y", "z"]),
            _ => with(&["xx", "yy", "zz", "xy", "yz", "xz"]),
        }
    }

    /// Whether it is a time statistic.
    pub fn is_statistical(self) -> bool {
        matches!(
            self,
            Self::MeanVelocity
                | Self::MeanPressure
                | Self::PressureRms
                | Self::ReynoldsStress
                | Self::TurbulentKineticEnergy
        )
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
    /// Solid fraction: 1 in solid cells and in cells whose centres a block covers, 0 in the fluid, and in between in cells cut
    /// by an exact surface.
    Solid,
    /// Magnitude of the mean velocity, m/s; this field and those below need `statistics`.
    MeanSpeed,
    /// Mean of the pressure, Pa.
    MeanPressure,
    /// Root mean square of the fluctuations of the pressure, Pa.
    PressureRms,
    /// Half the mean square of the fluctuations of the velocity, m²/s².
    TurbulentKineticEnergy,
}

impl SliceField {
    /// The field from which it is computed.
    pub fn field(self) -> Field {
        match self {
            Self::Speed => Field::Velocity,
            Self::Pressure => Field::Pressure,
            Self::Density => Field::Density,
            Self::EddyViscosity => Field::EddyViscosity,
            Self::QCriterion => Field::QCriterion,
            Self::Solid => Field::Solid,
            Self::MeanSpeed => Field::MeanVelocity,
            Self::MeanPressure => Field::MeanPressure,
            Self::PressureRms => Field::PressureRms,
            Self::TurbulentKineticEnergy => Field::TurbulentKineticEnergy,
        }
    }
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

/// Time histories, as CSV and PNG.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct History {
    /// The curves.
    pub quantities: Vec<Quantity>,
    /// Time between points, s. Default a 200th of the run.
    pub every: Option<f64>,
}

impl History {
    /// Name, without extension, of the files of the history with this number: `history`, `history_2`, ….
    pub fn file_name(number: usize) -> String {
        match number {
            0 => "history".into(),
            _ => format!("history_{}", number + 1),
        }
    }
}

/// An integral over the whole fluid, or over all blocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// ∫ ½ρu² dV, J.
    KineticEnergy,
    /// ∫ ½ω² dV, m³/s².
    Enstrophy,
    /// ∫ ρ dV, kg, outside of static solids, blocks included.
    Mass,
    /// ∫ ρu_x dV, kg m/s, over all cells, including those inside blocks, where it oscillates from step to step. To measure the
    /// flow past blocks, use a probe on a plane.
    MomentumX,
    /// ∫ ρu_y dV, kg m/s; as `momentum_x`.
    MomentumY,
    /// ∫ ρu_z dV, kg m/s; as `momentum_x`.
    MomentumZ,
    /// Largest speed of the fluid, m/s.
    MaxSpeed,
    /// Mean velocity along the axis of `fluid.bulk_velocity`, of the fluid and of the blocks in it, m/s.
    BulkVelocity,
    /// Body force per mass that maintains `fluid.bulk_velocity`, along its axis, in addition to `fluid.acceleration`, m/s²: the
    /// slope of the energy line is this over g.
    DrivingAcceleration,
    /// Potential energy of particles in their gravity, relative to the time 0, J; along a periodic axis by the distance that they
    /// have moved.
    PotentialEnergy,
    /// Energy of compression of particles, Σ m ∫ p/ρ² dρ, relative to the time 0, J.
    CompressionEnergy,
    /// Kinetic, potential and compression energy of the particles that have left, at the time they left, relative to the origin
    /// of the coordinates, J.
    EscapedEnergy,
    /// Work of free and driven blocks on particles, J.
    BodyWork,
    /// Work of the forces that expel particles from fixed solids and blocks, J.
    PushWork,
    /// Work of the boundary particles on fluid particles, minus the work of their walls and blocks: the error of this boundary
    /// condition, J.
    DummyWork,
    /// Work done on particles, minus their energy and the energy of those that left: the energy dissipated by viscosity and
    /// diffusion, including the numerical error, J.
    DissipatedEnergy,
    /// Energy that blocks have lost in joints too narrow for particles, J.
    JointWork,
    /// Energy that free and driven blocks have lost to particles and in joints: `body_work` plus `joint_work`, up to the error
    /// of the alternating advance of blocks and water, J.
    LostToWater,
    /// Kinetic energy of the blocks, including rotation, J.
    BlockKineticEnergy,
    /// Potential energy of the blocks in gravity, relative to the time 0, J.
    BlockPotentialEnergy,
    /// Strain energy of the deformable blocks, J, from their state at the start: with an `initial_stress` it may become negative.
    StrainEnergy,
    /// Energy in the springs of the current contacts of the blocks, J: the work done on them since the contacts began. Negative
    /// if the area of a contact grew under compression, so that its springs returned more energy than they stored: see
    /// `contact_loss`.
    ContactEnergy,
    /// Energy dissipated by friction, J.
    FrictionWork,
    /// Energy dissipated by contact damping, mass damping and films of fluid, J.
    DampingWork,
    /// Energy in the springs of contacts when these ended, J: energy lost in contacts, or gained if it is negative. The
    /// springs conserve energy only while the area of their contact is constant; this is the error of the contact law.
    ContactLoss,
    /// Energy added to the blocks by driven blocks and external loads, J; what blocks give to free water is `lost_to_water`.
    OutsideWork,
    /// Relative error of the energy balance of the blocks, no unit: the sum of `block_kinetic_energy`,
    /// `block_potential_energy`, `strain_energy`, `contact_energy`, `friction_work`, `damping_work` and `contact_loss`, minus
    /// `outside_work`. It is the error of the time integration; that of the contact law is `contact_loss`.
    EnergyError,
    /// Number of contacts of blocks.
    Contacts,
    /// Number of awake blocks: free ones that are not asleep, and driven ones.
    AwakeBlocks,
    /// Largest speed of a block's centroid, m/s.
    BlockMaxSpeed,
    /// Largest von Mises stress of a deformable block, Pa.
    MaxVonMises,
}

impl Quantity {
    /// Its name in scenes and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::KineticEnergy => "kinetic_energy",
            Self::Enstrophy => "enstrophy",
            Self::Mass => "mass",
            Self::MomentumX => "momentum_x",
            Self::MomentumY => "momentum_y",
            Self::MomentumZ => "momentum_z",
            Self::MaxSpeed => "max_speed",
            Self::BulkVelocity => "bulk_velocity",
            Self::DrivingAcceleration => "driving_acceleration",
            Self::PotentialEnergy => "potential_energy",
            Self::CompressionEnergy => "compression_energy",
            Self::EscapedEnergy => "escaped_energy",
            Self::BodyWork => "body_work",
            Self::PushWork => "push_work",
            Self::DummyWork => "dummy_work",
            Self::DissipatedEnergy => "dissipated_energy",
            Self::JointWork => "joint_work",
            Self::LostToWater => "lost_to_water",
            Self::BlockKineticEnergy => "block_kinetic_energy",
            Self::BlockPotentialEnergy => "block_potential_energy",
            Self::StrainEnergy => "strain_energy",
            Self::ContactEnergy => "contact_energy",
            Self::FrictionWork => "friction_work",
            Self::DampingWork => "damping_work",
            Self::ContactLoss => "contact_loss",
            Self::OutsideWork => "outside_work",
            Self::EnergyError => "energy_error",
            Self::Contacts => "contacts",
            Self::AwakeBlocks => "awake_blocks",
            Self::BlockMaxSpeed => "block_max_speed",
            Self::MaxVonMises => "max_von_mises",
        }
    }

    /// Whether it is a quantity of the blocks, not of the fluid.
    pub fn is_of_blocks(self) -> bool {
        use Quantity::*;
        !self.is_of_particles()
            && !matches!(
                self,
                KineticEnergy
                    | Enstrophy
                    | Mass
                    | MomentumX
                    | MomentumY
                    | MomentumZ
                    | MaxSpeed
                    | BulkVelocity
                    | DrivingAcceleration
            )
    }

    /// Whether only a fluid of particles has it.
    pub fn is_of_particles(self) -> bool {
        use Quantity::*;
        matches!(
            self,
            PotentialEnergy
                | CompressionEnergy
                | EscapedEnergy
                | BodyWork
                | PushWork
                | DummyWork
                | DissipatedEnergy
                | JointWork
                | LostToWater
        )
    }
}

impl Scene {
    pub(super) fn check_output(&self) -> Result<()> {
        let output = &self.output;
        interval("output.every", output.every)?;
        distinct("output.fields", &output.fields)?;
        self.check_eddy(
            "output.fields",
            output.fields.contains(&Field::EddyViscosity),
        )?;
        self.check_statistical("output.fields", &output.fields)?;
        let named = output.slices.iter().map(|slice| slice.name.as_str());
        names("output.slices", named.enumerate())?;
        for (index, slice) in output.slices.iter().enumerate() {
            self.check_slice(&format!("output.slices[{index}]"), slice)?;
        }
        for (index, history) in output.histories.iter().enumerate() {
            let key = format!("output.histories[{index}]");
            distinct(&format!("{key}.quantities"), &history.quantities)?;
            interval(format!("{key}.every"), history.every)?;
        }
        let of_blocks = |quantity: &Quantity| quantity.is_of_blocks() && !self.has_blocks();
        self.refuse_quantities(of_blocks, |name| {
            format!("{name} is of blocks, and there are none; leave it out")
        })
    }

    /// Refuses the first quantity of a history that is `wrong`, with the `message` for its name.
    pub(super) fn refuse_quantities(
        &self,
        wrong: impl Fn(&Quantity) -> bool,
        message: impl Fn(&str) -> String,
    ) -> Result<()> {
        for (index, history) in self.output.histories.iter().enumerate() {
            if let Some(quantity) = history.quantities.iter().find(|one| wrong(one)) {
                let key = format!("output.histories[{index}].quantities");
                return refuse(key, message(quantity.name()));
            }
        }
        Ok(())
    }

    fn check_slice(&self, key: &str, slice: &Slice) -> Result<()> {
        interval(format!("{key}.every"), slice.every)?;
        self.check_plane(key, slice.axis, slice.position, slice.field, slice.range)
    }

    /// Checks that a plane of the domain can be shown.
    pub(super) fn check_plane(
        &self,
        key: &str,
        axis: Axis,
        position: Option<f64>,
        field: SliceField,
        range: Option<[f64; 2]>,
    ) -> Result<()> {
        self.check_eddy(&format!("{key}.field"), field == SliceField::EddyViscosity)?;
        self.check_statistical(&format!("{key}.field"), &[field.field()])?;
        if let Some(range) = range {
            finite(format!("{key}.range"), &range)?;
            if range[0] >= range[1] {
                return refuse(
                    format!("{key}.range"),
                    format!(
                        "reaches from {} to {}; the first must be the smaller",
                        range[0], range[1]
                    ),
                );
            }
        }
        let mut point = self.domain.middle();
        if let Some(position) = position {
            point[axis.index()] = position;
        }
        inside(format!("{key}.position"), &self.domain, point)
    }

    /// Checks that the eddy viscosity is requested only with a model of it.
    pub(super) fn check_eddy(&self, key: &str, wanted: bool) -> Result<()> {
        if wanted && self.numerics.eddy_viscosity == EddyViscosity::None {
            return refuse(
                key,
                "there is no eddy_viscosity in this scene; set numerics.eddy_viscosity = \
                 \"wale\" or leave the field out",
            );
        }
        Ok(())
    }
}
