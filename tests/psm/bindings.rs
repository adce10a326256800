//! The saturation of cells with blocks, over several bindings.

use glam::{DQuat, DVec3};
use kit::Rig;
use riprap::{
    geometry::{Polyhedron, Pose},
    gpu::{kernel::submit_pass, readback::Readback},
    lattice::{Grid, Lattice, Populations, Setup, SolidOperator, State, Storage},
    psm::{Frame, SolidBlock, SolidCells},
    units::Units,
    wgpu,
};
use std::sync::Arc;

fn setup() -> Setup {
    let mut setup = Setup::periodic([48, 40, 20], 0.02);
    (setup.storage, setup.lanes, setup.brick) = (Storage::F16, 2, [8, 2, 2]);
    setup.wale = Some(0.3);
    setup.solid_operator = Some(SolidOperator::Holdych);
    setup
}

/// Runs some steps of a rotating box; returns the bindings of the planes, the loads of the last step and the populations.
fn run(limits: wgpu::Limits) -> (u32, Vec<u32>, Populations) {
    let rig = Rig::with_limits(limits);
    let (device, queue) = (&rig.device, &rig.queue);
    let mut lattice: Lattice = rig.start(setup(), &State::rest(48 * 40 * 20), false);
    let units = Units {
        cell: 1.0,
        time_step: 1.0,
        density: 1.0,
    };
    let frame = Frame {
        origin: DVec3::ZERO,
        units,
    };
    let shape = Polyhedron::cuboid(DVec3::new(7.0, 5.0, 6.0))
        .unwrap()
        .into();
    let block = SolidBlock {
        faces: true,
        ..SolidBlock::new(Arc::new(shape))
    };
    let mut cells = SolidCells::new(device, &lattice, frame, vec![block]).unwrap();
    for step in 0..6 {
        let turned = DQuat::from_rotation_x(0.02 * f64::from(step));
        let at = DVec3::new(11.3 + 0.05 * f64::from(step), 9.0, 8.0);
        let pose = Pose::rigid(at, turned, DVec3::X * 0.05, DVec3::X * 0.02);
        cells.place(device, queue, &mut lattice, &[pose]).unwrap();
        submit_pass(device, queue, |pass| {
            cells.record_cells(pass);
            lattice.record_psm(pass);
            cells.record_loads(pass);
            lattice.record_rest(pass);
        });
    }
    let mut readback = Readback::default();
    let count = cells.wrench_count();
    let read = readback.read::<u32>(device, queue, cells.wrenches(), count);
    let wrenches = rig.wait(read).unwrap();
    let bindings = lattice.bindings().psm_planes;
    (bindings, wrenches, rig.populations(&mut lattice))
}

#[test]
fn planes_above_a_binding_are_spread() {
    let all = Rig::new().device.limits();
    if all.max_storage_buffers_per_shader_stage < 16 {
        return;
    }
    let (one, loads, populations) = run(all.clone());
    assert_eq!(one, 1);
    // Two of nine planes of all cells.
    let plane = 4 * u64::from(Grid::new(&setup()).unwrap().scalar_count());
    let (several, found, there) = run(wgpu::Limits {
        max_storage_buffer_binding_size: 2 * plane,
        ..all
    });
    assert!(several > 1);
    assert!(loads.iter().any(|&bits| bits != 0));
    assert!((found, there) == (loads, populations), "{several} bindings");
}
