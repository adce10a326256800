//! Probes: measurements of the flow and of blocks.

use glam::DVec3;
use schemars::JsonSchema;
use serde::Deserialize;
use toml::de::DeTable;

use super::rules::{distinct, inside, interval, names, ordered, positive, refuse};
use super::tagged::Kind;
use super::{Axis, Direction, Field, History, Scene, WallModel};
use crate::error::Result;

/// Most points of a line.
const MOST_POINTS: u32 = 1_000_000;

/// A measurement, written as CSV; the forces on a `block`, the level of a `gauge`, a `run_up` and the volume of water in a
/// `box` are also plotted over time, as PNG.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    /// Name of the file.
    pub name: String,
    /// Where it measures.
    #[serde(rename = "kind")]
    #[schemars(flatten)]
    pub place: ProbePlace,
    /// Fields that it measures. Default velocity and pressure. Some kinds have fixed columns and no other fields: a `gauge` the
    /// level, a `run_up` its position, a `face` area, pressure and force, a `block` its position, velocity, rotation, spin and
    /// forces, and its stress if it deforms, a `sensor` pressure and impulse.
    #[serde(default = "usual_fields")]
    #[schemars(default = "Vec::<Field>::new")]
    pub fields: Vec<Field>,
    /// Time between measurements, s. Default: only at the end of the run. With `statistics`, these are its samples.
    #[serde(default)]
    pub every: Option<f64>,
}

/// Where a probe measures.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(tag = "kind")]
pub enum ProbePlace {
    /// One point, interpolated; in particles the plane that fits those around it best, and `NaN` where there
    /// is no water.
    Point {
        /// The point, m.
        at: [f64; 3],
    },
    /// Equally spaced points of a line, both ends included, each measured as a point; `NaN` as for a point.
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
    /// Mean, smallest and largest value over the fluid cells whose centres lie in a box. For particles, over the particles in
    /// the box, and also their volume (m³); if there are none, the values are `NaN` and the volume is 0.
    Box {
        /// Lower corner, m.
        min: [f64; 3],
        /// Upper corner, m.
        max: [f64; 3],
    },
    /// A face of a static solid: the fluid cells in a box that have a solid cell behind them. Area, mean, smallest
    /// and largest pressure, and the force on the solid.
    Face {
        /// Lower corner of the box, m.
        min: [f64; 3],
        /// Upper corner of the box, m.
        max: [f64; 3],
        /// Outward normal of the solid's face; the solid cell is behind the fluid cell, against this normal.
        normal: Direction,
    },
    /// A block: its centroid (m) and velocity (m/s), its rotation since the start as the vector of its axis and angle (degrees,
    /// at most 180), its spin (rad/s), and the force (N) and torque (N m) of its contacts on it. In a fluid also the force (N)
    /// and torque (N m) of the flow on it, without buoyancy, and its buoyancy (N), all at the last exchange. In particles the
    /// force includes buoyancy, and the column of the buoyancy is 0. With `coupling.lubrication` also `film_force` (N), the
    /// force of films of fluid in thin gaps.
    Block {
        /// Name of the block; blocks of a row or of a rock mass have a number appended: `stone_3`.
        block: String,
        /// Whether to measure the loads of the fluid on each of its plane faces too. Writes `NAME_faces.csv`, one row per face,
        /// with the numbers of its `part` and `face`, `area` and `wetted_area` (m²), mean `pressure` and `shear` stress (Pa),
        /// whether it is in a `joint` (another block, solid or wall within three cells of it), `joint_area` (m²) of the closed
        /// part of the joint and `joint_pressure` (Pa) there, taken from its rim, `position` of its centroid (m), outward
        /// `normal`, `force` (N), `moment` about the centroid of the block (N m), and the vector of the shear stress; and
        /// `faces_*.vtp`. Adds two columns to the table of the block: `uplift_of_faces`, the force on faces that look down,
        /// against gravity (N), and `joint_pressure`, the mean over its joints (Pa), both including closed joints. Pressures
        /// are those of the fluid: relative to the hydrostatic pressure if the acceleration of the fluid leaves gravity out.
        /// Values are NaN where a face has no fluid next to it. Needs a fluid. Default false.
        #[serde(default)]
        faces: bool,
        /// Whether to add to its table its factors of safety, `safety_sliding`, `safety_uplift` and `safety_toppling`, by limit
        /// equilibrium of weight, fluid, point loads, acceleration and its contacts, and to report them in the summary of the
        /// run; `inf` if nothing drives it, `NaN` if it touches nothing. In closed joints they use the pressure of the rim in
        /// the fluid of the lattice. Not for a block with a `guide`. Default false.
        #[serde(default)]
        safety: bool,
    },
    /// The free surface of particles above a point: its height, m; `NaN` where no water is above the point.
    Gauge {
        /// The point, x and y, m.
        at: [f64; 2],
    },
    /// A sensor on a wall or a fixed block next to particles: the mean `pressure` on a square patch over the last time step
    /// (Pa), and its `impulse` since the start (Pa s), from which the mean over any time follows. Both are 0 where there is no
    /// water. Parts of the patch in fixed blocks or outside the domain do not count.
    Sensor {
        /// Centre of the patch, m.
        at: [f64; 3],
        /// Normal of the patch, into the water.
        normal: Direction,
        /// Edge of the patch, m. Default: the spacing of the particles.
        #[serde(default)]
        size: Option<f64>,
    },
    /// Position along a direction of the farthest particle in a box, m, without drops; `NaN` if there is none.
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
    pub(super) const KINDS: &[Kind] = &[
        ("point", "at", ""),
        ("line", "from to count", ""),
        ("plane", "axis position", ""),
        ("box", "min max", ""),
        ("face", "min max normal", ""),
        ("block", "block", "faces safety"),
        ("gauge", "at", ""),
        ("sensor", "at normal", "size"),
        ("run_up", "min max direction", ""),
    ];

    /// Centres of the squares of a `sensor`, none larger than `spacing` (m), m; in a `plane` scene one square along y. Empty
    /// for other kinds.
    pub fn patch(&self, spacing: f64, plane: bool) -> Vec<DVec3> {
        let Self::Sensor { at, normal, size } = self else {
            return Vec::new();
        };
        let size = size.unwrap_or(spacing);
        let along = |turn: usize| -> Vec<DVec3> {
            let axis = (normal.axis().index() + turn) % 3;
            let count = match plane && axis == 1 {
                true => 1,
                false => (size / spacing).ceil().max(1.0) as u32,
            };
            let offset = |n: u32| ((f64::from(n) + 0.5) / f64::from(count) - 0.5) * size;
            (0..count).map(|n| DVec3::AXES[axis] * offset(n)).collect()
        };
        let (first, second) = (along(1), along(2));
        let row = |a: &DVec3| {
            second
                .iter()
                .map(|b| DVec3::from(*at) + *a + *b)
                .collect::<Vec<_>>()
        };
        first.iter().flat_map(row).collect()
    }

    /// The points of a line, each with its distance from the first, m; empty for other kinds.
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

/// Checks that a probe has only fields that its kind allows, and the right number of coordinates.
pub(super) fn check_keys(probe: &DeTable<'_>, kind: &str) -> Result<(), String> {
    let always = match kind {
        "block" => Some("position, velocity, rotation, spin, force and torque"),
        "gauge" => Some("the level"),
        "sensor" => Some("pressure and impulse"),
        "run_up" => Some("the place of the farthest particle"),
        _ => None,
    };
    let fields = probe.get("fields").map(|fields| fields.get_ref());
    if let (Some(gives), Some(_)) = (always, fields) {
        return Err(format!(
            "a `{kind}` probe always gives {gives} and no fields; remove `fields`"
        ));
    }
    let mut listed = fields
        .and_then(|list| list.as_array())
        .into_iter()
        .flatten();
    if kind == "face" && listed.any(|field| field.get_ref().as_str() != Some("pressure")) {
        return Err("a `face` probe always gives area, pressure and force and no other fields; remove `fields`".into());
    }
    let at = probe.get("at").and_then(|at| at.get_ref().as_array());
    match (kind, at.map(|at| at.len())) {
        ("point" | "sensor", Some(count)) if count != 3 => {
            Err(format!("`at` has {count} numbers; a point has x, y and z"))
        }
        ("gauge", Some(count)) if count != 2 => Err(format!(
            "`at` has {count} numbers; a gauge stands at x and y"
        )),
        _ => Ok(()),
    }
}

/// Default fields of a probe.
fn usual_fields() -> Vec<Field> {
    vec![Field::Velocity, Field::Pressure]
}

impl Scene {
    pub(super) fn check_probes(&self) -> Result<()> {
        let named = self.probes.iter().map(|probe| probe.name.as_str());
        names("probes", named.enumerate())?;
        for (index, probe) in self.probes.iter().enumerate() {
            self.check_probe(&format!("probes[{index}]"), probe)?;
        }
        let histories = 0..self.output.histories.len();
        let of_histories: Vec<String> = histories.map(History::file_name).collect();
        for (index, probe) in self.probes.iter().enumerate() {
            // Some file systems are not case-sensitive.
            if of_histories.contains(&probe.name.to_lowercase()) {
                return refuse(
                    format!("probes[{index}].name"),
                    "output.histories write files of this name; give the probe another one",
                );
            }
            let owner = |other: &&Probe| self.tables_of(other).contains(&probe.name);
            if let Some(owner) = self.probes.iter().find(owner) {
                return refuse(
                    format!("probes[{index}].name"),
                    format!(
                        "`{}` is a further table of `{}`; give it another name",
                        probe.name, owner.name
                    ),
                );
            }
            if self.numerics.wall_model != WallModel::None
                && probe.name.eq_ignore_ascii_case("walls")
            {
                return refuse(
                    format!("probes[{index}].name"),
                    "`walls` is the table of numerics.wall_model; give it another name",
                );
            }
        }
        Ok(())
    }

    /// The names of the tables that a probe writes in addition to its own.
    fn tables_of(&self, probe: &Probe) -> Vec<String> {
        let mut tables = Vec::new();
        if matches!(probe.place, ProbePlace::Block { faces: true, .. }) {
            tables.push(format!("{}_faces", probe.name));
        }
        if self.statistics.is_some() && probe.every.is_some() {
            let with = |name: &String| format!("{name}_statistics");
            let of_faces: Vec<_> = tables.iter().map(with).collect();
            tables.extend(of_faces);
            let further = ["statistics", "spectrum", "correlation"];
            tables.extend(further.map(|table| format!("{}_{table}", probe.name)));
        }
        tables
    }

    fn check_probe(&self, key: &str, probe: &Probe) -> Result<()> {
        interval(format!("{key}.every"), probe.every)?;
        distinct(&format!("{key}.fields"), &probe.fields)?;
        self.check_eddy(
            &format!("{key}.fields"),
            probe.fields.contains(&Field::EddyViscosity),
        )?;
        self.check_statistical(&format!("{key}.fields"), &probe.fields)?;
        let within = |part: &str, point| inside(format!("{key}.{part}"), &self.domain, point);
        match &probe.place {
            ProbePlace::Point { at } => within("at", *at),
            ProbePlace::Line { from, to, count } => {
                within("from", *from)?;
                within("to", *to)?;
                if *count < 2 {
                    return refuse(
                        format!("{key}.count"),
                        format!("a line has at least 2 points, not {count}"),
                    );
                }
                if *count > MOST_POINTS {
                    return refuse(
                        format!("{key}.count"),
                        format!("a line has at most {MOST_POINTS} points, not {count}"),
                    );
                }
                Ok(())
            }
            ProbePlace::Plane { axis, position } => {
                let mut point = self.domain.middle();
                point[axis.index()] = *position;
                within("position", point)
            }
            ProbePlace::Block { faces: true, .. } if !self.has_fluid() => refuse(
                format!("{key}.faces"),
                "there is no fluid in this scene that could load the faces of a block; remove `faces`, or \
                 add [fluid]",
            ),
            ProbePlace::Block { faces: true, .. } if self.has_particles() => refuse(
                format!("{key}.faces"),
                "particles load blocks as a whole, and not face by face; remove `faces`, or use a lattice fluid",
            ),
            // The name of the block is checked when the blocks are built.
            ProbePlace::Block { .. } if self.has_blocks() => Ok(()),
            ProbePlace::Block { .. } => refuse(
                format!("{key}.block"),
                "there are no blocks in this scene; remove the probe, or add [[blocks]]",
            ),
            ProbePlace::Gauge { at: [x, y] } => within("at", [*x, *y, self.domain.middle()[2]]),
            ProbePlace::Sensor { at, size, .. } => {
                if let Some(size) = size {
                    positive(format!("{key}.size"), *size, "m")?;
                }
                within("at", *at)
            }
            ProbePlace::Box { min, max }
            | ProbePlace::Face { min, max, .. }
            | ProbePlace::RunUp { min, max, .. } => {
                ordered(key, *min, *max)?;
                within("min", *min)?;
                within("max", *max)
            }
        }
    }
}
