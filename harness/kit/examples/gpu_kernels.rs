//! Writes the kernels, as linked for a scene on a GPU, as SPIR-V: `gpu_kernels FOLDER [KERNELS]`.
//!
//! Writes a file NAME.spv for each kernel, and `index.json` with its entry point and its bindings. Files of the folder
//! KERNELS, if given, replace those of the library, so that a change can be examined without a build.

use glam::DVec3;
use naga::{
    ShaderStage,
    back::{pipeline_constants::process_overrides, spv},
    proc::{BoundsCheckPolicies, BoundsCheckPolicy},
};
use riprap::{
    gpu::{kernel::bindings, link::Program},
    lattice::{
        self, Bindings, BrickKind, Collision, Face, Force, Grid, SolidOperator, SolidWeight,
        Storage, SurfaceCell, WallModel, collide_stream, single_cells,
    },
    psm::{self, CellMapping, Forms},
    sph::{self, CellGrid, EquationOfState, NeighbourSearch, Scheme, Side},
    wgpu,
};
use std::{
    collections::{HashMap, HashSet},
    error::Error,
    fs,
    path::Path,
};

type Outcome = Result<(), Box<dyn Error>>;

/// The output folder, the replaced files, and the programs written so far.
struct Output<'a> {
    folder: &'a Path,
    replaced: Vec<(String, String)>,
    index: serde_json::Map<String, serde_json::Value>,
    written: HashSet<Vec<u8>>,
}

impl Output<'_> {
    /// Links the program, sets the overrides, those that depend on a scene's size to 1, and writes the SPIR-V that wgpu passes to
    /// a driver with robustBufferAccess2. Programs that several setups share are written once.
    fn put(
        &mut self,
        name: &str,
        program: &Program,
        entry: &str,
        constants: &[(&'static str, f64)],
    ) -> Outcome {
        let replaced = self.replaced.iter();
        let program = replaced.fold(program.clone(), |p, (file, text)| p.text(file, text));
        let linked = program.link()?;
        let given: HashMap<_, _> = constants.iter().copied().collect();
        let overrides = linked.module.overrides.iter();
        let numbers = overrides
            .filter_map(|(_, o)| o.name.clone())
            .map(|n| (n.clone(), given.get(n.as_str()).copied().unwrap_or(1.0)))
            .collect();
        let stage = (ShaderStage::Compute, entry);
        let (module, info) =
            process_overrides(&linked.module, &linked.info, Some(stage), &numbers)?;
        let options = spv::Options {
            lang_version: (1, 3),
            flags: spv::WriterFlags::empty(),
            bounds_check_policies: BoundsCheckPolicies {
                index: BoundsCheckPolicy::Restrict,
                buffer: BoundsCheckPolicy::Unchecked,
                ..Default::default()
            },
            ..Default::default()
        };
        let pipeline = spv::PipelineOptions {
            shader_stage: ShaderStage::Compute,
            entry_point: entry.into(),
        };
        let words = spv::write_vec(&module, &info, &options, Some(&pipeline))?;
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        if self.written.contains(&bytes) {
            return Ok(());
        }
        fs::write(self.folder.join(format!("{name}.spv")), &bytes)?;
        self.written.insert(bytes);
        let bound: Vec<_> = bindings(&linked, entry)?
            .iter()
            .map(|b| serde_json::json!([b.number, b.kind == wgpu::BufferBindingType::Uniform]))
            .collect();
        let described = serde_json::json!({ "entry": entry, "bindings": bound });
        self.index.insert(name.into(), described);
        Ok(())
    }

    /// All entry points of the program, with `suffix` in their names.
    fn put_all(
        &mut self,
        suffix: &str,
        program: &Program,
        constants: &[(&'static str, f64)],
    ) -> Outcome {
        for entry in &program.link()?.module.entry_points {
            let name = format!("{}_{suffix}", entry.name);
            self.put(&name, program, &entry.name, constants)?;
        }
        Ok(())
    }

    /// The steps of the lattice, and its single-cell kernels.
    fn lattice(&mut self) -> Outcome {
        for (storage, lanes, stored) in [(Storage::F32, 1, "f32"), (Storage::F16, 2, "f16")] {
            let mut setup = lattice::Setup::periodic([128; 3], 0.01);
            (setup.storage, setup.lanes) = (storage, lanes);
            for (wale, eddy) in [(None, ""), (Some(0.5), "_wale")] {
                let mut setup = setup.clone();
                setup.wale = wale;
                self.step(&format!("{stored}{eddy}"), BrickKind::All, &setup)?;
                self.sampling_step(&format!("{stored}{eddy}"), BrickKind::All, &setup)?;
                setup.faces = [(); 3].map(|()| [Face::Wall([0.0; 3]), Face::Wall([0.0; 3])]);
                self.step(&format!("{stored}{eddy}_walls"), BrickKind::Flagged, &setup)?;
                if wale.is_some() {
                    let mut setup = setup.clone();
                    setup.wall_model = Some(WallModel::WernerWengle);
                    self.step(
                        &format!("{stored}{eddy}_wall_model"),
                        BrickKind::Flagged,
                        &setup,
                    )?;
                    setup.solid_operator = Some(SolidOperator::Holdych);
                    let name = format!("{stored}{eddy}_psm_wall_model");
                    self.step(&name, BrickKind::Psm, &setup)?;
                    if storage == Storage::F32 {
                        setup.sloping_faces = true;
                        let name = format!("{stored}{eddy}_psm_sloping_faces");
                        self.step(&name, BrickKind::Psm, &setup)?;
                    }
                }
                let mut at_rest = setup.clone();
                at_rest.surface = vec![SurfaceCell {
                    cell: 0,
                    fraction: 0.5,
                }];
                let name = format!("{stored}{eddy}_surface");
                self.step(&name, BrickKind::Surface, &at_rest)?;
                if wale.is_some() && storage == Storage::F32 {
                    at_rest.wall_model = Some(WallModel::WernerWengle);
                    let name = format!("{stored}{eddy}_surface_wall_model");
                    self.step(&name, BrickKind::Surface, &at_rest)?;
                }
                for (operator, name) in [
                    (SolidOperator::Holdych, "holdych"),
                    (SolidOperator::Noble, "noble"),
                    (SolidOperator::Superposition, "superposition"),
                ] {
                    setup.solid_operator = Some(operator);
                    let name = format!("{stored}{eddy}_psm_{name}");
                    self.step(&name, BrickKind::Psm, &setup)?;
                }
                setup.solid_operator = Some(SolidOperator::Holdych);
                let name = format!("{stored}{eddy}_psm_holdych");
                self.sampling_step(&name, BrickKind::Psm, &setup)?;
            }
            let variant = |change: fn(&mut lattice::Setup)| {
                let mut setup = setup.clone();
                change(&mut setup);
                setup
            };
            for (name, setup) in [
                ("bgk", variant(|s| s.collision = Collision::Bgk)),
                ("suga", variant(|s| s.collision = Collision::Suga)),
                ("force", variant(|s| s.force = Force::Constant([1e-6; 3]))),
                ("no_guard", variant(|s| s.max_speed = 0.0)),
            ] {
                self.step(&format!("{stored}_{name}"), BrickKind::All, &setup)?;
            }
            self.single_cells(stored, setup)?;
        }
        Ok(())
    }

    fn step(&mut self, name: &str, kind: BrickKind, setup: &lattice::Setup) -> Outcome {
        self.step_with(&format!("step_{name}"), 1.into(), kind, setup)
    }

    /// A step that adds a sample to the statistics over time.
    fn sampling_step(&mut self, name: &str, kind: BrickKind, setup: &lattice::Setup) -> Outcome {
        let bindings = Bindings {
            statistics: 1,
            ..Bindings::from(1)
        };
        self.step_with(&format!("step_{name}_statistics"), bindings, kind, setup)
    }

    fn step_with(
        &mut self,
        name: &str,
        bindings: Bindings,
        kind: BrickKind,
        setup: &lattice::Setup,
    ) -> Outcome {
        let grid = Grid::new(setup)?;
        let mut constants = lattice::constants(setup, &grid, false);
        constants.push(("BRICKS", grid.bricks().iter().product::<u32>().into()));
        let program = collide_stream(setup, bindings, kind);
        self.put(name, &program, "collide_stream", &constants)
    }

    fn single_cells(&mut self, stored: &str, mut setup: lattice::Setup) -> Outcome {
        setup.faces[0] = [Face::Wall([0.0; 3]), Face::Wall([0.0; 3])];
        let grid = Grid::new(&setup)?;
        let mut constants = lattice::constants(&setup, &grid, false);
        constants.extend([
            ("LINKS_OF_ROW", lattice::LINKS_OF_ROW as f64),
            ("LINKS_OF_INVOCATION", 1.0),
        ]);
        for file in [
            "links",
            "moving_wall",
            "synthetic_turbulence",
            "wall_model",
            "mark_blocks",
            "block_friction",
            "pressure_face",
            "outflow",
            "exchange",
            "initialise",
            "macroscopic",
            "velocity_psm",
            "velocity_restored",
            "sums",
            "derive",
            "gather",
            "statistics",
        ] {
            let program = single_cells(&setup, 1, file)
                .slot("quantity", "quantity_eddy_viscosity")
                .slot("sample", "sample_populations");
            self.put_all(stored, &program, &constants)?;
        }
        if setup.storage == Storage::F32 {
            self.sloping_faces(&setup, constants)?;
        }
        Ok(())
    }

    /// The kernels of the wall model on sloping faces.
    fn sloping_faces(
        &mut self,
        setup: &lattice::Setup,
        mut constants: Vec<(&'static str, f64)>,
    ) -> Outcome {
        constants.retain(|(name, _)| *name != "SLOPING");
        constants.push(("SLOPING", 1.0));
        for file in ["block_friction", "sloping_friction", "surface_friction"] {
            self.put_all("sloping", &single_cells(setup, 1, file), &constants)?;
        }
        Ok(())
    }

    fn blocks(&mut self) -> Outcome {
        let grid = Grid::new(&lattice::Setup::periodic([128; 3], 0.01))?;
        let mut constants = psm::constants(&grid);
        constants.push(("SPHERE_GROWTH", 0.4));
        let (forms, weight) = (Forms::ALL, SolidWeight::Exact);
        for (entry, program) in [
            (
                "voxelise",
                psm::voxelise(&grid, CellMapping::Parallel, forms, weight),
            ),
            ("voxelise_edges", psm::voxelise_edges(&grid, forms, weight)),
            (
                "combine_parts",
                psm::combine_parts(&grid, CellMapping::Parallel),
            ),
            (
                "reduce_tiles",
                psm::reduce_tiles(&grid, CellMapping::Parallel),
            ),
            (
                "reduce_faces",
                psm::reduce_faces(&grid, CellMapping::Parallel),
            ),
            ("sum_faces", psm::sum_faces()),
            ("reduce_blocks", psm::reduce_blocks()),
        ] {
            self.put(entry, &program, entry, &constants)?;
        }
        Ok(())
    }

    fn water(&mut self) -> Outcome {
        for (search, searched) in [
            (NeighbourSearch::Cells, "cells"),
            (NeighbourSearch::Lists, "lists"),
        ] {
            let mut setup = sph::Setup::tank(DVec3::splat(2.0), 0.02, 10.0);
            (setup.neighbours, setup.batched_neighbours) = (search, true);
            self.particles(searched, &setup)?;
            setup.equation_of_state = EquationOfState::Tait;
            self.particles(&format!("{searched}_tait"), &setup)?;
            setup.laminar_viscosity = 0.01;
            setup.faces[0] = [Side::Periodic; 2];
            self.particles(&format!("{searched}_tait_viscous_periodic"), &setup)?;
            let mut setup = sph::Setup::tank(DVec3::splat(2.0), 0.02, 10.0);
            (setup.neighbours, setup.batched_neighbours) = (search, true);
            setup.scheme = Scheme::Mueller { viscosity: 0.01 };
            self.particles(searched, &setup)?;
        }
        Ok(())
    }

    fn particles(&mut self, name: &str, setup: &sph::Setup) -> Outcome {
        let grid = CellGrid::new(setup)?;
        let mut constants = sph::constants(setup, &grid);
        constants.push(("CAPACITY", 128.0));
        for kernel in sph::kernels_of(setup) {
            let program = sph::program(setup, &grid, kernel);
            self.put(&format!("{kernel}_{name}"), &program, kernel, &constants)?;
        }
        Ok(())
    }

    fn searches(&mut self) -> Outcome {
        for kernel in ["bin_count", "bin_scatter", "scan_sum", "scan_spread"] {
            self.put(kernel, &Program::new(kernel), kernel, &[])?;
        }
        for found in ["found_count", "found_write"] {
            let program = Program::new("pairs").slot("found", found);
            self.put(&format!("pairs_{found}"), &program, "pairs", &[])?;
        }
        Ok(())
    }
}

fn main() -> Outcome {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().ok_or("gpu_kernels FOLDER [KERNELS]")?;
    fs::create_dir_all(&folder)?;
    let mut replaced = Vec::new();
    for file in arguments.next().iter().flat_map(fs::read_dir).flatten() {
        let path = file?.path();
        let name = path.file_stem().ok_or("a file without a name")?;
        replaced.push((
            name.to_string_lossy().into_owned(),
            fs::read_to_string(&path)?,
        ));
    }
    let mut output = Output {
        folder: Path::new(&folder),
        replaced,
        index: serde_json::Map::new(),
        written: HashSet::new(),
    };
    output.lattice()?;
    output.blocks()?;
    output.water()?;
    output.searches()?;
    let index = serde_json::to_string_pretty(&output.index)?;
    fs::write(output.folder.join("index.json"), index)?;
    Ok(())
}
