//! Vertices of lines with a width.

use super::fluid_plane::FluidPlane;
use super::geometry::List;
use super::scales::Scales;
use crate::picture::Trace;
use crate::picture::field_lines::arrows;
use bytemuck::{Pod, Zeroable};
use glam::DVec3;

/// Half of the width of a trace, pixels, and the coloured fraction of it: a dark rim on both sides separates the line from a
/// plane of the same colour.
const TRACE: f32 = 2.4;
const CORE: f32 = 0.58;
/// Length and half width of an arrow head on a trace, and the distance between arrow heads, pixels.
const ARROW: (f64, f32) = (20.0, 7.5);
const APART: f64 = 300.0;
/// Colour of the border of a plane, and half of its width, pixels.
const BORDER: ([u8; 4], f32) = ([38, 38, 38, u8::MAX], 0.75);

/// A corner of a stroke, as in stroke.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct End {
    position: [f32; 3],
    other: [f32; 3],
    colour: [u8; 4],
    half_width: [f32; 2],
    core: f32,
}

impl List<End> {
    /// Adds a stroke between two ends: half of its width in pixels, and its upper limit in metres.
    pub fn stroke(&mut self, ends: [DVec3; 2], colour: [u8; 4], [half, limit]: [f32; 2]) {
        self.tapered(ends, colour, [half; 2], limit, 1.0);
    }

    /// Adds a stroke with a width at each end and dark rims outside of the fraction `core` in its middle.
    fn tapered(
        &mut self,
        ends: [DVec3; 2],
        colour: [u8; 4],
        [from, to]: [f32; 2],
        limit: f32,
        core: f32,
    ) {
        let [a, b] = ends.map(|end| end.as_vec3().to_array());
        // Around the quadrilateral; looking from the other end, the sides are exchanged.
        let corners = [
            (a, b, from, core),
            (a, b, -from, core),
            (b, a, to, -core),
            (b, a, -to, -core),
        ];
        let corners = corners.map(|(position, other, half, core)| End {
            position,
            other,
            colour,
            half_width: [half, limit],
            core,
        });
        self.push(corners.into_iter(), &[[0, 1, 2], [0, 2, 3]]);
    }

    /// Adds the edges of a plane, relative to `target` (m).
    pub fn border(&mut self, plane: &FluidPlane, target: DVec3) {
        let corners = plane.corners().map(|corner| corner - target);
        for (from, to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
            self.stroke([*from, *to], BORDER.0, [BORDER.1, f32::MAX]);
        }
    }

    /// Adds a streamline with arrow heads, relative to `target` (m).
    pub fn trace(
        &mut self,
        trace: &Trace,
        target: DVec3,
        scales: &Scales,
        pixels_per_metre: impl Fn(DVec3) -> f64,
    ) {
        let colour = |speed: f64| {
            let [r, g, b] = scales.trace(speed);
            [r, g, b, u8::MAX]
        };
        let pairs = trace.points.windows(2).zip(trace.speeds.windows(2));
        for (ends, speeds) in pairs {
            let colour = colour(0.5 * (speeds[0] + speeds[1]));
            let ends = [ends[0] - target, ends[1] - target];
            self.tapered(ends, colour, [TRACE; 2], f32::MAX, CORE);
        }
        let Some(&middle) = trace.points.get(trace.points.len() / 2) else {
            return;
        };
        let points: Vec<[f64; 3]> = trace.points.iter().map(|point| point.to_array()).collect();
        for arrow in arrows(&points, APART / pixels_per_metre(middle)) {
            let at = trace.points[arrow.point];
            let half = 0.5 * ARROW.0 / pixels_per_metre(at) * DVec3::from(arrow.towards);
            let ends = [at - half - target, at + half - target];
            let colour = colour(trace.speeds[arrow.point]);
            self.tapered(ends, colour, [ARROW.1, 0.0], f32::MAX, CORE);
        }
    }
}
