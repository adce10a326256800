//! The linked WGSL of the kernels of a scene, as files.

use anyhow::Result;
use riprap::{Error, gpu::link::Linked, psm::SolidCells, simulation::Simulation, sph};
use std::{fmt::Write, path::Path};

/// Writes a file for each program of the fluid of a scene: those of a step, and the single-cell kernels that are in use.
pub fn write(folder: &Path, simulation: &Simulation) -> Result<()> {
    if let Some(lattice) = simulation.lattice() {
        let single = lattice.single_cell_kernels();
        let coupled = simulation.coupled();
        let solid_cells = coupled.as_ref().map(|coupled| coupled.solid_cells());
        let step = lattice
            .kernels(false)
            .chain(lattice.sampling_kernels(false));
        let blocks = solid_cells.into_iter().flat_map(SolidCells::kernels);
        let faces = solid_cells.into_iter().flat_map(SolidCells::face_kernels);
        let kernels = step.chain(blocks).map(|(kernel, _)| kernel).chain(faces);
        let kernels = kernels.chain(single.iter().map(|kernel| &**kernel));
        return write_programs(folder, kernels.map(|kernel| kernel.linked()));
    }
    let Some(particles) = simulation.particles() else {
        let message = "the scene has no fluid, so that there are no kernels to write";
        return Err(Error::argument("--kernels", message).into());
    };
    let setup = particles.setup();
    let grid = sph::CellGrid::new(setup)?;
    let linked = sph::kernels_of(setup).map(|kernel| sph::program(setup, &grid, kernel).link());
    let linked = linked.collect::<riprap::Result<Vec<_>>>()?;
    write_programs(folder, linked.iter())
}

/// Writes each program once; programs of the same file that differ in their slots are numbered.
fn write_programs<'a>(folder: &Path, linked: impl Iterator<Item = &'a Linked>) -> Result<()> {
    let failed = |path: &Path, error: std::io::Error| {
        let message = format!("cannot be written: {error}; choose another folder with `--kernels`");
        Error::file(path, message)
    };
    std::fs::create_dir_all(folder).map_err(|error| failed(folder, error))?;
    let mut programs: Vec<&Linked> = Vec::new();
    for program in linked {
        let known = |other: &&Linked| (&other.file, &other.text) == (&program.file, &program.text);
        if !programs.iter().any(known) {
            programs.push(program);
        }
    }
    for (place, program) in programs.iter().enumerate() {
        let same = |others: &[&Linked]| others.iter().filter(|p| p.file == program.file).count();
        let name = if same(&programs) == 1 {
            format!("{}.wgsl", program.file)
        } else {
            format!("{}_{}.wgsl", program.file, same(&programs[..=place]))
        };
        let mut text = String::new();
        for (slot, file) in &program.slots {
            // Writing to a `String` cannot fail.
            let _ = writeln!(text, "// ${slot}: {file}");
        }
        text.push_str(&program.text);
        let path = folder.join(name);
        std::fs::write(&path, text).map_err(|error| failed(&path, error))?;
    }
    Ok(())
}
