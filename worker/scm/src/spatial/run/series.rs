//! Three terms of a series that approaches a limit.

/// The largest ratio of two successive changes at which a series counts as geometric; means with mere scatter have any ratio.
const MAX_RATIO: f64 = 0.5;

/// The last of three terms, and the changes that led to it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Series {
    pub(super) changes: [f64; 2],
    pub(super) last: f64,
}

impl Series {
    /// Returns the remaining distance of a geometric series to its limit: `d r / (1 − r)` after a change d that was r
    /// times the preceding one.
    fn remainder(&self) -> Option<f64> {
        let [before, last] = self.changes;
        let ratio = last / before;
        (0.0..MAX_RATIO)
            .contains(&ratio)
            .then(|| last * ratio / (1.0 - ratio))
    }

    /// Returns the limit of a geometric series, else its last term.
    pub(super) fn limit(&self) -> f64 {
        self.last + self.remainder().unwrap_or(0.0)
    }

    /// Returns the distance of the last term from the limit; its last change if the limit is unknown.
    pub(super) fn left(&self) -> f64 {
        self.remainder().unwrap_or(self.changes[1]).abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(first: f64, second: f64, last: f64) -> Series {
        Series {
            changes: [second - first, last - second],
            last,
        }
    }

    #[test]
    fn a_geometric_series_has_its_limit() {
        // 2 + e^−2k
        let term = |k: f64| 2.0 + libm::exp(-2.0 * k);
        let series = series(term(0.0), term(1.0), term(2.0));
        assert!((series.limit() - 2.0).abs() < 1e-14, "{series:?}");
        assert!((series.left() - libm::exp(-4.0)).abs() < 1e-14, "{series:?}");
    }

    #[test]
    fn a_series_that_is_not_geometric_keeps_its_last_term_and_change() {
        for (second, last) in [(1.0, 0.5), (1.0, 2.0), (0.0, 1.0)] {
            let series = series(0.0, second, last);
            assert_eq!(series.limit().to_bits(), last.to_bits());
            assert!((series.left() - (last - second).abs()).abs() < 1e-15);
        }
        assert!(series(1.0, 1.0, 1.0).left().abs() < f64::MIN_POSITIVE);
    }
}
