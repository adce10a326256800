//! Values between the cell centres.

use super::Image;

impl Image {
    /// The array `name` at `point` (m), by trilinear interpolation between cell centres.
    ///
    /// A point outside the outermost centres takes the value at the nearest place between them.
    /// Solid cells carry no weight, so that a value next to a wall is the fluid's. `None` where
    /// there is no such array, where all cells around the point are solid, or where the point is
    /// not a number.
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
