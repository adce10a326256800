//! Boxes in still water: Archimedes.

use super::{
    super::{Outcome, Stand},
    pool::{self, GRAVITY, Pool},
};

const SPACING: f64 = 0.05;
const DEPTH: f64 = 1.0;
const LENGTH: f64 = 1.6;
/// Times over which the last of the motion is averaged out, s.
const LOOKS: u32 = 40;

/// The push on a box that is held under water, in the middle and beside a wall of the tank.
pub fn submerged(stand: &Stand) -> Outcome {
    let mut records = Vec::new();
    for (what, x, angle) in [("in the middle", 0.8, 0), ("turned by 30°", 0.8, 30)] {
        let edge = 8.0 * SPACING;
        let more = format!(
            r#"
            [[blocks]]
            name = "box"
            kind = "box"
            size = [{edge}, 1, {edge}]
            position = [{x}, 0.5, 0.5]
            rotation = {{ axis = [0, 1, 0], angle = {angle} }}
            motion = "fixed"
            [[probes]]
            name = "box"
            kind = "block"
            block = "box"
            "#
        );
        let scene = pool::scene([LENGTH, 1.5 * DEPTH], SPACING, [LENGTH, DEPTH], &more)?;
        let mut pool = Pool::fill(stand, &scene)?;
        pool.advance(3.0)?;
        let mut force = glam::DVec3::ZERO;
        for look in 1..=LOOKS {
            pool.advance(3.0 + 0.05 * f64::from(look))?;
            force += pool.felt(0).flow.force / f64::from(LOOKS);
        }
        let weight = 1000.0 * GRAVITY * edge * edge;
        let trial = pool.trial("box under water");
        records.push(trial.relative(format!("push / ρVg, {what}"), force.z / weight, 1.0, 0.01));
        records.push(trial.at_most(
            format!("push across / ρVg, {what}"),
            force.x.abs() / weight,
            0.01,
        ));
    }
    Ok(records)
}

/// The draft of a box that floats, let go a twentieth of its height too high.
pub fn floating(stand: &Stand) -> Outcome {
    let (width, height, density) = (12.0 * SPACING, 8.0 * SPACING, 500.0);
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
        position = [0.8, 0.5, {}]
        material = "wood"
        "#,
        DEPTH - start + 0.5 * height
    );
    let scene = pool::scene([LENGTH, 2.0 * DEPTH], SPACING, [LENGTH, DEPTH], &more)?;
    let mut pool = Pool::fill(stand, &scene)?;
    let end = if stand.full { 20.0 } else { 8.0 };
    pool.advance(end)?;
    let mut draft = 0.0;
    for look in 1..=LOOKS {
        pool.advance(end + 0.05 * f64::from(look))?;
        let bottom = pool.pose(0).centre.z - 0.5 * height;
        let area = f64::from(pool.surface.particles().numbers().water) * SPACING * SPACING;
        // Level of all the water, that which the box pushes up included.
        let level = (area - width * bottom) / (LENGTH - width);
        draft += (level - bottom) / f64::from(LOOKS);
    }
    let tilt = pool.pose(0).deformation.x_axis.z.abs();
    let trial = pool.trial("floating box");
    Ok(vec![
        trial.relative("draft / exact", draft / exact, 1.0, 0.01),
        trial.at_most("tilt, rad", tilt, 0.01),
    ])
}
