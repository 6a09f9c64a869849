//! Levels of a condition: groups of values that differ too little to be set on purpose.

/// Width of a level as a share of the range of all values.
const TOLERANCE: f64 = 0.02;
/// Ratio of the range to the largest absolute value below which all values are one level, because the rig holds the condition constant.
const HELD: f64 = 0.01;
/// Maximum number of levels in a table.
const MAX_LEVELS: usize = 12;

/// A range of values of a condition that count as one level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Level {
    /// Smallest value.
    pub from: f64,
    /// Largest value.
    pub to: f64,
}

impl Level {
    /// Returns whether a value belongs to the level.
    pub fn holds(self, value: f64) -> bool {
        (self.from..=self.to).contains(&value)
    }
}

/// Groups values into levels, the smallest first. A level spans less than 2 % of the range; values that differ by less than 1 % are one
/// level.
pub fn levels(values: impl IntoIterator<Item = f64>) -> Vec<Level> {
    let mut sorted: Vec<f64> = values.into_iter().collect();
    sorted.sort_by(f64::total_cmp);
    within(&sorted, TOLERANCE)
}

/// Groups values into at most twelve levels for a table, by doubling the tolerance as often as necessary.
pub fn few_levels(values: impl IntoIterator<Item = f64>) -> Vec<Level> {
    let mut sorted: Vec<f64> = values.into_iter().collect();
    sorted.sort_by(f64::total_cmp);
    let mut tolerance = TOLERANCE;
    loop {
        let found = within(&sorted, tolerance);
        if found.len() <= MAX_LEVELS {
            return found;
        }
        tolerance *= 2.0;
    }
}

fn within(sorted: &[f64], tolerance: f64) -> Vec<Level> {
    let mut found: Vec<Level> = Vec::new();
    let (Some(&least), Some(&largest)) = (sorted.first(), sorted.last()) else {
        return found;
    };
    let range = largest - least;
    let span = if range < HELD * largest.abs().max(least.abs()) {
        f64::INFINITY
    } else {
        tolerance * range
    };
    for &value in sorted {
        match found.last_mut() {
            Some(level) if value <= level.from || value - level.from < span => level.to = value,
            _ => found.push(Level {
                from: value,
                to: value,
            }),
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bounds(levels: &[Level]) -> Vec<[f64; 2]> {
        levels.iter().map(|l| [l.from, l.to]).collect()
    }

    #[test]
    fn values_that_scatter_about_a_set_point_are_one_level() {
        let loads = [60.0, 120.0, 60.4, 59.9, 121.0];
        assert_eq!(bounds(&levels(loads)), [[59.9, 60.4], [120.0, 121.0]]);
        assert_eq!(bounds(&levels([25.0, 25.0])), [[25.0, 25.0]]);
        assert_eq!(bounds(&levels([])), [[0.0; 2]; 0]);
        // A value 2 % of the range above the first belongs to the next level.
        assert_eq!(bounds(&levels([0.0, 0.02, 1.0])).len(), 3);
        let one = levels(loads)[0];
        assert!(one.holds(60.0) && !one.holds(120.0));
    }

    #[test]
    fn a_condition_that_the_rig_holds_has_one_level() {
        assert_eq!(
            bounds(&levels([9.988, 10.0, 9.995])),
            [[9.988, 10.0]],
            "mm/s: within .2 %"
        );
        assert_eq!(bounds(&levels([-0.2, 0.0, 0.005])).len(), 3);
    }

    #[test]
    fn a_table_has_at_most_twelve_levels() {
        let scattered = (0..100).map(|k| f64::from(k * k));
        let found = few_levels(scattered.clone());
        assert!((6..=12).contains(&found.len()), "{found:?}");
        let counted: usize = found
            .iter()
            .map(|level| scattered.clone().filter(|v| level.holds(*v)).count())
            .sum();
        assert_eq!(counted, 100);
    }
}
