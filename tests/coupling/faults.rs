//! Errors of coupled scenes and their messages.

use crate::fixture::{World, fluid, material};
use glam::{DQuat, DVec3};
use kit::{Rig, assert_contains, scene::read};
use riprap::{
    Error,
    coupling::Rock,
    geometry::{Pose, Shape},
    lattice::{Lattice, Setup, SolidOperator, State},
    psm::{Frame, SolidBlock, SolidCells},
    scene::build::block_setup,
    simulation::Needs,
    units::Units,
    wgpu,
};
use std::sync::Arc;

const UNITS: Units = Units {
    cell: 1.0,
    time_step: 1.0,
    density: 1.0,
};

fn ball(radius: f64) -> SolidBlock {
    SolidBlock::new(Arc::new(Shape::sphere(radius).unwrap()))
}

fn at(centre: DVec3) -> Pose {
    Pose::at_rest(centre, DQuat::IDENTITY)
}

fn lattice(rig: &Rig, cells: [u32; 3], operator: Option<SolidOperator>) -> Lattice {
    let mut setup = Setup::periodic(cells, 0.02);
    setup.solid_operator = operator;
    let rest = State::rest(cells.iter().product::<u32>() as usize);
    rig.start(setup, &rest, false)
}

fn frame() -> Frame {
    Frame {
        origin: DVec3::ZERO,
        units: UNITS,
    }
}

#[test]
fn poses_that_are_nowhere_are_refused_and_the_next_ones_are_not() {
    let rig = Rig::new();
    let mut lattice = lattice(&rig, [16, 8, 8], Some(SolidOperator::Holdych));
    let blocks = vec![ball(2.0), ball(1.5)];
    let mut immersed = SolidCells::new(&rig.device, &lattice, frame(), blocks).unwrap();
    let good = [at(DVec3::splat(4.0)), at(DVec3::new(11.0, 4.0, 4.0))];
    let mut place = |poses: &[Pose]| {
        let placed = immersed.place(&rig.device, &rig.queue, &mut lattice, poses);
        (placed, immersed.tiles())
    };
    let tiles = place(&good).1;
    assert!(tiles > 0);
    let nan = at(DVec3::new(f64::NAN, 0.0, 0.0));
    let mut spun = good[1];
    spun.deformation_rate.x_axis.y = f64::INFINITY;
    for bad in [nan, spun] {
        let error = place(&[good[0], bad]).0.unwrap_err();
        assert!(matches!(error, Error::NotFinite { .. }), "{error}");
        assert!(error.to_string().contains('1'), "{error}");
    }
    // Finite, but with cell indices beyond their range.
    for far in [1e12, -1e30, 1e300] {
        let error = place(&[good[0], at(DVec3::new(4.0, far, 4.0))])
            .0
            .unwrap_err();
        assert!(error.to_string().contains("far"), "{error}");
    }
    let error = place(&good[..1]).0.unwrap_err().to_string();
    assert!(error.contains("1 poses for 2 blocks"), "{error}");
    let (placed, again) = place(&good);
    placed.unwrap();
    assert_eq!(again, tiles);
}

#[test]
fn a_lattice_without_a_solid_operator_takes_no_blocks() {
    let rig = Rig::new();
    let lattice = lattice(&rig, [8, 8, 8], None);
    let error = SolidCells::new(&rig.device, &lattice, frame(), vec![ball(2.0)]).unwrap_err();
    assert!(error.to_string().contains("solid operator"), "{error}");
}

/// A device that can hold the fluid, but not the data of blocks in all cells: the populations take all bindings except one.
#[test]
fn blocks_that_reach_more_cells_than_a_binding_holds_are_refused() {
    let cells = [64, 64, 48];
    let all = 4 * u64::from(cells.iter().product::<u32>());
    let limits = Rig::new().device.limits();
    let buffers = limits.max_storage_buffers_per_shader_stage.min(12);
    // Five buffers are for other fields. Nine numbers per cell are more than the directions in one binding.
    let directions = 27_u64.div_ceil(u64::from(buffers - 5));
    assert!(directions < 9);
    let rig = Rig::with_limits(wgpu::Limits {
        max_storage_buffer_binding_size: directions * all,
        max_storage_buffers_per_shader_stage: buffers,
        ..limits
    });
    let mut lattice = lattice(&rig, cells, Some(SolidOperator::Holdych));
    let mut immersed = SolidCells::new(&rig.device, &lattice, frame(), vec![ball(40.0)]).unwrap();
    let mut place =
        |centre: DVec3| immersed.place(&rig.device, &rig.queue, &mut lattice, &[at(centre)]);
    for _ in 0..2 {
        let error = place(DVec3::splat(32.0)).unwrap_err();
        assert!(matches!(error, Error::Limit { .. }), "{error}");
        assert!(error.to_string().contains("larger cell"), "{error}");
    }
    // The same lattice with a block that fits.
    let mut small = SolidCells::new(&rig.device, &lattice, frame(), vec![ball(3.0)]).unwrap();
    let pose = [at(DVec3::splat(20.0))];
    small
        .place(&rig.device, &rig.queue, &mut lattice, &pose)
        .unwrap();
}

/// The limits in [`Needs`] are sufficient.
#[test]
fn a_device_with_what_a_scene_needs_runs_it() {
    let text = format!(
        r#"{}{}
        [rock]
        gravity = [0, 0, -0.01]
        [numerics]
        time_step = 0.25
        velocity_scale = 0.1
        [[blocks]]
        kind = "box"
        size = [2, 2, 2]
        position = [2, 2, 2]"#,
        fluid([8, 8, 8], 0.05),
        material("rock", 2000.0)
    );
    let scene = read(&text).unwrap();
    let adapter = kit::gpu::selected().unwrap();
    let needs = Needs::of(&scene, &adapter).unwrap();
    let (device, queue) = kit::gpu::open(&adapter, needs.features, needs.limits.clone()).unwrap();
    let rig = Rig { device, queue };
    let mut sim = rig.simulation(&scene).unwrap();
    rig.wait(sim.advance(3)).unwrap();
    assert!(sim.coupled().unwrap().blocks().poses()[0].velocity.z < 0.0);
}

#[test]
fn a_block_faster_than_any_flow_is_named() {
    let mut world = World::new(&format!(
        r#"{}{}
        [rock]
        gravity = [0, 0, 0]
        [numerics]
        time_step = 0.25
        velocity_scale = 0.1
        [[blocks]]
        name = "ram"
        kind = "box"
        size = [2, 2, 2]
        position = [2, 2, 2]
        motion = "driven"
        velocity = ["0.02 + 0.3 * t", 0, 0]"#,
        fluid([10, 8, 8], 0.02),
        material("rock", 2000.0)
    ));
    let error = world.try_advance(40).unwrap_err();
    assert!(matches!(error, Error::Diverged { .. }), "{error}");
    let text = error.to_string();
    assert_contains(&text, &["ram", "cells per step"]);
}

#[test]
fn a_block_that_is_crushed_ends_the_run_where_it_was() {
    let mut world = World::new(&format!(
        r#"{}{}
        [boundaries]
        x_min = {{ kind = "wall" }}
        x_max = {{ kind = "wall" }}
        [rock]
        gravity = [0, 0, 0]
        [numerics]
        time_step = 0.25
        velocity_scale = 0.1
        [[blocks]]
        name = "press"
        kind = "box"
        size = [1, 3, 3]
        position = [2.6, 2, 2]
        motion = "driven"
        velocity = [0.1, 0, 0]
        [[blocks]]
        name = "nut"
        kind = "box"
        size = [1.5, 1.5, 1.5]
        position = [4.2, 2, 2]"#,
        fluid([10, 8, 8], 0.05),
        material("rock", 2000.0)
    ));
    let saved = world.rig.wait(world.sim.checkpoint()).unwrap();
    let error = world.try_advance(200).unwrap_err();
    assert!(matches!(error, Error::DeepOverlap { .. }), "{error}");
    assert!(error.to_string().contains("nut"), "{error}");
    let stopped = [world.centre(0), world.centre(1)];
    // A second attempt returns the same error and changes no state.
    let error = world.try_advance(1).unwrap_err();
    assert!(matches!(error, Error::DeepOverlap { .. }), "{error}");
    assert_eq!([world.centre(0), world.centre(1)], stopped);
    // The state from before can be continued.
    world.sim.restore(&saved).unwrap();
    world.advance(10);
}

#[test]
fn single_loads_for_free_blocks_in_cells_that_reflect_are_refused() {
    let text = format!(
        r#"{}{}
        [coupling]
        average = false
        [numerics]
        velocity_scale = 0.1
        [[blocks]]
        kind = "sphere"
        radius = 1
        position = [2, 2, 2]"#,
        fluid([8, 8, 8], 0.05),
        material("rock", 2000.0)
    );
    let error = read(&text).unwrap_err().to_string();
    assert_contains(&error, &["average", "noble"]);
    read(&format!("{text}\nmotion = \"fixed\"")).unwrap();
    let noble = text.replace("[numerics]", "[numerics]\nsolid_operator = \"noble\"");
    read(&noble).unwrap();
}

#[test]
fn a_frame_without_units_and_a_pose_without_volume_are_refused() {
    let rig = Rig::new();
    let mut lattice = lattice(&rig, [16, 8, 8], Some(SolidOperator::Holdych));
    let mut put = |change: &dyn Fn(&mut Frame, &mut Pose)| {
        let (mut frame, mut pose) = (frame(), at(DVec3::splat(4.0)));
        change(&mut frame, &mut pose);
        let immersed = SolidCells::new(&rig.device, &lattice, frame, vec![ball(2.0)]);
        let placed =
            immersed.and_then(|mut all| all.place(&rig.device, &rig.queue, &mut lattice, &[pose]));
        placed.map_err(|error| error.to_string()).err()
    };
    assert_eq!(put(&|_, _| {}), None);
    for bad in [f64::NAN, 0.0, -1.0, f64::INFINITY] {
        for (place, told) in [
            ("units.cell", put(&|frame, _| frame.units.cell = bad)),
            (
                "units.time_step",
                put(&|frame, _| frame.units.time_step = bad),
            ),
            ("units.density", put(&|frame, _| frame.units.density = bad)),
        ] {
            assert!(
                told.as_ref().is_some_and(|told| told.starts_with(place)),
                "{told:?}"
            );
        }
    }
    let told = put(&|frame, _| frame.origin.x = f64::NAN).unwrap();
    assert!(told.starts_with("frame.origin"), "{told}");
    let told = put(&|_, pose| pose.deformation.z_axis = DVec3::ZERO).unwrap();
    assert!(
        told.starts_with("block 0: ") && told.contains("determinant"),
        "{told}"
    );
}

/// Two cubes overlap by 4 mm, less than what is refused.
#[test]
fn contacts_that_throw_blocks_apart_are_warned_of() {
    let advice = |rock: &str, gap: f64| {
        let scene = read(&format!(
            r#"
            run.duration = 1
            {rock}
            [[materials]]
            name = "rock"
            density = 2650
            normal_stiffness = 1e10
            friction = 30
            [[blocks]]
            name = "lower"
            kind = "box"
            size = [1, 1, 1]
            motion = "fixed"
            [[blocks]]
            name = "upper"
            kind = "box"
            size = [1, 1, 1]
            position = [0, 0, {}]
            "#,
            1.0 + gap
        ))
        .unwrap();
        let setup = block_setup(&scene).unwrap();
        let rock = pollster::block_on(Rock::new(None, &scene, setup, None)).unwrap();
        rock.setup().advice.clone()
    };
    let found = advice("", -0.004);
    let [warning] = &found[..] else {
        panic!("{found:?}");
    };
    assert_eq!(warning.place, "block upper");
    assert_contains(&warning.message, &["`lower`", "4.00e-3 m", "relax = true"]);
    // Its penetration at rest is 2.6 µm.
    assert!(advice("", -2.6e-6).is_empty());
    assert!(advice("rock.relax = true", -0.004).is_empty());
}
