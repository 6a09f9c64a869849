//! Size and correlation of the noise of a channel's samples, from their differences.
//!
//! The noise is taken as autoregressive of the first order: samples `k` apart have the correlation `phi^k`. Half the mean square of
//! differences of residuals at the distance `k` is `s^2 (1 - phi^k)`, whatever constant the residuals have, so that two distances give both.
//! The mean of many samples has the variance `s^2 tau / count` with `tau = (1 + phi) / (1 - phi)`.

use std::collections::VecDeque;

/// Distances at which differences are taken; the ratio of their mean squares is `1 + phi + ... + phi^(FAR - 1)`.
const FAR: usize = 10;
/// Number of differences that the mean squares remember.
const MEMORY: f64 = 1000.0;
/// Number of far differences before there is an estimate.
const LEAST: usize = 40;
/// A square counts as at most this many times the mean square: a step of the soil is no noise.
const CAP: f64 = 9.0;
/// Largest correlation of neighbours: longer ones than two seconds at 10 Hz are not told from the signal.
const MAX_CORRELATION: f64 = 0.95;

/// A running estimate of the noise of one channel.
#[derive(Debug, Clone, Default)]
pub struct NoiseEstimate {
    last: VecDeque<f64>,
    near: MeanSquare,
    far: MeanSquare,
}

/// A mean square that forgets.
#[derive(Debug, Clone, Default)]
struct MeanSquare {
    count: usize,
    value: f64,
}

impl MeanSquare {
    fn add(&mut self, difference: f64) {
        self.count += 1;
        let square = difference * difference;
        let capped = match self.count > LEAST {
            true => square.min(CAP * self.value),
            false => square,
        };
        self.value += (capped - self.value) / (self.count as f64).min(MEMORY);
    }
}

impl NoiseEstimate {
    /// Takes the residual of a sample: measured less what the model makes of the best parameters so far.
    pub fn add(&mut self, residual: f64) {
        if let Some(before) = self.last.back() {
            self.near.add(residual - before);
        }
        if self.last.len() == FAR {
            let before = self.last.pop_front().unwrap_or(residual);
            self.far.add(residual - before);
        }
        self.last.push_back(residual);
    }

    /// Returns the standard deviation of a sample and the number of samples that are worth one independent sample; `None` of fewer than 50
    /// samples, and where neighbours never differ. The mean of `count` samples has the variance `sd^2 correlated / count`.
    ///
    /// Checked by `tests::size_and_correlation_are_found`.
    pub fn sd_and_correlated(&self) -> Option<(f64, f64)> {
        if self.far.count < LEAST || self.near.value <= 0.0 {
            return None;
        }
        let ratio = self.far.value / self.near.value;
        let sum = |phi: f64| (0..FAR).map(|k| libm::pow(phi, k as f64)).sum::<f64>();
        let [mut low, mut high] = [0.0, MAX_CORRELATION];
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            *(if sum(middle) < ratio { &mut low } else { &mut high }) = middle;
        }
        let variance = 0.5 * self.near.value / (1.0 - low);
        Some((variance.sqrt(), (1.0 + low) / (1.0 - low)))
    }

    /// Returns whether neighbours never differ, though there are enough samples for an estimate.
    pub fn is_silent(&self) -> bool {
        self.far.count >= LEAST && self.near.value <= 0.0
    }
}

#[cfg(test)]
mod tests {
    use statistics::rng::Stream;

    use super::*;

    fn estimate(phi: f64, step: f64) -> (f64, f64) {
        let mut noise = NoiseEstimate::default();
        let innovations = Stream::new(3, 0, 0, 0).normals(2000);
        let mut value = 0.0;
        for (i, innovation) in innovations.iter().enumerate() {
            value = phi * value + (1.0 - phi * phi).sqrt() * 2.0 * innovation;
            noise.add(value + if i < 1700 { 5.0 } else { 5.0 + step });
        }
        noise.sd_and_correlated().expect("an estimate")
    }

    #[test]
    fn size_and_correlation_are_found() {
        for (phi, correlated) in [(0.0, 1.0), (0.6, 4.0), (0.8, 9.0)] {
            for step in [0.0, 40.0] {
                let (sd, found) = estimate(phi, step);
                let variance = sd * sd * found;
                assert!(
                    (0.5..2.0).contains(&(variance / (4.0 * correlated))),
                    "{phi}: {sd} {found}"
                );
            }
        }
        assert!(NoiseEstimate::default().sd_and_correlated().is_none());
    }
}
