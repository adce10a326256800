//! The sun and the sky, and the shadows of bodies for each of their directions.
//!
//! A uniform sky consists of many directions, each with its own shadow map: where bodies hide a part of the sky it is
//! darker, which shows the depth of a heap. All maps are tiles of one texture; the sun's is the largest.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

/// Size of the shader's table of lights.
pub const MOST: usize = 64;
/// Tiles along each edge of the atlas, and the largest number of triangles for which it is used; the sun takes the
/// quarter in the corner, the directions of the sky the rest. Every light draws every triangle once, on the CPU
/// in somewhat less than 1 µs. With more triangles only the sun has a shadow map.
const TILES: [(usize, usize); 2] = [(8, 50_000), (4, 600_000)];
/// Factor by which a GPU draws more triangles in that time, at least.
const GPU: usize = 50;

/// Illuminance of the sun on a surface that faces it.
pub const SUN: f64 = 0.64;
/// Illuminance of the whole sky on the ground.
pub const SKY: f64 = 0.56;
/// Illuminance from the ground on a surface that faces it.
pub const BOUNCE: f64 = 0.16;

/// A light direction, as in view.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Light {
    across: [f32; 4],
    upwards: [f32; 4],
    depth: [f32; 4],
    towards: [f32; 4],
    tile: [f32; 4],
}

/// The lights, and their tiles in the atlas: left, top, size, texels.
pub struct Lights {
    /// The sun first.
    pub lights: Vec<Light>,
    /// In the order of the lights.
    pub tiles: Vec<[u32; 3]>,
}

impl Lights {
    /// The lights over bodies in the box from `low` to `high` (m, relative to the camera's target), with
    /// shadow maps in an atlas of `texels` × `texels`. `triangles` are those of all bodies, drawn on a CPU or not.
    pub fn new(
        sun: DVec3,
        zenith: DVec3,
        [low, high]: [DVec3; 2],
        triangles: usize,
        on_cpu: bool,
        texels: u32,
    ) -> Self {
        let pace = if on_cpu { 1 } else { GPU };
        let fitting = TILES.iter().find(|(_, most)| triangles <= most * pace);
        // A single tile, for the sun.
        let along = fitting.map_or(1, |(along, _)| *along);
        let unit = texels / along as u32;
        let sun_tiles = along.div_ceil(2);
        let inside = |at: usize| at % along < sun_tiles && at / along < sun_tiles;
        let cells = (0..along * along).filter(|&at| !inside(at));
        let mut tiles = vec![[0, 0, sun_tiles as u32 * unit]];
        tiles
            .extend(cells.map(|at| [(at % along) as u32 * unit, (at / along) as u32 * unit, unit]));
        let directions = tiles.len() - 1;
        let mut towards = vec![sun];
        towards.extend((0..directions).map(|index| sky(index, directions, zenith)));
        let lights = towards.iter().zip(&tiles);
        Self {
            lights: lights
                .map(|(&towards, &tile)| Light::new(towards, [low, high], tile, texels))
                .collect(),
            tiles,
        }
    }

    /// Illuminance of each direction of the sky on a surface that faces it; 0 if there are no directions.
    pub fn sky_weight(&self) -> f64 {
        // Cosines of directions uniform over a hemisphere have the mean ½.
        match self.lights.len() - 1 {
            0 => 0.0,
            directions => 2.0 * SKY / directions as f64,
        }
    }
}

impl Light {
    fn new(towards: DVec3, [low, high]: [DVec3; 2], [x, y, size]: [u32; 3], texels: u32) -> Self {
        let across = towards.any_orthonormal_vector();
        let axes = [across, towards.cross(across), -towards];
        // Along each axis: the box with a margin of two texels, mapped to 0 to 1.
        let margin = 2.0 / f64::from(size);
        let mut widest = 0.0_f64;
        let rows = axes.map(|axis| {
            let middle = axis.dot(0.5 * (low + high));
            let half = axis
                .abs()
                .dot(0.5 * (high - low))
                .max(f64::from(f32::MIN_POSITIVE));
            let scale = 0.5 * (1.0 - 2.0 * margin) / half;
            widest = widest.max(1.0 / scale);
            let row = scale * axis;
            [row.x, row.y, row.z, 0.5 - scale * middle].map(|value| value as f32)
        });
        let texel = widest / f64::from(size);
        let t = towards;
        let whole = 1.0 / f64::from(texels);
        Self {
            across: rows[0],
            upwards: rows[1],
            depth: rows[2],
            towards: [t.x, t.y, t.z, texel].map(|value| value as f32),
            tile: [
                f64::from(x) * whole,
                f64::from(y) * whole,
                f64::from(size) * whole,
                whole,
            ]
            .map(|value| value as f32),
        }
    }
}

/// Uniform directions over the hemisphere around `zenith`: equal steps of height, each rotated by the golden angle
/// (Vogel 1979, for a disc).
fn sky(index: usize, count: usize, zenith: DVec3) -> DVec3 {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let height = (index as f64 + 0.5) / count as f64;
    let (sin, cos) = (golden * index as f64).sin_cos();
    let across = zenith.any_orthonormal_vector();
    let level = (1.0 - height * height).sqrt() * (cos * across + sin * zenith.cross(across));
    level + height * zenith
}
