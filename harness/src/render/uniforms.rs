//! The uniforms that view.wgsl declares.

use super::camera::{Axes, Camera};
use super::drawing::{Background, Drawing};
use super::light::{BOUNCE, Lights, SKY, SUN};
use bytemuck::{Pod, Zeroable};
use glam::DVec3;

/// As in view.wgsl, where the fields are explained.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Uniforms {
    right: [f32; 4],
    up: [f32; 4],
    forward: [f32; 4],
    eye: [f32; 4],
    size: [f32; 4],
    zenith: [f32; 4],
    weights: [f32; 4],
    ground: [f32; 4],
    ground_x: [f32; 4],
    ground_y: [f32; 4],
    grid: [f32; 4],
    above: [f32; 4],
    below: [f32; 4],
}

/// Depth of the near plane, in distances to the camera's target: nearer things are not visible. A float depth that
/// approaches zero at infinity resolves depths equally well with a near plane this close.
const NEAR: f64 = 1e-3;
/// Approximate number of grid cells of the ground across the bodies.
const CELLS: f64 = 8.0;

impl Uniforms {
    pub fn new(
        drawing: &Drawing<'_>,
        camera: &Camera,
        axes: &Axes,
        size: [u32; 2],
        [low, high]: [DVec3; 2],
        sun: DVec3,
        lights: &Lights,
    ) -> Self {
        let [width, height] = size.map(f64::from);
        let tangent = (0.5 * camera.field_of_view).tan();
        let eye = camera.from - camera.to;
        let zenith = camera.up.normalize();
        let height_of_target = camera.to.dot(zenith);
        let ground = drawing
            .ground
            .map_or(0.0, |ground| ground.height - height_of_target);
        let (middle, radius) = (0.5 * (low + high), 0.5 * (high - low).length());
        // Without bodies, the surroundings of the camera's target.
        let radius = if radius > 0.0 {
            radius
        } else {
            camera.distance() * tangent
        };
        let ground_middle = middle + (ground - middle.dot(zenith)) * zenith;
        let [x, y] = grid_axes(zenith);
        // 1, 2 or 5 times a power of ten.
        let spacing = round_down(2.0 * radius / CELLS);
        let faded = 2.4 * radius;
        let near = NEAR * camera.distance();
        let (above, below) = match drawing.background {
            Background::White => ([1.0; 3], [1.0; 3]),
            Background::Sky => ([0.36, 0.55, 0.82], [0.93, 0.95, 0.98]),
        };
        let places = [x, y].map(|axis| {
            let place = axis.dot(camera.to) + axis.dot(ground_middle);
            place.rem_euclid(spacing)
        });
        let sky = lights.sky_weight();
        let open = SUN * sun.dot(zenith).max(0.0) + SKY;
        Self {
            right: four(axes.right, height / (width * tangent)),
            up: four(axes.up, 1.0 / tangent),
            forward: four(axes.forward, near),
            eye: four(eye, 0.5 * height / tangent),
            size: four(DVec3::new(width, height, lights.lights.len() as f64), 0.0),
            zenith: four(zenith, BOUNCE),
            weights: four(
                DVec3::new(SUN, sky, open),
                if sky > 0.0 { 0.0 } else { SKY },
            ),
            ground: four(ground_middle, radius),
            ground_x: four(x, spacing),
            ground_y: four(y, faded),
            grid: four(DVec3::new(places[0], places[1], 0.0), 0.0),
            above: four(above.into(), 1.0),
            below: four(below.into(), 1.0),
        }
    }

    /// Whether the eye is on the side of the ground with the grid.
    pub fn above_ground(&self) -> bool {
        let [eye, ground, zenith] = [self.eye, self.ground, self.zenith];
        (0..3)
            .map(|axis| (eye[axis] - ground[axis]) * zenith[axis])
            .sum::<f32>()
            > 0.0
    }
}

/// Axes of the grid on the ground.
fn grid_axes(zenith: DVec3) -> [DVec3; 2] {
    // The axis of the world that is closest to horizontal, the first one of a tie: x, y for z up.
    let level = |axis: &DVec3| axis.dot(zenith).abs();
    let mut x = DVec3::X;
    for axis in [DVec3::Y, DVec3::Z] {
        if level(&axis) < level(&x) - 1e-9 {
            x = axis;
        }
    }
    let x = (x - x.dot(zenith) * zenith).normalize();
    [x, zenith.cross(x)]
}

/// The largest of 1, 2 or 5 times a power of ten that is not above `length`.
pub fn round_down(length: f64) -> f64 {
    let decade = 10_f64.powi(length.log10().floor() as i32);
    let leads = [5.0, 2.0];
    let lead = leads.into_iter().find(|lead| lead * decade <= length);
    lead.unwrap_or(1.0) * decade
}

fn four(v: DVec3, w: f64) -> [f32; 4] {
    [v.x, v.y, v.z, w].map(|value| value as f32)
}
