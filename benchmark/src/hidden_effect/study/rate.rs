//! Shares with their uncertainty.

use std::fmt;

/// Half of the two-sided 95 % interval of a standard normal distribution.
const Z: f64 = 1.959_963_984_540_054;

/// A number of cases among all.
#[derive(Debug, Default, Clone, Copy, PartialEq, Eq)]
pub struct Rate {
    pub count: usize,
    pub total: usize,
}

impl Rate {
    /// Counts the cases that hold.
    pub fn new(cases: impl IntoIterator<Item = bool>) -> Self {
        let each = cases.into_iter().map(|holds| Self {
            count: usize::from(holds),
            total: 1,
        });
        each.sum()
    }

    pub fn share(self) -> f64 {
        self.count as f64 / self.total.max(1) as f64
    }

    /// Wilson's 95 % interval; from 0 to 1 without a case.
    ///
    /// # Source
    /// Wilson 1927, "Probable inference, the law of succession, and statistical inference", J. Am. Stat. Assoc. 22.
    pub fn interval(self) -> [f64; 2] {
        if self.total == 0 {
            return [0.0, 1.0];
        }
        let (n, p) = (self.total as f64, self.share());
        let middle = p + Z * Z / (2.0 * n);
        let half = Z * (p * (1.0 - p) / n + Z * Z / (4.0 * n * n)).sqrt();
        let whole = 1.0 + Z * Z / n;
        [
            ((middle - half) / whole).max(0.0),
            ((middle + half) / whole).min(1.0),
        ]
    }

    /// The exact 90 % interval of a binomial probability; from 0 to 1 without a case.
    ///
    /// # Source
    /// Clopper & Pearson 1934, "The use of confidence or fiducial limits illustrated in the case of the binomial", Biometrika 26.
    pub fn exact_interval(self) -> [f64; 2] {
        // Returns the probability at which as many successes or more have this tail, which grows with the probability.
        let solve = |count: usize, tail: f64| {
            let (mut low, mut high) = (0.0, 1.0);
            for _ in 0..60 {
                let middle = f64::midpoint(low, high);
                if upper_tail(count, self.total, middle) < tail {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            high
        };
        let low = if self.count == 0 {
            0.0
        } else {
            solve(self.count, 0.05)
        };
        let high = if self.count == self.total {
            1.0
        } else {
            solve(self.count + 1, 0.95)
        };
        [low, high]
    }
}

/// Returns ln n!.
fn log_factorial(n: usize) -> f64 {
    libm::lgamma(n as f64 + 1.0)
}

/// Returns the probability of at least `count` successes in `total` trials.
fn upper_tail(count: usize, total: usize, probability: f64) -> f64 {
    let (log_p, log_q) = (probability.ln(), (1.0 - probability).ln());
    let term = |k: usize| {
        let ways = log_factorial(total) - log_factorial(k) - log_factorial(total - k);
        let failures = total - k;
        (ways + k as f64 * log_p + failures as f64 * log_q).exp()
    };
    (count..=total).map(term).sum()
}

impl fmt::Display for Rate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [low, high] = self.interval();
        let Self { count, total } = self;
        write!(
            f,
            "{count} of {total} ({:.3}, {low:.3} to {high:.3})",
            self.share()
        )
    }
}

impl std::iter::Sum for Rate {
    fn sum<I: Iterator<Item = Self>>(rates: I) -> Self {
        rates.fold(Self::default(), |sum, rate| Self {
            count: sum.count + rate.count,
            total: sum.total + rate.total,
        })
    }
}

/// Returns the mean and standard error; 0 without a value.
pub fn mean(values: &[f64]) -> [f64; 2] {
    let n = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|x| (x - mean) * (x - mean)).sum();
    [mean, (squares / (n - 1.0).max(1.0) / n).sqrt()]
}

/// Returns the median; 0 without a value.
pub fn median(values: &[f64]) -> f64 {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}
