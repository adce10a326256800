//! Small balls: size, place, colour and depth.

use super::fixture::{WHITE, body, body_in_the_middle_row, drawing, level, plain_cube, render};
use glam::DVec3;
use riprap_harness::render::{Colours, Drawing, Drop, Drops};

/// Balls of `radius` (m) at `centres`, all of the lowest value.
fn drops(radius: f64, centres: &[DVec3]) -> Option<Drops> {
    Some(Drops {
        drops: centres
            .iter()
            .map(|centre| Drop {
                centre: *centre,
                value: 0.0,
            })
            .collect(),
        radius,
        colours: Colours {
            label: "speed".into(),
            unit: "m/s".into(),
            range: Some([0.0, 1.0]),
        },
    })
}

/// The picture of balls and a cube without colour bar, seen from 10 m along +y.
fn seen(drops: Option<Drops>, cube: Option<DVec3>) -> riprap_harness::render::Picture {
    let meshes = [plain_cube()];
    render(
        &Drawing {
            drops,
            ..drawing(&meshes, cube.into_iter().map(body).collect(), level())
        },
        [500, 300],
    )
}

/// Whether a pixel has the blue of the lowest value, in any light.
fn is_blue([r, g, b]: [u8; 3]) -> bool {
    b > g && g > r && b > r.saturating_add(30)
}

#[test]
fn a_ball_is_round_and_as_large_as_it_is() {
    let picture = seen(drops(0.5, &[DVec3::ZERO]), None);
    // Left of the colour bar.
    let [middle, _] = body_in_the_middle_row(&picture);
    let blue: Vec<[u32; 2]> = (0..300)
        .flat_map(|y| (middle - 80..middle + 80).map(move |x| [x, y]))
        .filter(|&[x, y]| is_blue(picture.pixel(x, y)))
        .collect();
    let span = |axis: usize| {
        let all = blue.iter().map(|at| at[axis]);
        (all.clone().max().unwrap() - all.min().unwrap() + 1) as f64
    };
    // 300 pixels are 2 · 10 tan 7.5° = 2.633 m, so that a metre has 114 pixels.
    let diameter = 300.0 / (20.0 * 7.5_f64.to_radians().tan());
    assert!((span(0) - diameter).abs() < 4.0, "{} {diameter}", span(0));
    assert!((span(1) - diameter).abs() < 4.0, "{} {diameter}", span(1));
    let area = std::f64::consts::PI / 4.0 * diameter * diameter;
    assert!(
        (blue.len() as f64 / area - 1.0).abs() < 0.06,
        "{} {area}",
        blue.len()
    );
}

#[test]
fn balls_hide_and_are_hidden_by_their_depth() {
    let middle = |picture: &riprap_harness::render::Picture| {
        let [x, y] = body_in_the_middle_row(picture);
        picture.pixel(x, y)
    };
    let small = drops(0.1, &[DVec3::new(0.0, -0.7, 0.0)]);
    assert!(is_blue(middle(&seen(small, Some(DVec3::ZERO)))));
    let behind = drops(0.1, &[DVec3::new(0.0, 0.7, 0.0)]);
    assert!(!is_blue(middle(&seen(behind, Some(DVec3::ZERO)))));
    // Half inside the face of the cube, at y = −0.5: its front is visible.
    let half = drops(0.2, &[DVec3::new(0.0, -0.45, 0.0)]);
    assert!(is_blue(middle(&seen(half, Some(DVec3::ZERO)))));
    // Its centre is nearer to the face, but all of it is inside the cube.
    let inside = drops(0.2, &[DVec3::new(0.0, -0.2, 0.0)]);
    assert!(!is_blue(middle(&seen(inside, Some(DVec3::ZERO)))));
}

#[test]
fn a_ball_far_smaller_than_a_pixel_is_still_there() {
    let picture = seen(drops(1e-5, &[DVec3::ZERO]), None);
    let there = (0..300).any(|y| (0..400).any(|x| picture.pixel(x, y) != WHITE));
    assert!(there);
}
