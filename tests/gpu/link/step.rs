//! The step kernels: all slots, and each pair of a slot's file and a number of bindings.

use super::specialise::{LAYOUTS, bindings_of, forces, names, specialise, third_of_variants};
use riprap::lattice::{
    Bindings, BrickKind, Collision, Equilibrium, Setup, SolidOperator, SurfaceCell, WallModel,
    collide_stream,
};

/// Kinds of bricks, each solid operator once, and whether solids at rest fill cells partially.
const KINDS: [(BrickKind, Option<SolidOperator>, bool); 7] = [
    (BrickKind::All, None, false),
    (BrickKind::Plain, None, true),
    (BrickKind::Flagged, None, false),
    (BrickKind::Surface, None, true),
    (BrickKind::Psm, Some(SolidOperator::Holdych), false),
    (BrickKind::Psm, Some(SolidOperator::Noble), true),
    (BrickKind::Psm, Some(SolidOperator::Superposition), false),
];

#[test]
fn the_step_in_variants_of_all_slots() {
    for variant in third_of_variants(&[LAYOUTS.len(), 3, 2, 3, 3, 2, KINDS.len()]) {
        let [layout, collision, equilibrium, wale, force, guard, kind] = variant[..] else {
            unreachable!()
        };
        let mut setup = Setup::periodic([4; 3], 0.1);
        (setup.storage, setup.lanes, setup.wide) = LAYOUTS[layout];
        setup.collision = [Collision::Bgk, Collision::Hermite, Collision::Suga][collision];
        setup.equilibrium = [Equilibrium::Product, Equilibrium::SecondOrder][equilibrium];
        setup.wale = (wale > 0).then_some(0.5);
        setup.wale_interval = 1 + guard as u32;
        setup.wall_model = (wale == 2).then_some(WallModel::WernerWengle);
        setup.force = forces()[force].clone();
        setup.max_speed = 0.4 * guard as f64;
        let (kind, operator, surface) = KINDS[kind];
        setup.solid_operator = operator;
        if surface {
            setup.surface = vec![SurfaceCell {
                cell: 0,
                fraction: 0.5,
            }];
        }
        let flagged = !matches!(kind, BrickKind::All | BrickKind::Plain);
        let with_surface = surface && matches!(kind, BrickKind::Surface | BrickKind::Psm);
        // Walls set flags, so that not all bricks are plain fluid.
        if wale == 2 && kind == BrickKind::All {
            continue;
        }
        let count = bindings_of(&variant);
        let sampling = variant.iter().sum::<usize>().is_multiple_of(3);
        let bindings = Bindings {
            statistics: u32::from(sampling),
            ..Bindings::from(count)
        };
        let linked = collide_stream(&setup, bindings, kind)
            .link()
            .unwrap_or_else(|error| panic!("{setup:?} {kind:?} {count}: {error}"));
        let wanted = [
            ("velocity_before_0", setup.wale.is_some()),
            ("velocity_after_0", wale > 0 && guard == 0),
            ("eddy_viscosity", wale > 0 && guard == 1),
            ("near_wall_viscosity", wale == 2),
            ("uniform_force", force == 1),
            ("force_field_0", force == 2),
            ("guard_state", guard == 1),
            ("bricks", kind != BrickKind::All),
            ("flags", flagged),
            ("surface_slots", with_surface),
            ("surface_fractions", with_surface),
            ("psm_planes_0", operator.is_some()),
            ("statistics_0", sampling),
            (
                "face_codes",
                kind == BrickKind::Psm && setup.has_block_friction(),
            ),
        ];
        let wanted = wanted.iter().filter(|w| w.1).map(|w| w.0.to_owned());
        let found = names(&linked, "collide_stream");
        assert_eq!(found, (wanted.collect(), count as usize), "{setup:?}");
        specialise(
            &linked,
            "collide_stream",
            &setup,
            variant.iter().sum::<usize>() % 2 == 1,
        );
    }
}
