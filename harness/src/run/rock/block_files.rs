//! Blocks for ParaView: `blocks_000123.vtu` and the collection `blocks.pvd`; the same for contacts, and for faces whose
//! loads somebody asks for.

use super::super::{
    recorder::{Recorder, RunLog},
    scene_run::SceneRun,
    schedule::Schedule,
};
use anyhow::Result;
use riprap::{
    output::{Pvd, write_surface, write_vtp, write_vtu},
    scene::ProbePlace,
    simulation::{block_polyhedra, contact_cloud, face_surface},
};
use std::path::{Path, PathBuf};

pub struct BlockFiles {
    schedule: Schedule,
    folder: PathBuf,
    blocks: Pvd,
    contacts: Option<Pvd>,
    faces: Option<Pvd>,
}

impl BlockFiles {
    /// Begins the collections, or goes on with them after a restart.
    pub fn new(run: &SceneRun, folder: &Path, last: u64) -> Result<Self> {
        let output = &run.scene().output;
        let collection = |name: &str| {
            let path = folder.join(name);
            match run.step() {
                0 => Pvd::create(path),
                _ => Pvd::resume(path, run.time()),
            }
        };
        let contacts = output.contacts.then(|| collection("contacts.pvd"));
        let mut probes = run.scene().probes.iter();
        let asks = |place: &ProbePlace| matches!(place, ProbePlace::Block { faces: true, .. });
        let faces = probes.any(|probe| asks(&probe.place));
        let faces = faces.then(|| collection("faces.pvd"));
        Ok(Self {
            schedule: Schedule::new(output.every, run.time_step(), last),
            folder: folder.to_owned(),
            blocks: collection("blocks.pvd")?,
            contacts: contacts.transpose()?,
            faces: faces.transpose()?,
        })
    }
}

impl Recorder for BlockFiles {
    fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn record(&mut self, run: &mut SceneRun, log: &mut RunLog) -> Result<()> {
        let Some(rock) = run.rock() else {
            return Ok(());
        };
        let (step, time) = (rock.step, rock.time);
        let path = self.folder.join(format!("blocks_{step:06}.vtu"));
        let shown = &rock.setup.blocks[..rock.shown];
        write_vtu(&path, &block_polyhedra(shown, rock.blocks, rock.loads))?;
        self.blocks.add(time, &path)?;
        log.file(self.folder.join("blocks.pvd"));
        log.file(path);
        if let Some(contacts) = &mut self.contacts {
            let path = self.folder.join(format!("contacts_{step:06}.vtp"));
            write_vtp(&path, &contact_cloud(rock.blocks))?;
            contacts.add(time, &path)?;
            log.file(self.folder.join("contacts.pvd"));
            log.file(path);
        }
        if let (Some(faces), Some(coupled)) = (&mut self.faces, rock.coupled) {
            let path = self.folder.join(format!("faces_{step:06}.vtp"));
            write_surface(&path, &face_surface(&coupled))?;
            faces.add(time, &path)?;
            log.file(self.folder.join("faces.pvd"));
            log.file(path);
        }
        Ok(())
    }
}
