//! The exchange between blocks and a fluid: poses in, loads out; the intervals between exchanges, and the time step of
//! blocks without a fluid.

use super::{FluidLoad, Rock};
use crate::{
    Error, Result,
    geometry::{Form, Pose, Shape, area_of, corners},
    rock::{Blocks, Motion, integrate::Principal},
    scene::Scene,
};
use glam::{DMat3, DQuat, DVec3};
use std::{f64::consts::PI, future::Future};

/// Interval between two exchanges of loads and poses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExchangeInterval {
    /// No block can move: one exchange at the end, for output.
    Static,
    /// All blocks that can move are asleep: an exchange after this number of fluid steps.
    Asleep(u64),
    /// An exchange after `steps` steps of the fluid, and the one after that at most `next` steps later.
    Awake {
        /// Fluid steps until the exchange.
        steps: u64,
        /// Fluid steps from there to the following exchange: more than `steps` if all blocks may fall asleep.
        next: u64,
    },
}

/// A fluid with blocks in it: poses in, loads out.
pub trait Fluid {
    /// Simulated time, s.
    fn time(&self) -> f64;

    /// Advances the fluid to the next exchange, but not beyond the time `end` (s). The blocks start at `poses` and move
    /// with the velocities of these poses. Returns the mean load on each block since the previous exchange, or `None` if the
    /// advance ended before the next one.
    fn advance(
        &mut self,
        poses: &[Pose],
        interval: ExchangeInterval,
        end: f64,
    ) -> impl Future<Output = Result<Option<Vec<FluidLoad>>>>;
}

/// Advances fluid and rock together until the time `end` (s).
///
/// # Errors
/// Returns the errors of the fluid and of [`Rock::exchange`].
pub async fn run(fluid: &mut impl Fluid, rock: &mut Rock, end: f64) -> Result<()> {
    while fluid.time() < end {
        let poses = rock.poses();
        let loads = fluid.advance(&poses, rock.exchange_interval(), end).await?;
        if let Some(loads) = loads {
            rock.exchange(&loads, fluid.time()).await?;
        }
    }
    Ok(())
}

/// Fraction of its speed that the pressure of a plane sound wave may take from a block between two exchanges. At 1 the
/// block comes to rest; above 2 its oscillation grows.
const MAX_SPEED_CHANGE: f64 = 1.0;
/// A deformable block responds more: 3 ρ c A/m for two opposite faces A of a box that move apart.
const DEFORMABLE_RESPONSE: f64 = 3.0;

/// Σ A n⊗n over the surfaces of all parts of a shape, m².
fn projected_area(shape: &Shape) -> DMat3 {
    let pose = Pose::at_rest(DVec3::ZERO, DQuat::IDENTITY);
    let faces = shape.parts().iter().map(|part| match &part.form {
        Form::Sphere { radius } => {
            DMat3::from_diagonal(DVec3::splat(4.0 * PI / 3.0 * radius * radius))
        }
        Form::Convex(of) => (0..of.faces().len())
            .map(|face| {
                let (_, area) = area_of(&corners(of, face, part.offset, &pose));
                let normal = area.normalize_or_zero();
                DMat3::from_cols(area * normal.x, area * normal.y, area * normal.z)
            })
            .fold(DMat3::ZERO, |sum, face| sum + face),
    });
    faces.fold(DMat3::ZERO, |sum, part| sum + part)
}

/// Longest stable time between two exchanges of free blocks with a compressible fluid of acoustic impedance ρc
/// `impedance` (kg/m²s), s; infinite without free blocks. The fluid sees a constant velocity of the block during that
/// time. If it lasts too long, the sound pressure overcompensates the motion of a light block, and the block oscillates.
pub fn longest_exchange(rock: &Rock, impedance: f64) -> f64 {
    let blocks = rock.setup().setup.blocks.iter().enumerate();
    let free = blocks.filter(|(_, block)| block.motion == Motion::Free);
    free.map(|(number, block)| {
        let area = Principal::of(projected_area(&block.shape))
            .moments
            .max_element();
        let response = if block.deformable.is_some() {
            DEFORMABLE_RESPONSE
        } else {
            1.0
        };
        MAX_SPEED_CHANGE * rock.blocks().mass(number) / (response * impedance * area)
    })
    .fold(f64::INFINITY, f64::min)
}

/// Sub-steps per step if the scene gives no time step: the length of the step does not change when contacts stiffen and
/// sub-steps get shorter, and rounding to a whole number of sub-steps then wastes at most a tenth.
const SUB_STEPS: f64 = 10.0;
/// Largest number of sub-steps per step: at a millisecond each, as in large scenes, such a step runs for a quarter of an
/// hour.
const MAX_SUB_STEPS: f64 = 1e6;

/// Time step of a scene of `blocks` without a fluid, s.
///
/// # Errors
/// [`Error::Scene`] if neither the scene nor a contact determines it, or if a step has too many sub-steps.
pub(crate) fn rock_step(scene: &Scene, blocks: &Blocks) -> Result<f64> {
    if !blocks.time_step().is_finite() {
        return Err(Error::scene(
            "rock.time_step",
            "no block is free, so that no contact determines the time step; give time_step \
             in s",
        ));
    }
    let usual = SUB_STEPS * blocks.time_step();
    let time_step = match (scene.rock.time_step, scene.run.duration) {
        (Some(given), _) => given,
        (None, None) => usual,
        // A whole number of steps, so that the run ends at its duration.
        (None, Some(duration)) => duration / (duration / usual).ceil(),
    };
    check_substep_count(time_step, blocks)?;
    Ok(time_step)
}

/// Rejects blocks whose contacts need more than [`MAX_SUB_STEPS`] sub-steps in a step of `time_step` (s).
///
/// # Errors
/// [`Error::Scene`] with the changes that would lengthen the sub-steps.
pub(crate) fn check_substep_count(time_step: f64, blocks: &Blocks) -> Result<()> {
    bound(time_step, blocks.time_step())
}

fn bound(time_step: f64, sub_step: f64) -> Result<()> {
    let steps = time_step / sub_step;
    if steps <= MAX_SUB_STEPS || steps.is_nan() {
        return Ok(());
    }
    Err(Error::scene(
        "materials",
        format!(
            "contacts need sub-steps of {sub_step:.3e} s, {steps:.3e} of them in a step of {time_step:.3e} s, and the limit \
             is {MAX_SUB_STEPS:e}; use a normal_stiffness smaller by {:.1e}, heavier blocks, or a shorter time_step",
            (steps / MAX_SUB_STEPS).powi(2)
        ),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Polyhedron;

    #[test]
    fn projected_areas_of_a_box_and_a_sphere() {
        let sides = DVec3::new(1.0, 2.0, 3.0);
        let box_ = Shape::from(Polyhedron::cuboid(sides).expect("a box"));
        let moments = projected_area(&box_).to_cols_array();
        for (found, exact) in moments
            .iter()
            .zip([12.0, 0.0, 0.0, 0.0, 6.0, 0.0, 0.0, 0.0, 4.0])
        {
            assert!((found - exact).abs() < 1e-12, "{moments:?}");
        }
        let sphere = projected_area(&Shape::sphere(0.5).expect("a sphere"));
        assert!((sphere.x_axis.x - PI / 3.0).abs() < 1e-12);
    }

    #[test]
    fn steps_that_never_end_are_refused() {
        assert!(bound(1e-3, 1e-8).is_ok() && bound(1e-3, f64::INFINITY).is_ok());
        let message = bound(1e-3, 1e-12).unwrap_err().to_string();
        assert!(
            message.contains("normal_stiffness smaller by 1.0e6"),
            "{message}"
        );
        assert!(bound(1e-3, 0.0).is_err());
    }
}
