//! Mean and standard deviation of draws.

/// Returns the arithmetic mean; `None` for an empty slice.
#[must_use]
pub fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// Returns the mean and sample standard deviation (divisor n - 1; 0 for a single value), the latter in two passes.
#[must_use]
pub fn mean_and_sd(values: &[f64]) -> Option<(f64, f64)> {
    let mean = mean(values)?;
    let squares: f64 = values.iter().map(|x| (x - mean) * (x - mean)).sum();
    let divisor = values.len().saturating_sub(1).max(1) as f64;
    Some((mean, (squares / divisor).sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hand_numbers() {
        // Squares about 3: 4 + 1 + 0 + 1 + 4 = 10; 10 / 4 = 2.5.
        assert_eq!(
            mean_and_sd(&[1.0, 2.0, 3.0, 4.0, 5.0]),
            Some((3.0, 2.5_f64.sqrt()))
        );
        assert_eq!(mean_and_sd(&[2.0]), Some((2.0, 0.0)));
        assert_eq!(mean_and_sd(&[]), None);
    }
}
