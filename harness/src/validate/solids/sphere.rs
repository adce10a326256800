//! A sphere in fluid at rest: released, and rotating.

use crate::validate::{
    CaseContext, Method, Outcome,
    tank::{self, Tank, block, numbers},
};
use riprap::scene::{BlockShape, Motion};
use std::f64::consts::{PI, TAU};

/// Gravity, small enough for Stokes flow: ρ U D/μ is 0.05 at the end.
const GRAVITY: f64 = 1e-6;
/// Edge of the tank in radii: an echo returns after 3 radii to the wall and 3 back, and walls add 1 % of added mass.
const EDGE: f64 = 8.0;
/// Times at which the velocity is measured, radii at the speed of sound: the initial sound has left, no echo has returned.
const BETWEEN: [f64; 2] = [3.0, 4.5];

/// A sphere released in fluid at rest: its acceleration is (ρₛ−ρ)g/(ρₛ+ρ/2) once the sound of its release has left, less the
/// viscous forces that have built up by then.
///
/// On the lattice both take time. Before sound has crossed the sphere only its own mass resists: the acceleration of the first
/// step is (ρₛ−ρ)g/ρₛ, a third more at ρₛ = 1.5 ρ. Afterwards viscosity adds the Basset force, which grows with √(νt): for less
/// than 1 % when sound has left a sphere of 16 cells, ν would have to be 2e-5, where cells act as either solid or fluid. So the
/// reference is the solution with both effects, which is exact for a small sphere in a wide tank.
///
/// Spheres of ρₛ/ρ = 1.5 and 2.65.
pub fn release(context: &CaseContext) -> Outcome {
    let mut runs = vec![(1.5, 8.0, 0.505), (2.65, 8.0, 0.505)];
    if context.full {
        runs.extend([(1.5, 8.0, 0.6), (2.65, 8.0, 0.6), (1.5, 8.0, 0.5005)]);
        runs.extend([(1.5, 16.0, 0.505), (2.65, 16.0, 0.505)]);
    }
    let mut records = Vec::new();
    for (density, radius, tau) in runs {
        let nu = (tau - 0.5) / 3.0;
        let steps = BETWEEN.map(|time| (time * radius * 3f64.sqrt()).round() as u64);
        let edge = EDGE * radius;
        let mut scene = tank::scene([edge as u32; 3], tau)?;
        tank::close(&mut scene);
        scene.rock.gravity = [0.0, 0.0, -GRAVITY];
        scene.materials[0].density = density;
        let shape = BlockShape::Sphere { radius };
        let middle = [0.5 * edge; 3];
        scene.blocks.push(block(shape, middle, Motion::Free));
        let mut tank = Tank::fill(context, &scene)?;
        let mut speeds = [0.0; 3];
        for (speed, until) in speeds.iter_mut().zip([1, steps[0], steps[1]]) {
            tank.advance(until - tank.simulation.step())?;
            *speed = -tank.pose(0).velocity.z;
        }
        let theory = Release {
            radius,
            density,
            nu,
        };
        let [begin, end] = steps.map(|step| theory.speed(step as f64));
        let trial = tank.trial(&format!("sphere r {radius} ρ {density}"));
        let quantity = format!("acceleration / theory, ρs/ρ = {density}, r = {radius}, τ = {tau}");
        let ratio = (speeds[2] - speeds[1]) / (end - begin);
        records.push(trial.relative(quantity, ratio, 1.0, 5e-2));
        let drag = 1.0 - (end - begin) / ((steps[1] - steps[0]) as f64 * theory.inviscid());
        records.push(trial.report("part of it that viscosity takes", drag));
        let start = speeds[0] / ((density - 1.0) / density * GRAVITY);
        records.push(trial.relative("first step / ((ρs−ρ)g/ρs)", start, 1.0, 1e-3));
        records.push(trial.relative("velocity at the end / theory", speeds[2] / end, 1.0, None));
    }
    Ok(records)
}

/// A sphere in a wide fluid of density 1.
struct Release {
    radius: f64,
    density: f64,
    nu: f64,
}

impl Release {
    /// Acceleration with added mass only.
    fn inviscid(&self) -> f64 {
        (self.density - 1.0) * GRAVITY / (self.density + 0.5)
    }

    /// Velocity at a time. Sound leaves as a dipole, φ = ∂/∂r [f(t − (r−R)/c)/r] cos θ, and the pressure on the
    /// sphere is that of φ; Basset's and Stokes' forces are added.
    fn speed(&self, time: f64) -> f64 {
        const STEP: f64 = 0.05;
        let c = 1.0 / 3f64.sqrt();
        let (r, nu) = (self.radius, self.nu);
        let volume = 4.0 / 3.0 * PI * r.powi(3);
        // f', f'' at r = R.
        let (mut once, mut twice, mut speed) = (0.0, 0.0, 0.0);
        let mut history: Vec<f64> = Vec::new();
        while (history.len() as f64) * STEP < time {
            let ago = |k: usize| (history.len() - k) as f64 * STEP;
            let memory = |(k, a): (usize, &f64)| a * 2.0 * (ago(k).sqrt() - ago(k + 1).sqrt());
            let basset: f64 = history.iter().enumerate().map(memory).sum();
            let viscous = 6.0 * r * r * (PI * nu).sqrt() * basset + 6.0 * PI * nu * r * speed;
            let sound = 4.0 / 3.0 * PI * r * r * (twice / (c * r) + once / (r * r));
            let weight = (self.density - 1.0) * volume * GRAVITY;
            let rate = (weight - sound - viscous) / (self.density * volume);
            // The fluid at the surface moves with it: f''/(c²R) + 2f'/(cR²) + 2f/R³ is the velocity.
            let third = c * c * r * (rate - 2.0 * twice / (c * r * r) - 2.0 * once / r.powi(3));
            twice += third * STEP;
            once += twice * STEP;
            speed += rate * STEP;
            history.push(rate);
        }
        speed
    }
}

/// ω r²/ν: the inertial part of the torque grows with its square and is 1e-4 of the whole.
const REYNOLDS: f64 = 0.3;

/// Torque on a sphere that rotates in a viscous fluid: 8πμr³ω/(1 − c) in a dilute periodic array. Spheres of 8 cells in 24³, and
/// with `--full` of 16 in 48³.
pub fn rotation(context: &CaseContext) -> Outcome {
    let mut runs = vec![(4.0, 24, 0.6, 3e-2), (4.0, 24, 1.0, 3e-2)];
    if context.full {
        runs.extend([(8.0, 48, 0.6, 1e-2), (8.0, 48, 1.0, 1e-2)]);
    }
    let mut records = Vec::new();
    for (radius, edge, tau, limit) in runs {
        let nu = (tau - 0.5) / 3.0;
        let length = f64::from(edge);
        let omega = REYNOLDS * nu / (radius * radius);
        let mut scene = tank::scene([edge; 3], tau)?;
        let shape = BlockShape::Sphere { radius };
        let mut sphere = block(shape, [0.5 * length + 0.2; 3], Motion::Driven);
        sphere.spin = numbers([0.0, 0.0, omega]);
        scene.blocks.push(sphere);
        // The slowest mode of the box, which hardly affects the torque, has decayed to 0.2 %.
        let steps = (6.0 / (nu * (TAU / length).powi(2))) as u64;
        scene.coupling.interval = (steps / 8) as u32;
        let mut tank = Tank::fill(context, &scene)?;
        tank.advance(8 * u64::from(scene.coupling.interval))?;
        let concentration = 4.0 / 3.0 * PI * (radius / length).powi(3);
        let exact = -8.0 * PI * nu * radius.powi(3) * omega / (1.0 - concentration);
        let torque = tank.load(0).flow.torque();
        let trial = tank.trial("turning sphere");
        let quantity = format!("T / (8πμr³ω/(1−c)), r = {radius}, τ = {tau}");
        records.push(trial.relative(quantity, torque.z / exact, 1.0, limit));
        let across = torque.truncate().length() / exact.abs();
        records.push(trial.at_most("torque across / torque", across, 1e-3));
    }
    Ok(records)
}

/// Speed of the rim of a sphere that turns twice, cells per step: a Mach number of 0.1.
const RIM: f64 = 0.06;

/// A sphere turns twice: no fluid is faster than its rim, neither outside nor in the cells of the sphere.
pub fn turning(context: &CaseContext) -> Outcome {
    let (radius, edge, tau) = (6.0, 24, 0.6);
    let mut records = Vec::new();
    for method in [Method::DEFAULT, Method::SUPERPOSITION] {
        let mut scene = tank::scene([edge; 3], tau)?;
        let shape = BlockShape::Sphere { radius };
        let mut sphere = block(shape, [0.5 * f64::from(edge) + 0.2; 3], Motion::Driven);
        sphere.spin = numbers([0.6 * RIM / radius, 0.0, 0.8 * RIM / radius]);
        scene.blocks.push(sphere);
        method.choose(&mut scene);
        let mut tank = Tank::fill(context, &scene)?;
        tank.advance((2.0 * TAU * radius / RIM) as u64)?;
        let fastest = tank.totals()?.max_speed;
        let trial = tank.trial("turning sphere");
        let quantity = format!("largest speed / speed of the rim, {}", method.name);
        records.push(trial.at_most(quantity, fastest / RIM, 1.0));
    }
    Ok(records)
}
