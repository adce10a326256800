//! The loads on the faces of a block: `NAME_faces.csv`.

use super::super::{
    history::table,
    recorder::{Recorder, RunLog},
    scene_run::SceneRun,
    schedule::Schedule,
};
use anyhow::Result;
use riprap::{coupling::JointLoad, output::Csv, psm::FaceLoad, scene::Probe};
use std::path::{Path, PathBuf};

/// Numbers of a face that are no vectors.
const SCALARS: [&str; 9] = [
    "part",
    "face",
    "area",
    "wetted_area",
    "pressure",
    "shear",
    "joint",
    "joint_area",
    "joint_pressure",
];
/// Its vectors.
const VECTORS: [&str; 5] = ["position", "normal", "force", "moment", "shear"];

pub struct FaceTable {
    schedule: Schedule,
    block: usize,
    path: PathBuf,
    table: Csv,
}

impl FaceTable {
    /// Begins the table of the faces of a block, or goes on with it after a restart.
    pub fn new(
        run: &SceneRun,
        folder: &Path,
        last: u64,
        (probe, block): (&Probe, usize),
    ) -> Result<Self> {
        let along = |what: &str| ["x", "y", "z"].map(|axis| format!("{what}_{axis}"));
        let scalars = SCALARS.map(String::from).into_iter();
        let columns: Vec<String> = scalars.chain(VECTORS.into_iter().flat_map(along)).collect();
        let path = folder.join(format!("{}_faces.csv", probe.name));
        Ok(Self {
            schedule: Schedule::new(probe.every, run.time_step(), last),
            table: table(run, &path, &columns)?,
            block,
            path,
        })
    }
}

/// A row of the table; a face has a closed joint, or not.
fn row(load: &FaceLoad, joint: bool, closed: Option<&JointLoad>) -> Vec<f64> {
    let face = &load.face;
    let shear = load.shear();
    let mut row = vec![
        face.part as f64,
        face.face as f64,
        face.area,
        load.wetted,
        load.pressure(),
        shear.length(),
        f64::from(u8::from(joint)),
        closed.map_or(0.0, |closed| closed.area),
        closed.map_or(f64::NAN, |closed| {
            -closed.force.dot(face.normal) / closed.area
        }),
    ];
    let vectors = [face.centre, face.normal, load.force, load.moment, shear];
    row.extend(vectors.iter().flat_map(|vector| vector.to_array()));
    row
}

impl Recorder for FaceTable {
    fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn record(&mut self, run: &mut SceneRun, log: &mut RunLog) -> Result<()> {
        let Some((rock, coupled)) = run.rock().and_then(|rock| Some((rock, rock.coupled?))) else {
            return Ok(());
        };
        let loads = coupled.face_loads(self.block).iter();
        let closed = coupled.joint_loads(self.block);
        let joints = loads.zip(coupled.faces_in_joints(self.block));
        for (number, (load, joint)) in joints.enumerate() {
            let row = row(load, joint, closed.get(number));
            self.table.append(rock.step, rock.time, &row)?;
        }
        log.file(self.path.clone());
        Ok(())
    }
}
