//! What happens on the faces of the domain.

use schemars::JsonSchema;
use serde::Deserialize;

use super::Face;
use super::tagged::{need, refuse_others, through};
use crate::formula::Formula;

/// The conditions on the six faces.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Boundaries {
    /// Face at the smallest x. Default periodic.
    pub x_min: Boundary,
    /// Face at the largest x. Default periodic.
    pub x_max: Boundary,
    /// Face at the smallest y. Default periodic.
    pub y_min: Boundary,
    /// Face at the largest y. Default periodic.
    pub y_max: Boundary,
    /// Face at the smallest z. Default periodic.
    pub z_min: Boundary,
    /// Face at the largest z. Default periodic.
    pub z_max: Boundary,
}

impl Boundaries {
    /// The condition on `face`.
    pub fn face(&self, face: Face) -> &Boundary {
        match face {
            Face::XMin => &self.x_min,
            Face::XMax => &self.x_max,
            Face::YMin => &self.y_min,
            Face::YMax => &self.y_max,
            Face::ZMin => &self.z_min,
            Face::ZMax => &self.z_max,
        }
    }

    /// All faces with their conditions.
    pub fn iter(&self) -> impl Iterator<Item = (Face, &Boundary)> {
        Face::ALL.into_iter().map(|face| (face, self.face(face)))
    }
}

/// Condition on a face of the domain.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema)]
#[schemars(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Boundary {
    /// What leaves here enters at the opposite face, which must be periodic too.
    #[default]
    Periodic,
    /// No slip; particles without viscosity slide along it.
    Wall {
        /// Velocity of the wall, m/s; its component normal to the face is 0. Default at rest.
        #[schemars(default)]
        velocity: [f64; 3],
    },
    /// No flow through the face and no friction on it.
    FreeSlip,
    /// The velocity is given.
    Velocity {
        /// Velocity, m/s: three numbers or formulas of x, y, z, t.
        velocity: [Formula; 3],
    },
    /// The pressure is given.
    Pressure {
        /// Pressure above the reference pressure, Pa. Default 0.
        #[schemars(default)]
        pressure: f64,
        /// Whether the pressure is held firmly. Default false: it is held on average, and waves
        /// and vortices leave.
        #[schemars(default)]
        reflecting: bool,
    },
    /// Particles that get here are lost, and counted. A lattice has no such face.
    Open,
}

impl Boundary {
    /// Its `kind` in a scene.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Periodic => "periodic",
            Self::Wall { .. } => "wall",
            Self::FreeSlip => "free_slip",
            Self::Velocity { .. } => "velocity",
            Self::Pressure { .. } => "pressure",
            Self::Open => "open",
        }
    }

    /// Whether fluid can pass, other than periodically.
    pub fn is_open(&self) -> bool {
        matches!(
            self,
            Self::Velocity { .. } | Self::Pressure { .. } | Self::Open
        )
    }
}

#[derive(Deserialize)]
#[serde(rename_all = "snake_case")]
enum Kind {
    Periodic,
    Wall,
    FreeSlip,
    Velocity,
    Pressure,
    Open,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Flat {
    kind: Kind,
    velocity: Option<[Formula; 3]>,
    pressure: Option<f64>,
    reflecting: Option<bool>,
}

impl Flat {
    fn typed(self) -> Result<Boundary, String> {
        let given = [
            ("velocity", self.velocity.is_some()),
            ("pressure", self.pressure.is_some()),
            ("reflecting", self.reflecting.is_some()),
        ];
        let only = |kind, allowed: &[&str]| refuse_others(kind, allowed, &given);
        Ok(match self.kind {
            Kind::Periodic => {
                only("periodic", &[])?;
                Boundary::Periodic
            }
            Kind::Wall => {
                only("wall", &["velocity"])?;
                let velocity = self.velocity.unwrap_or_default();
                let [Some(u), Some(v), Some(w)] = velocity.map(|f| f.constant()) else {
                    return Err("the velocity of a wall is three numbers, not formulas".into());
                };
                Boundary::Wall {
                    velocity: [u, v, w],
                }
            }
            Kind::FreeSlip => {
                only("free_slip", &[])?;
                Boundary::FreeSlip
            }
            Kind::Velocity => {
                only("velocity", &["velocity"])?;
                Boundary::Velocity {
                    velocity: need(self.velocity, "velocity", "velocity")?,
                }
            }
            Kind::Pressure => {
                only("pressure", &["pressure", "reflecting"])?;
                Boundary::Pressure {
                    pressure: self.pressure.unwrap_or(0.0),
                    reflecting: self.reflecting.unwrap_or(false),
                }
            }
            Kind::Open => {
                only("open", &[])?;
                Boundary::Open
            }
        })
    }
}

through!(Flat => Boundary);
