//! Checks of a setup.

use super::{
    Face, Force, Setup, SolidOperator, SolidWeight, Storage, SurfaceCell, face_name, in_plane,
};
use crate::{Error, Result};

/// Largest equivalent sand roughness, cells: the cells beside the wall still lie above the roughness's zero of the log law.
pub const MAX_ROUGHNESS: f64 = 5.0;

impl Setup {
    /// Checks the setup.
    ///
    /// # Errors
    /// [`Error::Argument`] naming the first field that cannot be used.
    pub(super) fn check(&self) -> Result<()> {
        self.check_numbers()?;
        let cells = self.cells.iter().map(|&n| u128::from(n)).product();
        if !self.solid.is_empty() {
            same("solid", self.solid.len(), cells)?;
        }
        self.check_surface(cells)?;
        match &self.force {
            Force::None => {}
            Force::Constant(force) => finite("force", &force.map(|f| f as f32))?,
            Force::Field(field) => {
                same("force", field.len(), cells)?;
                finite("force", field.as_flattened())?;
            }
        }
        let gradient = self.open_face_gradient.map(|g| g as f32);
        finite("open_face_gradient", &gradient)?;
        for (axis, faces) in self.faces.iter().enumerate() {
            let periodic = faces.iter().filter(|face| **face == Face::Periodic).count();
            if periodic == 1 {
                let message = "a face is periodic only together with the opposite one";
                return Err(Error::argument(face_name(axis, 0), message));
            }
            for (side, face) in faces.iter().enumerate() {
                let name = face_name(axis, side);
                self.check_face(face, axis, &name)?;
                let Some(turbulence) = &self.turbulence[axis][side] else {
                    continue;
                };
                if !matches!(face, Face::Velocity(_)) {
                    let message = "only a velocity face feeds turbulence; make it one, or leave `turbulence` out";
                    return Err(Error::argument(name, message));
                }
                turbulence.check(&name)?;
            }
        }
        if ![1, 2].contains(&self.lane_axis) {
            let message = format!(
                "the lanes of an element lie along axis 1 or 2, not {}",
                self.lane_axis
            );
            return Err(Error::argument("lane_axis", message));
        }
        let brick = self.brick.iter().map(|&n| u128::from(n)).product::<u128>();
        if ![32, 64, 128, 256].contains(&brick) {
            let message = format!("a brick has 32, 64, 128 or 256 elements, not {brick}");
            return Err(Error::argument("brick", message));
        }
        Ok(())
    }

    fn check_surface(&self, cells: u128) -> Result<()> {
        let mut next = 0;
        for SurfaceCell { cell, fraction } in &self.surface {
            let wrong =
                |message: &str| Err(Error::argument("surface", format!("cell {cell} {message}")));
            if u128::from(*cell) >= cells {
                return wrong("is not in the domain");
            }
            if *cell < next {
                return wrong(
                    "is listed after one that does not come before it; list each cell once, in ascending order",
                );
            }
            if !(*fraction > 0.0 && *fraction < 1.0) {
                return wrong("is not filled in part; leave it out, or make it solid");
            }
            if self.solid.get(*cell as usize) == Some(&true) {
                return wrong("is solid as well; leave it out");
            }
            next = cell.saturating_add(1);
        }
        Ok(())
    }

    fn check_numbers(&self) -> Result<()> {
        let excess = (3.0 * self.nu) as f32;
        if !(excess.is_finite() && excess > 0.0) {
            let message = format!(
                "the viscosity must be positive, and 3 ν a number of 32 bits; ν is {:?}",
                self.nu
            );
            return Err(Error::argument("nu", message));
        }
        let rates = self.bulk_rates();
        let rates = [
            ("s4", rates.s4),
            ("s10", rates.s10),
            ("s13", rates.s13),
            ("s16", rates.s16),
            ("s17", rates.s17),
            ("s18", rates.s18),
            ("s20", rates.s20),
            ("s23", rates.s23),
            ("s26", rates.s26),
        ];
        for (name, rate) in rates {
            let rate = rate as f32;
            // In f32, 1/τ of the lowest viscosities is 2.
            if !(rate > 0.0 && rate <= 2.0) {
                let message = format!("is {rate}; a rate lies above 0, up to 2");
                return Err(Error::argument(format!("rates.{name}"), message));
            }
        }
        let lambdas = [
            ("lambda", self.lambda),
            ("wall_lambda", self.wall_lambda),
            ("solid_lambda", self.solid_lambda),
        ];
        for (name, lambda) in lambdas {
            if let Some(lambda) = lambda
                && !(lambda > 0.0 && lambda.is_finite())
            {
                let message = format!("is {lambda}; give a number greater than 0");
                return Err(Error::argument(name, message));
            }
        }
        if self.weight() == SolidWeight::Exact
            && !matches!(self.solid_operator, None | Some(SolidOperator::Holdych))
        {
            let message = "the exact weight belongs to SolidOperator::Holdych; leave it out, or use \
                           SolidWeight::Standard";
            return Err(Error::argument("solid_weight", message));
        }
        if let Some(floor) = self.odd_rate_floor
            && !(0.0..2.0).contains(&floor)
        {
            let message = format!("is {floor}; a rate lies from 0 to below 2, such as 0.8");
            return Err(Error::argument("odd_rate_floor", message));
        }
        if let Some(constant) = self.wale
            && !(constant >= 0.0 && (constant as f32).is_finite())
        {
            let message = format!("is {constant}; give a number from 0, such as 0.5");
            return Err(Error::argument("wale", message));
        }
        if !matches!(self.wale_interval, 1 | 2) {
            let message = format!("is {}; give 1 or 2 steps", self.wale_interval);
            return Err(Error::argument("wale_interval", message));
        }
        self.check_joint_aperture()?;
        self.check_wall_model()?;
        let squared = (self.max_speed * self.max_speed) as f32;
        if !(self.max_speed >= 0.0 && squared.is_finite()) {
            let message = format!(
                "is {}; give a speed such as 0.43, or 0 for no guard",
                self.max_speed
            );
            return Err(Error::argument("max_speed", message));
        }
        Ok(())
    }

    fn check_wall_model(&self) -> Result<()> {
        if self.wall_model.is_some() && self.wale.is_none() {
            let message = "a wall model reads the velocity that WALE keeps; set `wale`, or leave the model out";
            return Err(Error::argument("wall_model", message));
        }
        let reflects = matches!(self.solid_operator, None | Some(SolidOperator::Holdych));
        if self.sloping_faces
            && (self.wall_model.is_none() || !reflects || self.storage != Storage::F32)
        {
            let message = "needs `wall_model`, the operator of Holdych and populations in 32 bits; set them, or leave it out";
            return Err(Error::argument("sloping_faces", message));
        }
        let allowed = |name: &str, roughness: f64| match (0.0..=MAX_ROUGHNESS).contains(&roughness)
        {
            true => Ok(()),
            false => Err(Error::argument(
                name,
                format!(
                    "is {roughness} cells; the log law of rough walls holds from 0 to {MAX_ROUGHNESS} cells"
                ),
            )),
        };
        for roughness in self.wall_roughness.as_flattened() {
            allowed("wall_roughness", *roughness)?;
        }
        if !self.solid_roughness.is_empty() {
            let cells = self.cells.iter().map(|&n| u128::from(n)).product();
            same("solid_roughness", self.solid_roughness.len(), cells)?;
        }
        for roughness in &self.solid_roughness {
            allowed("solid_roughness", f64::from(*roughness))?;
        }
        Ok(())
    }

    /// The face normal to `axis` that messages call `name`.
    fn check_face(&self, face: &Face, axis: usize, name: &str) -> Result<()> {
        match face {
            Face::Periodic | Face::FreeSlip => Ok(()),
            Face::Wall(velocity) => {
                finite(name, &velocity.map(|v| v as f32))?;
                if velocity[axis] != 0.0 {
                    let message = format!(
                        "a wall moves only along itself, so that component {axis} of its velocity must be 0, not {}; \
                         for flow through the face use `Face::Velocity`",
                        velocity[axis]
                    );
                    return Err(Error::argument(name, message));
                }
                Ok(())
            }
            Face::Velocity(list) => {
                let (a, b) = in_plane(axis);
                let plane = u128::from(self.cells[a]) * u128::from(self.cells[b]);
                same(name, list.len(), plane)?;
                finite(name, list.as_flattened())
            }
            Face::Pressure { density } | Face::Outflow { density } => {
                if *density > 0.0 && (*density as f32).is_finite() {
                    return Ok(());
                }
                let message = format!(
                    "its density is {density}; give a number greater than 0, such as 1 for the pressure 0"
                );
                Err(Error::argument(name, message))
            }
        }
    }
}

/// Checks that there is one value per cell.
fn same(name: &str, values: usize, cells: u128) -> Result<()> {
    if values as u128 == cells {
        return Ok(());
    }
    Err(Error::argument(
        name,
        format!("{values} values for {cells} cells"),
    ))
}

/// Checks that all values are finite.
pub(super) fn finite(name: &str, values: &[f32]) -> Result<()> {
    match values.iter().find(|value| !value.is_finite()) {
        None => Ok(()),
        Some(bad) => {
            let message = format!("contains {bad}; give finite numbers of 32 bits");
            Err(Error::argument(name, message))
        }
    }
}
