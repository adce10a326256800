//! Volumes of unit cells below triangles: the solid fractions of a grid, exact up to rounding.

use glam::DVec3;

/// Corners of a clipped triangle.
type Polygon = Vec<DVec3>;

/// Computes the volume of each cell that lies below `triangles` (in cells, from the lower corner of the grid), one column along
/// z after another. The volume below a triangle counts as positive if the triangle is counter-clockwise seen from above,
/// otherwise as negative. So a closed surface, oriented outwards, gives 1 in the cells inside, and a height surface gives the
/// volume below it. `found` receives the indices of a column in x and y, the volumes of its cells, and the area that triangles
/// cover.
pub(crate) fn volumes_below(
    triangles: &[[DVec3; 3]],
    [nx, ny, nz]: [u32; 3],
    mut found: impl FnMut([u32; 2], &[f64], f64),
) {
    let mut columns: Vec<Vec<u32>> = vec![Vec::new(); nx as usize * ny as usize];
    for (n, corners) in (0..).zip(triangles) {
        let low = corners[0].min(corners[1]).min(corners[2]);
        let high = corners[0].max(corners[1]).max(corners[2]);
        // Float to integer casts saturate, so that parts outside the grid drop out.
        for y in low.y.floor() as u32..(high.y.ceil().max(0.0) as u32).min(ny) {
            for x in low.x.floor() as u32..(high.x.ceil().max(0.0) as u32).min(nx) {
                columns[x as usize + nx as usize * y as usize].push(n);
            }
        }
    }
    let mut volumes = vec![0.0; nz as usize];
    for y in 0..ny {
        for x in 0..nx {
            let column = &columns[x as usize + nx as usize * y as usize];
            volumes.fill(0.0);
            let mut covered = 0.0;
            let corner = DVec3::new(x.into(), y.into(), 0.0);
            for &n in column {
                covered += add_triangle(&triangles[n as usize].map(|p| p - corner), &mut volumes);
            }
            found([x, y], &volumes, covered);
        }
    }
}

/// Adds the volume below a triangle, clipped to the unit square, to the cells of its column; returns the clipped area in plan.
fn add_triangle(corners: &[DVec3; 3], volumes: &mut [f64]) -> f64 {
    let mut polygon = corners.to_vec();
    for (axis, sign, at) in [
        (0, 1.0, 0.0),
        (0, -1.0, -1.0),
        (1, 1.0, 0.0),
        (1, -1.0, -1.0),
    ] {
        polygon = clipped(&polygon, |p| sign * p[axis] - at);
    }
    let area = area_of(&polygon);
    let heights = || polygon.iter().map(|p| p.z);
    let low = heights().fold(f64::INFINITY, f64::min);
    let high = heights().fold(f64::NEG_INFINITY, f64::max);
    let mut over = None;
    for (k, volume) in volumes.iter_mut().enumerate() {
        let (bottom, top) = (k as f64, k as f64 + 1.0);
        if bottom >= high {
            break;
        }
        if top <= low {
            *volume += area;
            continue;
        }
        let below = over.unwrap_or_else(|| above(&polygon, bottom));
        let next = above(&polygon, top);
        *volume += below - next;
        over = Some(next);
    }
    area
}

/// Part of a polygon where the linear function `inside` is not negative.
fn clipped(polygon: &[DVec3], inside: impl Fn(&DVec3) -> f64) -> Polygon {
    let mut left = Vec::with_capacity(polygon.len() + 1);
    for (n, here) in polygon.iter().enumerate() {
        let next = &polygon[(n + 1) % polygon.len()];
        let (a, b) = (inside(here), inside(next));
        if a >= 0.0 {
            left.push(*here);
        }
        if (a < 0.0) != (b < 0.0) {
            left.push(*here + (*next - *here) * (a / (a - b)));
        }
    }
    left
}

/// The triangles of a convex polygon, each with its area seen from above, positive if it is counter-clockwise.
fn fan(polygon: &[DVec3]) -> impl Iterator<Item = (f64, [DVec3; 3])> + '_ {
    let pairs = polygon.get(1..).unwrap_or_default().windows(2);
    pairs.map(|pair| {
        let (u, v) = (pair[0] - polygon[0], pair[1] - polygon[0]);
        (
            0.5 * (u.x * v.y - u.y * v.x),
            [polygon[0], pair[0], pair[1]],
        )
    })
}

fn area_of(polygon: &[DVec3]) -> f64 {
    fan(polygon).map(|(area, _)| area).sum()
}

/// Volume between the height `from` and the part of a polygon above it.
fn above(polygon: &[DVec3], from: f64) -> f64 {
    let higher = clipped(polygon, |p| p.z - from);
    fan(&higher)
        .map(|(area, corners)| area * (corners.iter().map(|p| p.z).sum::<f64>() / 3.0 - from))
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fractions of all cells, x fastest.
    fn fractions(triangles: &[[DVec3; 3]], cells: [u32; 3]) -> Vec<f64> {
        let [nx, ny, nz] = cells.map(|n| n as usize);
        let mut all = vec![0.0; nx * ny * nz];
        volumes_below(triangles, cells, |[x, y], volumes, _| {
            for (z, volume) in volumes.iter().enumerate() {
                all[x as usize + nx * (y as usize + ny * z)] = *volume;
            }
        });
        all
    }

    /// The triangles of a box.
    fn cuboid(low: DVec3, high: DVec3) -> Vec<[DVec3; 3]> {
        let shape = crate::geometry::Polyhedron::cuboid(high - low).unwrap();
        let centre = 0.5 * (low + high);
        let corner = |n: u32| shape.vertices()[n as usize] + centre;
        let loops = shape.loops().iter();
        loops
            .flat_map(|face| (1..face.len() - 1).map(|n| [face[0], face[n], face[n + 1]]))
            .map(|corners| corners.map(corner))
            .collect()
    }

    #[test]
    fn a_box_fills_its_part_of_each_cell() {
        let (low, high) = (DVec3::new(0.25, -1.0, 0.5), DVec3::new(2.75, 1.5, 2.125));
        let found = fractions(&cuboid(low, high), [4, 3, 3]);
        let overlap = |a: usize, n: usize| {
            let (from, to) = (n as f64, n as f64 + 1.0);
            (high[a].min(to) - low[a].max(from)).clamp(0.0, 1.0)
        };
        for (n, fraction) in found.into_iter().enumerate() {
            let expected = overlap(0, n % 4) * overlap(1, n / 4 % 3) * overlap(2, n / 12);
            assert!(
                (fraction - expected).abs() < 1e-12,
                "{n}: {fraction}, not {expected}"
            );
        }
    }

    /// Below an inclined plane, in cells that it enters through every face.
    #[test]
    fn a_plane_of_heights_leaves_what_is_below_it() {
        let height = |x: f64, y: f64| 0.3 + 0.7 * x - 0.4 * y;
        let at = |x: f64, y: f64| DVec3::new(x, y, height(x, y));
        let corners = [at(-1.0, -1.0), at(6.0, -1.0), at(6.0, 6.0), at(-1.0, 6.0)];
        let triangles = [
            [corners[0], corners[1], corners[2]],
            [corners[0], corners[2], corners[3]],
        ];
        let cells = [5, 4, 3];
        volumes_below(&triangles, cells, |[x, y], volumes, covered| {
            assert!((covered - 1.0).abs() < 1e-12);
            for (z, volume) in volumes.iter().enumerate() {
                // The midpoint rule on 400 × 400 columns.
                let n = 400;
                let mut sum = 0.0;
                for j in 0..n {
                    for i in 0..n {
                        let place = |at: u32, i: usize| f64::from(at) + (i as f64 + 0.5) / n as f64;
                        let h = height(place(x, i), place(y, j)) - z as f64;
                        sum += h.clamp(0.0, 1.0);
                    }
                }
                let expected = sum / (n * n) as f64;
                assert!((volume - expected).abs() < 1e-5, "{volume}, not {expected}");
            }
        });
    }
}
