//! Boundary conditions on the faces of the domain.

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, de::Error as _};

use super::rules::{finite, finite_constants, refuse};
use super::tagged::Kind;
use super::{Face, Scene, sample::mean_normal_velocity, static_solids::Mask};
use crate::error::Result;
use crate::formula::Formula;

/// The conditions on the six faces.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[non_exhaustive]
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
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[schemars(tag = "kind")]
pub enum Boundary {
    /// Periodic; the opposite face must be periodic too.
    #[default]
    Periodic,
    /// No slip; particles without viscosity slide along it.
    Wall {
        /// Velocity of the wall, m/s; its component normal to the face is 0. Default at rest; with particles at rest, where driven
        /// blocks move the water.
        #[serde(default, deserialize_with = "numbers")]
        velocity: [f64; 3],
        /// Equivalent sand roughness k_s of a wall at rest, m, for `numerics.wall_model`. Default 0, smooth.
        #[serde(default)]
        roughness: f64,
    },
    /// No flow through the face and no friction on it.
    FreeSlip,
    /// Inlet or outlet with a given velocity.
    Velocity {
        /// Velocity, m/s: three numbers or formulas of x, y, z, t.
        velocity: [Formula; 3],
        /// Synthetic turbulence added to the velocity. Default none.
        #[serde(default)]
        turbulence: Option<Turbulence>,
    },
    /// Outlet or inlet with a given pressure.
    Pressure {
        /// Pressure above the reference pressure, Pa: a number or a formula of t, for example of a water level. Default 0. A
        /// constant `fluid.acceleration` along the face adds the hydrostatic pressure; the middle of the face has the given
        /// pressure.
        #[serde(default)]
        pressure: Formula,
        /// Whether the pressure is held exactly, so that waves are reflected. Default false: it is held on average, and waves
        /// and vortices leave.
        #[serde(default)]
        reflecting: bool,
    },
    /// Particles that reach this face are removed and counted. Not for a lattice.
    Open,
}

/// Isotropic turbulence at an inlet: von Kármán's spectrum, advected by the mean normal velocity of the face, without a
/// net flow. For a fluid on a lattice.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Turbulence {
    /// RMS of each velocity component over the mean normal velocity of the face, up to 1.
    pub intensity: f64,
    /// Integral length of its eddies, m, at least a cell.
    pub length: f64,
    /// Seed of the eddies; each face has eddies of its own. Default 0.
    #[serde(default)]
    pub seed: u64,
}

impl Boundary {
    pub(super) const KINDS: &[Kind] = &[
        ("periodic", "", ""),
        ("wall", "", "velocity roughness"),
        ("free_slip", "", ""),
        ("velocity", "velocity", "turbulence"),
        ("pressure", "", "pressure reflecting"),
        ("open", "", ""),
    ];

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

impl Turbulence {
    fn check(&self, key: &str, cell: f64) -> Result<()> {
        if !(self.intensity > 0.0 && self.intensity <= 1.0) {
            return refuse(
                format!("{key}.intensity"),
                format!(
                    "is {}; give the RMS of a component over the mean velocity, above 0 up to 1, such as 0.05",
                    self.intensity
                ),
            );
        }
        if !(self.length >= cell && self.length.is_finite()) {
            return refuse(
                format!("{key}.length"),
                format!(
                    "is {} m; the grid resolves eddies of at least one cell, {cell} m here, better four",
                    self.length
                ),
            );
        }
        Ok(())
    }
}

/// Reads the velocity of a wall: three formulas without variables.
fn numbers<'de, D: Deserializer<'de>>(from: D) -> Result<[f64; 3], D::Error> {
    match <[Formula; 3]>::deserialize(from)?.map(|f| f.constant()) {
        [Some(u), Some(v), Some(w)] => Ok([u, v, w]),
        _ => Err(D::Error::custom(
            "the velocity of a wall is three numbers, not formulas",
        )),
    }
}

/// Largest net flow through velocity faces, relative to the sum of inflow and outflow: far above the rounding of the
/// sums; with it the density drifts by a millionth each time the fluid is replaced.
const BALANCED: f64 = 1e-6;

impl Scene {
    pub(super) fn check_boundaries(&self) -> Result<()> {
        for (face, boundary) in self.boundaries.iter() {
            let key = format!("boundaries.{}", face.name());
            let other = self.boundaries.face(face.opposite());
            if *boundary == Boundary::Periodic && *other != Boundary::Periodic {
                return refuse(
                    key,
                    format!(
                        "is periodic but {} is `{}`; make both periodic, or give {} a condition \
                         of its own",
                        face.opposite().name(),
                        other.kind(),
                        face.name()
                    ),
                );
            }
            match boundary {
                Boundary::Wall {
                    velocity,
                    roughness,
                } => {
                    let of_roughness = format!("{key}.roughness");
                    self.check_roughness(&of_roughness, *roughness)?;
                    if *roughness != 0.0 && *velocity != [0.0; 3] {
                        return refuse(
                            of_roughness,
                            "the wall model is for walls at rest; remove `roughness` or `velocity`",
                        );
                    }
                    finite(format!("{key}.velocity"), velocity)?;
                    let normal = velocity[face.axis().index()];
                    if normal != 0.0 {
                        return refuse(
                            format!("{key}.velocity"),
                            format!(
                                "a wall moves only along itself, so its {} component must be 0, \
                                 not {normal}; for flow through the face use kind = \"velocity\"",
                                face.axis().name()
                            ),
                        );
                    }
                }
                Boundary::Velocity {
                    velocity,
                    turbulence,
                } => {
                    finite_constants(&format!("{key}.velocity"), velocity)?;
                    let velocities = self.face_velocity(face, 0.0)?;
                    if let Some(turbulence) = turbulence {
                        let key = format!("{key}.turbulence");
                        turbulence.check(&key, self.domain.cell)?;
                        let steady = !velocity.iter().any(Formula::uses_time);
                        if steady && mean_normal_velocity(face, &velocities) == 0.0 {
                            return refuse(
                                key,
                                "no net flow through this face carries it in; give a velocity towards the fluid, or remove `turbulence`",
                            );
                        }
                    }
                }
                Boundary::Pressure { pressure, .. } => {
                    if pressure.uses_place() {
                        return refuse(
                            format!("{key}.pressure"),
                            format!("`{pressure}` uses x, y or z; the variable allowed here is t"),
                        );
                    }
                    finite_constants(&format!("{key}.pressure"), std::slice::from_ref(pressure))?;
                    self.face_pressure(face, 0.0)?;
                }
                Boundary::Periodic | Boundary::FreeSlip | Boundary::Open => {}
            }
        }
        Ok(())
    }

    /// Checks that water that enters through velocity faces can reach a pressure face past the solids, or that as much leaves the part
    /// of the domain that they close.
    pub(super) fn check_openings(&self, mask: &Mask) -> Result<()> {
        let of_kind = |is_kind: fn(&Boundary) -> bool| {
            let faces = self.boundaries.iter().filter(move |(_, b)| is_kind(b));
            faces.map(|(face, _)| face)
        };
        let inlets: Vec<_> = of_kind(|b| matches!(b, Boundary::Velocity { .. })).collect();
        let outlets = of_kind(|b| matches!(b, Boundary::Pressure { .. }));
        let outlets: Vec<[u32; 3]> = outlets.flat_map(|face| mask.face_cells(face)).collect();
        if inlets.is_empty() || outlets.is_empty() {
            return Ok(());
        }
        let mut closed = None;
        // Water also passes edges and corners of cells, which takes longer to follow.
        for diagonals in [false, true] {
            let reached = self.reached(mask, &outlets, diagonals);
            let [mut net, mut all] = [0.0; 2];
            closed = None;
            for &face in &inlets {
                let axis = face.axis().index();
                let velocities = self.face_velocity(face, 0.0)?;
                for (velocity, cell) in velocities.iter().zip(mask.face_cells(face)) {
                    if !reached.is_solid(cell) {
                        net += velocity[axis] * face.outward();
                        all += velocity[axis].abs();
                        closed = closed.or(Some((face, cell)));
                    }
                }
            }
            if net.abs() <= BALANCED * all {
                return Ok(());
            }
        }
        let Some((face, cell)) = closed else {
            return Ok(());
        };
        refuse(
            format!("boundaries.{}", face.name()),
            format!(
                "solids close the water at {:?} m off from every pressure face, so that its mass would grow or shrink without end; open a \
                 way, or close this part of the face with a solid",
                self.centre(cell)
            ),
        )
    }

    /// The solids with all cells of fluid that are connected to those of `from`, through faces or also through edges and corners.
    fn reached(&self, mask: &Mask, from: &[[u32; 3]], diagonals: bool) -> Mask {
        let steps = (0..27).map(|n| [n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1]);
        let is_step = |c: &[i64; 3]| match c.iter().map(|c| c.abs()).sum() {
            0 => false,
            order => diagonals || order == 1,
        };
        let steps: Vec<[i64; 3]> = steps.filter(is_step).collect();
        let cells = mask.cells().map(i64::from);
        let periodic =
            [0, 1, 2].map(|a| *self.boundaries.face(Face::ALL[2 * a]) == Boundary::Periodic);
        let mut reached = mask.clone();
        let mut open = Vec::new();
        let mut next = from.to_vec();
        loop {
            for cell in next.drain(..) {
                if !reached.is_solid(cell) {
                    reached.set(cell, true);
                    open.push(cell);
                }
            }
            let Some(cell) = open.pop() else {
                return reached;
            };
            for c in &steps {
                let to = [0, 1, 2].map(|a| i64::from(cell[a]) + c[a]);
                if (0..3).all(|a| periodic[a] || (0..cells[a]).contains(&to[a])) {
                    next.push([0, 1, 2].map(|a| to[a].rem_euclid(cells[a]) as u32));
                }
            }
        }
    }

    /// Checks that inflow and outflow are equal if all openings of a scene are velocity faces.
    pub(super) fn check_balance(&self) -> Result<()> {
        let is_pressure = |boundary: &Boundary| matches!(boundary, Boundary::Pressure { .. });
        let given: Vec<Face> = self
            .boundaries
            .iter()
            .filter(|(_, b)| matches!(b, Boundary::Velocity { .. }))
            .map(|(face, _)| face)
            .collect();
        if given.is_empty() || self.boundaries.iter().any(|(_, b)| is_pressure(b)) {
            return Ok(());
        }
        let solid = self.solid_fractions()?;
        let area = self.domain.cell * self.domain.cell;
        let (mut inward, mut outward) = (0.0, 0.0);
        for face in &given {
            let axis = face.axis().index();
            let velocities = self.face_velocity(*face, 0.0)?;
            for (velocity, cell) in velocities.iter().zip(solid.mask.face_cells(*face)) {
                let flow = velocity[axis] * face.outward() * area * solid.open(cell);
                if flow > 0.0 {
                    outward += flow;
                } else {
                    inward -= flow;
                }
            }
        }
        if (inward - outward).abs() <= BALANCED * (inward + outward) {
            return Ok(());
        }
        let names: Vec<&str> = given.iter().map(|face| face.name()).collect();
        refuse(
            format!("boundaries.{}", names[0]),
            format!(
                "at t = 0 the velocity faces {} let {inward:.6e} m³/s in and {outward:.6e} m³/s \
                 out, and there is no pressure face that could take the difference: make one of \
                 them kind = \"pressure\", or balance the velocities",
                names.join(", ")
            ),
        )
    }
}
