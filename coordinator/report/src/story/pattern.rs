//! The pattern of a channel's errors in words: the conditions at which they are largest.

use result::table::level::few_levels;
use result::table::row::ComparisonRow;
use result::words::number;

/// Ratio of a level's error to that of all runs above which the level stands out.
const STANDS_OUT: f64 = 1.3;

/// A function that reads a condition from a row.
type Condition = (&'static str, f64, &'static str, fn(&ComparisonRow) -> f64);

/// Slip, load, speed and slip angle, each with the factor and unit in which it is shown.
const CONDITIONS: [Condition; 4] = [
    ("slip", 1.0, "", |row| row.slip),
    ("a load of", 1.0, " N", |row| row.wheel_load_n),
    ("a speed of", 1000.0, " mm/s", |row| row.sled_speed_m_s),
    ("a slip angle of", 1.0, " deg", |row| row.slip_angle_deg),
];

/// Describes where the errors of a channel without a significant trend lie: the common sign in all runs, else the level with the largest
/// error.
pub(super) fn place(rows: &[&ComparisonRow]) -> Option<String> {
    let residuals = rows
        .iter()
        .filter_map(|row| Some((*row, row.measured - row.predicted?)));
    let residuals: Vec<(&ComparisonRow, f64)> = residuals.collect();
    one_direction(&residuals).or_else(|| standing_out(&residuals))
}

fn one_direction(residuals: &[(&ComparisonRow, f64)]) -> Option<String> {
    let above = residuals.iter().filter(|(_, r)| *r > 0.0).count();
    let direction = match above {
        0 => "over",
        n if n == residuals.len() => "under",
        _ => return None,
    };
    (residuals.len() > 1).then(|| format!("{direction}-predicted in every run"))
}

/// Names the worst level of the condition that tells best where the errors are large: an angle of 90 degrees, and not the low load that a
/// ploughing wheel has there.
fn standing_out(residuals: &[(&ComparisonRow, f64)]) -> Option<String> {
    let all: Vec<f64> = residuals.iter().map(|(_, r)| *r).collect();
    let threshold = STANDS_OUT * rms(&all);
    let mut best: Option<(f64, String)> = None;
    for (name, factor, unit, value) in CONDITIONS {
        let levels = few_levels(residuals.iter().map(|(row, _)| value(row)));
        let groups: Vec<Vec<f64>> = levels
            .iter()
            .map(|level| {
                let of_level = residuals.iter().filter(|(row, _)| level.holds(value(row)));
                of_level.map(|(_, r)| *r).collect()
            })
            .collect();
        let worst = levels
            .iter()
            .zip(&groups)
            .max_by(|a, b| rms(a.1).total_cmp(&rms(b.1)));
        let Some((level, of_level)) =
            worst.filter(|(_, of_level)| levels.len() > 1 && rms(of_level) > threshold)
        else {
            continue;
        };
        let scatter = scatter_of_sizes(&groups, residuals.len());
        if best.as_ref().is_none_or(|(least, _)| scatter < *least) {
            let middle = 0.5 * (level.from + level.to) * factor;
            let mean = of_level.iter().sum::<f64>() / of_level.len() as f64;
            let direction = match mean / rms(of_level) {
                m if m > 0.5 => ", under-predicted there",
                m if m < -0.5 => ", over-predicted there",
                _ => "",
            };
            let level = number::significant(middle, 2);
            best = Some((scatter, format!("most at {name} {level}{unit}{direction}")));
        }
    }
    best.map(|(_, words)| words)
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
