//! Coverage of the 90 % intervals, and the expected one.

use super::row::ComparisonRow;

/// Nominal probability of the predictive intervals.
const NOMINAL: f64 = 0.9;
/// Probability of the range of counts that is called expected.
const EXPECTED: f64 = 0.95;

/// Measurements inside their interval, of those that have one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Coverage {
    /// Inside.
    pub inside: usize,
    /// With an interval.
    pub total: usize,
}

impl Coverage {
    /// Counts rows; `None` where no row has an interval.
    pub fn count<'a>(rows: impl Iterator<Item = &'a ComparisonRow>) -> Option<Self> {
        Self::from_outcomes(rows.filter_map(ComparisonRow::covered))
    }

    /// The same by the intervals of the corrected predictions.
    pub fn count_corrected<'a>(rows: impl Iterator<Item = &'a ComparisonRow>) -> Option<Self> {
        Self::from_outcomes(rows.filter_map(ComparisonRow::covered_corrected))
    }

    /// Counts which of them are inside; `None` of none.
    pub fn from_outcomes(covered: impl Iterator<Item = bool>) -> Option<Self> {
        let covered: Vec<bool> = covered.collect();
        let inside = covered.iter().filter(|c| **c).count();
        (!covered.is_empty()).then_some(Coverage {
            inside,
            total: covered.len(),
        })
    }

    /// The counts that right intervals would give 95 % of the time, if the rows were independent: the central
    /// range of the binomial distribution.
    pub fn expected(self) -> [usize; 2] {
        let tail = 0.5 * (1.0 - EXPECTED);
        [quantile(self.total, tail), quantile(self.total, 1.0 - tail)]
    }

    /// `42 of 48 (44 to 47 expected)`.
    pub fn words(self) -> String {
        let [low, high] = self.expected();
        format!("{} of {} ({low} to {high} expected)", self.inside, self.total)
    }
}

/// Smallest count whose cumulative binomial probability reaches `p`.
fn quantile(n: usize, p: f64) -> usize {
    let log_factorial = |k: usize| libm::lgamma(k as f64 + 1.0);
    let mut sum = 0.0;
    for k in 0..n {
        let choices = log_factorial(n) - log_factorial(k) - log_factorial(n - k);
        let misses = (n - k) as f64;
        sum += (choices + k as f64 * NOMINAL.ln() + misses * (1.0 - NOMINAL).ln()).exp();
        if sum >= p {
            return k;
        }
    }
    n
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_expected_range_is_the_binomial_s() {
        // P(0 of 1) = 0.1 and P(1 of 1) = 0.9: either may happen.
        assert_eq!(Coverage { inside: 1, total: 1 }.expected(), [0, 1]);
        // Of ten: P(<= 6) = 0.0128, P(<= 7) = 0.0702, P(10) = 0.349.
        assert_eq!(Coverage { inside: 9, total: 10 }.expected(), [7, 10]);
    }
}
