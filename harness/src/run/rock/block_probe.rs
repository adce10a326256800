//! A table for each block that a probe follows, `NAME.csv`, and its forces and torques over time, `NAME.png`.

use super::super::{
    curves,
    history::table,
    recorder::{Recorder, RunLog},
    scene_run::SceneRun,
    schedule::Schedule,
};
use super::{Rock, Safety, forces};
use anyhow::Result;
use glam::DVec3;
use riprap::{
    Error, coupling::Coupled, output::Csv, safety::Standing, scene::Probe, simulation::voigt,
};
use std::path::{Path, PathBuf};

/// What is measured of every block, each along x, y and z.
const MEASURED: [&str; 6] = [
    "position", "velocity", "rotation", "spin", "force", "torque",
];
/// What is measured of a block in a fluid as well.
const IN_FLUID: [&str; 3] = ["fluid_force", "fluid_torque", "buoyancy"];
/// What is measured where films of fluid push blocks that nearly touch.
const FILM: &str = "film_force";
/// What is measured of a block with fixed points as well: the force with which they hold it.
const SUPPORT: &str = "support";
/// What is measured of a deformable block as well: Cauchy stress along the axes of the world, Pa, the von
/// Mises stress, Pa, and the strain energy, J.
const STRESSED: [&str; 8] = [
    "stress_xx",
    "stress_yy",
    "stress_zz",
    "stress_xy",
    "stress_yz",
    "stress_xz",
    "von_mises",
    "strain_energy",
];

/// What its faces show: the force of the fluid on those that look down, against gravity, and the mean pressure on those
/// in joints, closed ones too.
const OF_FACES: [&str; 2] = ["uplift_of_faces", "joint_pressure"];
/// How safely it stands.
const SAFETY: [&str; 3] = ["safety_sliding", "safety_uplift", "safety_toppling"];

pub struct BlockProbe {
    schedule: Schedule,
    block: usize,
    faces: bool,
    safety: bool,
    path: PathBuf,
    table: Csv,
}

impl BlockProbe {
    /// Begins the table of the block called `name`, or goes on with it after a restart.
    pub fn new(
        run: &SceneRun,
        folder: &Path,
        last: u64,
        (probe, name): (&Probe, &str),
        [faces, safety]: [bool; 2],
    ) -> Result<Self> {
        let (rock, block) = find(run, probe, name)?;
        let mut measured = MEASURED.to_vec();
        if block < rock.loads.len() {
            measured.extend(IN_FLUID);
        }
        if rock.setup.film.is_some() {
            measured.push(FILM);
        }
        if rock.blocks.support(block).is_some() {
            measured.push(SUPPORT);
        }
        let stressed = rock.blocks.stress(block).is_some();
        let along = |what: &&str| ["x", "y", "z"].map(|axis| format!("{what}_{axis}"));
        let mut columns: Vec<String> = measured.iter().flat_map(along).collect();
        if stressed {
            columns.extend(STRESSED.map(Into::into));
        }
        if faces {
            columns.extend(OF_FACES.map(String::from));
        }
        if safety {
            columns.extend(SAFETY.map(String::from));
        }
        let path = folder.join(format!("{}.csv", probe.name));
        Ok(Self {
            schedule: Schedule::new(probe.every, run.time_step(), last),
            table: table(run, &path, &columns)?,
            block,
            faces,
            safety,
            path,
        })
    }
}

/// The blocks of a run, and the number of that which a probe follows.
pub fn find<'a>(run: &'a SceneRun, probe: &Probe, name: &str) -> riprap::Result<(Rock<'a>, usize)> {
    let found = run.rock().and_then(|rock| {
        let mut blocks = rock.setup.blocks.iter();
        Some((rock, blocks.position(|block| block.name == name)?))
    });
    found.ok_or_else(|| {
        Error::scene(
            format!("probes.{}", probe.name),
            format!("there is no block `{name}`"),
        )
    })
}

/// The vectors of `MEASURED`, of `IN_FLUID` where there is one, of `FILM` where there may be any, and of `SUPPORT` where
/// something holds it.
fn measure(rock: &Rock<'_>, block: usize) -> Vec<DVec3> {
    let blocks = rock.blocks;
    let pose = blocks.poses()[block];
    let at_start = rock.setup.blocks[block].rotation;
    let turned = (blocks.rotation(block) * at_start.conjugate()).to_scaled_axis();
    let mut all = vec![pose.centre, pose.velocity, turned.map(f64::to_degrees)];
    all.extend(blocks.spins().nth(block));
    all.extend(blocks.contact_forces().nth(block));
    all.extend(blocks.contact_torques().nth(block));
    if let Some(load) = rock.loads.get(block) {
        all.extend([load.flow.force, load.flow.torque(), load.buoyancy.force]);
    }
    if rock.setup.film.is_some() {
        all.extend(blocks.film_forces().get(block));
    }
    all.extend(blocks.support(block));
    all
}

/// The numbers of `STRESSED`; none of a rigid block.
fn stressed(rock: &Rock<'_>, block: usize) -> Vec<f64> {
    let Some(stress) = rock.blocks.stress(block) else {
        return Vec::new();
    };
    let mut all = voigt(stress).to_vec();
    all.extend(rock.blocks.von_mises(block));
    all.extend(rock.blocks.strain_energy(block));
    all
}

/// Those of `OF_FACES`.
fn measure_faces(coupled: Coupled<'_>, block: usize, gravity: DVec3) -> [f64; 2] {
    let up = -gravity.normalize_or_zero();
    let loads = coupled.face_loads(block);
    let closed = coupled.joint_loads(block);
    let (mut uplift, mut force, mut area) = (0.0, 0.0, 0.0);
    for (number, (load, joint)) in loads.iter().zip(coupled.faces_in_joints(block)).enumerate() {
        let closed = closed.get(number).copied().unwrap_or_default();
        let (normal, all) = (load.face.normal, load.force + closed.force);
        if normal.dot(up) < 0.0 {
            uplift += all.dot(up);
        }
        if joint {
            force -= all.dot(normal);
            area += load.wetted + closed.area;
        }
    }
    [uplift, force / area]
}

/// How a block stands: in its closed joints is the water that is at their rim.
fn standing(rock: &Rock<'_>, block: usize) -> Standing {
    let load = rock.loads.get(block).copied().unwrap_or_default();
    let fluid = rock
        .coupled
        .and_then(|coupled| coupled.wrench_with_uplift(block));
    let whole = || {
        [
            load.flow.force + load.buoyancy.force,
            load.flow.torque() + load.buoyancy.torque(),
        ]
    };
    Standing::of(rock.setup, rock.blocks, block, fluid.unwrap_or_else(whole))
}

impl Recorder for BlockProbe {
    fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    fn record(&mut self, run: &mut SceneRun, log: &mut RunLog) -> Result<()> {
        if let Some(rock) = run.rock() {
            let vectors = measure(&rock, self.block).into_iter();
            let mut values: Vec<f64> = vectors.flat_map(|vector| vector.to_array()).collect();
            values.extend(stressed(&rock, self.block));
            if let (true, Some(coupled)) = (self.faces, rock.coupled) {
                values.extend(measure_faces(coupled, self.block, rock.blocks.gravity()));
            }
            if self.safety {
                let now = standing(&rock, self.block);
                values.extend([now.sliding.factor, now.uplift, now.toppling]);
                let name = rock.blocks.name(self.block);
                Safety::note(&mut log.safety, name, rock.time, &now);
            }
            self.table.append(rock.step, rock.time, &values)?;
            log.file(self.path.clone());
        }
        Ok(())
    }

    fn finish(&mut self, run: &SceneRun, log: &mut RunLog) -> Result<()> {
        let Some(rock) = run.rock() else {
            return Ok(());
        };
        let mut tracks = forces::FORCES.to_vec();
        if self.block < rock.loads.len() {
            tracks.splice(..0, forces::IN_FLUID);
        }
        let scene = run.scene();
        let title = format!("{}: {}", scene.title, rock.blocks.name(self.block));
        curves::draw(scene, &self.path, &title, &tracks, log)
    }
}
