//! Where the flow is measured.

use schemars::JsonSchema;
use serde::Deserialize;

use super::tagged::{need, refuse_others, through};
use super::{Axis, Direction, Field};

/// A measurement, written as CSV; the forces on a `block`, the level of a `gauge`, a `run_up` and the volume of water in a
/// `box` are drawn over time next to it, as PNG.
#[derive(Clone, Debug, PartialEq, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Probe {
    /// Name of the file.
    pub name: String,
    /// Where it measures.
    #[schemars(flatten)]
    pub place: ProbePlace,
    /// What it measures. Default velocity and pressure. A `gauge` always gives the level, a `run_up` its
    /// place, a `face` area, pressure and force, a `block` its position, velocity, rotation, spin and forces,
    /// its stress if it deforms, a `sensor` pressure and impulse, and no other fields.
    #[schemars(default)]
    pub fields: Vec<Field>,
    /// Time between measurements, s. Default: only at the end of the run.
    #[schemars(default)]
    pub every: Option<f64>,
}

/// Where a probe measures.
#[derive(Clone, Debug, PartialEq, JsonSchema)]
#[schemars(tag = "kind", rename_all = "snake_case")]
pub enum ProbePlace {
    /// One point, interpolated; among particles their mean, weighted by the kernel, and `NaN` where there is no water.
    Point {
        /// The point, m.
        at: [f64; 3],
    },
    /// Equally spaced points of a line, both ends included, interpolated, or by the kernel; `NaN` as for a point.
    Line {
        /// First point, m.
        from: [f64; 3],
        /// Last point, m.
        to: [f64; 3],
        /// Number of points, at least 2.
        count: u32,
    },
    /// All cells of a plane.
    Plane {
        /// Normal of the plane.
        axis: Axis,
        /// Where the plane cuts the axis, m.
        position: f64,
    },
    /// Mean, least and largest value over the fluid cells whose centres lie in a box, or over the particles in it,
    /// of these the volume too (m³); `NaN` where no particle is in it, and a volume of 0.
    Box {
        /// Lower corner, m.
        min: [f64; 3],
        /// Upper corner, m.
        max: [f64; 3],
    },
    /// A face of a static solid: the fluid cells in a box that have a solid cell behind them.
    /// Area, mean, least and largest pressure, and the force on the solid.
    Face {
        /// Lower corner of the box, m.
        min: [f64; 3],
        /// Upper corner of the box, m.
        max: [f64; 3],
        /// Outward normal of the solid's face: the solid cell lies against it.
        normal: Direction,
    },
    /// A block: its centroid (m) and velocity (m/s), its rotation since the start as the vector of
    /// its axis and angle (degrees, at most 180), its spin (rad/s), and the force (N) and torque (N m) of its
    /// contacts on it. In a fluid also the force (N) and torque (N m) of the flow on it, without
    /// buoyancy, and its buoyancy (N): those of the last exchange. Among particles the force has buoyancy in it, and that
    /// column is 0. With `coupling.lubrication` also `film_force` (N), that of films of fluid in thin gaps.
    Block {
        /// Name of the block; one of a row or of a rock mass has its number after it: `stone_3`.
        block: String,
        /// Whether to measure the loads of the fluid on each of its plane faces too: writes `NAME_faces.csv`, a
        /// row a face, with the numbers of its `part` and `face`, `area` and `wetted_area` (m²), mean `pressure`
        /// and `shear` stress (Pa), whether it is in a `joint` (another block, solid or wall within three cells
        /// over it), `joint_area` (m²) of that where it is closed and `joint_pressure` (Pa) there, that of its rim,
        /// `position` of its centroid (m), outward `normal`, `force` (N), `moment` about the centroid of
        /// the block (N m), and the vector of the shear stress; and `faces_*.vtp`. Adds to the table of the
        /// block `uplift_of_faces`, the force on faces that look down, against gravity (N), and
        /// `joint_pressure`, the mean over its joints (Pa), both with what is closed. Pressure is that of the fluid: above the
        /// hydrostatic one where the fluid's acceleration leaves gravity out. NaN stands where no fluid lies
        /// beside. Needs a fluid. Default false.
        #[schemars(default)]
        faces: bool,
        /// Whether to add to its table its factors of safety, `safety_sliding`, `safety_uplift` and
        /// `safety_toppling`, by limit equilibrium of weight, fluid, point loads, acceleration and its contacts, and to tell
        /// them in the summary of the run; `inf` where nothing drives it, `NaN` where it touches nothing. In closed joints they
        /// take the pressure of their rim in the lattice's fluid. Not of a block with a `guide`. Default false.
        #[schemars(default)]
        safety: bool,
    },
    /// The free surface of particles above a point: its height, m; `NaN` where no water is above the point.
    Gauge {
        /// The point, x and y, m.
        at: [f64; 2],
    },
    /// A sensor on a wall or a fixed block next to particles: the mean `pressure` on a square patch over the last time step
    /// (Pa), and its `impulse` since the start (Pa s), from which the mean over any time follows. Where there is no water
    /// both are of nothing, 0.
    Sensor {
        /// Centre of the patch, m.
        at: [f64; 3],
        /// Normal of the patch, into the water.
        normal: Direction,
        /// Edge of the patch, m. Default: the spacing of the particles.
        #[schemars(default)]
        size: Option<f64>,
    },
    /// The farthest of the particles in a box along a direction, drops aside: its place, m; `NaN` where there is none.
    RunUp {
        /// Lower corner of the box, m.
        min: [f64; 3],
        /// Upper corner of the box, m.
        max: [f64; 3],
        /// The direction.
        direction: Direction,
    },
}

impl ProbePlace {
    /// The points of a line, each with its distance from the first, m; none of another kind.
    pub fn stations(&self) -> Vec<(f64, [f64; 3])> {
        let Self::Line { from, to, count } = self else {
            return Vec::new();
        };
        let length = (0..3)
            .map(|axis| (to[axis] - from[axis]).powi(2))
            .sum::<f64>()
            .sqrt();
        let station = |n: u32| {
            let part = f64::from(n) / f64::from(count - 1);
            // Exact at both ends.
            let at = |axis: usize| from[axis] * (1.0 - part) + to[axis] * part;
            (part * length, [0, 1, 2].map(at))
        };
        (0..*count).map(station).collect()
    }
}

#[derive(Deserialize)]
#[serde(rename_all = "snake_case")]
enum Kind {
    Point,
    Line,
    Plane,
    Box,
    Face,
    Block,
    Gauge,
    Sensor,
    RunUp,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Flat {
    kind: Kind,
    name: String,
    fields: Option<Vec<Field>>,
    every: Option<f64>,
    at: Option<At>,
    from: Option<[f64; 3]>,
    to: Option<[f64; 3]>,
    count: Option<u32>,
    axis: Option<Axis>,
    position: Option<f64>,
    min: Option<[f64; 3]>,
    max: Option<[f64; 3]>,
    normal: Option<Direction>,
    direction: Option<Direction>,
    size: Option<f64>,
    block: Option<String>,
    faces: Option<bool>,
    safety: Option<bool>,
}

/// A point, or the foot of a column.
#[derive(Deserialize)]
#[serde(transparent)]
struct At(Vec<f64>);

impl At {
    fn point(self) -> Result<[f64; 3], String> {
        let count = self.0.len();
        self.0
            .try_into()
            .map_err(|_| format!("`at` has {count} numbers; a point has x, y and z"))
    }

    fn column(self) -> Result<[f64; 2], String> {
        let count = self.0.len();
        self.0
            .try_into()
            .map_err(|_| format!("`at` has {count} numbers; a gauge stands at x and y"))
    }
}

impl Flat {
    fn typed(self) -> Result<Probe, String> {
        let given = [
            ("at", self.at.is_some()),
            ("from", self.from.is_some()),
            ("to", self.to.is_some()),
            ("count", self.count.is_some()),
            ("axis", self.axis.is_some()),
            ("position", self.position.is_some()),
            ("min", self.min.is_some()),
            ("max", self.max.is_some()),
            ("normal", self.normal.is_some()),
            ("direction", self.direction.is_some()),
            ("size", self.size.is_some()),
            ("block", self.block.is_some()),
            ("faces", self.faces.is_some()),
            ("safety", self.safety.is_some()),
        ];
        let only = |kind, allowed: &[&str]| refuse_others(kind, allowed, &given);
        let fixed = |kind: &str, gives: &str| match self.fields {
            Some(_) => Err(format!(
                "a `{kind}` probe always gives {gives} and no fields; remove `fields`"
            )),
            None => Ok(()),
        };
        let place = match self.kind {
            Kind::Point => {
                only("point", &["at"])?;
                ProbePlace::Point {
                    at: need(self.at, "at", "point")?.point()?,
                }
            }
            Kind::Line => {
                only("line", &["from", "to", "count"])?;
                ProbePlace::Line {
                    from: need(self.from, "from", "line")?,
                    to: need(self.to, "to", "line")?,
                    count: need(self.count, "count", "line")?,
                }
            }
            Kind::Plane => {
                only("plane", &["axis", "position"])?;
                ProbePlace::Plane {
                    axis: need(self.axis, "axis", "plane")?,
                    position: need(self.position, "position", "plane")?,
                }
            }
            Kind::Box => {
                only("box", &["min", "max"])?;
                ProbePlace::Box {
                    min: need(self.min, "min", "box")?,
                    max: need(self.max, "max", "box")?,
                }
            }
            Kind::Face => {
                only("face", &["min", "max", "normal"])?;
                let useless = |field: &Field| *field != Field::Pressure;
                if self.fields.iter().flatten().any(useless) {
                    return Err(
                        "a `face` probe always gives area, pressure and force and no \
                                other fields; remove `fields`"
                            .into(),
                    );
                }
                ProbePlace::Face {
                    min: need(self.min, "min", "face")?,
                    max: need(self.max, "max", "face")?,
                    normal: need(self.normal, "normal", "face")?,
                }
            }
            Kind::Block => {
                only("block", &["block", "faces", "safety"])?;
                fixed(
                    "block",
                    "position, velocity, rotation, spin, force and torque",
                )?;
                ProbePlace::Block {
                    block: need(self.block, "block", "block")?,
                    faces: self.faces.unwrap_or_default(),
                    safety: self.safety.unwrap_or_default(),
                }
            }
            Kind::Gauge => {
                only("gauge", &["at"])?;
                fixed("gauge", "the level")?;
                ProbePlace::Gauge {
                    at: need(self.at, "at", "gauge")?.column()?,
                }
            }
            Kind::Sensor => {
                only("sensor", &["at", "normal", "size"])?;
                fixed("sensor", "pressure and impulse")?;
                ProbePlace::Sensor {
                    at: need(self.at, "at", "sensor")?.point()?,
                    normal: need(self.normal, "normal", "sensor")?,
                    size: self.size,
                }
            }
            Kind::RunUp => {
                only("run_up", &["min", "max", "direction"])?;
                fixed("run_up", "the place of the farthest particle")?;
                ProbePlace::RunUp {
                    min: need(self.min, "min", "run_up")?,
                    max: need(self.max, "max", "run_up")?,
                    direction: need(self.direction, "direction", "run_up")?,
                }
            }
        };
        Ok(Probe {
            name: self.name,
            place,
            fields: self
                .fields
                .unwrap_or_else(|| vec![Field::Velocity, Field::Pressure]),
            every: self.every,
        })
    }
}

through!(Flat => Probe);
