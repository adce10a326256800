//! Means and covariances over time in f64, computed from all samples at once.

/// Means of four quantities, and the mean products of their fluctuations: density, xx, yy, zz, xy, yz, xz.
pub fn moments(samples: &[[f32; 4]]) -> ([f64; 4], [f64; 7]) {
    let count = samples.len() as f64;
    let mean = [0, 1, 2, 3].map(|k| samples.iter().map(|x| f64::from(x[k])).sum::<f64>() / count);
    let product = |[a, b]: [usize; 2]| {
        let of = |x: &[f32; 4]| (f64::from(x[a]) - mean[a]) * (f64::from(x[b]) - mean[b]);
        samples.iter().map(of).sum::<f64>() / count
    };
    let pairs = [[0, 0], [1, 1], [2, 2], [3, 3], [1, 2], [2, 3], [1, 3]];
    (mean, pairs.map(product))
}
