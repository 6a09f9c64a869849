//! Compare predictions with measurements.

/// Share of the values that lie in their closed intervals; `None` for empty or unequally long slices.
#[must_use]
pub fn coverage(intervals: &[(f64, f64)], values: &[f64]) -> Option<f64> {
    if values.is_empty() || intervals.len() != values.len() {
        return None;
    }
    let inside = intervals
        .iter()
        .zip(values)
        .filter(|((low, high), value)| low <= value && *value <= high)
        .count();
    Some(inside as f64 / values.len() as f64)
}

/// Root of the mean squared difference; `None` for empty or unequally long slices.
#[must_use]
pub fn rmse(predicted: &[f64], measured: &[f64]) -> Option<f64> {
    if measured.is_empty() || predicted.len() != measured.len() {
        return None;
    }
    let squares: f64 = predicted
        .iter()
        .zip(measured)
        .map(|(p, m)| (p - m) * (p - m))
        .sum();
    Some((squares / measured.len() as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hand_numbers() {
        assert_eq!(coverage(&[(0.0, 1.0), (0.0, 1.0)], &[0.5, 1.5]), Some(0.5));
        // Squares 9 and 16: sqrt(25 / 2).
        assert_eq!(rmse(&[3.0, 0.0], &[0.0, 4.0]), Some(12.5_f64.sqrt()));
        assert_eq!(rmse(&[], &[]), None);
    }
}
