//! Coverage: counts of measurements inside their 90 % intervals, and the counts to expect.

use super::row::ComparisonRow;

/// Nominal probability of the predictive intervals.
const NOMINAL: f64 = 0.9;
/// Probability of the expected range of counts.
const EXPECTED: f64 = 0.95;

/// A count of measurements inside their interval.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Coverage {
    /// Number of measurements inside their interval.
    pub inside: usize,
    /// Number of measurements with an interval.
    pub total: usize,
}

impl Coverage {
    /// Counts rows; `None` if no row has an interval.
    pub fn count<'a>(rows: impl Iterator<Item = &'a ComparisonRow>) -> Option<Self> {
        Self::from_outcomes(rows.filter_map(ComparisonRow::covered))
    }

    /// Counts rows by the intervals of the corrected predictions; `None` if no row has one.
    pub fn count_corrected<'a>(rows: impl Iterator<Item = &'a ComparisonRow>) -> Option<Self> {
        Self::from_outcomes(rows.filter_map(ComparisonRow::covered_corrected))
    }

    /// Counts the measurements that are inside, given as `true`; `None` for an empty iterator.
    pub fn from_outcomes(covered: impl Iterator<Item = bool>) -> Option<Self> {
        let covered: Vec<bool> = covered.collect();
        let inside = covered.iter().filter(|c| **c).count();
        (!covered.is_empty()).then_some(Coverage {
            inside,
            total: covered.len(),
        })
    }

    /// Returns the range of counts that correct intervals give 95 % of the time if the rows are independent: the central range of the
    /// binomial distribution.
    pub fn expected(self) -> [usize; 2] {
        let tail = 0.5 * (1.0 - EXPECTED);
        [quantile(self.total, tail), quantile(self.total, 1.0 - tail)]
    }

    /// Returns, for example, `42 of 48 (44 to 47 expected)`.
    pub fn words(self) -> String {
        let [low, high] = self.expected();
        format!("{} of {} ({low} to {high} expected)", self.inside, self.total)
    }
}

/// Returns the smallest count whose cumulative binomial probability reaches `p`.
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
        // P(0 of 1) = 0.1 and P(1 of 1) = 0.9, so both counts are in the range.
        assert_eq!(Coverage { inside: 1, total: 1 }.expected(), [0, 1]);
        // For ten rows P(<= 6) = 0.0128, P(<= 7) = 0.0702 and P(10) = 0.349.
        assert_eq!(Coverage { inside: 9, total: 10 }.expected(), [7, 10]);
    }
}
