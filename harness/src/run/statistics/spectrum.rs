//! Power spectra of samples at equal intervals.

use rustfft::{FftPlanner, num_complex::Complex};
use std::f64::consts::PI;

/// Smallest number of samples in a segment.
const FEWEST: usize = 16;

/// One row per frequency (Hz): the frequency, and for each of `columns`, sampled every `interval` (s), the power spectral
/// density, whose integral over the frequencies is the variance (unit²/Hz). The mean is removed.
///
/// By the method of Welch 1967 (IEEE Trans. Audio Electroacoust. 15:70): mean over at least seven segments that overlap by
/// half under a Hann window, each of a power of two of samples. No rows for fewer than 64 samples.
pub fn spectra(columns: &[Vec<f64>], interval: f64) -> Vec<Vec<f64>> {
    let count = columns.first().map_or(0, Vec::len);
    if count < 4 * FEWEST || interval <= 0.0 {
        return Vec::new();
    }
    let length = 1 << (count / 4).ilog2();
    let densities: Vec<Vec<f64>> = columns
        .iter()
        .map(|column| density(column, length, interval))
        .collect();
    let row = |k: usize| {
        let mut row = vec![(k + 1) as f64 / (length as f64 * interval)];
        row.extend(densities.iter().map(|density| density[k]));
        row
    };
    (0..length / 2).map(row).collect()
}

/// Density at the frequencies 1, 2, … length/2 of 1/(length · interval).
fn density(samples: &[f64], length: usize, interval: f64) -> Vec<f64> {
    let mean = samples.iter().sum::<f64>() / samples.len() as f64;
    let hann = |n: usize| 0.5 - 0.5 * (2.0 * PI * n as f64 / length as f64).cos();
    let window: Vec<f64> = (0..length).map(hann).collect();
    let power: f64 = window.iter().map(|w| w * w).sum();
    let transform = FftPlanner::new().plan_fft_forward(length);
    let mut density = vec![0.0; length / 2];
    let starts: Vec<usize> = (0..=samples.len() - length).step_by(length / 2).collect();
    let segments = starts.len() as f64;
    for start in starts {
        let windowed = samples[start..][..length].iter().zip(&window);
        let mut values: Vec<Complex<f64>> = windowed
            .map(|(value, weight)| Complex::new((value - mean) * weight, 0.0))
            .collect();
        transform.process(&mut values);
        for (k, sum) in density.iter_mut().enumerate() {
            // Both signs of the frequency contribute; the highest has only one.
            let sides = if 2 * (k + 1) == length { 1.0 } else { 2.0 };
            *sum += sides * values[k + 1].norm_sqr() * interval / (power * segments);
        }
    }
    density
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sine_is_a_peak_at_its_frequency_and_its_variance_the_integral() {
        let (interval, frequency) = (0.01, 12.5);
        let wave = |n: usize| 3.0 + 2.0 * (2.0 * PI * frequency * n as f64 * interval).sin();
        let rows = spectra(&[(0..1000).map(wave).collect(), vec![1.0; 1000]], interval);
        assert_eq!(rows.len(), 64);
        let step = rows[1][0] - rows[0][0];
        let integral: f64 = rows.iter().map(|row| row[1] * step).sum();
        assert!((integral - 2.0).abs() < 0.02, "{integral}");
        let peak = rows.iter().max_by(|a, b| a[1].total_cmp(&b[1])).unwrap();
        assert!((peak[0] - frequency).abs() < step, "{}", peak[0]);
        assert!(rows.iter().all(|row| row[2] == 0.0));
        assert!(spectra(&[vec![0.0; 63]], interval).is_empty());
    }
}
