//! Two values that bracket the threshold.

use riprap::{Error, Result};

/// The value at which no block moves and the one at which a block does, either of which may be the larger.
#[derive(Clone, Copy, Debug)]
pub struct Bracket {
    still: f64,
    moves: f64,
    tolerance: f64,
    /// Number of ends that have been tried.
    tried: u8,
}

impl Bracket {
    /// A bracket with both ends, which are tried first.
    pub fn new(still: f64, moves: f64, tolerance: f64) -> Result<Self> {
        if !(still.is_finite() && moves.is_finite()) || still == moves {
            let message = format!(
                "{still} and {moves} have nothing between them; give two values that differ"
            );
            return Err(Error::argument("--from, --to", message));
        }
        if !(tolerance.is_finite() && tolerance > 0.0) {
            let message =
                format!("{tolerance} is no distance; give a positive one, in the unit of the key");
            return Err(Error::argument("--tolerance", message));
        }
        Ok(Self {
            still,
            moves,
            tolerance,
            tried: 0,
        })
    }

    /// The value to try next; `None` if the ends are close enough, or no number lies between them.
    pub fn next(&self) -> Option<f64> {
        let middle = 0.5 * (self.still + self.moves);
        match self.tried {
            0 => Some(self.still),
            1 => Some(self.moves),
            _ if self.is_narrow() || middle == self.still || middle == self.moves => None,
            _ => Some(middle),
        }
    }

    /// Records whether a block `moved` at the `value` that [`Bracket::next`] gave.
    pub fn take(&mut self, value: f64, moved: bool) -> std::result::Result<(), String> {
        match (self.tried, moved) {
            (0, true) => {
                return Err(format!(
                    "a block moves at {value} already; give another value for --from, or --settle"
                ));
            }
            (1, false) => {
                return Err(format!(
                    "no block moves at {value}; give another value for --to, or a longer run"
                ));
            }
            (2.., true) => self.moves = value,
            (2.., false) => self.still = value,
            _ => {}
        }
        self.tried = (self.tried + 1).min(2);
        Ok(())
    }

    /// Whether both ends have been tried and are close enough.
    pub fn is_narrow(&self) -> bool {
        self.tried == 2 && (self.moves - self.still).abs() <= self.tolerance
    }

    /// The value at which no block moves and the one at which a block does, once both have been tried.
    pub fn found(&self) -> Option<[f64; 2]> {
        (self.tried == 2).then_some([self.still, self.moves])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bisects with the threshold at `at`: the bracket and the number of trials.
    fn search(from: f64, to: f64, tolerance: f64, at: f64) -> ([f64; 2], u32) {
        let mut bracket = Bracket::new(from, to, tolerance).unwrap();
        let mut trials = 0;
        while let Some(value) = bracket.next() {
            let moved = (value > at) == (to > from);
            bracket.take(value, moved).unwrap();
            trials += 1;
        }
        assert!(bracket.is_narrow());
        (bracket.found().unwrap(), trials)
    }

    #[test]
    fn the_threshold_stays_between_the_ends() {
        let ([still, moves], trials) = search(0.0, 8.0, 0.01, 2.7);
        assert!(still <= 2.7 && 2.7 < moves && moves - still <= 0.01);
        // Both ends, and log2(8/0.01) = 9.6 halvings.
        assert_eq!(trials, 12);
        // A number at whose low values blocks move, such as a friction angle.
        let ([still, moves], _) = search(45.0, 5.0, 0.5, 31.0);
        assert!(moves < 31.0 && 31.0 <= still && still - moves <= 0.5);
    }

    #[test]
    fn ends_that_are_none_are_told() {
        let mut bracket = Bracket::new(0.0, 1.0, 0.1).unwrap();
        assert!(bracket.take(0.0, true).unwrap_err().contains("--from"));
        bracket.take(0.0, false).unwrap();
        assert!(bracket.take(1.0, false).unwrap_err().contains("--to"));
        assert!(bracket.found().is_none());
        for (from, to, tolerance) in [(1.0, 1.0, 0.1), (0.0, f64::NAN, 0.1), (0.0, 1.0, 0.0)] {
            assert!(Bracket::new(from, to, tolerance).is_err());
        }
    }

    #[test]
    fn a_tolerance_below_rounding_ends() {
        let mut bracket = Bracket::new(1.0, 1.0 + 4.0 * f64::EPSILON, 1e-300).unwrap();
        let mut trials = 0;
        while let Some(value) = bracket.next() {
            bracket.take(value, value > 1.0).unwrap();
            trials += 1;
        }
        assert!(trials < 6 && !bracket.is_narrow());
    }
}
