//! The cells of a plane as the texels of a texture, and ever coarser copies of them for planes that are seen from far.

use super::fluid_plane::FluidPlane;
use crate::picture::colour::{linear_of_srgb, srgb_of_linear};
use crate::picture::colour_bar::ColourBar;

/// One of the copies.
pub struct Level {
    /// Texels along both axes.
    pub size: [u32; 2],
    /// Red, green and blue (sRGB), which are 0 where there is no fluid, and the part that is fluid.
    pub rgba: Vec<u8>,
}

/// All copies, the cells themselves first and one texel last.
pub fn levels(plane: &FluidPlane, bar: &ColourBar) -> Vec<Level> {
    let texel = |value: &f32| match value.is_nan() {
        true => [0; 4],
        false => {
            let colour = bar.colour(f64::from(*value));
            [colour.0, colour.1, colour.2, u8::MAX]
        }
    };
    let rgba: Vec<u8> = plane.values.iter().flat_map(texel).collect();
    let size = plane.cells.map(|count| count as u32);
    let mut made = vec![Level { size, rgba }];
    while let Some(coarser) = made.last().and_then(coarser) {
        made.push(coarser);
    }
    made
}

/// Half as many texels along both axes, each the mean of the light of those that it covers.
fn coarser(fine: &Level) -> Option<Level> {
    let size = fine.size.map(|count| (count / 2).max(1));
    if size == fine.size {
        return None;
    }
    let linear: [f64; 256] = std::array::from_fn(|channel| linear_of_srgb(channel as u8));
    // Where a count is odd, one of the texels covers three.
    let covered = |along: usize, at: u32| {
        let place = |edge: u32| u64::from(edge) * u64::from(fine.size[along]);
        let whole = u64::from(size[along]);
        (place(at) / whole) as usize..place(at + 1).div_ceil(whole) as usize
    };
    let mut rgba = Vec::with_capacity(4 * (size[0] * size[1]) as usize);
    for v in 0..size[1] {
        for u in 0..size[0] {
            let mut sum = [0.0; 4];
            let mut count = 0.0;
            for row in covered(1, v) {
                for column in covered(0, u) {
                    let at = 4 * (row * fine.size[0] as usize + column);
                    for channel in 0..3 {
                        sum[channel] += linear[usize::from(fine.rgba[at + channel])];
                    }
                    sum[3] += f64::from(fine.rgba[at + 3]);
                    count += 1.0;
                }
            }
            rgba.extend([0, 1, 2].map(|channel| srgb_of_linear(sum[channel] / count)));
            rgba.push((sum[3] / count).round() as u8);
        }
    }
    Some(Level { size, rgba })
}
