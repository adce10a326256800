//! Rock masses: volumes add up, neighbours share planes, and joints have the prescribed orientation and spacing.

use crate::measure::{assert_sound, assert_sound_to};
use glam::DVec3;
use kit::assert_near;
use proptest::prelude::*;
use riprap::geometry::{
    Compass, Fragments, HalfSpace, JointSet, Persistence, Polyhedron, RockMass, Scatter,
};
use std::collections::BTreeMap;

fn cuboid(min: DVec3, max: DVec3) -> Vec<HalfSpace> {
    let faces = DVec3::AXES.into_iter().flat_map(|axis| {
        [
            HalfSpace::through(min, -axis),
            HalfSpace::through(max, axis),
        ]
    });
    faces.collect()
}

fn set(dip: f64, dip_direction: f64, spacing: f64) -> JointSet {
    JointSet {
        dip,
        dip_direction,
        spacing,
        scatter: Scatter::None,
        origin: DVec3::ZERO,
        seed: 7,
        persistence: None,
    }
}

/// 20 × 16 × 12 m with a slope, cut by three oblique sets.
fn slope(spacing: f64, scatter: Scatter) -> RockMass {
    let at = DVec3::new(500.0, -300.0, 40.0);
    let joint = |dip, direction, seed| JointSet {
        scatter,
        seed,
        origin: at + DVec3::new(0.3, 0.2, 0.1),
        ..set(dip, direction, spacing)
    };
    let face = HalfSpace::through(at + DVec3::new(9.0, 0.0, 0.0), DVec3::new(1.0, 0.2, 1.0));
    RockMass {
        surfaces: vec![face],
        joints: vec![
            joint(35.0, 80.0, 1),
            joint(80.0, 170.0, 2),
            joint(65.0, 265.0, 3),
        ],
        ..RockMass::new(vec![cuboid(
            at - DVec3::new(10.0, 8.0, 6.0),
            at + DVec3::new(10.0, 8.0, 6.0),
        )])
    }
}

fn bits(plane: &HalfSpace) -> [u64; 4] {
    let [x, y, z] = plane.normal.to_array();
    // Adding zero makes −0 and 0 equal.
    [x, y, z, plane.distance].map(|v| (v + 0.0).to_bits())
}

fn assert_adds_up(cut: &Fragments) {
    let blocks = cut.blocks.iter().map(|b| b.shape.volume());
    let slivers = cut.slivers.iter().map(|s| s.volume);
    let sum: f64 = blocks.chain(slivers).sum();
    let error = (sum - cut.volume).abs() / cut.volume;
    // Only rounding: the requirement is 1e-9.
    assert!(error < 1e-12, "volumes miss by {error:e}");
}

#[test]
fn three_orthogonal_sets_make_equal_bricks() {
    let mass = RockMass {
        joints: vec![
            set(0.0, 0.0, 0.5),
            set(90.0, 0.0, 1.0),
            set(90.0, 90.0, 2.0),
        ],
        ..RockMass::new(vec![cuboid(DVec3::ZERO, DVec3::new(8.0, 5.0, 3.0))])
    };
    let cut = mass.cut().unwrap();
    assert_eq!((cut.blocks.len(), cut.slivers.len()), (4 * 5 * 6, 0));
    assert_eq!(cut.volume, 120.0);
    let brick = Polyhedron::cuboid(DVec3::new(2.0, 1.0, 0.5)).unwrap();
    for block in &cut.blocks {
        assert_eq!(block.shape.faces().len(), 6);
        assert_near(block.shape.volume(), brick.volume(), 1e-14);
        assert_near(block.shape.radius(), brick.radius(), 1e-14);
        // Centres are at odd halves of the spacings.
        let cell = block.centre / DVec3::new(2.0, 1.0, 0.5) - 0.5;
        assert!((cell - cell.round()).length() < 1e-13);
    }
}

#[test]
fn ten_thousand_blocks_add_up_and_are_sound() {
    let cut = slope(0.66, Scatter::Uniform { range: 0.3 }).cut().unwrap();
    assert!(cut.blocks.len() > 10_000, "{} blocks", cut.blocks.len());
    assert_adds_up(&cut);
    for block in cut.blocks.iter().step_by(7) {
        assert_sound(&block.shape);
        for (world, face) in block.planes.iter().zip(block.shape.faces()) {
            assert_eq!(world.normal, face.normal);
            let distance = world.distance - world.normal.dot(block.centre);
            // World coordinates are 500 m, which gives the error.
            assert_near(distance, face.distance, 1e-12);
        }
    }
}

#[test]
fn neighbours_faces_coincide_to_the_bit() {
    let cut = slope(1.5, Scatter::Normal { deviation: 0.3 })
        .cut()
        .unwrap();
    assert!(cut.blocks.len() > 500);
    let size = cut.volume.cbrt();
    // Area of faces by plane: both sides have the same area, except on the surface.
    let mut sides: BTreeMap<[u64; 4], f64> = BTreeMap::new();
    for block in &cut.blocks {
        for (plane, ring) in block.planes.iter().zip(block.shape.loops()) {
            let points: Vec<DVec3> = ring
                .iter()
                .map(|v| block.shape.vertices()[*v as usize])
                .collect();
            *sides.entry(bits(plane)).or_default() += crate::measure::area(&points).length();
        }
    }
    let mass = slope(1.5, Scatter::None);
    let mut surface = 0;
    for (plane, area) in &sides {
        let [x, y, z, d] = plane.map(f64::from_bits);
        let opposite = HalfSpace {
            normal: -DVec3::new(x, y, z),
            distance: -d,
        };
        match sides.get(&bits(&opposite)) {
            Some(other) => assert_near(*area, *other, 1e-9 * size * size),
            None => {
                let own = mass.volumes[0].iter().chain(&mass.surfaces);
                assert!(
                    own.map(bits).any(|b| b == *plane),
                    "an open joint {plane:?}"
                );
                surface += 1;
            }
        }
    }
    assert_eq!(surface, 7);
}

#[test]
fn the_same_mass_is_the_same_bits_on_any_number_of_threads() {
    let mass = slope(1.5, Scatter::Lognormal { deviation: 0.8 });
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| mass.cut().unwrap())
    };
    let one = on(1);
    assert_eq!(one, on(3));
    let mut other = mass.clone();
    other.joints[1].seed += 1;
    assert_ne!(one.blocks.len(), other.cut().unwrap().blocks.len());
}

#[test]
fn dip_and_dip_direction_are_the_geologists() {
    let sqrt = f64::sqrt(0.5);
    let z_up = Compass::default();
    // 45° down to the east: the normal leans east.
    let normal = z_up.normal(45.0, 90.0).unwrap();
    assert!(normal.distance(DVec3::new(sqrt, 0.0, sqrt)) < 1e-15);
    assert_eq!(z_up.normal(90.0, 0.0).unwrap(), DVec3::Y);
    assert_eq!(z_up.normal(0.0, 123.0).unwrap(), DVec3::Z);
    // y up, north away from the viewer: east is x.
    let y_up = Compass {
        up: DVec3::Y * 2.0,
        north: DVec3::new(0.0, 5.0, -1.0),
    };
    let normal = y_up.normal(45.0, 90.0).unwrap();
    assert!(normal.distance(DVec3::new(sqrt, sqrt, 0.0)) < 1e-15);
    // A wedge in the manner of Goodman & Shi: planes 45/105 and 70/235 intersect in a line that plunges 31.1965°.
    let a = z_up.normal(45.0, 105.0).unwrap();
    let b = z_up.normal(70.0, 235.0).unwrap();
    let line = a.cross(b).normalize();
    assert_near(line.z.abs().asin().to_degrees(), 31.1965, 5e-5);
}

/// Spacings of the joints of one horizontal set in a tall column.
fn gaps(scatter: Scatter, seed: u64) -> Vec<f64> {
    let mass = RockMass {
        joints: vec![JointSet {
            scatter,
            seed,
            ..set(0.0, 0.0, 1.0)
        }],
        ..RockMass::new(vec![cuboid(
            DVec3::new(-50.0, -50.0, -1000.0),
            DVec3::new(50.0, 50.0, 1000.0),
        )])
    };
    let cut = mass.cut().unwrap();
    assert_adds_up(&cut);
    let slivers = cut.slivers.iter().map(|s| (s.centre.z, s.volume));
    let blocks = cut.blocks.iter().map(|b| (b.centre.z, b.shape.volume()));
    let mut all: Vec<(f64, f64)> = blocks.chain(slivers).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    // The first and the last gap end at the surface of the column.
    all[1..all.len() - 1].iter().map(|(_, v)| v / 1e4).collect()
}

#[test]
fn spacings_have_the_distribution_asked_for() {
    let moments = |scatter| {
        let gaps = gaps(scatter, 11);
        let n = gaps.len() as f64;
        let mean = gaps.iter().sum::<f64>() / n;
        let square = gaps.iter().map(|g| (g - mean).powi(2)).sum::<f64>() / n;
        (gaps, mean, square.sqrt())
    };
    let (gaps, mean, deviation) = moments(Scatter::None);
    assert_eq!(gaps.len(), 1998);
    assert!((mean - 1.0).abs() < 1e-12 && deviation < 1e-9);
    // For 2000 gaps the mean has an error of σ/45 and the deviation of about σ/63 (exponential σ/32): 4 times that.
    let cases = [
        (Scatter::Uniform { range: 0.6 }, 0.6 / 3f64.sqrt(), 1.0),
        (Scatter::Normal { deviation: 0.2 }, 0.2, 1.0),
        (Scatter::Lognormal { deviation: 0.4 }, 0.4, 2.0),
        (Scatter::Exponential, 1.0, 2.0),
    ];
    for (scatter, sigma, heavy) in cases {
        let (gaps, mean, deviation) = moments(scatter);
        assert!(
            (mean - 1.0).abs() < 4.0 * sigma / 44.0,
            "{scatter:?}: mean {mean}"
        );
        let error = (deviation / sigma - 1.0).abs();
        assert!(
            error < 4.0 * heavy / 63.0,
            "{scatter:?}: deviation {deviation}"
        );
        assert!(gaps.iter().all(|g| *g > 0.0));
    }
}

#[test]
fn joints_that_end_cut_their_share() {
    let with = |fraction| {
        let persistence = Some(Persistence {
            fraction,
            length: 0.5,
        });
        let mut mass = RockMass::new(vec![cuboid(DVec3::ZERO, DVec3::splat(20.0))]);
        // Columns first, and then horizontal joints that each column meets or not.
        mass.joints = vec![
            set(90.0, 0.0, 1.0),
            set(90.0, 90.0, 1.0),
            set(0.0, 0.0, 1.0),
        ];
        mass.joints[2].persistence = persistence;
        let cut = mass.cut().unwrap();
        assert_adds_up(&cut);
        cut.blocks.len()
    };
    // 400 columns, each met by 19 joints.
    assert_eq!(with(0.0), 400);
    assert_eq!(with(1.0), 400 * 20);
    let share = (with(0.3) - 400) as f64 / (400.0 * 19.0);
    // 7600 draws: σ = 0.0053.
    assert_near(share, 0.3, 0.02);
}

#[test]
fn slivers_are_listed_and_can_be_kept() {
    let mut mass = RockMass::new(vec![cuboid(DVec3::ZERO, DVec3::ONE)]);
    // Thin pieces: at the top 0.01 m, which contact resolves; at the side 2e-5 m, which it does not.
    mass.joints = vec![set(0.0, 0.0, 0.99), set(90.0, 90.0, 1.0 - 2e-5)];
    mass.smallest_thickness = 0.02;
    let cut = mass.cut().unwrap();
    assert_adds_up(&cut);
    assert_eq!((cut.blocks.len(), cut.slivers.len()), (1, 3));
    let kept = cut.keep_slivers();
    assert_adds_up(&kept);
    assert_eq!((kept.blocks.len(), kept.slivers.len()), (2, 2));
    mass.smallest_thickness = 0.0;
    assert_eq!(mass.cut().unwrap().blocks.len(), 2);
    mass.smallest_volume = 0.5;
    let cut = mass.cut().unwrap();
    assert_adds_up(&cut);
    assert_eq!((cut.blocks.len(), cut.slivers.len()), (1, 3));
}

#[test]
fn several_volumes_are_cut_by_the_same_joints() {
    let low = cuboid(DVec3::ZERO, DVec3::new(4.0, 4.0, 1.0));
    let high = cuboid(DVec3::new(0.0, 0.0, 1.0), DVec3::new(2.0, 4.0, 3.0));
    let mass = RockMass {
        joints: vec![set(60.0, 30.0, 0.7), set(70.0, 150.0, 0.8)],
        ..RockMass::new(vec![low, high])
    };
    let cut = mass.cut().unwrap();
    assert_near(cut.volume, 32.0, 1e-13);
    assert_adds_up(&cut);
    let joint = mass.compass.normal(60.0, 30.0).unwrap();
    let of = |upper: bool| {
        let blocks = cut
            .blocks
            .iter()
            .filter(move |b| (b.centre.z > 1.0) == upper);
        let planes = blocks.flat_map(|b| &b.planes);
        let joints = planes.filter(|p| p.normal == joint).map(bits);
        joints.collect::<std::collections::BTreeSet<_>>()
    };
    assert!(of(true).intersection(&of(false)).count() >= 3);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_sets_cut_sound_blocks(
        sets in proptest::collection::vec((0.0..90.0_f64, 0.0..360.0_f64, 1.0..4.0_f64, 0..3_u64), 1..5),
        twin in -3..3_i32,
        surface in (-1.0..1.0_f64, -1.0..1.0_f64),
    ) {
        let mut mass = RockMass::new(vec![cuboid(DVec3::splat(-4.0), DVec3::splat(4.0))]);
        mass.surfaces = vec![HalfSpace::through(DVec3::Z * 2.0, DVec3::new(surface.0, surface.1, 1.0))];
        mass.joints = sets
            .iter()
            .map(|(dip, direction, spacing, seed)| JointSet {
                scatter: if *seed == 0 { Scatter::None } else { Scatter::Exponential },
                seed: *seed,
                persistence: (*seed == 2).then_some(Persistence { fraction: 0.5, length: 2.0 }),
                ..set(*dip, *direction, *spacing)
            })
            .collect();
        // The first again, rotated slightly: by at most 1e-15, 1e-12, 1e-9 or nothing.
        let mut again = mass.joints[0].clone();
        again.dip = (again.dip + 10f64.powi(5 * twin - 8) * f64::from(twin.signum())).clamp(0.0, 90.0);
        mass.joints.push(again);
        let cut = mass.cut().unwrap();
        assert_adds_up(&cut);
        for block in &cut.blocks {
            // 1e-12 of the mass for each decision.
            assert_sound_to(&block.shape, 1e-11 * 4.0);
        }
    }
}

#[test]
fn what_is_no_rock_mass_is_refused() {
    let good = slope(3.0, Scatter::None);
    let share = |fraction, length| Some(Persistence { fraction, length });
    let changes: [&dyn Fn(&mut RockMass); 15] = [
        &|m| m.volumes.clear(),
        &|m| m.volumes[0][2].distance = f64::NAN,
        &|m| m.volumes[0] = m.volumes[0][1..].to_vec(),
        &|m| m.surfaces[0].distance = -1e4,
        &|m| m.joints[1].spacing = 0.0,
        &|m| m.joints[1].spacing = 1e-7,
        &|m| m.joints[1].dip = 91.0,
        &|m| m.joints[1].dip_direction = f64::NAN,
        &|m| m.joints[2].origin.x = 1e9,
        &|m| m.joints[2].origin.x = f64::NAN,
        &|m| m.joints[0].scatter = Scatter::Uniform { range: 3.0 },
        &|m| m.compass.north = DVec3::Z,
        &|m| m.joints[0].persistence = share(1.5, 1.0),
        &|m| m.joints[0].persistence = share(0.5, 0.0),
        &|m| m.joints.iter_mut().for_each(|j| j.spacing = 0.05),
    ];
    let refusal = |change: &&dyn Fn(&mut RockMass)| {
        let mut mass = good.clone();
        change(&mut mass);
        let cut = mass.cut().map(|c| c.blocks.len());
        cut.unwrap_err().to_string() + "\n"
    };
    insta::assert_snapshot!(changes.iter().map(refusal).collect::<String>());
}
