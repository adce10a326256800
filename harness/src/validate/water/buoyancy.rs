//! Buoyancy of boxes in still water.

use crate::validate::{
    CaseContext, Outcome, Trial,
    tank::{self, GRAVITY, Tank},
};
use riprap::scene::Scheme;

const SPACING: f64 = 0.05;
const DEPTH: f64 = 1.0;
const LENGTH: f64 = 2.4;
/// Readings, 0.05 s apart, that average out the residual motion.
const LOOKS: u32 = 40;
/// Edge of the box, m.
const EDGE: f64 = 8.0 * SPACING;
/// Middle of the tank, m.
pub const MIDDLE: f64 = 0.5 * DEPTH;

/// Buoyancy and horizontal force, over ρVg, on a box held under water at the height `z` (m) and rotated by `angle` (degrees).
pub fn held(
    context: &CaseContext,
    (z, angle): (f64, f64),
    scheme: Scheme,
) -> anyhow::Result<(Trial, [f64; 2])> {
    let more = format!(
        r#"
        [[blocks]]
        name = "box"
        kind = "box"
        size = [{EDGE}, 1, {EDGE}]
        position = [{}, 0.5, {z}]
        rotation = {{ axis = [0, 1, 0], angle = {angle} }}
        motion = "fixed"
        [[probes]]
        name = "box"
        kind = "block"
        block = "box"
        "#,
        0.5 * LENGTH
    );
    let mut scene = tank::pool([LENGTH, 1.5 * DEPTH], SPACING, [LENGTH, DEPTH], &more)?;
    tank::choose(&mut scene, scheme);
    let mut pool = Tank::fill(context, &scene)?;
    pool.advance_to(3.0)?;
    let mut force = glam::DVec3::ZERO;
    for look in 1..=LOOKS {
        pool.advance_to(3.0 + 0.05 * f64::from(look))?;
        force += pool.load(0).flow.force / f64::from(LOOKS);
    }
    let weight = 1000.0 * GRAVITY * EDGE * EDGE;
    Ok((
        pool.trial("box under water"),
        [force.z / weight, force.x / weight],
    ))
}

/// Archimedes' law for a box under water, along the lattice and oblique to it, and on the floor, where it holds for the pressure
/// that closed joints transmit.
pub fn submerged(context: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    for angle in [0.0, 30.0] {
        let (trial, [up, across]) = held(context, (MIDDLE, angle), Scheme::Delta)?;
        let what = format!("turned by {angle}°");
        records.push(trial.relative(format!("push / ρVg, {what}"), up, 1.0, 0.01));
        records.push(trial.at_most(format!("push across / ρVg, {what}"), across.abs(), 0.01));
    }
    let (trial, [up, _]) = held(context, (0.5 * EDGE, 0.0), Scheme::Delta)?;
    records.push(trial.relative("push / ρVg, on the floor", up, 1.0, 0.05));
    Ok(records)
}

/// Gaps between two boxes, spacings.
const GAPS: [f64; 4] = [0.0, 0.75, 1.4, 2.0];

/// Archimedes' law for a box above another one with flush sides, at gaps in which the water exerts only a part of its pressure.
/// The error is relative to the full pressure on the base: without a joint model all of it would be missing at the first gap;
/// with a joint model that ignored the water in the gap it would count twice at the third.
pub fn stacked(context: &CaseContext) -> Outcome {
    let (under, mut records) = (6.0 * SPACING, Vec::new());
    for gap in GAPS {
        let base = under + gap * SPACING;
        let boxes = [("under", 0.0, under), ("over", base, EDGE)].map(|(name, low, height)| {
            format!(
                r#"
                [[blocks]]
                name = "{name}"
                kind = "box"
                size = [{EDGE}, 1, {height}]
                position = [{}, 0.5, {}]
                motion = "fixed"
                [[probes]]
                name = "{name}"
                kind = "block"
                block = "{name}"
                "#,
                0.5 * LENGTH,
                low + 0.5 * height
            )
        });
        let size = [LENGTH, 1.5 * DEPTH];
        let scene = tank::pool(size, SPACING, [LENGTH, DEPTH], &boxes.concat())?;
        let mut pool = Tank::fill(context, &scene)?;
        pool.advance_to(2.0)?;
        let mut up = 0.0;
        for look in 1..=LOOKS {
            pool.advance_to(2.0 + 0.05 * f64::from(look))?;
            up += pool.load(1).flow.force.z / f64::from(LOOKS);
        }
        let push = 1000.0 * GRAVITY * EDGE;
        let trial = pool.trial("stacked boxes");
        let name = format!("push beyond ρVg / pressure on the base, gap of {gap} spacings");
        let error = (up - push * EDGE) / (push * (DEPTH - base));
        let limit = if gap == 0.0 { 0.02 } else { 0.1 };
        records.push(trial.absolute(name, error, 0.0, limit));
    }
    Ok(records)
}

/// Drafts of floating boxes, released a spacing too high, over the draft by Archimedes' law; the smaller box, of four spacings,
/// only shows how the error grows.
pub fn floating(context: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    for layers in [12, 8] {
        let (trial, draft, tilt) = float(context, f64::from(layers) * SPACING)?;
        let name = format!("draft / exact, {} spacings", layers / 2);
        let limit = (layers == 12).then_some(0.01);
        records.push(trial.relative(name, draft, 1.0, limit));
        records.extend(limit.map(|limit| trial.at_most("tilt, rad", tilt, limit)));
    }
    Ok(records)
}

/// Draft over the exact one, and tilt (rad), of a box of the height `height` (m), half as heavy as water.
fn float(context: &CaseContext, height: f64) -> anyhow::Result<(Trial, f64, f64)> {
    let (width, density) = (16.0 * SPACING, 500.0);
    let exact = density / 1000.0 * height;
    let start = exact - SPACING;
    let more = format!(
        r#"
        [[materials]]
        name = "wood"
        density = {density}
        normal_stiffness = 1e7
        friction = 30
        [[blocks]]
        name = "box"
        kind = "box"
        size = [{width}, 1, {height}]
        position = [1.2, 0.5, {}]
        material = "wood"
        "#,
        DEPTH - start + 0.5 * height
    );
    let scene = tank::pool([LENGTH, 2.0 * DEPTH], SPACING, [LENGTH, DEPTH], &more)?;
    let mut pool = Tank::fill(context, &scene)?;
    let end = if context.full { 20.0 } else { 8.0 };
    pool.advance_to(end)?;
    let mut draft = 0.0;
    for look in 1..=LOOKS {
        pool.advance_to(end + 0.05 * f64::from(look))?;
        let bottom = pool.pose(0).centre.z - 0.5 * height;
        draft += (level(&pool.water()?.positions, width) - bottom) / f64::from(LOOKS);
    }
    let tilt = pool.pose(0).deformation.x_axis.z.abs();
    Ok((pool.trial("floating box"), draft / exact, tilt))
}

/// Water level between the box and the walls: half a spacing above the highest particles, averaged over columns a spacing wide.
fn level(positions: &[glam::DVec3], width: f64) -> f64 {
    // Next to solids the boundary layers in them bend the surface.
    let margin = 4.0 * SPACING;
    let side = 0.5 * (LENGTH - width);
    let columns = ((side - 2.0 * margin) / SPACING).round() as usize;
    let mut tops = vec![f64::NEG_INFINITY; 2 * columns];
    for x in positions {
        for (half, start) in [margin, LENGTH - side + margin].into_iter().enumerate() {
            let column = ((x.x - start) / SPACING).floor();
            if (0.0..columns as f64).contains(&column) {
                let top = &mut tops[half * columns + column as usize];
                *top = top.max(x.z);
            }
        }
    }
    // Columns that are momentarily empty are skipped.
    let tops: Vec<f64> = tops.into_iter().filter(|top| top.is_finite()).collect();
    tops.iter().sum::<f64>() / tops.len() as f64 + 0.5 * SPACING
}
