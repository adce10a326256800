//! Correlation between the points of a line.

/// Largest number of points: a sample costs the square of it.
const MOST: usize = 1000;

/// Two-point correlations along a line taken as homogeneous: means over all pairs of points at equal distances.
pub struct Correlation {
    separation: f64,
    /// First sample of each column at each point: sums are of differences from it.
    first: Vec<Vec<f64>>,
    /// Sums of values and squares of each column at each point.
    sums: Vec<Vec<[f64; 2]>>,
    /// Sums of products over pairs and samples of each column and separation.
    products: Vec<Vec<f64>>,
    coordinates: usize,
    count: f64,
}

impl Correlation {
    /// Correlations along a line whose `rows` begin with `s` and the point.
    pub fn new(rows: &[Vec<f64>], coordinates: usize) -> Option<Self> {
        let points = rows.len();
        if coordinates != 4 || !(3..=MOST).contains(&points) {
            return None;
        }
        let columns = coordinates..rows[0].len();
        Some(Self {
            separation: rows[1][0] - rows[0][0],
            first: columns
                .clone()
                .map(|c| rows.iter().map(|row| row[c]).collect())
                .collect(),
            sums: vec![vec![[0.0; 2]; points]; columns.len()],
            products: vec![vec![0.0; points]; columns.len()],
            coordinates,
            count: 0.0,
        })
    }

    pub fn push(&mut self, rows: &[Vec<f64>]) {
        self.count += 1.0;
        for (column, first) in self.first.iter().enumerate() {
            let value = |(row, first): (&Vec<f64>, &f64)| row[self.coordinates + column] - first;
            let values: Vec<f64> = rows.iter().zip(first).map(value).collect();
            for (sum, value) in self.sums[column].iter_mut().zip(&values) {
                *sum = [sum[0] + value, sum[1] + value * value];
            }
            for (apart, sum) in self.products[column].iter_mut().enumerate() {
                let pairs = values.iter().zip(values.iter().skip(apart));
                *sum += pairs.map(|(a, b)| a * b).sum::<f64>();
            }
        }
    }

    /// One row per separation (m): the separation, and the correlation coefficient of each column, starting at 1; NaN for a
    /// column that does not vary. Separations go up to half the line, beyond which few pairs are left.
    pub fn rows(&self) -> Vec<Vec<f64>> {
        let points = self.products.first().map_or(0, Vec::len);
        let coefficient = |column: usize, apart: usize| {
            let mean = |sum: &[f64; 2]| sum[0] / self.count;
            let deviation =
                |sum: &[f64; 2]| (sum[1] / self.count - mean(sum).powi(2)).max(0.0).sqrt();
            let sums = &self.sums[column];
            let (mut shift, mut scale) = (0.0, 0.0);
            for (a, b) in sums.iter().zip(&sums[apart..]) {
                shift += mean(a) * mean(b);
                scale += deviation(a) * deviation(b);
            }
            let covariance = self.products[column][apart] / self.count - shift;
            if scale > 0.0 {
                covariance / scale
            } else {
                f64::NAN
            }
        };
        let row = |apart: usize| {
            let mut row = vec![apart as f64 * self.separation];
            row.extend((0..self.first.len()).map(|column| coefficient(column, apart)));
            row
        };
        (0..points.div_ceil(2)).map(row).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn a_wave_of_random_phase_is_correlated_as_its_cosine() {
        let points = 33;
        // 200 evenly spaced phases, whose mean is exact. The mean of the flow varies along the line.
        let sample = |n: usize| -> Vec<Vec<f64>> {
            let phase = 2.0 * PI * n as f64 / 200.0;
            let row = |i: usize| {
                let s = 0.25 * i as f64;
                vec![
                    s,
                    s,
                    0.0,
                    0.0,
                    5.0 * s + (2.0 * PI * s / 4.0 + phase).cos(),
                    7.0,
                ]
            };
            (0..points).map(row).collect()
        };
        let mut correlation = Correlation::new(&sample(0), 4).unwrap();
        (0..200).for_each(|n| correlation.push(&sample(n)));
        let rows = correlation.rows();
        assert_eq!(rows.len(), 17);
        for row in rows {
            let expected = (2.0 * PI * row[0] / 4.0).cos();
            assert!((row[1] - expected).abs() < 1e-9, "{row:?}");
            assert!(row[2].is_nan());
        }
    }
}
