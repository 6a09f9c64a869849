//! Quantiles of equally weighted draws.

use super::moments::mean_and_sd;

/// A marginal posterior in five numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrawSummary {
    /// Mean.
    pub mean: f64,
    /// Sample standard deviation.
    pub sd: f64,
    /// 5 % quantile.
    pub q05: f64,
    /// Median.
    pub q50: f64,
    /// 95 % quantile.
    pub q95: f64,
}

/// Returns the mean, sd and quantiles of equally weighted draws; `None` for an empty slice.
#[must_use]
pub fn summary(values: &[f64]) -> Option<DrawSummary> {
    let (mean, sd) = mean_and_sd(values)?;
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let [q05, q50, q95] = [0.05, 0.5, 0.95].map(|p| quantile_of_sorted(&sorted, p));
    Some(DrawSummary {
        mean,
        sd,
        q05,
        q50,
        q95,
    })
}

/// Returns the quantile of type 7: linear between order statistics at (n - 1) p (Hyndman & Fan 1996,
/// doi:10.1080/00031305.1996.10473566).
///
/// `None` for an empty slice or `p` outside [0, 1].
#[must_use]
pub fn quantile(values: &[f64], p: f64) -> Option<f64> {
    if values.is_empty() || !(0.0..=1.0).contains(&p) {
        return None;
    }
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    Some(quantile_of_sorted(&sorted, p))
}

/// Returns the quantile of a non-empty ascending slice, for p in [0, 1].
fn quantile_of_sorted(sorted: &[f64], p: f64) -> f64 {
    let position = (sorted.len() - 1) as f64 * p;
    let below = libm::floor(position) as usize;
    let above = (below + 1).min(sorted.len() - 1);
    sorted[below] + (position - below as f64) * (sorted[above] - sorted[below])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_linear_between_order_statistics() {
        let values = [4.0, 1.0, 3.0, 2.0];
        // (4 - 1) 0.5 = 1.5: half-way between 2 and 3. (4 - 1) 0.05 = 0.15.
        assert_eq!(quantile(&values, 0.5), Some(2.5));
        assert_eq!(quantile(&values, 0.0), Some(1.0));
        assert_eq!(quantile(&values, 1.0), Some(4.0));
        assert!((quantile(&values, 0.05).unwrap() - 1.15).abs() < 1e-12);
        assert_eq!(quantile(&values, 1.1), None);
        assert_eq!(quantile(&[], 0.5), None);
    }
}
