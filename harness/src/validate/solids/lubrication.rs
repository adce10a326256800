//! Blocks that approach a wall: the force that the grid resolves in the gap, and the lubrication force added to it.

use crate::validate::{
    CaseContext, Outcome, Trial,
    tank::{self, Tank, block, numbers},
};
use glam::{DQuat, DVec3};
use riprap::{
    geometry::{Form, Part, Polyhedron, Pose},
    rock::{
        contact::{Placed, ThinGap},
        law::Film,
    },
    scene::{BlockShape, Boundary, Motion, Scene},
};
use std::f64::consts::PI;

/// Relaxation time: ν = 1/6, so that the flow adjusts to the gap at once.
const TAU: f64 = 1.0;
const NU: f64 = (TAU - 0.5) / 3.0;
/// Velocity of the approach: a Reynolds number of a few hundredths.
const SPEED: f64 = 1e-3;
/// Gaps at which the force is measured, cells.
const GAPS: [f64; 6] = [2.0, 1.5, 1.0, 0.5, 0.25, 0.12];
/// Steps over which a force is averaged.
const WINDOW: u64 = 20;
/// Limit on the relative error of the force: the grid takes over between a gap of half a cell and one of a whole cell, wherever
/// the gap lies among the cells.
const LIMIT: f64 = 0.2;
/// Radius of the sphere, and half an edge of the cube, cells.
const RADIUS: f64 = 5.0;
const HALF: f64 = 6.0;

/// The body that approaches the floor.
#[derive(Clone, Copy, PartialEq)]
enum Body {
    Sphere,
    Cube,
}

impl Body {
    fn half(self) -> f64 {
        match self {
            Self::Sphere => RADIUS,
            Self::Cube => HALF,
        }
    }

    fn shape(self) -> BlockShape {
        match self {
            Self::Sphere => BlockShape::Sphere { radius: RADIUS },
            Self::Cube => BlockShape::Box {
                size: [2.0 * HALF; 3],
            },
        }
    }

    /// A tank with the body above a floor by `gap`: above the wall, or above a fixed block whose face lies in a cell at the
    /// height `within`.
    fn scene(self, gap: f64, motion: Motion, within: Option<f64>) -> anyhow::Result<Scene> {
        let edge = 40;
        let mut scene = tank::scene([edge; 3], TAU)?;
        let wall = || Boundary::Wall {
            velocity: [0.0; 3],
            roughness: 0.0,
        };
        (scene.boundaries.z_min, scene.boundaries.z_max) = (wall(), wall());
        let middle = 0.5 * f64::from(edge);
        // Off the corners of the cells, as most blocks are.
        let floor = within.map_or(0.0, |within| 4.0 + within);
        let at = [middle + 0.3, middle + 0.2, floor + self.half() + gap];
        scene.blocks.push(block(self.shape(), at, motion));
        if within.is_some() {
            let slab = BlockShape::Box {
                size: [f64::from(edge), f64::from(edge), floor],
            };
            let slab = block(slab, [middle, middle, 0.5 * floor], Motion::Fixed);
            scene.blocks.push(slab);
        }
        Ok(scene)
    }

    /// The resistance of lubrication theory at a gap, N s/m: Brenner's series for the sphere, Reynolds' equation for the
    /// square, ∫φ = 0.140577 a⁴ / 4 with ∇²φ = −1 (Timoshenko & Goodier 1951).
    fn theory(self, gap: f64) -> f64 {
        match self {
            Self::Sphere => 6.0 * PI * NU * RADIUS * brenner(gap / RADIUS),
            Self::Cube => 3.0 * NU * 0.140_577 * (2.0 * HALF).powi(4) / gap.powi(3),
        }
    }

    /// Resistance that the films of the library add at a gap.
    fn film(self, gap: f64) -> anyhow::Result<f64> {
        let film = Film {
            viscosity: NU,
            round: 2.0 / 3.0,
            flat: 0.8,
            roughness: 0.1,
            delay: None,
            slip: Vec::new(),
        };
        let cuboid = |size: f64, z: f64| -> anyhow::Result<Placed> {
            let form = Form::Convex(Polyhedron::cuboid(DVec3::splat(size))?);
            Ok(Placed::of(
                &Part {
                    form,
                    offset: DVec3::ZERO,
                },
                &at(z),
            ))
        };
        let at_gap = self.half() + gap;
        let placed = match self {
            Self::Sphere => {
                let mut placed = Placed::default();
                placed.update_sphere(RADIUS, DVec3::ZERO, &at(at_gap));
                placed
            }
            Self::Cube => cuboid(2.0 * HALF, at_gap)?,
        };
        let near = ThinGap::between(&cuboid(100.0, -50.0)?, &placed, film.reach());
        Ok(near.map_or(0.0, |squeeze| film.resistance(&squeeze)))
    }
}

fn at(z: f64) -> Pose {
    Pose::at_rest(DVec3::Z * z, DQuat::IDENTITY)
}

/// Brenner 1961, Chem. Eng. Sci. 16:242: drag of a sphere that approaches a plane, over Stokes's, the gap in radii.
fn brenner(gap: f64) -> f64 {
    let alpha = (1.0 + gap).acosh();
    let term = |n: i32| {
        let n = f64::from(n);
        let a = (2.0 * n + 1.0) * alpha;
        let above = 2.0 * a.sinh() + (2.0 * n + 1.0) * (2.0 * alpha).sinh();
        let below = 4.0 * (0.5 * a).sinh().powi(2) - ((2.0 * n + 1.0) * alpha.sinh()).powi(2);
        n * (n + 1.0) / ((2.0 * n - 1.0) * (2.0 * n + 3.0)) * (above / below - 1.0)
    };
    let terms = (1..100_000).map(term).take_while(|term| *term > 1e-12);
    4.0 / 3.0 * alpha.sinh() * terms.sum::<f64>()
}

/// Force on a driven block at several gaps over that of theory, from the grid alone and with the film.
pub fn run(context: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    let mut runs = vec![
        (Body::Sphere, "sphere D 10", None),
        (Body::Cube, "cube of 12", None),
        (Body::Cube, "cube of 12 over a block", Some(0.4)),
    ];
    if context.full {
        runs.push((Body::Cube, "cube of 12 over a block, higher", Some(0.75)));
        runs.push((Body::Sphere, "sphere D 10 over a block", Some(0.4)));
    }
    for (body, name, within) in runs {
        let mut scene = body.scene(GAPS[0] + 0.5, Motion::Driven, within)?;
        scene.blocks[0].velocity = numbers([0.0, 0.0, -SPEED]);
        let mut tank = Tank::fill(context, &scene)?;
        for gap in GAPS {
            let middle = ((GAPS[0] + 0.5 - gap) / SPEED) as u64;
            tank.advance(middle - WINDOW / 2 - tank.simulation.step())?;
            let mut force = 0.0;
            for _ in 0..WINDOW {
                tank.advance(1)?;
                force += tank.load(0).flow.force.z / WINDOW as f64;
            }
            let (grid, theory) = (force / SPEED, body.theory(gap));
            let whole = grid + body.film(gap)?;
            let trial = tank.trial(name);
            records.push(trial.relative(
                format!("{name}, gap {gap}: grid alone / theory"),
                grid / theory,
                1.0,
                None,
            ));
            // Wider gaps have no film, and theory does not cover the sides of a cube.
            if gap < 1.0 {
                let quantity = format!("{name}, gap {gap}: with lubrication / theory");
                records.push(trial.relative(quantity, whole / theory, 1.0, LIMIT));
            }
        }
    }
    Ok(records)
}

/// Time in which a free block sinks from a gap of a cell to a fifth of it, with lubrication and without, over that of theory.
pub fn landing(context: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    for (body, name) in [(Body::Sphere, "sphere D 10"), (Body::Cube, "cube of 12")] {
        let (from, to) = (1.0, 0.2);
        // Sinks at a hundredth of a cell per step at a gap of one cell.
        let weight = 1e-2 * body.theory(from);
        for lubrication in [true, false] {
            let mut scene = body.scene(1.5, Motion::Free, None)?;
            let volume = match body {
                Body::Sphere => 4.0 / 3.0 * PI * RADIUS.powi(3),
                Body::Cube => (2.0 * HALF).powi(3),
            };
            scene.materials[0].density = 2.0;
            scene.rock.gravity = [0.0, 0.0, -weight / volume];
            scene.coupling.lubrication = lubrication;
            let mut tank = Tank::fill(context, &scene)?;
            let mut times = [f64::NAN; 2];
            let mut before = 1.5;
            let expected = sinking(body, weight, from, to);
            while times[1].is_nan() && (tank.simulation.step() as f64) < 4.0 * expected + 1e3 {
                tank.advance(1)?;
                let gap = tank.pose(0).centre.z - body.half();
                for (time, mark) in times.iter_mut().zip([from, to]) {
                    if before > mark && gap <= mark {
                        let part = (before - mark) / (before - gap);
                        *time = tank.simulation.step() as f64 - 1.0 + part;
                    }
                }
                before = gap;
            }
            let how = if lubrication { "with" } else { "without" };
            let ratio = (times[1] - times[0]) / expected;
            let trial: Trial = tank.trial(&format!("{name}, {how} lubrication"));
            let quantity = format!("{name}: time from 1 to 0.2 cells / theory, {how} lubrication");
            let limit = lubrication.then_some(LIMIT);
            records.push(trial.relative(quantity, ratio, 1.0, limit));
        }
    }
    Ok(records)
}

/// Sinking time of theory, ∫ c dh / W with the resistance c and the weight W.
fn sinking(body: Body, weight: f64, from: f64, to: f64) -> f64 {
    const PARTS: u32 = 200;
    let ratio = (from / to).powf(1.0 / f64::from(PARTS));
    let part = |k: u32| {
        let middle = to * ratio.powf(f64::from(k) + 0.5);
        body.theory(middle) * middle * ratio.ln() / weight
    };
    (0..PARTS).map(part).sum()
}
