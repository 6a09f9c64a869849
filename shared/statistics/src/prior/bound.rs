//! Test whether a posterior touches a bound of its prior.

/// Distance of an outer quantile from a bound up to which it touches the bound, as a share of the range.
const NEAR: f64 = 0.02;

/// Returns whether `q05` or `q95` lies within 2 % of the range of a bound. False if the range is not finite.
#[must_use]
pub(super) fn at_bound(q05: f64, q95: f64, (lower, upper): (f64, f64)) -> bool {
    let near = NEAR * (upper - lower);
    near.is_finite() && (q05 - lower <= near || upper - q95 <= near)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_percent_of_the_range_counts() {
        assert!(at_bound(0.15, 5.0, (0.0, 10.0)));
        assert!(at_bound(5.0, 9.9, (0.0, 10.0)));
        assert!(!at_bound(0.25, 9.7, (0.0, 10.0)));
        assert!(!at_bound(0.0, 5.0, (0.0, f64::INFINITY)));
    }
}
