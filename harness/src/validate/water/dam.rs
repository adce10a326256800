//! Dam break (Martin & Moyce 1952): speed of the front over the dry floor.

use crate::validate::{
    CaseContext, Outcome, Trial,
    tank::{self, GRAVITY, Tank},
};
use riprap::scene::Scheme;

/// Width a of the column, 2.25 in, m; it is 2a high.
const WIDTH: f64 = 0.05715;
/// Speed dZ/dT of the front while 1.8 < Z < 3.6, from their table.
pub const SPEED: f64 = 1.37;
const STRETCH: [f64; 2] = [1.8, 3.6];

/// Speed dZ/dT of the front with Z = x/a and T = t √(2g/a), and the share of particles kept.
pub fn front(
    context: &CaseContext,
    columns: u32,
    scheme: Scheme,
) -> anyhow::Result<(Trial, [f64; 2])> {
    let spacing = WIDTH / f64::from(columns);
    let size = [5.0 * WIDTH, 3.0 * WIDTH];
    let mut scene = tank::pool(size, spacing, [WIDTH, 2.0 * WIDTH], "")?;
    tank::choose(&mut scene, scheme);
    let mut pool = Tank::fill(context, &scene)?;
    let unit = (WIDTH / (2.0 * GRAVITY)).sqrt();
    let (mut front, mut time) = (vec![1.0], vec![0.0]);
    while front[front.len() - 1] < 3.9 && time[time.len() - 1] < 6.0 {
        pool.advance_to(pool.simulation.time() + 0.02 * unit)?;
        let water = pool.water()?;
        // Particles on the floor only: spray ahead of them is not the front.
        let floor = water.positions.iter().filter(|x| x.z < 2.0 * spacing);
        let farthest = floor.fold(0.0, |most: f64, x| most.max(x.x)) + 0.5 * spacing;
        front.push(farthest / WIDTH);
        time.push(pool.simulation.time() / unit);
    }
    let [from, to] = STRETCH.map(|z| passes(&front, &time, z));
    let kept = pool.water()?.len() as f64 / f64::from(pool.particles().counts().fluid);
    Ok((
        pool.trial("dam break"),
        [(STRETCH[1] - STRETCH[0]) / (to - from), kept],
    ))
}

/// The front of a dam break.
pub fn run(context: &CaseContext) -> Outcome {
    let columns: &[u32] = if context.full { &[20, 40] } else { &[20] };
    let mut records = Vec::new();
    for &columns in columns {
        let (trial, [speed, kept]) = front(context, columns, Scheme::Delta)?;
        let name = format!("dZ/dT of the front, a/Δx = {columns}");
        records.push(trial.relative(name, speed, SPEED, 0.08));
        records.push(trial.absolute("share of particles kept", kept, 1.0, 0.0));
    }
    Ok(records)
}

/// Time at which the front passes `z`.
fn passes(front: &[f64], time: &[f64], z: f64) -> f64 {
    let Some(n) = front
        .iter()
        .position(|front| *front >= z)
        .filter(|n| *n > 0)
    else {
        return f64::NAN;
    };
    let share = (z - front[n - 1]) / (front[n] - front[n - 1]);
    time[n - 1] + share * (time[n] - time[n - 1])
}
