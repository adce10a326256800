//! The force law of a contact on its own.

use glam::{DMat3, DQuat, DVec3};
use kit::assert_relative;
use riprap::rock::law::{Force, History, Joint, Motion, Section, force};
use std::f64::consts::PI;

const JOINT: Joint = Joint {
    normal_stiffness: 1e8,
    shear_stiffness: 5e7,
    friction_angle: PI / 6.0,
    cohesion: 0.0,
    tensile_strength: 0.0,
    damping: 0.1,
};

/// A/12 along both axes.
const SQUARE: DMat3 = DMat3::from_cols(
    DVec3::new(1.0 / 6.0, 0.0, 0.0),
    DVec3::new(0.0, 1.0 / 6.0, 0.0),
    DVec3::ZERO,
);

/// Pressed by 1 mm over 2 m²: 200 kN.
const SECTION: Section = Section {
    normal: DVec3::Z,
    overlap: 1e-3,
    area: 2.0,
    elastic_area: 2.0,
    spread: SQUARE,
    rolls: false,
    opening: 0.0,
};

const REST: Motion = Motion {
    displacement: DVec3::ZERO,
    velocity: DVec3::ZERO,
    spin: DVec3::ZERO,
    frame: DQuat::IDENTITY,
    time_step: 1e-4,
    mass: 1000.0,
};

fn slid(joint: &Joint, displacement: f64, history: &History) -> Force {
    let motion = Motion {
        displacement: DVec3::X * displacement,
        ..REST
    };
    force(joint, &SECTION, &motion, history)
}

#[test]
fn springs_push_by_stiffness_area_and_way() {
    let found = slid(&JOINT, 1e-4, &History::default());
    // k_n A u_n = 200 kN, −k_s A Δu_s = −10 kN.
    let error = (found.total() - DVec3::new(-1e4, 0.0, 2e5)).length();
    assert!(error < 1e-9, "{found:?}");
    assert_eq!(found.friction, 0.0);
}

#[test]
fn shear_stops_at_coulombs_cap_and_the_slip_takes_its_work() {
    // A displacement of 0.1 m would give 10 MN; the cap is cA + f_n tan φ.
    let joint = Joint {
        cohesion: 1e4,
        ..JOINT
    };
    let found = slid(&joint, 0.1, &History::default());
    let cap = 2e4 + 2e5 * (PI / 6.0).tan();
    assert_relative(found.total().x, -cap, 1e-12);
    let slip = 0.1 - cap / 1e8;
    assert_relative(found.friction, cap * slip, 1e-12);
}

#[test]
fn shear_turns_with_a_pair_that_turns_as_one() {
    let start = slid(&JOINT, 1e-4, &History::default());
    let mut history = start.history;
    // Both blocks rotate by 90° about an oblique axis, in steps of 1°.
    let axis = DVec3::new(1.0, 2.0, 3.0).normalize();
    let mut frame = DQuat::IDENTITY;
    for step in 1..=90 {
        frame = DQuat::from_axis_angle(axis, f64::from(step) * PI / 180.0);
        let section = Section {
            normal: frame * DVec3::Z,
            ..SECTION
        };
        history = force(&JOINT, &section, &Motion { frame, ..REST }, &history).history;
    }
    let error = (frame * history.shear - frame * start.spring.with_z(0.0)).length();
    assert!(error < 1e-8, "{error} N of 1e4 N");
}

#[test]
fn shear_turns_by_half_the_twist_of_one_block_about_the_normal() {
    // Only the second block spins: the mean spin of both is half of that. Nothing slips.
    let joint = Joint {
        cohesion: 1e12,
        ..JOINT
    };
    let mut history = slid(&JOINT, 1e-4, &History::default()).history;
    let motion = Motion {
        spin: DVec3::Z * (PI / 2.0),
        time_step: 1e-2,
        ..REST
    };
    for _ in 0..100 {
        history = force(&joint, &SECTION, &motion, &history).history;
    }
    let turned = DQuat::from_rotation_z(PI / 4.0) * DVec3::X * -1e4;
    assert!((history.shear - turned).length() < 1e-8, "{history:?}");
}

#[test]
fn a_dashpot_pulls_only_while_a_bond_holds() {
    let opening = |speed: f64, bonded: bool| {
        let joint = Joint {
            tensile_strength: 1e4,
            ..JOINT
        };
        let motion = Motion {
            velocity: DVec3::Z * speed,
            ..REST
        };
        let history = History {
            bonded,
            ..History::default()
        };
        force(&joint, &SECTION, &motion, &history)
    };
    // c_n = 2ζ √(m* k_n A) = 89.4 kN s/m: at 2.3 m/s it pulls by 5.7 kN, at 3 m/s by 68 kN.
    let c = 0.2 * (1000.0f64 * 2e8).sqrt();
    let held = opening(2.3, true);
    assert!((held.total().z - (2e5 - 2.3 * c)).abs() < 1e-6 && held.total().z < 0.0);
    assert!(held.history.bonded);
    let broken = opening(3.0, true);
    assert_eq!(broken.total().z, -2e4);
    assert!(!broken.history.bonded);
    assert_eq!(opening(2.3, false).total().z, 0.0);
}

#[test]
fn the_dashpot_in_shear_stays_under_the_cap() {
    let motion = Motion {
        velocity: DVec3::X * 50.0,
        ..REST
    };
    let found = force(&JOINT, &SECTION, &motion, &History::default());
    let cap = 2e5 * (PI / 6.0).tan();
    assert_relative(found.total().x, -cap, 1e-12);
    // The spring keeps its force of zero.
    assert_eq!(found.history.shear, DVec3::ZERO);
}

#[test]
fn a_corner_is_as_stiff_as_its_elastic_area_and_as_strong_as_its_own() {
    let corner = Section {
        area: 1e-4,
        elastic_area: 0.25,
        ..SECTION
    };
    let joint = Joint {
        cohesion: 1e6,
        ..JOINT
    };
    let moved = |displacement: f64| {
        let motion = Motion {
            displacement: DVec3::X * displacement,
            ..REST
        };
        force(&joint, &corner, &motion, &History::default()).total()
    };
    // k_n A u_n = 25 kN, k_s A Δu_s = 1.25 kN.
    let error = (moved(1e-4) - DVec3::new(-1.25e3, 0.0, 2.5e4)).length();
    assert!(error < 1e-9, "{error} N");
    // cA + f_n tan φ, with 100 N of cohesion.
    let cap = 1e2 + 2.5e4 * (PI / 6.0).tan();
    let held = moved(0.1).x;
    assert_relative(held, -cap, 1e-12);
}

#[test]
fn a_bond_breaks_where_it_bends_the_most_or_has_slipped_as_far_as_it_opens() {
    let joint = Joint {
        tensile_strength: 1e4,
        ..JOINT
    };
    let bond = History {
        bonded: true,
        ..History::default()
    };
    let open = |overlap: f64, opening: f64| {
        let section = Section {
            overlap,
            opening,
            ..SECTION
        };
        force(&joint, &section, &REST, &bond)
    };
    // σ_t/k_n = 0.1 mm is the limit for the opening in the middle plus the additional opening at the edge.
    let held = open(-0.6e-4, 0.39e-4);
    assert!(
        (held.spring.z + 1e8 * 2.0 * 0.6e-4).abs() < 1e-6,
        "{held:?}"
    );
    assert!(held.history.bonded);
    assert!(!open(-0.6e-4, 0.41e-4).history.bonded);
    // σ_t/k_s = 0.2 mm; the cap is reached at 1.15 mm.
    let cap = 2e5 * (PI / 6.0).tan() / 1e8;
    let first = slid(&joint, cap + 1.5e-4, &bond).history;
    assert!(
        first.bonded && (first.slip - 1.5e-4).abs() < 1e-12,
        "{first:?}"
    );
    assert!(!slid(&joint, 0.6e-4, &first).history.bonded);
}

#[test]
fn shear_over_the_face_resists_a_twist_about_the_normal_up_to_its_friction() {
    let on = |section: Section, angle: f64, displacement: f64| {
        let motion = Motion {
            displacement: DVec3::X * displacement,
            spin: DVec3::Z * (angle / REST.time_step),
            ..REST
        };
        let joint = Joint {
            damping: 0.0,
            ..JOINT
        };
        force(&joint, &section, &motion, &History::default())
    };
    let twisted = |angle: f64, displacement: f64| on(SECTION, angle, displacement);
    // k_s A²/6 = 33.3 MN m; F = 200 kN tan 30°, T_max = (√2 + ln(1 + √2))/6 √2 F.
    let most = 2e5 * (PI / 6.0).tan();
    let twist = (2f64.sqrt() + (1.0 + 2f64.sqrt()).ln()) / 6.0 * 2f64.sqrt() * most;
    let held = twisted(1e-4, 0.0);
    assert_relative(held.couple().z, -1e-4 * 1e8 / 3.0, 1e-12);
    assert_eq!(held.friction, 0.0);
    // A sphere touches at a point.
    let ball = Section {
        rolls: true,
        ..SECTION
    };
    assert_eq!(on(ball, 1e-4, 0.0).couple().z, 0.0);
    let slipped = twisted(1.0, 0.0);
    assert_relative(slipped.couple().z, -twist, 1e-12);
    assert_relative(slipped.friction, twist * (1.0 - twist / (1e8 / 3.0)), 1e-12);
    // Both at once lie on the limit surface, n = 1 + 0.7 (1/2 + 1/4).
    let both = twisted(1.0, 0.5);
    let [f, t] = [both.total().x / most, both.couple().z / twist].map(f64::abs);
    assert!(f > 0.1 && t > 0.1, "{f}, {t}");
    assert_relative(f * f + t.powf(1.525), 1.0, 1e-12);
    // An edge of 3 m has an arm of a quarter of its length; a circle nearly 2/3 of its radius; a face of 2 m by 1 m the mean
    // distance of its points from the middle, by the midpoint rule.
    let arm = |area: f64, [x, y]: [f64; 2]| {
        let spread = DMat3::from_diagonal(DVec3::new(x, y, 0.0));
        let section = Section {
            area,
            spread,
            ..SECTION
        };
        -on(section, 1.0, 0.0).couple().z / most
    };
    assert_relative(arm(1e-9, [9.0 / 12.0, 0.0]), 0.75, 1e-6);
    assert_relative(arm(PI, [0.25; 2]), 2.0 / 3.0, 1e-2);
    let middles = (0..1000).map(|i| (f64::from(i) + 0.5) / 1000.0);
    let row = |x: f64| middles.clone().map(move |y| x.hypot(0.5 * y)).sum::<f64>();
    let mean = middles.clone().map(row).sum::<f64>() / 1e6;
    assert_relative(arm(2.0, [4.0 / 12.0, 1.0 / 12.0]), mean, 1e-5);
}

/// Blocks that rotate about a point yield within 3 % of the force and the moment of uniform pressure over a rectangle.
#[test]
fn force_and_moment_share_the_friction_as_under_uniform_pressure() {
    let middles = |side: f64| (0..60).map(move |i| ((f64::from(i) + 0.5) / 60.0 - 0.5) * side);
    for [a, b] in [[1.0, 1.0], [2.0, 1.0], [1.0, 2.0], [10.0, 1.0], [1.0, 10.0]] {
        let all: Vec<DVec3> = middles(a)
            .flat_map(|x| middles(b).map(move |y| DVec3::new(x, y, 0.0)))
            .collect();
        let mean = |value: &dyn Fn(DVec3) -> DVec3| {
            all.iter().map(|x| value(*x)).sum::<DVec3>() / all.len() as f64
        };
        let section = Section {
            area: 2.0,
            spread: DMat3::from_diagonal(DVec3::new(a * a, b * b, 0.0) * (2.0 / (12.0 * a * b))),
            ..SECTION
        };
        let scale = (2.0 / (a * b)).sqrt();
        for distance in [0.1, 0.3, 0.5, 1.0, 3.0] {
            // About a point on the y axis: the force is along x.
            let pull = |x: DVec3| {
                -DVec3::Z
                    .cross(x - DVec3::Y * distance * a.max(b))
                    .normalize()
            };
            let push = mean(&pull).x;
            let moment = mean(&|x| x.cross(pull(x))).z * scale;
            // Shear and twist in this proportion, beyond the limit.
            let stiffness = JOINT.shear_stiffness * section.area;
            let polar = section.spread.x_axis.x + section.spread.y_axis.y;
            let motion = Motion {
                displacement: DVec3::X * (-1e7 * push / stiffness),
                spin: DVec3::Z * (-1e7 * moment / (stiffness * polar * REST.time_step)),
                ..REST
            };
            let joint = Joint {
                damping: 0.0,
                ..JOINT
            };
            let found = force(&joint, &section, &motion, &History::default());
            let limit = 2e5 * (PI / 6.0).tan();
            assert_relative(found.total().x / (limit * push), 1.0, 0.03);
            assert_relative(found.couple().z / (limit * moment), 1.0, 0.03);
        }
    }
}
