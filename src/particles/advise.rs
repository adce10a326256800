//! What particles carry badly.

use super::Setup;
use crate::{
    Result,
    block::Form,
    bodies::{Blocks, Motion},
    broadphase::HostBroadphase,
    coupling::{Gap, gaps},
    scene::{Advice, Scene, Warning},
    simulation::BlockSetup,
};
use glam::DVec3;

/// Particles over the depth of water below which waves and pressure are coarse: at 25 a standing wave loses a
/// few percent of its height a period.
const FEW: f64 = 10.0;

/// What may disappoint in the water of `scene`, which `setup` computes: its particles are at `positions` (m) at the
/// start, beside the blocks of `blocks`, which are as `state` says.
///
/// # Errors
/// None that is known of: blocks that stand do so in finite places.
pub async fn advise(
    scene: &Scene,
    blocks: &BlockSetup,
    state: &Blocks,
    setup: &Setup,
    positions: &[DVec3],
) -> Result<Advice> {
    let mut advice = Advice::new();
    let mut warn = |place: String, message: String| advice.push(Warning { place, message });
    let spacing = setup.spacing;
    if let Some(up) = (-setup.gravity).try_normalize() {
        let heights = positions.iter().map(|x| up.dot(*x));
        let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| {
            (low.min(at), high.max(at))
        });
        let deep = (high - low) / spacing + 1.0;
        if deep < FEW {
            warn(
                "particles.spacing".into(),
                format!(
                    "the water is {deep:.0} particles deep, and waves want {FEW} at least: a spacing of {:.2e} m",
                    spacing * deep / FEW
                ),
            );
        }
    }
    let free = || {
        let all = blocks.setup.blocks.iter();
        all.filter(|block| block.motion == Motion::Free)
    };
    let gravity = DVec3::from(scene.rock.gravity);
    if free().next().is_some() && gravity.distance(setup.gravity) > 1e-6 * gravity.length() {
        warn(
            "fluid.acceleration".into(),
            format!(
                "is {} m/s² for the water, and rock.gravity is {gravity} m/s² for the blocks; nothing floats right \
                 unless they are the same",
                setup.gravity
            ),
        );
    }
    let reach = f64::from(setup.layers()) * spacing;
    let thin = |form: &Form| match form {
        Form::Sphere { radius } => 2.0 * radius < reach,
        Form::Convex(part) => 2.0 * part.smallest_distance() < reach,
    };
    let thin = free().filter(|block| block.shape.parts().iter().all(|part| thin(&part.form)));
    let names: Vec<&str> = thin.map(|block| block.name.as_str()).collect();
    if let Some(first) = names.first() {
        warn(
            "particles.spacing".into(),
            format!(
                "{} blocks, `{first}` the first, are thinner than the {reach:.2e} m that the kernel reaches: water feels \
                 what is on their other side; use a smaller spacing",
                names.len()
            ),
        );
    }
    let mut finder = HostBroadphase;
    let width = 2.0 * spacing;
    let mut narrow = gaps(&blocks.setup, state, blocks.in_fluid, width, &mut finder).await?;
    narrow.retain(|gap| !gap.is_closed(spacing));
    let least = |a: &&Gap, b: &&Gap| a.width.total_cmp(&b.width);
    if let Some(narrowest) = narrow.iter().min_by(least) {
        let [first, second] = narrowest
            .blocks
            .map(|block| blocks.setup.blocks[block].name.as_str());
        warn(
            "particles.spacing".into(),
            format!(
                "{} gaps between blocks are narrower than two spacings, the narrowest of {:.2e} m between `{first}` and \
                 `{second}`: no water goes in; close them, or use a smaller spacing",
                narrow.len(),
                narrowest.width
            ),
        );
    }
    Ok(advice)
}
