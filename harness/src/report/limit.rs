//! The limit of a number over three grids (Richardson 1911).

/// Orders that a method may show; an observed one beyond is that of rounding or of a change of sign.
const ORDERS: [f64; 2] = [0.5, 3.0];

/// The limit, and the part of it by which it may be off: what the extrapolation adds, or the last change where the
/// numbers swing. Each grid is twice as fine as the one before.
pub fn limit([coarse, middle, fine]: [f64; 3]) -> (f64, f64) {
    let ratio = (coarse - middle) / (middle - fine);
    if !(ratio.is_finite() && ratio > 0.0) {
        return (fine, ((middle - fine) / fine).abs());
    }
    let order = ratio.log2().clamp(ORDERS[0], ORDERS[1]);
    let limit = fine + (fine - middle) / (order.exp2() - 1.0);
    (limit, (fine / limit - 1.0).abs())
}

#[cfg(test)]
mod tests {
    use super::limit;

    /// 2 (1 + h²/10) at h = 4, 2, 1.
    #[test]
    fn a_power_law_has_its_limit() {
        let (found, uncertainty) = limit([5.2, 2.8, 2.2]);
        assert!((found - 2.0).abs() < 1e-12);
        assert!((uncertainty - 0.1).abs() < 1e-12);
    }

    #[test]
    fn numbers_that_swing_have_their_last() {
        assert_eq!(limit([1.0, 3.0, 2.0]), (2.0, 0.5));
        assert_eq!(limit([2.0, 2.0, 2.0]), (2.0, 0.0));
    }
}
