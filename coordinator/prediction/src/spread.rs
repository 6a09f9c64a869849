//! Means and intervals over weighted draws.

/// Probabilities of the ends of a 90 % interval.
const ENDS: [f64; 2] = [0.05, 0.95];

/// Returns the weighted mean; `None` without weight.
pub fn mean(values: &[(f64, f64)]) -> Option<f64> {
    let total: f64 = values.iter().map(|(_, weight)| weight).sum();
    (total > 0.0).then(|| values.iter().map(|(value, weight)| value * weight).sum::<f64>() / total)
}

/// Returns the weighted variance about the mean; `None` without weight.
pub fn variance(values: &[(f64, f64)]) -> Option<f64> {
    let center = mean(values)?;
    let squares: Vec<(f64, f64)> = values
        .iter()
        .map(|(value, weight)| ((value - center) * (value - center), *weight))
        .collect();
    mean(&squares)
}

/// Returns the 5 % and the 95 % quantile of weighted values, linear between the middles of their weights; `None` without weight.
///
/// Checked by `tests::equal_weights_give_the_quantiles_of_a_uniform_sample`.
pub fn interval(values: &[(f64, f64)]) -> Option<[f64; 2]> {
    let mut sorted: Vec<(f64, f64)> = values
        .iter()
        .copied()
        .filter(|(_, weight)| *weight > 0.0)
        .collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let total: f64 = sorted.iter().map(|(_, weight)| weight).sum();
    let mut below = 0.0;
    let middles: Vec<(f64, f64)> = sorted
        .iter()
        .map(|&(value, weight)| {
            let middle = (below + 0.5 * weight) / total;
            below += weight;
            (middle, value)
        })
        .collect();
    let (first, last) = (middles.first()?, middles.last()?);
    let at = |p: f64| {
        let above = middles.partition_point(|(middle, _)| *middle < p);
        match (
            above.checked_sub(1).map(|below| middles[below]),
            middles.get(above),
        ) {
            (Some((low, a)), Some((high, b))) if high - low > 0.0 => a + (p - low) / (high - low) * (b - a),
            (None, _) => first.1,
            _ => last.1,
        }
    };
    Some(ENDS.map(at))
}

/// Returns the share of the weight at which a statement holds; `None` without weight.
pub fn probability(values: impl Iterator<Item = (bool, f64)>) -> Option<f64> {
    let values: Vec<(f64, f64)> = values
        .map(|(holds, weight)| (f64::from(u8::from(holds)), weight))
        .collect();
    mean(&values)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_weights_give_the_quantiles_of_a_uniform_sample() {
        let values: Vec<(f64, f64)> = (0..100).map(|i| ((f64::from(i) + 0.5) / 100.0, 2.0)).collect();
        let [low, high] = interval(&values).unwrap();
        assert!(
            (low - 0.05).abs() < 1e-12 && (high - 0.95).abs() < 1e-12,
            "{low} {high}"
        );
        assert!((mean(&values).unwrap() - 0.5).abs() < 1e-12);
        assert_eq!(interval(&[]), None);
        assert_eq!(mean(&[(1.0, 0.0)]), None);
    }

    #[test]
    fn a_draw_of_little_weight_hardly_counts() {
        let heavy = (0..100).map(|i| ((f64::from(i) + 0.5) / 100.0, 1.0));
        let values: Vec<(f64, f64)> = heavy.chain([(1e9, 1e-9)]).collect();
        let [_, high] = interval(&values).unwrap();
        assert!((high - 0.95).abs() < 1e-6, "{high}");
        assert!((variance(&[(1.0, 1.0), (3.0, 1.0)]).unwrap() - 1.0).abs() < 1e-12);
        assert_eq!(probability([(true, 1.0), (false, 3.0)].into_iter()), Some(0.25));
    }
}
