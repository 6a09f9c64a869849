//! Levels of a condition: values that differ by less than the accuracy of a setting are one level.

/// Difference of neighbouring values, as a share of the range of all values, up to which they are one level `[1]`.
const SAME_LEVEL: f64 = 0.02;

/// Returns the level of each value, ascending from 0: a gap of more than 2 % of the range begins another level.
pub fn levels_of(values: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let (Some(&first), Some(&last)) = (order.first(), order.last()) else {
        return Vec::new();
    };
    let gap = SAME_LEVEL * (values[last] - values[first]);
    let mut level = vec![0; values.len()];
    for pair in order.windows(2) {
        let is_next = values[pair[1]] - values[pair[0]] > gap;
        level[pair[1]] = level[pair[0]] + usize::from(is_next);
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
}
