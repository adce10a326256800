//! What the velocity's gradient tells: vorticity, and Q (Hunt, Wray and Moin, 1988).
//!
//! A plain reference on the host, for pictures and tests; cost grows with the cells.

use super::{Array, Image};

/// Derivatives of an image's `velocity`, m/s, taken among fluid cells only.
///
/// Central differences, second order; next to a solid or a face of the domain one-sided, second
/// order where two fluid cells follow each other there, first order where only one does, zero
/// where none does.
#[derive(Clone, Copy, Debug)]
pub struct VelocityQuantities<'a> {
    image: &'a Image,
    velocity: &'a [f32],
    solid: Option<&'a [f32]>,
    periodic: [bool; 3],
}

impl<'a> VelocityQuantities<'a> {
    /// Of `image`, whose opposite faces join where `periodic` says so.
    ///
    /// `None` if the image has no array `velocity` of three components on every cell, or its
    /// array `solid` does not fill the cells.
    pub fn new(image: &'a Image, periodic: [bool; 3]) -> Option<Self> {
        let velocity = image
            .array("velocity")
            .filter(|array| array.components == 3)?;
        let solid = image.array("solid").map(|array| array.values.as_slice());
        let fits = image.fault().is_none();
        fits.then_some(Self {
            image,
            velocity: &velocity.values,
            solid,
            periodic,
        })
    }

    /// ∂u_a/∂x_b at `[a][b]`, 1/s; zero in a solid cell.
    pub fn gradient(&self, cell: [usize; 3]) -> [[f64; 3]; 3] {
        let mut gradient = [[0.0; 3]; 3];
        let Some(centre) = self.fluid(cell) else {
            return gradient;
        };
        for axis in 0..3 {
            let at = |shift: isize| self.neighbour(cell, axis, shift);
            for (component, row) in gradient.iter_mut().enumerate() {
                let value = |shift: isize| at(shift).map(|velocity| velocity[component]);
                let difference = match (value(-1), value(1)) {
                    (Some(below), Some(above)) => (above - below) / 2.0,
                    (None, Some(above)) => one_sided(centre[component], above, value(2)),
                    (Some(below), None) => -one_sided(centre[component], below, value(-2)),
                    (None, None) => 0.0,
                };
                row[axis] = difference / self.image.spacing;
            }
        }
        gradient
    }

    /// The array `vorticity` (3 components), ω = ∇ × u, 1/s.
    pub fn vorticity(&self) -> Array {
        self.array("vorticity", 3, |g, values| {
            values.extend([
                (g[2][1] - g[1][2]) as f32,
                (g[0][2] - g[2][0]) as f32,
                (g[1][0] - g[0][1]) as f32,
            ]);
        })
    }

    /// The array `q_criterion`, Q = (‖Ω‖² − ‖S‖²)/2 = −½ Σ ∂u_a/∂x_b ∂u_b/∂x_a, 1/s²; positive
    /// where rotation outweighs strain.
    pub fn q_criterion(&self) -> Array {
        self.array("q_criterion", 1, |g, values| {
            let mut sum = 0.0;
            for (a, row) in g.iter().enumerate() {
                for (b, value) in row.iter().enumerate() {
                    sum += value * g[b][a];
                }
            }
            values.push((-0.5 * sum) as f32);
        })
    }

    fn array(
        &self,
        name: &str,
        components: usize,
        push: impl Fn([[f64; 3]; 3], &mut Vec<f32>),
    ) -> Array {
        let [nx, ny, nz] = self.image.cells;
        let mut values = Vec::with_capacity(nx * ny * nz * components);
        for k in 0..nz {
            for j in 0..ny {
                for i in 0..nx {
                    push(self.gradient([i, j, k]), &mut values);
                }
            }
        }
        Array {
            name: name.to_owned(),
            components,
            values,
        }
    }

    /// The velocity of the cell `shift` cells along `axis`, if every cell up to it is fluid.
    fn neighbour(&self, cell: [usize; 3], axis: usize, shift: isize) -> Option<[f64; 3]> {
        let cells = self.image.cells[axis];
        let mut found = None;
        for distance in 1..=shift.unsigned_abs() as isize {
            let place = cell[axis] as isize + distance * shift.signum();
            let place = if self.periodic[axis] {
                place.rem_euclid(cells as isize) as usize
            } else {
                usize::try_from(place).ok().filter(|place| *place < cells)?
            };
            let mut next = cell;
            next[axis] = place;
            found = Some(self.fluid(next)?);
        }
        found
    }

    /// The velocity of a fluid cell, m/s.
    fn fluid(&self, [i, j, k]: [usize; 3]) -> Option<[f64; 3]> {
        let index = self.image.cell_index(i, j, k);
        if self.solid.is_some_and(|solid| solid[index] != 0.0) {
            return None;
        }
        Some([0, 1, 2].map(|component| f64::from(self.velocity[3 * index + component])))
    }
}

/// Derivative towards a side with values `near` and, maybe, `far`, one and two cells away.
fn one_sided(centre: f64, near: f64, far: Option<f64>) -> f64 {
    match far {
        Some(far) => (4.0 * near - 3.0 * centre - far) / 2.0,
        None => near - centre,
    }
}
