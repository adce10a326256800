//! The doubly periodic shear layer (Minion & Brown 1997, J. Comput. Phys. 138:734), κ = 80 on 64²: layers thinner than a cell
//! roll up. A scheme that is stable here at a viscosity and a Mach number is stable on unresolved flow.

use super::{Cell, Map, Outcome, Sink};
use crate::{
    bench,
    validate::{CaseContext, Flow, fields, record},
};
use riprap::{
    Error,
    lattice::{Collision, Equilibrium, Setup, State, Storage},
    scene::Scene,
    units::Units,
};
use std::{f64::consts::TAU, path::Path, time::Instant};

/// The map.
pub const MAP: Map = Map {
    name: "shear_layer",
    title: "Doubly periodic shear layer, κ = 80, 64² cells",
    x: "Mach number",
    y: "viscosity, lattice units",
    short: "6 methods, 3 viscosities, 4 Mach numbers, 3000 steps",
    full: "24 methods, 7 viscosities, 5 Mach numbers, 10 000 steps",
    run,
};

/// As thin as lanes of four cells allow.
const CELLS: [u32; 3] = [64, 64, 4];
/// Width of the box over that of the layers.
const KAPPA: f64 = 80.0;
/// Perturbation velocity across the layers that makes them roll up, over U₀.
const DELTA: f64 = 0.05;
/// Speed over U₀ at the end beyond which a run is marked as unphysical: viscosity should have slowed it down.
const FASTEST: f64 = 1.2;
/// Steps between readings of the speed.
const LOOK: u64 = 250;

/// The lowest viscosity stands for zero, which the library does not accept.
const NU: [f64; 7] = [1e-6, 1e-5, 1e-4, 1e-3, 3e-3, 1e-2, 3e-2];
const SHORT_NU: [f64; 3] = [1e-6, 1e-3, 1e-2];
const MACH: [f64; 5] = [0.1, 0.15, 0.2, 0.3, 0.4];
const SHORT_MACH: [f64; 4] = [0.1, 0.2, 0.3, 0.4];

#[derive(Clone, Copy, PartialEq)]
struct Method {
    collision: Collision,
    equilibrium: Equilibrium,
    wale: bool,
    storage: Storage,
}

impl Method {
    fn all(full: bool) -> Vec<Self> {
        let mut all = Vec::new();
        for collision in [Collision::Bgk, Collision::Suga, Collision::Hermite] {
            for equilibrium in [Equilibrium::SecondOrder, Equilibrium::Product] {
                for wale in [false, true] {
                    for storage in [Storage::F32, Storage::F16] {
                        let method = Self {
                            collision,
                            equilibrium,
                            wale,
                            storage,
                        };
                        if full || method.is_short() {
                            all.push(method);
                        }
                    }
                }
            }
        }
        all
    }

    /// Whether the short form includes it: each operator as it was published, and the default, also in 16 bits or with WALE.
    fn is_short(&self) -> bool {
        let plain = !self.wale && self.storage == Storage::F32;
        match (self.collision, self.equilibrium) {
            (_, Equilibrium::SecondOrder) => plain,
            (Collision::Hermite, Equilibrium::Product) => {
                !self.wale || self.storage == Storage::F32
            }
            _ => false,
        }
    }

    fn name(&self) -> String {
        let collision = record::collision(self.collision);
        let equilibrium = record::equilibrium(self.equilibrium);
        let wale = if self.wale { " wale" } else { "" };
        let storage = bench::storage(self.storage);
        format!("{collision} {equilibrium}{wale} {storage}")
    }

    /// The method in the syntax of scenes.
    fn numerics(&self) -> String {
        let eddy = if self.wale { "wale" } else { "none" };
        let equilibrium = match self.equilibrium {
            Equilibrium::SecondOrder => "second_order",
            Equilibrium::Product => "product",
        };
        let collision = record::collision(self.collision);
        format!(
            "collision = \"{collision}\"\nequilibrium = \"{equilibrium}\"\neddy_viscosity = \"{eddy}\"\n"
        )
    }

    fn setup(&self, context: &CaseContext, nu: f64) -> Setup {
        let mut setup = context.setup(CELLS, nu);
        (setup.collision, setup.equilibrium) = (self.collision, self.equilibrium);
        setup.wale = self.wale.then_some(0.5);
        setup.storage = self.storage;
        if self.storage == Storage::F16 {
            setup.lanes = setup.lanes.max(2);
        }
        setup
    }
}

/// Advice of the library before a run with the lattice viscosity `nu`, the largest speed `speed` (cells per step) and these
/// `numerics`, lines of TOML, in the format of [`Cell::warned`].
fn advice(nu: f64, speed: f64, numerics: &str) -> anyhow::Result<String> {
    let text = format!(
        "run = {{ steps = 1 }}\n[domain]\nsize = {CELLS:?}\ncell = 1\n[fluid]\ndensity = 1\nviscosity = {nu:e}\n\
         [numerics]\ntime_step = 1\nvelocity_scale = {speed:e}\n{numerics}"
    );
    let scene = Scene::from_toml(&text, Path::new("."), "stress")?;
    match scene.advise(&Units::of(&scene)?) {
        Err(Error::Scene { key, .. }) => Ok(format!("refused {key}")),
        Err(other) => Err(other.into()),
        Ok(warnings) => Ok(super::warned(&warnings)),
    }
}

/// Whether the advice fits the outcome: a run that ends badly needs at least a warning, and one that ends well must not be
/// refused. A warning before a run that ends well may concern accuracy.
fn fits(advice: &str, well: bool) -> bool {
    match advice {
        "" => well,
        refused if refused.starts_with("refused") => !well,
        _ => true,
    }
}

/// Layers at a quarter and three quarters of the height.
fn start(speed: f64) -> State {
    fields::state(CELLS, |[x, y, _]| {
        let (x, y) = (x / f64::from(CELLS[0]), y / f64::from(CELLS[1]));
        let along = if y <= 0.5 { y - 0.25 } else { 0.75 - y };
        let across = DELTA * (TAU * (x + 0.25)).sin();
        (0.0, [speed * (KAPPA * along).tanh(), speed * across, 0.0])
    })
}

fn run(context: &CaseContext, sink: &mut Sink) -> anyhow::Result<()> {
    let (nus, machs): (&[f64], &[f64]) = match context.full {
        true => (&NU, &MACH),
        false => (&SHORT_NU, &SHORT_MACH),
    };
    let steps = if context.full { 10_000 } else { 3000 };
    for method in Method::all(context.full) {
        for &nu in nus {
            for &mach in machs {
                let mut cell = measure(context, &method, nu, mach, steps)?;
                cell.detail += &against_f32(sink, &method, &cell);
                sink.add(cell)?;
            }
        }
    }
    Ok(())
}

/// Outcome of the same run in 32 bits.
fn against_f32(sink: &Sink, method: &Method, cell: &Cell) -> String {
    if method.storage == Storage::F32 {
        return String::new();
    }
    let wide = Method {
        storage: Storage::F32,
        ..*method
    };
    let name = wide.name();
    let cells = sink.of(MAP.name);
    let same = |c: &&&Cell| c.panel == name && c.x == cell.x && c.y == cell.y;
    cells.iter().find(same).map_or(String::new(), |wide| {
        let same = match wide.outcome == cell.outcome {
            true => "as in f32",
            false => "other than in f32",
        };
        format!("; {same}: {} {}", wide.outcome, wide.label())
    })
}

fn measure(
    context: &CaseContext,
    method: &Method,
    nu: f64,
    mach: f64,
    steps: u64,
) -> anyhow::Result<Cell> {
    let begin = Instant::now();
    let speed = mach / 3f64.sqrt();
    let advice = advice(nu, speed, &method.numerics())?;
    let mut flow = context.flow(method.setup(context, nu), &start(speed), true)?;
    let found = follow(&mut flow, steps, speed)?;
    // Pressure stores about Ma² of the energy, which may be returned; a flow without forces cannot gain more.
    let gains = found.gain > mach * mach;
    let (outcome, cause) = match found.fault {
        Some(cell) => (
            Outcome::Error("Diverged".into()),
            format!(" in cell {cell:?}"),
        ),
        None if gains => (Outcome::Unphysical, ": no force gives it that".into()),
        None if found.speed > FASTEST => (Outcome::Unphysical, String::new()),
        None => (Outcome::Ended, String::new()),
    };
    let (y, x) = (format!("{nu:e}"), format!("{mach}"));
    Ok(Cell {
        // Persistent vortices are not a failure of the method.
        agrees: Some(fits(&advice, found.fault.is_none() && !gains)),
        outcome,
        value: found.fault.is_none().then_some(found.speed),
        steps: found.steps,
        warned: advice,
        seconds: begin.elapsed().as_secs_f64(),
        detail: format!(
            "largest max|u| / U₀ {:.3}, largest rise of the kinetic energy {:.4}{cause}",
            found.peak, found.gain
        ),
        ..Cell::new(MAP.name, &method.name(), y, x, "max|u| / U₀ at the end")
    })
}

/// Result of a run.
#[derive(Default)]
struct Found {
    /// The cell in which the guard stopped it.
    fault: Option<[u32; 3]>,
    steps: u64,
    /// max|u| / U₀ at the end, and the largest one.
    speed: f64,
    peak: f64,
    /// Largest rise of the kinetic energy over its previous minimum, relative to it.
    gain: f64,
}

/// Runs to the end, or until the guard stops it.
fn follow(flow: &mut Flow<'_>, steps: u64, speed: f64) -> anyhow::Result<Found> {
    let mut found = Found::default();
    let mut least = flow.sums()?.kinetic_energy;
    while found.steps < steps {
        let some = LOOK.min(steps - found.steps);
        if let Some(fault) = flow.try_advance(some)? {
            (found.fault, found.steps) = (Some(fault.cell), fault.step);
            return Ok(found);
        }
        found.steps += some;
        let sums = flow.sums()?;
        found.speed = sums.max_speed / speed;
        found.peak = found.peak.max(found.speed);
        found.gain = found.gain.max(sums.kinetic_energy / least - 1.0);
        least = least.min(sums.kinetic_energy);
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn methods_have_names_of_their_own_and_are_those_of_scenes() {
        let all = Method::all(true);
        assert_eq!(all.len(), 3 * 2 * 2 * 2);
        for (n, method) in all.iter().enumerate() {
            assert!(all[..n].iter().all(|other| other.name() != method.name()));
            // Within the range of every method.
            let advice = advice(0.01, 0.01, &method.numerics()).unwrap();
            assert_eq!(advice, "", "{}", method.name());
        }
        let short = Method::all(false);
        assert!(short.iter().all(|method| all.contains(method)));
        assert_eq!(short.len(), 6);
    }

    #[test]
    fn layers_are_antisymmetric_and_as_fast_as_they_should() {
        let state = start(0.1);
        let sum: f64 = state.velocity[0].iter().map(|u| f64::from(*u)).sum();
        assert!(sum.abs() < 1e-4, "{sum}");
        let fastest = state.velocity[0].iter().fold(0f32, |m, u| m.max(u.abs()));
        assert!((fastest - 0.1).abs() < 1e-6);
    }

    #[test]
    fn only_silence_before_a_fall_and_refusals_of_what_holds_are_wrong() {
        let of = |nu, speed| advice(nu, speed, "").unwrap();
        let (silent, warned, refused) = (of(0.01, 0.02), of(1e-5, 0.02), of(0.01, 0.2));
        assert_eq!(silent, "");
        assert_eq!(warned, "warned domain.cell");
        assert_eq!(refused, "refused numerics.time_step");
        assert!(fits(&silent, true) && !fits(&silent, false));
        assert!(fits(&warned, true) && fits(&warned, false));
        assert!(!fits(&refused, true) && fits(&refused, false));
    }
}
