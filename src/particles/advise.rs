//! What particles carry badly.

use super::{Scheme, Setup, Side, fill, placed::Placed, speeds::Speeds};
use crate::{
    Result,
    block::Form,
    bodies::{Block, Blocks, Motion},
    broadphase::HostBroadphase,
    coupling::{Gap, gaps},
    scene::{Advice, ProbePlace, Scene, Warning},
    simulation::{BlockSetup, scene_step},
};
use glam::DVec3;

/// Particles over the depth of water below which waves and pressure are coarse: at 25 a standing wave loses a
/// few percent of its height a period.
const FEW: f64 = 10.0;

/// Share of the water asked for by which particles may miss it.
const MISSED: f64 = 0.01;

/// Speed of long waves over the largest speed expected above which still water is denser by 4 % at its bottom.
const DEEP: f64 = 2.0;

/// How much faster than the largest speed expected a block may fall: it is a bound, friction and water make it less.
const FALL: f64 = 1.5;

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
    fullness(scene, blocks, setup, positions.len(), &mut warn)?;
    support(scene, blocks, setup, &mut warn);
    fast(scene, blocks, setup, positions, &mut warn);
    dry(scene, blocks, setup, positions, &mut warn);
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
    let thin = |block: &Block, form: &Form| match form {
        Form::Sphere { radius } => 2.0 * radius < reach,
        Form::Convex(part) => part.faces().iter().any(|face| {
            // In a plane nothing is before the ends of a prism.
            let end = setup.plane && (block.rotation * face.normal).y.abs() > 0.5;
            2.0 * face.distance < reach && !end
        }),
    };
    let thin = free().filter(|block| {
        let mut parts = block.shape.parts().iter();
        parts.all(|part| thin(block, &part.form))
    });
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
                 `{second}`: one layer of particles goes in at most, below half a spacing none; close them, or use a \
                 smaller spacing",
                narrow.len(),
                narrowest.width
            ),
        );
    }
    Ok(advice)
}

/// Whether the particles are as much water as was asked for.
fn fullness(
    scene: &Scene,
    blocks: &BlockSetup,
    setup: &Setup,
    particles: usize,
    warn: &mut impl FnMut(String, String),
) -> Result<()> {
    let Some(volume) = fill::volume(scene, blocks)? else {
        return Ok(());
    };
    let (asked, held) = (
        setup.density * volume,
        setup.particle_mass() * particles as f64,
    );
    if (held / asked - 1.0).abs() > MISSED {
        warn(
            "particles.spacing".into(),
            format!(
                "the particles are {held:.4} kg of water, and its bodies hold {asked:.4} kg; give them sides that are whole \
                 numbers of spacings from the lower corner of the domain, or use a smaller spacing"
            ),
        );
    }
    Ok(())
}

/// Whether anything stands against gravity.
fn support(
    scene: &Scene,
    blocks: &BlockSetup,
    setup: &Setup,
    warn: &mut impl FnMut(String, String),
) {
    let falls = |axis: usize| setup.faces[axis][0] == Side::Periodic || setup.gravity[axis] == 0.0;
    // Walls come after them.
    let held = blocks
        .setup
        .blocks
        .iter()
        .take(blocks.in_fluid + scene.solids.len());
    let mut held = held.filter(|block| block.motion != Motion::Free);
    if setup.gravity != DVec3::ZERO && (0..3).all(falls) && held.next().is_none() {
        warn(
            "boundaries".into(),
            format!(
                "gravity, {} m/s², is along axes that are periodic, and no block stands against it: the water falls for \
                 ever; give the lower face kind = \"wall\", or the water a bed",
                DVec3::from_array(
                    [0, 1, 2].map(|axis| scene.fluid.acceleration[axis].eval_at([0.0; 3], 0.0))
                )
            ),
        );
    }
}

/// Whether blocks stay at the speed for which sound is set.
fn fast(
    scene: &Scene,
    blocks: &BlockSetup,
    setup: &Setup,
    positions: &[DVec3],
    warn: &mut impl FnMut(String, String),
) {
    let usual = setup.largest_speed();
    let length = scene.run.length(scene_step(scene, setup.acoustic_step()));
    let speeds = Speeds::new(positions, setup.spacing, setup.gravity).over(length);
    let still = speeds.of_water() / std::f64::consts::SQRT_2;
    if setup.scheme == Scheme::Delta && still > DEEP * usual {
        let denser = (still / setup.sound_speed).powi(2);
        warn(
            "particles.largest_speed".into(),
            format!(
                "is {usual:.3} m/s for the speed of sound, and the water is so deep that at rest it would be {:.0} % denser \
                 at its bottom; give {:.3} m/s",
                100.0 * denser,
                speeds.of_water()
            ),
        );
    }
    let most = |free: bool| {
        let all = blocks.setup.blocks.iter();
        let all = all.filter(|block| (block.motion == Motion::Free) == free);
        let all = all.map(|block| (speeds.of(block), block.name.as_str()));
        all.max_by(|a, b| a.0.total_cmp(&b.0))
    };
    for (free, share, what) in [(false, 1.0, "is driven at"), (true, FALL, "may fall at")] {
        if let Some((speed, name)) = most(free).filter(|(speed, _)| *speed > 1.001 * share * usual)
        {
            warn(
                "particles.largest_speed".into(),
                format!(
                    "is {usual:.3} m/s for the speed of sound, and block `{name}` {what} up to {speed:.3} m/s, Mach \
                     {:.2}: water is compressed by what hits it; give {speed:.3} m/s",
                    speed / setup.sound_speed
                ),
            );
        }
    }
}

/// Whether probes stand where water can come.
fn dry(
    scene: &Scene,
    blocks: &BlockSetup,
    setup: &Setup,
    positions: &[DVec3],
    warn: &mut impl FnMut(String, String),
) {
    let fixed = blocks.setup.blocks.iter();
    let fixed = fixed.filter(|block| block.motion == Motion::Fixed);
    let fixed: Vec<(&str, Placed<'_>)> = fixed
        .flat_map(|block| {
            Placed::of(block)
                .into_iter()
                .map(|part| (block.name.as_str(), part))
        })
        .collect();
    let inside = |x: DVec3| {
        let found = fixed.iter().find(|(_, part)| part.depth(x) > 0.0);
        found.map(|(name, _)| *name)
    };
    let nothing = (f64::INFINITY, f64::NEG_INFINITY);
    let heights = positions.iter().map(|x| x.z);
    let (low, high) = heights.fold(nothing, |(low, high), z| (low.min(z), high.max(z)));
    for (index, probe) in scene.probes.iter().enumerate() {
        let block = match &probe.place {
            ProbePlace::Point { at } => inside(DVec3::from(*at)),
            // Half a spacing before its wall.
            ProbePlace::Sensor { at, normal, .. } => {
                let way = DVec3::AXES[normal.axis().index()] * f64::from(normal.sign());
                inside(DVec3::from(*at) + 0.5 * setup.spacing * way)
            }
            // All of the column up to the top of the water.
            ProbePlace::Gauge { at: [x, y] } => {
                let count = ((high - low) / setup.spacing).ceil() as u32;
                let column = (0..=count).map(|n| {
                    let z = low + f64::from(n) * setup.spacing;
                    inside(DVec3::new(*x, *y, z.min(high)))
                });
                let column: Option<Vec<&str>> = column.collect();
                column.and_then(|names| names.first().copied())
            }
            _ => None,
        };
        if let Some(block) = block {
            warn(
                format!("probes[{index}].at"),
                format!(
                    "`{}` is inside block `{block}`, where no water is: it will show nothing; move it",
                    probe.name
                ),
            );
        }
    }
}
