//! Where arrow heads stand on a line.

/// An arrow head.
pub struct Arrow<const D: usize> {
    /// Number of the point that it stands at.
    pub point: usize,
    /// Direction, a unit vector.
    pub towards: [f64; D],
}

/// Arrow heads on a line in `D` dimensions, about `apart` from each other, one at least.
pub fn arrows<const D: usize>(points: &[[f64; D]], apart: f64) -> Vec<Arrow<D>> {
    let length = |pair: &[[f64; D]]| {
        let square = (0..D).map(|axis| (pair[1][axis] - pair[0][axis]).powi(2));
        square.sum::<f64>().sqrt()
    };
    let whole: f64 = points.windows(2).map(length).sum();
    let count = (whole / apart).round().max(1.0);
    let mut arrows = Vec::new();
    let mut passed = 0.0;
    for (point, pair) in points.windows(2).enumerate() {
        let step = length(pair);
        let next = (arrows.len() as f64 + 0.5) * whole / count;
        if step > 0.0 && passed + step >= next && (arrows.len() as f64) < count {
            let towards = std::array::from_fn(|axis| (pair[1][axis] - pair[0][axis]) / step);
            arrows.push(Arrow { point, towards });
        }
        passed += step;
    }
    arrows
}
