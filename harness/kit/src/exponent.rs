//! How a cost grows.

/// The exponent p of cost ∝ countᵖ by least squares on the logarithms of (count, cost); none without two
/// counts.
pub fn exponent(points: &[(f64, f64)]) -> Option<f64> {
    let n = points.len() as f64;
    let logs = || points.iter().map(|(count, cost)| (count.ln(), cost.ln()));
    let x = logs().map(|p| p.0).sum::<f64>() / n;
    let y = logs().map(|p| p.1).sum::<f64>() / n;
    let spread: f64 = logs().map(|p| (p.0 - x).powi(2)).sum();
    let covariance: f64 = logs().map(|p| (p.0 - x) * (p.1 - y)).sum();
    (spread > 0.0).then(|| covariance / spread)
}
