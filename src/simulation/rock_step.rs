//! Length of a step of blocks without a fluid, and the number of sub-steps that contacts need in a step.

use crate::{Error, Result, rock::Blocks, scene::Scene};

/// Sub-steps of a step where the scene gives no time step: a step keeps its length when contacts
/// stiffen and sub-steps get shorter, and a whole number of them then wastes at most a tenth.
const SUB_STEPS: f64 = 10.0;
/// Limit of the sub-steps in a step: at a thousandth of a second each, as large scenes take, a step then lasts a quarter
/// of an hour.
const MAX_SUB_STEPS: f64 = 1e6;

/// Length of a step of a scene of `blocks` without a fluid, s.
///
/// # Errors
/// [`Error::Scene`] if neither the scene nor a contact determines it, or if a step has too many sub-steps.
pub(super) fn rock_step(scene: &Scene, blocks: &Blocks) -> Result<f64> {
    if !blocks.time_step().is_finite() {
        return Err(Error::scene(
            "rock.time_step",
            "no block is free, so that no contact says how long a step may be; give time_step \
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

/// Refuses blocks whose contacts want more than [`MAX_SUB_STEPS`] sub-steps in a step of `time_step` (s).
///
/// # Errors
/// [`Error::Scene`] with what would make them longer.
pub(super) fn check_substep_count(time_step: f64, blocks: &Blocks) -> Result<()> {
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
            "contacts want sub-steps of {sub_step:.3e} s, {steps:.3e} of them in a step of {time_step:.3e} s, and a run takes at \
             most {MAX_SUB_STEPS:e}; use a normal_stiffness smaller by {:.1e}, heavier blocks, or a shorter time_step",
            (steps / MAX_SUB_STEPS).powi(2)
        ),
    ))
}

#[cfg(test)]
mod tests {
    use super::bound;

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
