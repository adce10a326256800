//! The faces fit each other.

use super::rules::{finite, finite_constants, refuse};
use crate::error::Result;
use crate::scene::{Boundary, Face, Scene};

/// Largest net flow through velocity faces, relative to what flows in and out: far above the
/// rounding of the sums, and the density drifts by a millionth each time the fluid is replaced.
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
                Boundary::Wall { velocity } => {
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
                Boundary::Velocity { velocity } => {
                    finite_constants(&format!("{key}.velocity"), velocity)?;
                    self.face_velocity(face, 0.0)?;
                }
                Boundary::Pressure { pressure, .. } => {
                    finite(format!("{key}.pressure"), &[*pressure])?;
                }
                Boundary::Periodic | Boundary::FreeSlip | Boundary::Open => {}
            }
        }
        Ok(())
    }

    /// A scene whose only openings are velocity faces must let out what it lets in.
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
        let mask = self.solid_mask()?;
        let area = self.domain.cell * self.domain.cell;
        let (mut inward, mut outward) = (0.0, 0.0);
        for face in &given {
            let axis = face.axis().index();
            let velocities = self.face_velocity(*face, 0.0)?;
            for (velocity, cell) in velocities.iter().zip(mask.face_cells(*face)) {
                let flow = velocity[axis] * face.outward() * area;
                if mask.is_solid(cell) {
                    continue;
                }
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
