//! Levels of a condition: values that differ by less than the accuracy of a setting are one level.

/// Difference of neighbouring values, as a share of the range of all values, up to which they are one level `[1]`.
const SAME_LEVEL: f64 = 0.02;
/// Difference of loads, as a share of the larger one, up to which they are one level `[1]`.
pub(crate) const SAME_LOAD: f64 = 0.15;

/// Returns the level of each value, ascending from 0: a gap of more than 2 % of the range begins another level.
pub fn levels_of(values: &[f64]) -> Vec<usize> {
    let smallest = values.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let gap = SAME_LEVEL * (largest - smallest);
    levels(values, |below, above| above - below > gap)
}

/// Returns the level of each load, ascending from 0: a gap of more than 15 % of the load above it begins another level.
///
/// Loads that scatter about one nominal value are one level however many they are, so the level of a load does not depend on its error.
pub fn load_levels_of(loads_n: &[f64]) -> Vec<usize> {
    levels(loads_n, |below, above| above - below > SAME_LOAD * above)
}

fn levels(values: &[f64], is_next: impl Fn(f64, f64) -> bool) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut level = vec![0; values.len()];
    for pair in order.windows(2) {
        level[pair[1]] = level[pair[0]] + usize::from(is_next(values[pair[0]], values[pair[1]]));
    }
    level
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scatter_within_a_level_makes_no_further_one() {
        assert_eq!(levels_of(&[0.6, 0.2, 0.201, 0.4, 0.599]), [2, 0, 0, 1, 2]);
        assert_eq!(levels_of(&[5.0, 5.0]), [0, 0]);
        assert!(levels_of(&[]).is_empty());
    }

    #[test]
    fn loads_about_one_nominal_value_are_one_level() {
        assert_eq!(
            load_levels_of(&[20.0, 60.0, 24.0, 22.0, 57.0, 27.0]),
            [0, 1, 0, 0, 1, 0]
        );
    }
}
