//! Points on spheres.

use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// The golden angle, by which successive points of a spiral are turned: they then keep their distance.
const GOLDEN: f64 = 2.399_963_229_728_653;

/// Points on the sphere of `radius` (m) about the origin, as many as there are cubes of edge `spacing` (m) in
/// the layer of that thickness around it: a Fibonacci spiral (Swinbank & Purser 2006, Q. J. R. Meteorol. Soc.
/// 132:1769).
pub(super) fn spiral(radius: f64, spacing: f64) -> impl Iterator<Item = DVec3> {
    let layer = 2.0 * TAU * (radius * radius + spacing * spacing / 12.0) / (spacing * spacing);
    // What is left of a layer around the centre.
    let inner = radius < 0.5 * spacing;
    let core = 4.0 / 3.0 * PI * ((radius + 0.5 * spacing) / spacing).powi(3);
    let count = if inner { core } else { layer }.round().max(1.0);
    (0..count as u64).map(move |i| {
        let z = 1.0 - (2.0 * i as f64 + 1.0) / count;
        let (sin, cos) = (GOLDEN * i as f64).sin_cos();
        let across = (1.0 - z * z).sqrt();
        radius * DVec3::new(across * cos, across * sin, z)
    })
}
