//! Whether the sub-steps of contacts in a step can be computed at all.

use crate::{Error, Result, rock::Blocks};

/// Most sub-steps of a step: at a thousandth of a second each, as large scenes take, a step then lasts a quarter of an
/// hour.
const MOST: f64 = 1e6;

/// Refuses blocks whose contacts want more than [`MOST`] sub-steps in a step of `time_step` (s).
///
/// # Errors
/// [`Error::Scene`] with what would make them longer.
pub(super) fn countable(time_step: f64, blocks: &Blocks) -> Result<()> {
    bound(time_step, blocks.time_step())
}

fn bound(time_step: f64, sub_step: f64) -> Result<()> {
    let steps = time_step / sub_step;
    if steps <= MOST || steps.is_nan() {
        return Ok(());
    }
    Err(Error::scene(
        "materials",
        format!(
            "contacts want sub-steps of {sub_step:.3e} s, {steps:.3e} of them in a step of {time_step:.3e} s, and a run takes at \
             most {MOST:e}; use a normal_stiffness smaller by {:.1e}, heavier blocks, or a shorter time_step",
            (steps / MOST).powi(2)
        ),
    ))
}

#[cfg(test)]
mod tests {
    use super::bound;

    #[test]
    fn steps_that_never_end_are_refused() {
        assert!(bound(1e-3, 1e-8).is_ok() && bound(1e-3, f64::INFINITY).is_ok());
        let told = bound(1e-3, 1e-12).unwrap_err().to_string();
        assert!(told.contains("normal_stiffness smaller by 1.0e6"), "{told}");
        assert!(bound(1e-3, 0.0).is_err());
    }
}
