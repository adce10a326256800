//! Boxes in the form of the broadphase: f32 about a local origin, sorted into levels by size.

use super::Aabb;
use crate::{
    Error, Result,
    gpu::bins::{DeviceBox, Level, MAX_LEVELS, NUMBER_BITS},
};
use bytemuck::Zeroable;

/// Largest coordinate, m: differences in f32 are far from overflow there.
pub const FARTHEST: f64 = (1u128 << 100) as f64;

/// Exponents of the cell edges of the search, in powers of two of a metre.
const FINEST: i32 = -100;
const COARSEST: i32 = FINEST + MAX_LEVELS as i32 - 1;

/// There are at most 2 to this power cells from the origin to the farthest corner, so that an f32 represents
/// their indices exactly.
const DIGITS: i32 = 22;

/// Boxes with their levels.
///
/// The shift to the local origin and the conversion from f64 to f32 round, but neither reverses the order of two
/// numbers: boxes that overlap still do so. The search in f32 may find additional pairs but misses none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Boxes {
    /// One per input box, in the order of the input.
    pub boxes: Vec<DeviceBox>,
    /// From fine to coarse; only levels with a box.
    pub levels: Vec<Level>,
}

impl Boxes {
    /// Makes the boxes of `aabbs`.
    ///
    /// # Errors
    /// [`Error::Argument`] that names the box if a corner is not finite or farther than
    /// [`FARTHEST`], or if a lower corner is above the upper one; [`Error::Limit`] for more than
    /// 2²⁴ boxes.
    pub fn new(aabbs: &[Aabb]) -> Result<Self> {
        let origin = check(aabbs)?;
        let mut boxes = Vec::with_capacity(aabbs.len());
        let mut longest = [None; MAX_LEVELS];
        for (number, item) in (0..).zip(aabbs) {
            let local = |corner: [f64; 3]| [0, 1, 2].map(|a| (corner[a] - origin[a]) as f32);
            let (min, max) = (local(item.min), local(item.max));
            let extent = (0..3).map(|a| f64::from(max[a]) - f64::from(min[a]));
            let extent = extent.fold(0.0, f64::max);
            let reach = min.iter().chain(&max).map(|x| f64::from(x.abs()));
            let level = (exponent(extent) + 1)
                .max(exponent(reach.fold(0.0, f64::max)) + 1 - DIGITS)
                .clamp(FINEST, COARSEST);
            let at = (level - FINEST) as u32;
            let longest = &mut longest[at as usize];
            *longest = Some(f64::max(longest.unwrap_or(0.0), extent));
            boxes.push(DeviceBox {
                min,
                group: item.group,
                max,
                tag: number | at << NUMBER_BITS,
            });
        }
        // Levels are numbered without gaps: empty ones cost nothing.
        let mut levels = Vec::new();
        let ordinals = longest.map(|longest| {
            levels.extend(longest.map(|_| Level::zeroed()));
            levels.len().wrapping_sub(1) as u32
        });
        for (at, longest) in (0..).zip(longest) {
            if let Some(longest) = longest {
                let edge = f64::exp2(f64::from(FINEST + at)) as f32;
                levels[ordinals[at as usize] as usize] = Level {
                    scale: 1.0 / edge,
                    extent: (longest as f32).next_up().min(edge),
                };
            }
        }
        for item in &mut boxes {
            let number = item.tag & ((1 << NUMBER_BITS) - 1);
            let level = ordinals[(item.tag >> NUMBER_BITS) as usize];
            item.tag = number | level << NUMBER_BITS;
        }
        Ok(Self { boxes, levels })
    }
}

/// Checks the boxes, and returns the centre of their common bounding box.
fn check(aabbs: &[Aabb]) -> Result<[f64; 3]> {
    if aabbs.len() > 1 << NUMBER_BITS {
        return Err(Error::Limit {
            name: "items of a search for pairs".into(),
            wants: aabbs.len() as u64,
            has: 1 << NUMBER_BITS,
            remedy: "search in parts of the scene".into(),
        });
    }
    let (mut lowest, mut highest) = ([FARTHEST; 3], [-FARTHEST; 3]);
    for (number, item) in aabbs.iter().enumerate() {
        for a in 0..3 {
            let (min, max) = (item.min[a], item.max[a]);
            // Also false if one of them is NaN.
            if !(-FARTHEST <= min && min <= max && max <= FARTHEST) {
                return Err(refusal(number, a, min, max));
            }
            lowest[a] = min.min(lowest[a]);
            highest[a] = max.max(highest[a]);
        }
    }
    Ok([0, 1, 2].map(|a| 0.5 * (lowest[a] + highest[a])))
}

fn refusal(number: usize, axis: usize, min: f64, max: f64) -> Error {
    let axis = ["x", "y", "z"][axis];
    let reason = if min.abs() <= FARTHEST && max.abs() <= FARTHEST {
        "a box begins where it is lowest; exchange the corners"
    } else {
        "both must be finite and within 2^100 m; look for what moved it there, such as too long a \
         time step"
    };
    let message = format!("its box reaches from {min:e} to {max:e} m along {axis}: {reason}");
    Error::argument(format!("items[{number}]"), message)
}

/// ⌊log₂ x⌋ of a non-negative number; far below every level for zero.
fn exponent(x: f64) -> i32 {
    (x.to_bits() >> 52) as i32 - 1023
}
