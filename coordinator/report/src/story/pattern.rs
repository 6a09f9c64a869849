//! The pattern of a channel's errors in words: the conditions at which they are largest.

use job::load_levels_of;
use result::table::level::{Level, few_levels};
use result::table::row::ComparisonRow;
use result::words::number;

/// Ratio of a level's error to that of all runs above which the level stands out.
const STANDS_OUT: f64 = 1.3;

/// A condition: its name before a value, the factor and unit in which it is shown, and its value of a row.
struct Condition {
    name: &'static str,
    factor: f64,
    unit: &'static str,
    value: fn(&ComparisonRow) -> f64,
    /// Whether a rig that does not hold the condition lets it scatter.
    may_scatter: bool,
}

const CONDITIONS: [Condition; 4] = [
    Condition {
        name: "slip",
        factor: 1.0,
        unit: "",
        value: |row| row.slip,
        may_scatter: false,
    },
    Condition {
        name: "a load of",
        factor: 1.0,
        unit: " N",
        value: |row| row.wheel_load_n,
        may_scatter: true,
    },
    Condition {
        name: "a speed of",
        factor: 1000.0,
        unit: " mm/s",
        value: |row| row.sled_speed_m_s,
        may_scatter: false,
    },
    Condition {
        name: "a slip angle of",
        factor: 1.0,
        unit: " deg",
        value: |row| row.slip_angle_deg,
        may_scatter: false,
    },
];

/// A measured minus predicted value with its row.
type Residual<'a> = (&'a ComparisonRow, f64);

/// Describes where the errors of a channel without a significant trend lie: the common sign in all runs, else the level with the largest
/// error.
pub(super) fn place(rows: &[&ComparisonRow]) -> Option<String> {
    let residuals = residuals(rows);
    let level = || Some(standing_out(&residuals)?.words(""));
    one_direction(&residuals).or_else(level)
}

/// Describes where the errors of holdout runs lie if that is a level beyond the fitted runs, about which no trend of the fitted residuals says
/// anything.
pub(super) fn place_beyond(holdout: &[&ComparisonRow], fitted: &[&ComparisonRow]) -> Option<String> {
    let residuals = residuals(holdout);
    let worst = standing_out(&residuals)?;
    let values = || fitted.iter().map(|row| (worst.condition.value)(row));
    let is_beyond =
        values().all(|value| value < worst.level.from) || values().all(|value| value > worst.level.to);
    (is_beyond && !fitted.is_empty()).then(|| worst.words(", beyond the fitted ones"))
}

fn residuals<'a>(rows: &[&'a ComparisonRow]) -> Vec<Residual<'a>> {
    let residual = |row: &&'a ComparisonRow| Some((*row, row.measured - row.predicted?));
    rows.iter().filter_map(residual).collect()
}

fn one_direction(residuals: &[Residual]) -> Option<String> {
    let above = residuals.iter().filter(|(_, r)| *r > 0.0).count();
    let direction = match above {
        0 => "over",
        n if n == residuals.len() => "under",
        _ => return None,
    };
    (residuals.len() > 1).then(|| format!("{direction}-predicted in every run"))
}

/// The level of a condition with the largest errors.
struct WorstLevel {
    condition: &'static Condition,
    level: Level,
    /// Whether the values of the condition scatter without a gap, because the rig does not hold it.
    is_scattered: bool,
    /// Variance of the sizes of residuals within the levels of the condition.
    scatter: f64,
    /// Mean over root mean square of the level's residuals.
    bias: f64,
}

impl WorstLevel {
    /// Returns the level in words, with a remark after it.
    fn words(&self, remark: &str) -> String {
        let Condition {
            name, factor, unit, ..
        } = self.condition;
        let middle = number::significant(0.5 * (self.level.from + self.level.to) * factor, 2);
        let direction = match self.bias {
            bias if bias > 0.5 => ", under-predicted there",
            bias if bias < -0.5 => ", over-predicted there",
            _ => "",
        };
        format!("most at {name} {middle}{unit}{remark}{direction}")
    }
}

/// Returns the worst level of the condition that tells best where the errors are large: an angle of 90 degrees, and not the low load that a
/// ploughing wheel has there. A condition that scatters follows from those that were set, and comes after them.
fn standing_out(residuals: &[Residual]) -> Option<WorstLevel> {
    let threshold = STANDS_OUT * rms(&residuals.iter().map(|(_, r)| *r).collect::<Vec<_>>());
    let worst = CONDITIONS
        .iter()
        .filter_map(|condition| worst_level(condition, residuals, threshold));
    worst.min_by(|a, b| {
        let by_kind = a.is_scattered.cmp(&b.is_scattered);
        by_kind.then(a.scatter.total_cmp(&b.scatter))
    })
}

/// Returns the worst level of a condition; `None` if it has one level, or if no level's error is above the threshold.
fn worst_level(condition: &'static Condition, residuals: &[Residual], threshold: f64) -> Option<WorstLevel> {
    let value = condition.value;
    let levels = few_levels(residuals.iter().map(|(row, _)| value(row)));
    let of_level = |level: &Level| {
        let of_level = residuals.iter().filter(|(row, _)| level.holds(value(row)));
        of_level.map(|(_, r)| *r).collect()
    };
    let groups: Vec<Vec<f64>> = levels.iter().map(of_level).collect();
    let worst = levels.iter().zip(&groups);
    let (level, group) = worst.max_by(|a, b| rms(a.1).total_cmp(&rms(b.1)))?;
    let values: Vec<f64> = residuals.iter().map(|(row, _)| value(row)).collect();
    (levels.len() > 1 && rms(group) > threshold).then(|| WorstLevel {
        condition,
        level: *level,
        is_scattered: condition.may_scatter && load_levels_of(&values).iter().all(|level| *level == 0),
        scatter: scatter_of_sizes(&groups, residuals.len()),
        bias: group.iter().sum::<f64>() / group.len() as f64 / rms(group),
    })
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|r| r * r).sum::<f64>() / values.len() as f64).sqrt()
}

/// Returns the variance of the sizes of residuals within groups; infinite where fewer than half of the residuals tell it, so that many levels
/// with one run each explain nothing.
fn scatter_of_sizes(groups: &[Vec<f64>], residuals: usize) -> f64 {
    let within = |group: &Vec<f64>| {
        let mean = group.iter().map(|r| r.abs()).sum::<f64>() / group.len() as f64;
        group.iter().map(|r| (r.abs() - mean).powi(2)).sum::<f64>()
    };
    let degrees_of_freedom = residuals.saturating_sub(groups.len());
    match 2 * degrees_of_freedom < residuals {
        true => f64::INFINITY,
        false => groups.iter().map(within).sum::<f64>() / degrees_of_freedom as f64,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    /// Describes the errors of runs at the given slips with the given residuals.
    fn words(residuals: &[(f64, f64)]) -> Option<String> {
        let calibration = fixture::calibration();
        let comparison = calibration.comparison();
        let rows: Vec<ComparisonRow> = residuals
            .iter()
            .map(|&(slip, residual)| ComparisonRow {
                slip,
                measured: residual,
                predicted: Some(0.0),
                ..comparison.rows[0].clone()
            })
            .collect();
        place(&rows.iter().collect::<Vec<_>>())
    }

    #[test]
    fn the_condition_that_explains_the_errors_is_named_and_not_one_that_goes_along_with_it() {
        let calibration = fixture::calibration();
        let comparison = calibration.comparison();
        // The load is low at 90 degrees, and lowest in the run with the largest error; two other runs have a low load as well.
        let runs = [
            (0.0, 24.0, 1.0),
            (0.0, 23.0, -1.0),
            (0.0, 14.0, 1.0),
            (45.0, 24.0, -1.0),
            (45.0, 14.0, 1.0),
            (90.0, 17.0, 30.0),
            (90.0, 17.0, 32.0),
            (90.0, 14.0, 35.0),
        ];
        let rows: Vec<ComparisonRow> = runs
            .iter()
            .map(|&(slip_angle_deg, wheel_load_n, measured)| ComparisonRow {
                slip_angle_deg,
                wheel_load_n,
                measured,
                predicted: Some(0.0),
                ..comparison.rows[0].clone()
            })
            .collect();
        let words = place(&rows.iter().collect::<Vec<_>>());
        assert_eq!(
            words.as_deref(),
            Some("most at a slip angle of 90 deg, under-predicted there")
        );
        let rows: Vec<&ComparisonRow> = rows.iter().collect();
        let beyond = |fitted: &[&ComparisonRow]| place_beyond(&rows, fitted);
        assert_eq!(
            beyond(&rows[..5]).as_deref(),
            Some("most at a slip angle of 90 deg, beyond the fitted ones, under-predicted there")
        );
        assert_eq!((beyond(&rows), beyond(&[])), (None, None));
    }

    #[test]
    fn a_load_that_scatters_is_named_only_where_nothing_that_was_set_tells_the_errors() {
        let calibration = fixture::calibration();
        let comparison = calibration.comparison();
        let words = |runs: &[(f64, f64, f64)]| {
            let row = |&(slip_angle_deg, wheel_load_n, measured): &(f64, f64, f64)| ComparisonRow {
                slip_angle_deg,
                wheel_load_n,
                measured,
                predicted: Some(0.0),
                ..comparison.rows[0].clone()
            };
            let rows: Vec<ComparisonRow> = runs.iter().map(row).collect();
            place(&rows.iter().collect::<Vec<_>>()).unwrap()
        };
        // The error follows the load more closely than the angle that lowers the load.
        let scattered = [
            (0.0, 24.0, 1.0),
            (0.0, 24.0, -1.0),
            (0.0, 24.0, 1.0),
            (45.0, 21.0, 5.0),
            (45.0, 21.0, -5.0),
            (45.0, 18.0, 10.0),
            (90.0, 18.0, 10.0),
            (90.0, 18.0, -10.0),
            (90.0, 16.0, 30.0),
            (90.0, 16.0, 30.0),
        ];
        let angle = "most at a slip angle of 90 deg, under-predicted there";
        assert_eq!(words(&scattered), angle);
        let at_one_angle = scattered.map(|(_, load, error)| (0.0, load, error));
        assert_eq!(
            words(&at_one_angle),
            "most at a load of 16 N, under-predicted there"
        );
        // Loads with a gap were set.
        let set = scattered.map(|(angle, load, error)| (angle, if load < 17.0 { 8.0 } else { load }, error));
        assert_eq!(words(&set), "most at a load of 8.0 N, under-predicted there");
    }

    #[test]
    fn one_direction_is_said_before_a_level_and_an_even_scatter_has_no_place() {
        assert_eq!(
            words(&[(0.1, 1.0), (0.5, 9.0)]).as_deref(),
            Some("under-predicted in every run")
        );
        let level = words(&[(0.1, 1.0), (0.1, -1.0), (0.3, 1.0), (0.9, -9.0)]);
        assert_eq!(level.as_deref(), Some("most at slip 0.90, over-predicted there"));
        assert_eq!(words(&[(0.1, 1.0), (0.5, -1.0)]), None);
    }
}
