//! A film of viscous water that runs down an incline: u = g_x/ν (H z − z²/2).

use crate::validate::{CaseContext, Outcome, tank::Tank};
use anyhow::Result;
use riprap::scene::Scene;
use std::path::Path;

/// Depth, m.
const DEPTH: f64 = 1.0;
/// Gravity along the incline and normal to it, m/s².
const DOWN: f64 = 0.12;
const ACROSS: f64 = 1.0;
/// Kinematic viscosity, m²/s.
const VISCOSITY: f64 = 0.2;
/// Duration of the run until the flow is steady, in times 4H²/π²ν in which the slowest initial mode falls to 1/e.
const FADINGS: f64 = 7.0;

fn exact(z: f64) -> f64 {
    DOWN / VISCOSITY * (DEPTH * z - 0.5 * z * z)
}

/// The profile on ten layers of particles and on twenty.
pub fn run(context: &CaseContext) -> Outcome {
    let mut records = Vec::new();
    for (layers, limit) in [(10, None), (20, Some(0.01))] {
        let spacing = DEPTH / f64::from(layers);
        let text = format!(
            r#"
            domain = {{ size = [{}, 1, 1.5] }}
            fluid = {{ acceleration = [{DOWN}, 0, -{ACROSS}], viscosity = {VISCOSITY} }}
            particles = {{ spacing = {spacing}, plane = true }}
            run = {{ steps = 1 }}
            [boundaries]
            z_min = {{ kind = "wall" }}
            z_max = {{ kind = "open" }}
            [[water]]
            kind = "box"
            size = [{0}, 1, {DEPTH}]
            position = [{}, 0.5, {}]
            "#,
            // As short as the neighbourhood of a particle allows.
            20.0 * spacing,
            10.0 * spacing,
            0.5 * DEPTH,
        );
        let scene = Scene::from_toml(&text, Path::new("."), "film")?;
        scene.check()?;
        let mut pool = Tank::fill(context, &scene)?;
        let fading = 4.0 * DEPTH.powi(2) / (std::f64::consts::PI.powi(2) * VISCOSITY);
        pool.advance_to(FADINGS * fading)?;
        let miss = profile(&mut pool)?;
        let name = format!("L2(u), H/Δx = {layers}");
        let trial = pool.trial("viscous film");
        records.push(trial.at_most(name, miss, limit));
    }
    Ok(records)
}

/// L2 error of the velocity along the incline.
fn profile(pool: &mut Tank<'_>) -> Result<f64> {
    let water = pool.water()?;
    let (mut off, mut all) = (0.0, 0.0);
    for (x, v) in water.positions.iter().zip(&water.velocities) {
        let u = exact(x.z);
        off += (f64::from(v.x) - u).powi(2);
        all += u * u;
    }
    Ok(f64::sqrt(off / all))
}
