//! Tables of a block that a probe follows: `NAME.csv`, its forces and torques over time, `NAME.png`, and the loads on its
//! faces, `NAME_faces.csv`.

use super::super::{
    recorder::{Recorder, Recorders},
    scene_run::SceneRun,
    table::TimeTable,
};
use super::{Rock, Safety};
use crate::picture::Track;
use glam::{DQuat, DVec3};
use riprap::{
    Error,
    coupling::{Coupled, JointLoad},
    psm::FaceLoad,
    safety::SafetyFactors,
    scene::Probe,
    simulation::voigt,
};
use std::path::Path;

/// Names of the Cauchy stresses of a deformable block along the axes of the world, Pa.
const STRESSES: [&str; 6] = [
    "stress_xx",
    "stress_yy",
    "stress_zz",
    "stress_xy",
    "stress_yz",
    "stress_xz",
];

/// Names and values of the columns of a row.
#[derive(Default)]
struct Row(Vec<(String, f64)>);

impl Row {
    fn number(&mut self, name: &str, value: f64) {
        self.0.push((name.into(), value));
    }

    fn vector(&mut self, name: &str, value: DVec3) {
        for (axis, value) in ["x", "y", "z"].into_iter().zip(value.to_array()) {
            self.number(&format!("{name}_{axis}"), value);
        }
    }

    fn columns(self) -> Vec<String> {
        self.0.into_iter().map(|(name, _)| name).collect()
    }

    fn values(self) -> Vec<f64> {
        self.0.into_iter().map(|(_, value)| value).collect()
    }
}

/// The recorders of the tables of a probe of the block called `name`.
pub fn recorders(
    run: &SceneRun,
    folder: &Path,
    last: u64,
    (probe, name): (&Probe, &str),
    [faces, safety]: [bool; 2],
) -> riprap::Result<Recorders> {
    let found = run.rock().and_then(|rock| {
        let mut blocks = rock.setup.blocks.iter();
        Some((rock, blocks.position(|block| block.name == name)?))
    });
    let (rock, block) = found.ok_or_else(|| {
        Error::scene(
            format!("probes.{}", probe.name),
            format!("there is no block `{name}`"),
        )
    })?;
    let row = move |rock: &Rock<'_>, standing: Option<&SafetyFactors>| {
        let mut row = measure(rock, block);
        if let (true, Some(coupled)) = (faces, rock.coupled) {
            measure_faces(&mut row, coupled, block, rock.blocks.gravity());
        }
        if let Some(standing) = standing {
            row.number("safety_sliding", standing.sliding.factor);
            row.number("safety_uplift", standing.uplift);
            row.number("safety_toppling", standing.toppling);
        }
        row
    };
    let mut tracks = Vec::new();
    let mut vectors = vec![("contacts", "")];
    if block < rock.loads.len() {
        vectors.insert(0, ("fluid", "fluid_"));
    }
    for (of, prefix) in vectors {
        for (what, unit) in [("force", "N"), ("torque", "N m")] {
            let columns = ["x", "y", "z"].map(|axis| format!("{prefix}{what}_{axis}"));
            let columns = columns.each_ref().map(String::as_str);
            tracks.push(Track::new(&format!("{what} of {of}"), unit, &columns));
        }
    }
    let now = safety.then(|| standing(&rock, block));
    let table = TimeTable {
        name: probe.name.clone(),
        every: probe.every,
        columns: row(&rock, now.as_ref()).columns(),
        coordinates: Some(0),
        tracks,
        title: format!("{}: {name}", run.scene().title),
    };
    let mut recorders = vec![table.recorder(run, folder, last, move |run, log| {
        let Some(rock) = run.rock() else {
            return Ok(Vec::new());
        };
        let now = safety.then(|| standing(&rock, block));
        if let Some(now) = &now {
            Safety::note(&mut log.safety, rock.blocks.name(block), rock.time, now);
        }
        Ok(vec![row(&rock, now.as_ref()).values()])
    })?];
    if faces {
        recorders.push(face_table(run, folder, last, probe, block)?);
    }
    Ok(recorders)
}

/// The recorder of the loads on the faces of a block.
fn face_table(
    run: &SceneRun,
    folder: &Path,
    last: u64,
    probe: &Probe,
    block: usize,
) -> riprap::Result<Box<dyn Recorder>> {
    let table = TimeTable {
        name: format!("{}_faces", probe.name),
        every: probe.every,
        columns: face_row(&FaceLoad::default(), false, None).columns(),
        // Part and face.
        coordinates: Some(2),
        tracks: Vec::new(),
        title: String::new(),
    };
    table.recorder(run, folder, last, move |run, _| {
        let Some(coupled) = run.rock().and_then(|rock| rock.coupled) else {
            return Ok(Vec::new());
        };
        let loads = coupled.face_loads(block).iter();
        let closed = coupled.joint_loads(block);
        let joints = loads.zip(coupled.faces_in_joints(block)).enumerate();
        let row = |(number, (load, joint))| face_row(load, joint, closed.get(number)).values();
        Ok(joints.map(row).collect())
    })
}

/// Motion and forces; also the quantities of blocks in a fluid, with films, with fixed points, or deformable ones, if any.
fn measure(rock: &Rock<'_>, block: usize) -> Row {
    let blocks = rock.blocks;
    let pose = blocks.poses()[block];
    let at_start = rock.setup.blocks[block].rotation;
    let turned = rotation_vector(blocks.rotation(block) * at_start.conjugate());
    let mut row = Row::default();
    row.vector("position", pose.centre);
    row.vector("velocity", pose.velocity);
    row.vector("rotation", turned.map(f64::to_degrees));
    row.vector("spin", blocks.spins().nth(block).unwrap_or_default());
    let mut forces = blocks.contact_forces().zip(blocks.contact_torques());
    let (force, torque) = forces.nth(block).unwrap_or_default();
    row.vector("force", force);
    row.vector("torque", torque);
    if let Some(load) = rock.loads.get(block) {
        row.vector("fluid_force", load.flow.force);
        row.vector("fluid_torque", load.flow.torque());
        row.vector("buoyancy", load.buoyancy.force);
    }
    if rock.setup.film.is_some() {
        let forces = blocks.film_forces();
        row.vector("film_force", forces.get(block).copied().unwrap_or_default());
    }
    // The force with which fixed points hold it.
    if let Some(support) = blocks.support(block) {
        row.vector("support", support);
    }
    if let Some(stress) = blocks.stress(block) {
        for (name, value) in STRESSES.into_iter().zip(voigt(stress)) {
            row.number(name, value);
        }
        row.number("von_mises", blocks.von_mises(block).unwrap_or_default());
        let energy = blocks.strain_energy(block);
        row.number("strain_energy", energy.unwrap_or_default());
    }
    row
}

/// The uplift, the force of the fluid on faces that look down, against gravity, and the mean pressure on faces in joints,
/// closed ones included.
fn measure_faces(row: &mut Row, coupled: Coupled<'_>, block: usize, gravity: DVec3) {
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
    row.number("uplift_of_faces", uplift);
    row.number("joint_pressure", force / area);
}

/// The row of a face, with its closed joint, if it has one.
fn face_row(load: &FaceLoad, joint: bool, closed: Option<&JointLoad>) -> Row {
    let face = &load.face;
    let shear = load.shear();
    let mut row = Row::default();
    row.number("part", face.part as f64);
    row.number("face", face.face as f64);
    row.number("area", face.area);
    row.number("wetted_area", load.wetted);
    row.number("pressure", load.pressure());
    row.number("shear", shear.length());
    row.number("joint", f64::from(u8::from(joint)));
    row.number("joint_area", closed.map_or(0.0, |closed| closed.area));
    let closed = closed.filter(|closed| closed.area > 0.0);
    let pressure = |closed: &JointLoad| -closed.force.dot(face.normal) / closed.area;
    row.number("joint_pressure", closed.map_or(f64::NAN, pressure));
    row.vector("position", face.centre);
    row.vector("normal", face.normal);
    row.vector("force", load.force);
    row.vector("moment", load.moment);
    row.vector("shear", shear);
    row
}

/// Axis times angle, rad: at most π, of the two quaternions of a rotation that of the smaller angle.
fn rotation_vector(rotation: DQuat) -> DVec3 {
    let near = if rotation.w < 0.0 {
        -rotation
    } else {
        rotation
    };
    near.to_scaled_axis()
}

/// The factors of safety of a block.
fn standing(rock: &Rock<'_>, block: usize) -> SafetyFactors {
    SafetyFactors::of(rock.setup, rock.blocks, block, fluid_wrench(rock, block))
}

/// Force (N) and torque about its centroid (N m) of the fluid on a block, buoyancy included; closed joints hold the water
/// at their rim. Zero without a fluid.
pub fn fluid_wrench(rock: &Rock<'_>, block: usize) -> [DVec3; 2] {
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
    fluid.unwrap_or_else(whole)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotations_are_at_most_half_a_turn() {
        for (degrees, expected) in [(100.0, 100.0), (190.0, -170.0), (350.0, -10.0)] {
            let turned = rotation_vector(DQuat::from_rotation_z(f64::to_radians(degrees)));
            let expected = DVec3::Z * f64::to_radians(expected);
            assert!(turned.distance(expected) < 1e-12, "{degrees}: {turned}");
        }
    }
}
