//! Every kernel in every variant, and the structures that they share with the host.

use glam::DVec3;
use riprap::{
    kernel::{Binding, bindings},
    layout,
    particles::{
        Clock, Frame, Home, Hull, KERNELS, MOST_BINDINGS, Motion, Neighbours, Particle, Setup,
        Shelter, Side, StateEquation, program,
    },
};
use std::mem::offset_of;

#[test]
fn all_variants_compile_and_bind_what_is_asked_for() {
    let mut most = 0;
    for periodic in [false, true] {
        for state in [StateEquation::Linear, StateEquation::Tait] {
            let mut setup = Setup::tank(DVec3::splat(2.0), 0.1, 10.0);
            // With the other state, to have both.
            setup.laminar_viscosity = if state == StateEquation::Tait {
                0.01
            } else {
                0.0
            };
            setup.state = state;
            if periodic {
                setup.faces[0] = [Side::Periodic; 2];
            }
            for neighbours in [Neighbours::Cells, Neighbours::Lists] {
                setup.neighbours = neighbours;
                let frame = Frame::new(&setup).unwrap();
                for kernel in KERNELS {
                    let linked = program(&setup, &frame, kernel).link().unwrap();
                    let all = bindings(&linked, kernel).unwrap();
                    let storage = |b: &&Binding| b.kind != wgpu::BufferBindingType::Uniform;
                    most = most.max(all.iter().filter(storage).count() as u32);
                }
            }
        }
    }
    assert_eq!(most, MOST_BINDINGS);
}

#[test]
fn structures_lie_as_on_the_device() {
    let setup = Setup::tank(DVec3::splat(2.0), 0.1, 10.0);
    let frame = Frame::new(&setup).unwrap();
    let place = program(&setup, &frame, "shell_place").link().unwrap();
    let particle = [
        ("at", offset_of!(Particle, at)),
        ("id", offset_of!(Particle, id)),
        ("velocity", offset_of!(Particle, velocity)),
        ("excess", offset_of!(Particle, excess)),
    ];
    layout::check::<Particle>(&place.module, "Particle", &particle).unwrap();
    let home = [
        ("place", offset_of!(Home, place)),
        ("body", offset_of!(Home, body)),
    ];
    layout::check::<Home>(&place.module, "Home", &home).unwrap();
    let column = |base: usize, n: usize| base + 16 * n;
    let (turn, rate, change) = (
        offset_of!(Motion, turn),
        offset_of!(Motion, rate),
        offset_of!(Motion, change),
    );
    let motion = [
        ("centre", offset_of!(Motion, centre)),
        ("first", offset_of!(Motion, first)),
        ("velocity", offset_of!(Motion, velocity)),
        ("count", offset_of!(Motion, count)),
        ("acceleration", offset_of!(Motion, acceleration)),
        ("clings", offset_of!(Motion, clings)),
        ("turn_x", column(turn, 0)),
        ("turn_y", column(turn, 1)),
        ("turn_z", column(turn, 2)),
        ("rate_x", column(rate, 0)),
        ("rate_y", column(rate, 1)),
        ("rate_z", column(rate, 2)),
        ("change_x", column(change, 0)),
        ("change_y", column(change, 1)),
        ("change_z", column(change, 2)),
    ];
    layout::check::<Motion>(&place.module, "Motion", &motion).unwrap();
    let clock = [
        ("step", offset_of!(Clock, step)),
        ("limit", offset_of!(Clock, limit)),
        ("elapsed", offset_of!(Clock, elapsed)),
        ("left", offset_of!(Clock, left)),
        ("steps", offset_of!(Clock, steps)),
        ("fault", offset_of!(Clock, fault)),
        ("escaped", offset_of!(Clock, escaped)),
        ("crowd", offset_of!(Clock, crowd)),
        ("held", offset_of!(Clock, held)),
        ("shell_crowd", offset_of!(Clock, shell_crowd)),
        ("stale", offset_of!(Clock, stale)),
        ("travel", offset_of!(Clock, travel)),
        ("body_speed", offset_of!(Clock, body_speed)),
        ("missed", offset_of!(Clock, missed)),
        ("sorts", offset_of!(Clock, sorts)),
        ("fastest", offset_of!(Clock, fastest)),
        ("pressed", offset_of!(Clock, pressed)),
        ("pushed", offset_of!(Clock, pushed)),
    ];
    layout::check::<Clock>(&place.module, "Clock", &clock).unwrap();
    let shelter = [
        ("near", offset_of!(Shelter, near)),
        ("pressed", offset_of!(Shelter, pressed)),
        ("pushed", offset_of!(Shelter, pushed)),
    ];
    let keep_out = program(&setup, &frame, "keep_out").link().unwrap();
    layout::check::<Shelter>(&keep_out.module, "Shelter", &shelter).unwrap();
    let hull = [
        ("centre", offset_of!(Hull, centre)),
        ("radius", offset_of!(Hull, radius)),
        ("body", offset_of!(Hull, body)),
        ("first_face", offset_of!(Hull, first_face)),
        ("faces", offset_of!(Hull, faces)),
        ("bare", offset_of!(Hull, bare)),
    ];
    let load = program(&setup, &frame, "mueller_load").link().unwrap();
    layout::check::<Hull>(&load.module, "Hull", &hull).unwrap();
    let drift = program(&setup, &frame, "drift").link().unwrap();
    layout::check::<Clock>(&drift.module, "ClockShared", &clock).unwrap();
}
