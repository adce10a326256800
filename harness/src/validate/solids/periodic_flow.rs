//! Slow steady flow through a simple cubic array of a body.

use crate::validate::{
    CaseContext, Method, Trial,
    tank::{self, Tank, block, numbers},
};
use riprap::scene::{BlockShape, Motion, Rotation, Scene, Solid};
use std::{f64::consts::TAU, path::Path};

/// U D/ν: the inertial part of the drag grows with its square and is below 1e-4 of the whole.
const REYNOLDS: f64 = 0.05;
/// Relative change of the mean velocity below which the flow is steady, over the longer of its diffusive time (edge/2π)²/ν and
/// the time in which the drag stops it: the remaining error is of this size, a tenth of the limit on the balance of forces.
const STEADY: f64 = 1e-4;
/// Largest number of such times until the flow is steady: 8 are usual.
const MOST_TIMES: u32 = 64;

/// The body of the array.
#[derive(Clone, Debug)]
pub enum Body {
    /// A block: its shape, its offset from the middle in cells, and its rotation.
    Block(BlockShape, [f64; 3], Rotation),
    /// Solid cells, with walls by bounce-back.
    Cells(Vec<Solid>),
}

/// An array to be computed.
#[derive(Clone, Debug)]
pub struct PeriodicFlow {
    pub body: Body,
    /// Size across the body, cells.
    pub size: f64,
    /// Edge of the periodic cube of one body, cells.
    pub edge: u32,
    pub tau: f64,
    pub method: Method,
    /// Estimate of [`Drag::resistance`].
    pub expected: f64,
}

/// Result for an array.
pub struct Drag {
    /// Force on a body over μU, U the mean velocity over fluid and bodies, cells.
    pub resistance: f64,
    /// Relative difference between the force on the body and the force that drives the fluid; zero for solid cells.
    pub balance: f64,
    /// Setup and cost of the run.
    pub trial: Trial,
}

/// A static solid in a cube of `edge` cells, by its keys in a scene.
pub fn static_solids(edge: u32, keys: &str) -> anyhow::Result<Vec<Solid>> {
    let text = format!(
        "domain = {{ size = [{edge}, {edge}, {edge}], cell = 1 }}\nfluid = {{ density = 1, viscosity = 1 }}\n\
         numerics.time_step = 1\nrun.steps = 1\n[[solids]]\n{keys}"
    );
    Ok(Scene::from_toml(&text, Path::new("."), "solids")?.solids)
}

impl PeriodicFlow {
    /// Computes the steady flow along x.
    pub fn measure(&self, context: &CaseContext, name: &str) -> anyhow::Result<Drag> {
        let nu = (self.tau - 0.5) / 3.0;
        let volume = f64::from(self.edge).powi(3);
        let speed = REYNOLDS * nu / self.size;
        let push = nu * self.expected * speed / volume;
        let mut scene = tank::scene([self.edge; 3], self.tau)?;
        scene.fluid.acceleration = numbers([push, 0.0, 0.0]);
        scene.initial.velocity = numbers([speed, 0.0, 0.0]);
        self.method.choose(&mut scene);
        match &self.body {
            Body::Block(shape, offset, rotation) => {
                let centre = offset.map(|part| 0.5 * f64::from(self.edge) + part);
                // Driven, so that its loads are measured; it is at rest.
                let mut body = block(shape.clone(), centre, Motion::Driven);
                body.rotation = *rotation;
                scene.blocks.push(body);
            }
            Body::Cells(solids) => scene.solids = solids.clone(),
        }
        // An error of the mean velocity decays at the first rate, one of the profile at least at the second.
        let edge = f64::from(self.edge);
        let rates = [nu * self.expected / volume, nu * (TAU / edge).powi(2)];
        let time = (1.0 / rates[0].min(rates[1])).ceil();
        // The force is the mean over one such time.
        scene.coupling.interval = time as u32;
        let mut tank = Tank::fill(context, &scene)?;
        let mut flux = f64::NAN;
        for times in 1.. {
            // The populations reflected by cells inside a body alternate with a period of two steps. Without the half force: in
            // partially saturated cells it is no part of the flux.
            tank.advance(time as u64 - 1)?;
            let before = tank.totals()?.momentum[0];
            tank.advance(1)?;
            let now = 0.5 * (before + tank.totals()?.momentum[0]) / volume - 0.5 * push;
            let change = (now - flux).abs();
            flux = now;
            if change <= STEADY * now.abs() {
                break;
            }
            anyhow::ensure!(
                times < MOST_TIMES,
                "the flow through the array is not steady after {} steps",
                tank.simulation.step()
            );
        }
        let pushed = push * volume;
        let force = match self.body {
            Body::Block(..) => tank.load(0).flow.force.x,
            Body::Cells(_) => pushed,
        };
        Ok(Drag {
            resistance: force / (nu * flux),
            balance: force / pushed - 1.0,
            trial: tank.trial(name),
        })
    }
}
