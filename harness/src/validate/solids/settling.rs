//! A sphere that settles in a tank of oil (ten Cate, Nieuwstad, Derksen & Van den Akker 2002): 15 mm, 1120 kg/m³, released 0.12 m
//! above the floor of a tank of 0.1 × 0.1 × 0.16 m.
//!
//! In the slow experiment the sphere fell faster than a sphere without inertia would between these walls: 0.0360 m/s, while
//! Stokes' law and the walls of a square duct (Happel & Brenner 1983) allow 0.0355. The same tank with a twentieth of the weight,
//! where inertia hardly matters, is a second reference for it.

use crate::validate::{CaseContext, Method, Outcome, Record, Trial, tank::Tank};
use riprap::scene::Scene;
use std::path::Path;

pub const RADIUS: f64 = 7.5e-3;
/// Edge of the tank's floor, m.
pub const EDGE: f64 = 0.1;
/// Largest velocity in lattice units, on coarse grids.
pub const SPEED: f64 = 0.03;
/// kg/m³.
const NYLON: f64 = 1120.0;
/// Default gravity of scenes, m/s².
const GRAVITY: f64 = 9.81;
/// Samples of a trajectory.
const SAMPLES: f64 = 100.0;

/// One of their experiments.
pub struct Oil {
    name: &'static str,
    /// kg/m³.
    density: f64,
    /// Pa s.
    viscosity: f64,
    /// Largest measured velocity, m/s: the given part of the velocity in an infinite tank.
    pub fastest: f64,
    /// Initial height of its centre above the floor, m.
    height: f64,
    /// Time until the sphere is near the floor, s.
    time: f64,
    /// Density of the sphere, kg/m³.
    sphere: f64,
}

/// The slow experiment.
pub const E1: Oil = Oil {
    name: "E1",
    density: 970.0,
    viscosity: 0.373,
    fastest: 0.947 * 0.038,
    height: 0.1275,
    time: 3.2,
    sphere: NYLON,
};
/// The fast experiment.
const E4: Oil = Oil {
    name: "E4",
    density: 960.0,
    viscosity: 0.058,
    fastest: 0.955 * 0.128,
    height: 0.1275,
    time: 1.0,
    sphere: NYLON,
};

/// The slow experiment with a twentieth of the weight: the Reynolds number is 0.07, and inertia takes less than 0.2 % of the
/// velocity.
const CREEPING: Oil = Oil {
    name: "E1 creeping",
    // Half way up, as far from both ends as possible.
    height: 0.08,
    time: 2.4,
    sphere: E1.density + 0.05 * (NYLON - E1.density),
    ..E1
};

/// Result of a fall.
pub struct Fall {
    /// Time, s, and height of the gap below the sphere, m.
    gap: Vec<[f64; 2]>,
    /// Largest velocity, m/s.
    pub fastest: f64,
    /// Relaxation time.
    pub tau: f64,
    /// Largest y⁺ half a cell from the sphere at the end.
    pub y_plus: Option<f64>,
    /// Setup and cost of the run.
    pub trial: Trial,
}

impl Oil {
    /// Runs the fall until `time` (s), with `cells` along the edge of the floor and the largest velocity `speed` in lattice
    /// units.
    pub fn fall(
        &self,
        context: &CaseContext,
        (cells, speed): (u32, f64),
        time: f64,
        method: Method,
    ) -> anyhow::Result<Fall> {
        let cell = EDGE / f64::from(cells);
        let time_step = speed * cell / self.fastest;
        let (density, nu) = (self.density, self.viscosity / self.density);
        let (sphere, height) = (self.sphere, self.height);
        // Gravity acts on the rock only: it drives no flow, and the weight of the fluid would compress it.
        let text = format!(
            r#"
            domain = {{ size = [0.1, 0.1, 0.16], cell = {cell:e} }}
            fluid = {{ density = {density}, viscosity = {nu:e} }}
            numerics = {{ time_step = {time_step:e} }}
            run = {{ steps = 1 }}
            [boundaries]
            x_min = {{ kind = "wall" }}
            x_max = {{ kind = "wall" }}
            y_min = {{ kind = "wall" }}
            y_max = {{ kind = "wall" }}
            z_min = {{ kind = "wall" }}
            z_max = {{ kind = "wall" }}
            [[materials]]
            name = "nylon"
            density = {sphere}
            normal_stiffness = 1e7
            friction = 20
            [[blocks]]
            kind = "sphere"
            radius = {RADIUS}
            position = [0.05, 0.05, {height}]
            "#
        );
        let mut scene = Scene::from_toml(&text, Path::new("."), self.name)?;
        method.choose(&mut scene);
        let mut tank = Tank::fill(context, &scene)?;
        let every = (time / time_step / SAMPLES) as u64;
        let (mut gap, mut fastest) = (Vec::new(), 0.0f64);
        while tank.simulation.time() < time {
            tank.advance(every)?;
            let pose = tank.pose(0);
            fastest = fastest.max(-pose.velocity.z);
            gap.push([tank.simulation.time(), pose.centre.z - RADIUS]);
        }
        let what = format!("{} D {:.0}", self.name, 2.0 * RADIUS / cell);
        Ok(Fall {
            gap,
            fastest,
            tau: tank.lattice().setup().tau(),
            y_plus: tank.y_plus()?,
            trial: tank.trial(&what),
        })
    }
}

/// Time from which the velocity of [`E1`] changes by less than 0.5 % until the floor is near, s.
pub const E1_FASTEST: f64 = 1.4;

/// Velocity without inertia, with `cells` along the edge of the floor.
fn creeping(context: &CaseContext, cells: u32) -> anyhow::Result<Record> {
    let fall = CREEPING.fall(context, (cells, SPEED), CREEPING.time, Method::DEFAULT)?;
    let ratio = fall.fastest / creeping_velocity();
    let across = f64::from(cells) * 2.0 * RADIUS / EDGE;
    let quantity = format!("largest velocity / Stokes' law between walls, D = {across:.0}");
    Ok(fall.trial.relative(quantity, ratio, 1.0, 2e-2))
}

/// The slow experiment until its largest velocity, with 6 cells across the sphere.
pub fn short(context: &CaseContext) -> Outcome {
    let fall = E1.fall(context, (40, SPEED), E1_FASTEST, Method::DEFAULT)?;
    let ratio = fall.fastest / E1.fastest;
    let quantity = "largest velocity / measured, E1, D = 6";
    Ok(vec![fall.trial.relative(quantity, ratio, 1.0, 2e-2)])
}

/// Velocity of [`CREEPING`] by Stokes' law between walls: a square duct of half width l slows a small sphere by 1.9033 r/l, a
/// cylinder by 2.105 r/l (Happel & Brenner 1983, chapter 7). The further terms are those of the cylinder that slows it as much;
/// they are 0.5 % of the velocity.
fn creeping_velocity() -> f64 {
    let oil = CREEPING;
    let stokes = 2.0 / 9.0 * (oil.sphere - oil.density) * GRAVITY * RADIUS * RADIUS / oil.viscosity;
    let ratio = RADIUS / (0.5 * EDGE) * 1.9033 / 2.105;
    let above = 1.0 - 2.105 * ratio + 2.0865 * ratio.powi(3) - 1.7068 * ratio.powi(5);
    stokes * above / (1.0 - 0.75857 * ratio.powi(5))
}

/// Both experiments on three grids, with 9, 12 and 18 cells across the sphere, and the slow one without inertia.
pub fn whole(context: &CaseContext) -> Outcome {
    let grids = [60, 80, 120];
    let mut records = Vec::new();
    for cells in [60, 80] {
        records.push(creeping(context, cells)?);
    }
    for (oil, speed) in [(E1, 0.02), (E4, 0.03)] {
        let mut before: Option<Fall> = None;
        for cells in grids {
            let fall = oil.fall(context, (cells, speed), oil.time, Method::DEFAULT)?;
            let name = format!("{}, D = {}", oil.name, f64::from(cells) * 0.15);
            let ratio = fall.fastest / oil.fastest;
            let quantity = format!("largest velocity / measured, {name}");
            records.push(fall.trial.relative(quantity, ratio, 1.0, 2e-2));
            if let Some(coarse) = &before {
                let apart = |[time, gap]: &[f64; 2]| (at(&coarse.gap, *time) - gap).abs();
                let most = fall.gap.iter().map(apart).fold(0.0, f64::max) / RADIUS;
                let quantity = format!("trajectory against the coarser grid / r, {}", oil.name);
                records.push(fall.trial.at_most(quantity, most, 0.1));
            }
            before = Some(fall);
        }
    }
    Ok(records)
}

/// Linear interpolation between the points of a curve.
fn at(curve: &[[f64; 2]], x: f64) -> f64 {
    let after = curve.partition_point(|point| point[0] < x).max(1);
    let Some([[x0, y0], [x1, y1]]) = curve.get(after - 1..=after).and_then(|p| p.first_chunk())
    else {
        return curve.last().map_or(f64::NAN, |point| point[1]);
    };
    y0 + (y1 - y0) * (x - x0) / (x1 - x0)
}
