//! Files for ParaView, one per time, and their collection: `NAME_000123.vtu` and `NAME.pvd`.

use super::{
    recorder::{Recorders, RunLog, Schedule},
    scene_run::SceneRun,
};
use anyhow::Result;
use riprap::{
    output::{Pvd, write_surface, write_vti, write_vtp, write_vtu},
    scene::{Field, ProbePlace},
    simulation::{Kind, block_polyhedra, contact_cloud, face_surface, point_cloud, wall_surface},
};
use std::path::Path;

/// What is written into a collection.
enum Content {
    /// Fields on the cells of a lattice.
    Fields(Vec<Field>),
    /// Particles of water.
    Water,
    /// Blocks.
    Blocks,
    /// Contacts of blocks.
    Contacts,
    /// Faces of blocks with a probe of their loads.
    Faces,
    /// Walls with a wall model.
    Walls,
}

/// The collections that a run writes: new ones, or those continued after a restart.
pub fn recorders(run: &SceneRun, folder: &Path, last: u64) -> riprap::Result<Recorders> {
    let (simulation, scene) = (&run.simulation, run.scene());
    let mut contents = Vec::new();
    match simulation.kind() {
        Kind::Rock => {}
        Kind::Lattice => {
            let mut fields = scene.output.fields.clone();
            let covered = !simulation.solid().is_empty() || scene.has_blocks();
            if covered && !fields.contains(&Field::Solid) {
                // Without this field, ParaView and pictures show solids as fluid at rest.
                fields.push(Field::Solid);
            }
            contents.push(Content::Fields(fields));
            if !simulation.wall_places().is_empty() {
                contents.push(Content::Walls);
            }
        }
        Kind::Particles => contents.push(Content::Water),
    }
    if run.rock().is_some() {
        contents.push(Content::Blocks);
        if scene.output.contacts {
            contents.push(Content::Contacts);
        }
        let asks = |place: &ProbePlace| matches!(place, ProbePlace::Block { faces: true, .. });
        if scene.probes.iter().any(|probe| asks(&probe.place)) {
            contents.push(Content::Faces);
        }
    }
    let mut recorders = Recorders::new();
    for content in contents {
        let (folder, name) = (folder.to_owned(), content.name());
        let path = folder.join(format!("{name}.pvd"));
        let mut collection = match run.step() {
            0 => Pvd::create(&path)?,
            _ => Pvd::resume(&path, run.time())?,
        };
        let record = move |run: &mut SceneRun, log: &mut RunLog| {
            let extension = content.extension();
            let file = folder.join(format!("{name}_{:06}.{extension}", run.step()));
            if content.write(run, &file)? {
                collection.add(run.time(), &file)?;
                log.file(path.clone());
                log.file(file);
            }
            Ok(())
        };
        let schedule = Schedule::new(scene.output.every, run.time_step(), last);
        recorders.push(Box::new((schedule, record)));
    }
    Ok(recorders)
}

impl Content {
    fn name(&self) -> &'static str {
        match self {
            Self::Fields(_) => "fields",
            Self::Water => "water",
            Self::Blocks => "blocks",
            Self::Contacts => "contacts",
            Self::Faces => "faces",
            Self::Walls => "walls",
        }
    }

    fn extension(&self) -> &'static str {
        match self {
            Self::Fields(_) => "vti",
            Self::Blocks => "vtu",
            Self::Water | Self::Contacts | Self::Faces | Self::Walls => "vtp",
        }
    }

    /// Writes the present state, if there is any.
    fn write(&self, run: &mut SceneRun, path: &Path) -> Result<bool> {
        match self {
            Self::Fields(fields) => write_vti(path, &run.image(fields)?)?,
            Self::Water => {
                let water = run.water()?;
                write_vtp(path, &point_cloud(&water, &run.scene().output.fields))?;
            }
            Self::Walls => write_surface(path, &wall_surface(&run.wall_friction()?))?,
            Self::Blocks | Self::Contacts | Self::Faces => {
                let Some(rock) = run.rock() else {
                    return Ok(false);
                };
                let shown = &rock.setup.blocks[..rock.shown];
                match (self, rock.coupled) {
                    (Self::Blocks, _) => {
                        write_vtu(path, &block_polyhedra(shown, rock.blocks, rock.loads))?;
                    }
                    (Self::Contacts, _) => write_vtp(path, &contact_cloud(rock.blocks))?,
                    (_, Some(coupled)) => write_surface(path, &face_surface(&coupled))?,
                    _ => return Ok(false),
                }
            }
        }
        Ok(true)
    }
}
