//! Streamlines in space.

use super::field_lines::{Field, Taken};
use super::placed::{Placed, cells_in};
use glam::DVec3;
use riprap::output::ImageData;

/// Step relative to the cell size: trilinear velocity bends little within half a cell.
const STEP: f64 = 0.5;
/// Fraction of the largest speed below which f32 data does not resolve the direction.
const STILL: f64 = 1e-5;
/// Number of seeds tried for each line.
const TRIES: u32 = 16;
/// Smallest distance of seeds from lines, relative to the distance between that many lines through the whole box: small
/// enough that most lines find a seed, large enough that they leave few holes.
const APART: f64 = 0.5;
/// Smallest distance of a line from itself, relative to that distance.
const NEAREST_SELF: f64 = 0.15;
/// Length of the shortest line, relative to that distance: a shorter one shows no direction.
const SHORTEST: f64 = 0.5;
/// Length of the longest line, in edges of a cube with the volume of the box.
const LONGEST: f64 = 10.0;

/// A streamline.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trace {
    /// Points downstream, m.
    pub points: Vec<DVec3>,
    /// Speed at each point, m/s.
    pub speeds: Vec<f64>,
}

/// At most `count` streamlines of the array `velocity` of `image`, spread over its fluid: cells that are neither solid
/// nor in one of `blocks`. None if there is no such array, or nothing moves.
pub fn traces(image: &ImageData, blocks: &[Placed<'_>], count: u32) -> Vec<Trace> {
    let Some(flow) = Flow::new(image, blocks) else {
        return Vec::new();
    };
    let cells = image.cells.map(|n| n as f64);
    let edge = image.spacing * cells.iter().product::<f64>().cbrt();
    // Lines that cross a cube of this edge have this distance from each other.
    let distance = edge / f64::from(count.max(1)).sqrt();
    let step = STEP * image.spacing;
    let field = Field {
        direction: |point| flow.direction(point),
        step,
        own: NEAREST_SELF * distance,
        most: (LONGEST * edge / step) as usize,
    };
    let mut taken = Taken::new(APART * distance);
    let mut made = Vec::new();
    for number in 1..=count.saturating_mul(TRIES) {
        if made.len() == count as usize {
            break;
        }
        let part = [2, 3, 5].map(|base| halton(number, base));
        let seed =
            [0, 1, 2].map(|axis| image.origin[axis] + image.spacing * cells[axis] * part[axis]);
        if flow.direction(seed).is_none() || taken.near(seed, APART * distance) {
            continue;
        }
        let line = field.line(seed, |_| false);
        if (line.len() - 1) as f64 * step < SHORTEST * distance {
            continue;
        }
        line.iter().for_each(|point| taken.add(*point));
        made.push(Trace {
            speeds: line.iter().map(|point| flow.speed(*point)).collect(),
            points: line.into_iter().map(DVec3::from).collect(),
        });
    }
    made
}

/// A velocity on cells.
struct Flow<'a> {
    image: &'a ImageData,
    /// Cells that are solid or in blocks.
    left_out: Vec<bool>,
    still: f64,
}

impl<'a> Flow<'a> {
    fn new(image: &'a ImageData, blocks: &[Placed<'_>]) -> Option<Self> {
        let velocity = image.array("velocity")?;
        if velocity.values.len() != 3 * image.cell_count() {
            return None;
        }
        let mut left_out = cells_in(image, blocks);
        for (cell, out) in left_out.iter_mut().enumerate() {
            *out |= image.is_solid(cell);
        }
        let vectors = velocity.values.chunks_exact(3).zip(&left_out);
        let speeds = vectors.filter(|(_, out)| !**out).map(|(u, _)| length(u));
        let fastest = speeds.filter(|speed| speed.is_finite()).fold(0.0, f64::max);
        (fastest > 0.0).then_some(Self {
            image,
            left_out,
            still: STILL * fastest,
        })
    }

    fn velocity(&self, point: [f64; 3]) -> Option<DVec3> {
        let image = self.image;
        let mut cell = [0; 3];
        for axis in 0..3 {
            let place = ((point[axis] - image.origin[axis]) / image.spacing).floor();
            if !(0.0..image.cells[axis] as f64).contains(&place) {
                return None;
            }
            cell[axis] = place as usize;
        }
        if self.left_out[image.cell_index(cell[0], cell[1], cell[2])] {
            return None;
        }
        let velocity = image.sample("velocity", point)?;
        Some(DVec3::from_slice(&velocity))
    }

    fn speed(&self, point: [f64; 3]) -> f64 {
        self.velocity(point).map_or(0.0, DVec3::length)
    }

    fn direction(&self, point: [f64; 3]) -> Option<[f64; 3]> {
        let velocity = self.velocity(point)?;
        let speed = velocity.length();
        (speed > self.still).then(|| (velocity / speed).to_array())
    }
}

fn length(vector: &[f32]) -> f64 {
    let square = |x: &f32| f64::from(*x).powi(2);
    vector.iter().map(square).sum::<f64>().sqrt()
}

/// The radical inverse of `number`: three prime bases give points that fill a box evenly (Halton, 1960).
fn halton(mut number: u32, base: u32) -> f64 {
    let mut sum = 0.0;
    let mut part = 1.0;
    while number > 0 {
        part /= f64::from(base);
        sum += part * f64::from(number % base);
        number /= base;
    }
    sum
}
