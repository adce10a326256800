//! The header of a run: scene, adapter and steps.

use super::{rock::Rock, scene_run::SceneRun, summary::Summary};
use crate::{broadphase::left_out, print};
use riprap::{
    lattice::{Lattice, bytes_per_cell},
    sph::SphSolver,
    units::Units,
};
use std::path::Path;

/// Prints the scene, the adapter and the steps of a run to standard error.
pub fn print_header(run: &SceneRun, summary: &Summary, folder: &Path, last: u64) {
    let simulation = &run.simulation;
    eprintln!("{}", summary.title);
    if let Some((lattice, units)) = run.lattice() {
        eprintln!("  adapter   {}", summary.adapter);
        print_lattice(run, summary, lattice, units);
    }
    if let Some(particles) = simulation.particles() {
        eprintln!("  adapter   {}", summary.adapter);
        print_water(run, summary, particles);
    }
    if let Some(rock) = run.rock() {
        print_blocks(run, &rock);
    }
    if let Some(rock) = simulation.rock() {
        for line in left_out(&rock.setup().left_out) {
            eprintln!("  left out  {line}");
        }
    }
    if let (None, Some(rock)) = (simulation.lattice(), run.rock())
        && simulation.particles().is_none()
    {
        eprintln!(
            "  search    {}, skin {:.3e} m",
            summary.adapter,
            rock.blocks.skin()
        );
        eprintln!(
            "  step      Δt = {:.4e} s, sub-steps of at most {:.4e} s",
            run.time_step(),
            rock.blocks.time_step()
        );
    }
    eprintln!(
        "  run       {} to step {last}, {}; into {}",
        run.step(),
        print::time(last as f64 * run.time_step(), 6),
        folder.display()
    );
    for warning in &run.warnings {
        eprintln!("warning: {warning}");
    }
}

fn print_lattice(run: &SceneRun, summary: &Summary, lattice: &Lattice, units: &Units) {
    let (scene, setup) = (run.scene(), lattice.setup());
    let [x, y, z] = scene.cells();
    let bandwidth = summary
        .lattice
        .as_ref()
        .map_or(0.0, |found| found.bandwidth);
    eprintln!(
        "            copies {:.1} GB/s; the kernel moves {} bytes per cell and step",
        bandwidth / 1e9,
        bytes_per_cell(setup)
    );
    let memory = run.memory.as_ref().map(|memory| {
        format!(
            "; {} in {} bindings",
            print::bytes(memory.populations + memory.others),
            memory.bindings.populations
        )
    });
    eprintln!(
        "  grid      {x} × {y} × {z} cells of {:.4e} m, {} of them fluid{}",
        units.cell,
        lattice.geometry().fluid_cells,
        memory.unwrap_or_default()
    );
    let mach = scene.velocity_scale().map(|speed| units.mach(speed));
    let mach = mach.map_or_else(|_| "unknown".into(), |mach| format!("{mach:.3}"));
    eprintln!(
        "  step      Δt = {:.4e} s, τ = {:.6}, Mach {mach}",
        units.time_step,
        setup.tau()
    );
    let [wall, solid] = setup.odd_rate_floors();
    let odd = match (setup.lambda, setup.wall_lambda) {
        (Some(lambda), _) => format!("Λ = {lambda} everywhere"),
        (None, Some(lambda)) if setup.operator().is_some() => format!(
            "Λ = {lambda} next to walls, odd rates at least {wall:.3}, next to solids {solid:.3}"
        ),
        (None, Some(lambda)) => {
            format!("Λ = {lambda} next to walls, odd rates there at least {wall:.3}")
        }
        (None, None) => "published odd rates everywhere".into(),
    };
    eprintln!(
        "  kernel    {:?}, {:?}, {:?} storage, {} lanes, {odd}{}{}",
        setup.collision,
        setup.equilibrium,
        setup.storage,
        setup.lanes,
        match setup.wale {
            Some(constant) if setup.wale_interval == 1 => format!(", WALE {constant}"),
            Some(constant) => format!(", WALE {constant} every second step"),
            None => String::new(),
        },
        match setup.wall_model {
            Some(model) => format!(", walls by {model:?}"),
            None => String::new(),
        }
    );
}

fn print_water(run: &SceneRun, summary: &Summary, particles: &SphSolver) {
    if let Some(pool) = &summary.pool {
        eprintln!(
            "  water     {} particles of {:.4e} m, {} boundary particles; speed of sound {:.2} m/s",
            pool.particles, pool.spacing, pool.shell, pool.sound_speed
        );
    }
    eprintln!(
        "  step      Δt = {:.4e} s, acoustic steps of at most {:.4e} s",
        run.time_step(),
        particles.setup().acoustic_step()
    );
}

fn print_blocks(run: &SceneRun, rock: &Rock<'_>) {
    let Some(coupled) = run.simulation.coupled() else {
        eprintln!("  blocks    {}", rock.counted());
        return;
    };
    eprintln!(
        "  blocks    {}; {} in the fluid",
        rock.counted(),
        coupled.in_fluid()
    );
    let (time_step, sub_step) = (run.time_step(), rock.blocks.time_step());
    eprintln!(
        "            {} sub-steps of at most {:.4e} s; they exchange with the fluid every {} steps",
        (time_step / sub_step).ceil().max(1.0),
        sub_step.min(time_step),
        run.scene().coupling.interval
    );
}
