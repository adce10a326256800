//! What a run says before it starts.

use super::{super::engine::Engine, Coupling, Flow};
use crate::{gpu, print, search::left_out};
use riprap::lattice::bytes_a_cell;
use std::path::Path;

/// Tells, on standard error, what will run on what.
pub fn announce(engine: &Flow, folder: &Path, last: u64, bandwidth: f64) {
    let simulation = &engine.simulation;
    let (scene, units) = (simulation.scene(), simulation.units());
    let setup = simulation.lattice().setup();
    let memory = &engine.needs.memory;
    let [x, y, z] = scene.cells();
    eprintln!("{}", scene.title);
    eprintln!("  adapter   {}", gpu::describe(&engine.adapter));
    eprintln!(
        "            copies {:.1} GB/s; the kernel moves {} bytes a cell and step",
        bandwidth / 1e9,
        bytes_a_cell(setup)
    );
    eprintln!(
        "  grid      {x} × {y} × {z} cells of {:.4e} m, {} of them fluid; {} in {} bindings",
        units.cell,
        simulation.lattice().geometry().fluid_cells,
        print::bytes(memory.populations + memory.others),
        memory.bindings
    );
    let mach = scene.velocity_scale().map(|speed| units.mach(speed));
    let mach = mach.map_or_else(|_| "unknown".into(), |mach| format!("{mach:.3}"));
    eprintln!(
        "  step      Δt = {:.4e} s, τ = {:.6}, Mach {mach}",
        units.time_step,
        setup.tau()
    );
    let odd = match (setup.lambda, setup.wall_lambda) {
        (Some(lambda), _) => format!("Λ = {lambda} everywhere"),
        (None, Some(lambda)) => format!(
            "Λ = {lambda} beside walls, odd rates there at least {}",
            setup.odd_rate_floor
        ),
        (None, None) => "published odd rates everywhere".into(),
    };
    eprintln!(
        "  kernel    {:?}, {:?}, {:?} storage, {} lanes, {odd}{}",
        setup.collision,
        setup.equilibrium,
        setup.storage,
        setup.lanes,
        match setup.wale {
            Some(constant) => format!(", WALE {constant}"),
            None => String::new(),
        }
    );
    if let (Some(rock), Some(coupling)) = (engine.rock(), Coupling::of(simulation, 0)) {
        eprintln!(
            "  blocks    {}; {} in the fluid",
            rock.counted(),
            coupling.in_fluid
        );
        let sub_steps = (units.time_step / rock.blocks.time_step()).ceil().max(1.0);
        eprintln!(
            "            {sub_steps} sub-steps of at most {:.4e} s; they meet the fluid every {} steps",
            rock.blocks.time_step().min(units.time_step),
            scene.coupling.interval
        );
    }
    if let Some(coupled) = simulation.coupled() {
        for line in left_out(&coupled.setup().left_out) {
            eprintln!("  left out  {line}");
        }
    }
    eprintln!(
        "  run       {} to step {last}, {:.6} s; into {}",
        simulation.step(),
        units.time_from_lattice(last as f64),
        folder.display()
    );
    for warning in simulation.advice() {
        eprintln!("warning: {warning}");
    }
}
