//! A scene at half its resolution.

use super::super::{Args, SceneRun};
use anyhow::{Context, Result};
use riprap::{
    Error,
    scene::{Run, Scene},
    units::Units,
};

/// A scene at half the resolution of another.
pub struct Halved {
    /// The scene, without pictures.
    pub scene: Scene,
    /// Description of its resolution.
    pub says: String,
}

/// The scene with cells twice as wide, particles twice as far apart, or without a fluid steps twice as long.
pub fn halved(scene: &Scene, args: &Args) -> Result<Halved> {
    let mut half = scene.clone();
    half.views.clear();
    half.output.slices.clear();
    half.output.every = None;
    half.run.checkpoint_every = None;
    let says = match &mut half.particles {
        Some(particles) => {
            particles.spacing *= 2.0;
            let says = format!("particles {} m apart", particles.spacing);
            if args.steps.or(scene.run.steps).is_some() {
                let run = SceneRun::open(scene, &args.scene, args.adapter.as_deref())?;
                half.run = lasting(scene, args, run.time_step());
            }
            says
        }
        None if scene.has_fluid() => {
            widen(scene, &mut half)?;
            let time_step = Units::of(scene)?.time_step;
            half.numerics.time_step = half.numerics.time_step.map(|step| 2.0 * step);
            half.run = lasting(scene, args, time_step);
            format!("cells of {} m", half.domain.cell)
        }
        None => {
            let (step, sub_step) = steps_of(scene, args)?;
            half.rock.time_step = Some(2.0 * sub_step);
            half.run = lasting(scene, args, step);
            format!("steps of {:.3e} s", 2.0 * sub_step)
        }
    };
    half.check().with_context(|| {
        format!("the scene at half its resolution, {says}, for --error-estimate")
    })?;
    Ok(Halved { scene: half, says })
}

/// Cells twice as wide.
fn widen(scene: &Scene, half: &mut Scene) -> riprap::Result<()> {
    let cell = scene.domain.cell;
    let odd = scene.cells().into_iter().zip(["x", "y", "z"]);
    if let Some((cells, axis)) = odd.into_iter().find(|(cells, _)| cells % 2 == 1) {
        let at = |cells: u32| f64::from(cells) * cell;
        return Err(Error::scene(
            "domain.size",
            format!(
                "--error-estimate repeats the scene with cells of {} m, and {cells} cells of {cell} m along {axis} are \
                 no whole number of them; make the edge {:.6} or {:.6} m, or leave out --error-estimate",
                2.0 * cell,
                at(cells - 1),
                at(cells + 1)
            ),
        ));
    }
    half.domain.cell = 2.0 * cell;
    Ok(())
}

/// The same duration with other steps; the steps of the scene are `time_step` (s) long.
fn lasting(scene: &Scene, args: &Args, time_step: f64) -> Run {
    let length = match args.steps {
        Some(steps) => steps as f64 * time_step,
        None => scene.run.length(time_step),
    };
    Run {
        duration: Some(length),
        steps: None,
        checkpoint_every: None,
        kernels: scene.run.kernels,
    }
}

/// Length of the steps and of the sub-steps of dry blocks, s, once their contacts are known.
fn steps_of(scene: &Scene, args: &Args) -> Result<(f64, f64)> {
    let mut run = SceneRun::open(scene, &args.scene, args.adapter.as_deref())?;
    run.advance(1)?;
    let sub_step = run.rock().map(|rock| rock.blocks.time_step());
    let step = run.time_step();
    Ok((step, sub_step.unwrap_or(step).min(step)))
}
