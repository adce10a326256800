//! Coupled scenes with the GPU kernels (one cell per invocation, sums by workgroups, pairs found on the device) and with the
//! CPU kernels give the same results within the rounding of sums in different order.

use crate::{
    fixture::World, inlets::duct_scene, joint_seal::dam, periodic_images::pair, reproducibility,
};
use glam::DVec3;
use riprap::{
    geometry::{Load, Pose},
    scene::{Field, Kernels},
};

/// Largest relative difference: a step rounds to 1e-7 of the compared values, and none of these scenes takes more than a
/// hundred steps.
const LIMIT: f64 = 1e-5;

type Vectors = Vec<DVec3>;
type Of<T> = fn(&T) -> DVec3;

fn largest(all: impl Iterator<Item = DVec3>) -> f64 {
    all.map(DVec3::length).fold(0.0, f64::max)
}

/// Asserts that both differ by at most [`LIMIT`] times their largest value or `scale`.
#[track_caller]
fn assert_alike(what: &str, scale: f64, [cpu, gpu]: [Vectors; 2]) {
    assert_eq!(cpu.len(), gpu.len(), "{what}");
    let size = largest(cpu.iter().copied()).max(scale);
    let off = largest(cpu.iter().zip(&gpu).map(|(a, b)| *a - *b));
    println!("{what}: {off:e} of {size:e}");
    // A comparison with NaN is false.
    assert!(off <= LIMIT * size, "{what}: {off:e} of {size:e}");
}

/// Runs `steps` steps of a scene, in which blocks or fluid start with `speed` (m/s), with both kinds of kernels, and compares
/// positions and velocities of the blocks, the loads on blocks, faces and joints, and the flow.
fn check(text: &str, steps: u64, speed: f64) {
    let mut worlds = [Kernels::Cpu, Kernels::Gpu].map(|kernels| World::with(text, kernels));
    let lanes = |world: &World| world.sim.lattice().unwrap().setup().lanes;
    assert_eq!(worlds.each_ref().map(lanes), [4, 1]);
    for world in &mut worlds {
        world.advance(steps);
    }
    let both = |what: &dyn Fn(&World) -> Vectors| worlds.each_ref().map(what);
    // Blocks are about 1 m long, so that spins are speeds at their corners.
    let poses: [(&str, f64, Of<Pose>); 3] = [
        ("centres", 0.0, |pose| pose.centre),
        ("velocities", speed, |pose| pose.velocity),
        ("spins", speed, |pose| pose.deformation_rate * DVec3::ONE),
    ];
    for (name, scale, of) in poses {
        let poses = |world: &World| world.poses().iter().map(of).collect();
        assert_alike(name, scale, both(&poses));
    }
    let loads: [(&str, Of<Load>); 2] = [
        ("forces", |load| load.force),
        ("moments", |load| load.moment * DVec3::ONE),
    ];
    for (name, of) in loads {
        let cells = |world: &World| {
            let loads = world.sim.coupled().unwrap().cell_load().iter();
            loads.map(|load| of(&load.flow)).collect()
        };
        assert_alike(name, 0.0, both(&cells));
    }
    for block in 0..worlds[0].poses().len() {
        let faces = |world: &World| {
            let loads = world.sim.coupled().unwrap().face_loads(block).iter();
            loads.map(|load| load.force).collect()
        };
        let joints = |world: &World| {
            let loads = world.sim.coupled().unwrap().joint_loads(block);
            loads.iter().map(|load| load.force).collect()
        };
        assert_alike("faces", 0.0, both(&faces));
        assert_alike("joints", 0.0, both(&joints));
    }
    let flow = worlds.each_mut().map(|world| {
        let image = world.rig.wait(world.sim.image(&[Field::Velocity])).unwrap();
        let velocity = image.arrays[0].values.chunks_exact(3);
        let vector = |u: &[f32]| DVec3::new(u[0].into(), u[1].into(), u[2].into());
        velocity.map(vector).collect()
    });
    assert_alike("flow", 0.0, flow);
}

const FACES: &str = r#"
    [[probes]]
    name = "load"
    kind = "block"
    block = "pier"
    faces = true"#;

#[test]
fn free_driven_sleeping_and_fixed_blocks_with_eddy_viscosity() {
    for (interval, average) in [(1, false), (3, true)] {
        check(&reproducibility::scene(interval, average), 60, 0.15);
    }
}

#[test]
fn a_free_block_in_a_channel() {
    let inlet = "\"0.05*min(1, t/5)\"";
    check(&(duct_scene(inlet, 4.0, "") + FACES), 80, 0.05);
}

#[test]
fn a_dam_with_a_gate_on_closed_joints() {
    check(&dam(100.0), 60, 0.0);
}

/// The blocks meet after some ten steps, and the film between them keeps them apart. Later, the moments in a single step
/// differ more: by 6e-5 after 60 steps.
#[test]
fn two_blocks_with_a_film_that_meet_across_a_periodic_face() {
    check(&pair(8.0, true), 24, 0.1);
}
