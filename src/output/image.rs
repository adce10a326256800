//! Cell data of a flow at one time on a regular lattice, with interpolation between cell centres and quantities of the
//! velocity gradient: vorticity, and Q (Hunt, Wray and Moin, 1988). A plain reference on the host; the cost grows with the
//! number of cells.

use glam::DVec3;

/// Values on the cells of a box, x running fastest, then y, then z.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ImageData {
    /// Lower corner of the domain (of the first cell, not its centre), m.
    pub origin: [f64; 3],
    /// Cell size, m.
    pub spacing: f64,
    /// Number of cells in x, y and z.
    pub cells: [usize; 3],
    /// The quantities; an array called `solid` marks the cells without fluid by values ≠ 0.
    pub arrays: Vec<Array>,
}

/// One quantity on every cell.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Array {
    /// Name shown in ParaView; it implies the SI unit of the quantity.
    pub name: String,
    /// Components per cell: 1 for a scalar, 3 for a vector, 6 for a symmetric tensor.
    pub components: usize,
    /// `components` values per cell, interleaved, in the unit of the quantity.
    pub values: Vec<f32>,
}

impl Array {
    /// An array of one scalar per cell or point.
    pub fn scalars(name: &str, values: impl IntoIterator<Item = f64>) -> Self {
        Self {
            name: name.into(),
            components: 1,
            values: values.into_iter().map(|v| v as f32).collect(),
        }
    }

    /// An array of one vector per cell or point.
    pub fn vectors(name: &str, values: impl IntoIterator<Item = DVec3>) -> Self {
        let values = values.into_iter().flat_map(|v| v.to_array());
        Self {
            components: 3,
            ..Self::scalars(name, values)
        }
    }
}

impl ImageData {
    /// The array called `name`.
    pub fn array(&self, name: &str) -> Option<&Array> {
        self.arrays.iter().find(|array| array.name == name)
    }

    /// Number of cells.
    pub fn cell_count(&self) -> usize {
        self.cells.iter().product()
    }

    /// Index of cell (`i`, `j`, `k`) in an array of scalars.
    pub fn cell_index(&self, i: usize, j: usize, k: usize) -> usize {
        i + self.cells[0] * (j + self.cells[1] * k)
    }

    /// Whether cell number `cell` is solid; false without an array `solid`.
    pub fn is_solid(&self, cell: usize) -> bool {
        self.array("solid")
            .and_then(|solid| solid.values.get(cell))
            .is_some_and(|&value| value != 0.0)
    }

    /// Describes the first invalid size; `None` if every array fills all cells.
    pub(super) fn fault(&self) -> Option<String> {
        if self.spacing <= 0.0 || !self.spacing.is_finite() {
            return Some(format!(
                "the cell size is {} m; it must be positive and finite",
                self.spacing
            ));
        }
        let count = self.cell_count();
        self.arrays.iter().find_map(|array| {
            let wants = count * array.components;
            if ![1, 3, 6].contains(&array.components) {
                Some(format!(
                    "array {} has {} components; give 1 for a scalar, 3 for a vector or 6 for a symmetric tensor",
                    array.name, array.components
                ))
            } else if array.values.len() != wants {
                Some(format!(
                    "array {} has {} values; {:?} cells of {} components need {wants}",
                    array.name,
                    array.values.len(),
                    self.cells,
                    array.components
                ))
            } else {
                None
            }
        })
    }

    /// The array `name` at `point` (m), by trilinear interpolation between cell centres.
    ///
    /// A point outside the outermost centres takes the value at the nearest point between them.
    /// Solid cells have no weight, so that a value next to a wall is a value of the fluid. `None` if
    /// there is no such array, if all cells around the point are solid, or if the point is NaN.
    pub fn sample(&self, name: &str, point: [f64; 3]) -> Option<Vec<f64>> {
        let array = self.array(name)?;
        let solid = self.array("solid");
        let mut lower = [0; 3];
        let mut fraction = [0.0; 3];
        for axis in 0..3 {
            let last = self.cells[axis].checked_sub(1)?;
            let place = (point[axis] - self.origin[axis]) / self.spacing - 0.5;
            if place.is_nan() {
                return None;
            }
            let place = place.clamp(0.0, last as f64);
            lower[axis] = (place as usize).min(last);
            fraction[axis] = place - lower[axis] as f64;
        }
        let mut sum = vec![0.0; array.components];
        let mut total = 0.0;
        for corner in 0..8_usize {
            let mut weight = 1.0;
            let mut cell = lower;
            for axis in 0..3 {
                let upper = corner >> axis & 1;
                weight *= [1.0 - fraction[axis], fraction[axis]][upper];
                cell[axis] += upper;
            }
            // A weight of zero also keeps out the cell beyond the last one.
            if weight == 0.0 {
                continue;
            }
            let index = self.cell_index(cell[0], cell[1], cell[2]);
            if solid.is_some_and(|solid| solid.values.get(index).is_some_and(|&s| s != 0.0)) {
                continue;
            }
            let values = array.values.get(index * array.components..)?;
            for (sum, &value) in sum.iter_mut().zip(values) {
                *sum += weight * f64::from(value);
            }
            total += weight;
        }
        (total > 0.0).then(|| sum.iter().map(|sum| sum / total).collect())
    }
}

/// Derivatives of an image's `velocity`, m/s, taken among fluid cells only.
///
/// Second-order central differences. Next to a solid or a face of the domain they are one-sided: second
/// order with two fluid cells in a row on that side, first order with one, zero with none.
#[derive(Clone, Copy, Debug)]
pub struct VelocityQuantities<'a> {
    image: &'a ImageData,
    velocity: &'a [f32],
    solid: Option<&'a [f32]>,
    periodic: [bool; 3],
}

impl<'a> VelocityQuantities<'a> {
    /// The quantities of `image`, whose axes are periodic as given by `periodic`.
    ///
    /// `None` if the image has no array `velocity` of three components on every cell, or its
    /// array `solid` does not fill the cells.
    pub fn new(image: &'a ImageData, periodic: [bool; 3]) -> Option<Self> {
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

/// One-sided difference per cell towards the value `near`, one cell away, and `far`, two cells away, if available.
fn one_sided(centre: f64, near: f64, far: Option<f64>) -> f64 {
    match far {
        Some(far) => (4.0 * near - 3.0 * centre - far) / 2.0,
        None => near - centre,
    }
}
