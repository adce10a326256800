//! Moments of a series of correlated samples, and the statistical error of its mean.

/// Largest number of batches; at this number, pairs of batches are merged.
const BATCHES: usize = 64;
/// Smallest number of batches for an estimate of the error.
const FEWEST: usize = 16;

/// Running statistics of a quantity over time, in constant memory.
///
/// The error of the mean follows from batch means: the samples are divided into 32 to 64 batches of equal length (16 at least),
/// and the variance of their mean is multiplied by (1 + ρ)/(1 − ρ), with the correlation ρ of neighbouring batches
/// (Steiger & Wilson 2002, Management Science 48:1569, §2; Bartlett's first-order correction). In a series that drifts,
/// neighbouring batches are strongly correlated, and so the error is large.
///
/// ```
/// use riprap::output::Series;
/// let mut series = Series::default();
/// (0..1000).for_each(|n| series.push(f64::from(n % 2)));
/// assert!((series.mean() - 0.5).abs() < 1e-12 && (series.rms() - 0.5).abs() < 1e-12);
/// assert!(series.error().is_some_and(|error| error < 1e-9));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    count: u64,
    mean: f64,
    /// Sums of the second and third power of deviations.
    powers: [f64; 2],
    range: [f64; 2],
    /// Means of complete batches.
    batches: Vec<f64>,
    /// Samples per batch.
    length: u64,
    /// Sum and number of the samples of the incomplete batch.
    open: (f64, u64),
}

impl Default for Series {
    fn default() -> Self {
        Self {
            count: 0,
            mean: 0.0,
            powers: [0.0; 2],
            range: [f64::INFINITY, f64::NEG_INFINITY],
            batches: Vec::new(),
            length: 1,
            open: (0.0, 0),
        }
    }
}

impl Series {
    /// Adds a sample; a value that is not finite, such as the level of a dry gauge, is skipped.
    pub fn push(&mut self, value: f64) {
        if !value.is_finite() {
            return;
        }
        // Pébay 2008, Sandia report SAND2008-6212, eqs. 2.1 to 2.3 for one additional sample.
        let before = self.count as f64;
        self.count += 1;
        let n = self.count as f64;
        let difference = value - self.mean;
        let step = difference / n;
        let square = difference * step * before;
        self.mean += step;
        let [second, third] = &mut self.powers;
        *third += step * (square * (n - 2.0) - 3.0 * *second);
        *second += square;
        self.range = [self.range[0].min(value), self.range[1].max(value)];
        self.open = (self.open.0 + value, self.open.1 + 1);
        if self.open.1 == self.length {
            self.batches.push(self.open.0 / self.length as f64);
            self.open = (0.0, 0);
        }
        if self.batches.len() == BATCHES {
            let pairs = self.batches.chunks(2);
            self.batches = pairs.map(|pair| 0.5 * (pair[0] + pair[1])).collect();
            self.length *= 2;
        }
    }

    /// Number of samples.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Mean; NaN without samples.
    pub fn mean(&self) -> f64 {
        match self.count {
            0 => f64::NAN,
            _ => self.mean,
        }
    }

    /// Mean square of the deviations from the mean; NaN without samples.
    pub fn variance(&self) -> f64 {
        self.powers[0] / self.count as f64
    }

    /// Root of [`Series::variance`].
    pub fn rms(&self) -> f64 {
        self.variance().sqrt()
    }

    /// Mean cube of the deviations over the cube of their root mean square; 0 for a constant.
    pub fn skewness(&self) -> f64 {
        let cube = self.rms().powi(3);
        match cube == 0.0 {
            true => 0.0,
            false => self.powers[1] / self.count as f64 / cube,
        }
    }

    /// Smallest and largest sample; NaN without samples.
    pub fn range(&self) -> [f64; 2] {
        match self.count {
            0 => [f64::NAN; 2],
            _ => self.range,
        }
    }

    /// Standard error of the mean; `None` below 16 samples.
    pub fn error(&self) -> Option<f64> {
        let batches = &self.batches;
        if batches.len() < FEWEST {
            return None;
        }
        let n = batches.len() as f64;
        let mean = batches.iter().sum::<f64>() / n;
        let square = |of: &f64| (of - mean).powi(2);
        let scatter: f64 = batches.iter().map(square).sum();
        if scatter == 0.0 {
            return Some(0.0);
        }
        let product = |pair: &[f64]| (pair[0] - mean) * (pair[1] - mean);
        let together: f64 = batches.windows(2).map(product).sum();
        // The estimate of ρ is low by about 1/n; beyond 0.99 the series is no useful sample.
        let rho = (together / scatter + 1.0 / n).clamp(0.0, 0.99);
        Some((scatter / (n * (n - 1.0)) * (1.0 + rho) / (1.0 - rho)).sqrt())
    }

    /// Integral time scale in samples: half of error² · count/variance. `None` without an estimate of the error, or for a
    /// constant.
    pub fn integral_time(&self) -> Option<f64> {
        let error = self.error()?;
        let variance = self.variance();
        (variance > 0.0).then(|| 0.5 * error * error * self.count as f64 / variance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pseudo-random numbers of zero mean and unit variance: sums of twelve numbers of a 64-bit congruential generator.
    fn noise(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed;
        move || {
            let mut uniform = || {
                state = state
                    .wrapping_mul(6364136223846793005)
                    .wrapping_add(1442695040888963407);
                (state >> 11) as f64 / (1u64 << 53) as f64
            };
            (0..12).map(|_| uniform()).sum::<f64>() - 6.0
        }
    }

    /// A first-order autoregressive series of unit variance.
    fn correlated(seed: u64, coefficient: f64, count: usize) -> Series {
        let mut next = noise(seed);
        let mut value = next();
        let mut series = Series::default();
        for _ in 0..count {
            series.push(value);
            value = coefficient * value + (1.0 - coefficient * coefficient).sqrt() * next();
        }
        series
    }

    #[test]
    fn moments_are_those_of_the_definition() {
        let values = [3.0, -1.0, 4.0, 1.0, -5.0, 9.0, 2.0, 6.0, 1e3];
        let mut series = Series::default();
        assert!(series.mean().is_nan() && series.rms().is_nan());
        for value in values {
            series.push(value);
            series.push(f64::NAN);
        }
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let power = |p: i32| values.iter().map(|v| (v - mean).powi(p)).sum::<f64>() / n;
        let close = |a: f64, b: f64| (a - b).abs() < 1e-12 * b.abs();
        assert_eq!(series.count(), values.len() as u64);
        assert!(close(series.mean(), mean) && close(series.variance(), power(2)));
        assert!(close(series.skewness(), power(3) / power(2).powf(1.5)));
        assert_eq!(series.range(), [-5.0, 1e3]);
        assert_eq!(series.error(), None);
    }

    #[test]
    fn the_error_is_the_scatter_of_the_means_of_many_runs() {
        for (coefficient, count) in [(0.0, 4000), (0.9, 8000), (0.99, 40_000)] {
            let runs: Vec<Series> = (1..=200)
                .map(|n| correlated(n, coefficient, count))
                .collect();
            let scatter = runs.iter().map(|run| run.mean().powi(2)).sum::<f64>() / 200.0;
            let squares = runs.iter().map(|run| run.error().expect("enough").powi(2));
            let ratio = (squares.sum::<f64>() / 200.0 / scatter).sqrt();
            // The scatter of 200 means is known to 5 %.
            assert!((0.85..1.2).contains(&ratio), "{coefficient}: {ratio}");
            let time = runs[0].integral_time().expect("it varies");
            let exact = 0.5 * (1.0 + coefficient) / (1.0 - coefficient);
            assert!(
                (0.4..2.5).contains(&(time / exact)),
                "{coefficient}: {time} for {exact}"
            );
        }
    }

    #[test]
    fn a_series_that_drifts_has_a_large_error() {
        let mut series = Series::default();
        (0..5000).for_each(|n| series.push(f64::from(n)));
        let error = series.error().expect("enough");
        assert!(error > 0.5 * series.rms(), "{error} of {}", series.rms());
    }
}
