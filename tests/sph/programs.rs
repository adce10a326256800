//! All kernels in all variants, and the structures that they share with the host.

use glam::DVec3;
use riprap::{
    gpu::{
        kernel::{Binding, bindings},
        layout,
    },
    sph::{
        BodyMotion, CellGrid, Clock, EquationOfState, Hull, KERNELS, MAX_STORAGE_BUFFERS,
        NeighbourSearch, Particle, ReferencePosition, Setup, Side, WallWork, program,
    },
};
use std::mem::offset_of;

#[test]
fn all_variants_compile_and_bind_the_stated_number_of_buffers() {
    let mut most = 0;
    for periodic in [false, true] {
        for state in [EquationOfState::Linear, EquationOfState::Tait] {
            let mut setup = Setup::tank(DVec3::splat(2.0), 0.1, 10.0);
            // Viscous with one equation of state only, to cover both variants.
            setup.laminar_viscosity = if state == EquationOfState::Tait {
                0.01
            } else {
                0.0
            };
            setup.equation_of_state = state;
            if periodic {
                setup.faces[0] = [Side::Periodic; 2];
            }
            for neighbours in [NeighbourSearch::Cells, NeighbourSearch::Lists] {
                setup.neighbours = neighbours;
                let grid = CellGrid::new(&setup).unwrap();
                for kernel in KERNELS {
                    let linked = program(&setup, &grid, kernel).link().unwrap();
                    let all = bindings(&linked, kernel).unwrap();
                    let storage = |b: &&Binding| b.kind != riprap::wgpu::BufferBindingType::Uniform;
                    most = most.max(all.iter().filter(storage).count() as u32);
                }
            }
        }
    }
    assert_eq!(most, MAX_STORAGE_BUFFERS);
}

#[test]
fn structures_have_the_layout_of_the_kernels() {
    let setup = Setup::tank(DVec3::splat(2.0), 0.1, 10.0);
    let grid = CellGrid::new(&setup).unwrap();
    let linked = program(&setup, &grid, "boundary_position").link().unwrap();
    let particle = [
        ("at", offset_of!(Particle, at)),
        ("id", offset_of!(Particle, id)),
        ("velocity", offset_of!(Particle, velocity)),
        ("excess", offset_of!(Particle, excess)),
    ];
    layout::check::<Particle>(&linked.module, "Particle", &particle).unwrap();
    let reference = [
        ("position", offset_of!(ReferencePosition, position)),
        ("body", offset_of!(ReferencePosition, body)),
    ];
    layout::check::<ReferencePosition>(&linked.module, "ReferencePosition", &reference).unwrap();
    let column = |base: usize, n: usize| base + 16 * n;
    let (deformation, rate, acceleration) = (
        offset_of!(BodyMotion, deformation),
        offset_of!(BodyMotion, deformation_rate),
        offset_of!(BodyMotion, deformation_acceleration),
    );
    let motion = [
        ("centre", offset_of!(BodyMotion, centre)),
        ("first", offset_of!(BodyMotion, first)),
        ("velocity", offset_of!(BodyMotion, velocity)),
        ("count", offset_of!(BodyMotion, count)),
        ("acceleration", offset_of!(BodyMotion, acceleration)),
        ("no_slip", offset_of!(BodyMotion, no_slip)),
        ("deformation_x", column(deformation, 0)),
        ("deformation_y", column(deformation, 1)),
        ("deformation_z", column(deformation, 2)),
        ("deformation_rate_x", column(rate, 0)),
        ("deformation_rate_y", column(rate, 1)),
        ("deformation_rate_z", column(rate, 2)),
        ("deformation_acceleration_x", column(acceleration, 0)),
        ("deformation_acceleration_y", column(acceleration, 1)),
        ("deformation_acceleration_z", column(acceleration, 2)),
    ];
    layout::check::<BodyMotion>(&linked.module, "BodyMotion", &motion).unwrap();
    let clock = [
        ("step", offset_of!(Clock, step)),
        ("step_limit", offset_of!(Clock, step_limit)),
        ("elapsed", offset_of!(Clock, elapsed)),
        ("remaining", offset_of!(Clock, remaining)),
        ("steps", offset_of!(Clock, steps)),
        ("invalid_particle", offset_of!(Clock, invalid_particle)),
        ("escaped", offset_of!(Clock, escaped)),
        ("overflow", offset_of!(Clock, overflow)),
        ("pending_step", offset_of!(Clock, pending_step)),
        ("boundary_overflow", offset_of!(Clock, boundary_overflow)),
        ("stale", offset_of!(Clock, stale)),
        ("list_displacement", offset_of!(Clock, list_displacement)),
        ("max_body_speed", offset_of!(Clock, max_body_speed)),
        ("escaped_at_sort", offset_of!(Clock, escaped_at_sort)),
        ("sorts", offset_of!(Clock, sorts)),
        ("max_speed", offset_of!(Clock, max_speed)),
        ("boundary_work", offset_of!(Clock, boundary_work)),
        ("penalty_work", offset_of!(Clock, penalty_work)),
        ("crossings_x", offset_of!(Clock, crossings)),
        ("crossings_y", offset_of!(Clock, crossings) + 4),
        ("crossings_z", offset_of!(Clock, crossings) + 8),
    ];
    layout::check::<Clock>(&linked.module, "Clock", &clock).unwrap();
    let wall_work = [
        ("near_boundary", offset_of!(WallWork, near_boundary)),
        ("boundary_work", offset_of!(WallWork, boundary_work)),
        ("penalty_work", offset_of!(WallWork, penalty_work)),
    ];
    let penalty = program(&setup, &grid, "apply_penalty").link().unwrap();
    layout::check::<WallWork>(&penalty.module, "WallWork", &wall_work).unwrap();
    let hull = [
        ("centre", offset_of!(Hull, centre)),
        ("radius", offset_of!(Hull, radius)),
        ("body", offset_of!(Hull, body)),
        ("first_face", offset_of!(Hull, first_face)),
        ("faces", offset_of!(Hull, faces)),
        ("exposed", offset_of!(Hull, exposed)),
    ];
    let load = program(&setup, &grid, "mueller_load").link().unwrap();
    layout::check::<Hull>(&load.module, "Hull", &hull).unwrap();
    let drift = program(&setup, &grid, "drift").link().unwrap();
    layout::check::<Clock>(&drift.module, "ClockAtomic", &clock).unwrap();
}
