//! The pattern of a channel's errors in words: the conditions at which they are largest.

use shared::channel::Channel;

use crate::flag::cause::pattern_of;
use result::diagnostics::trends::TrendDiagnostics;
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

/// Describes where the errors lie: the significant trend of the fitted residuals, else the common sign in all runs, else the level with
/// the largest error.
pub(super) fn place(
    channel: Channel,
    rows: &[&ComparisonRow],
    trends: &[TrendDiagnostics],
) -> Option<String> {
    let residuals = rows
        .iter()
        .filter_map(|row| Some((*row, row.measured - row.predicted?)));
    let residuals: Vec<(&ComparisonRow, f64)> = residuals.collect();
    pattern_of(trends, channel)
        .or_else(|| one_direction(&residuals))
        .or_else(|| standing_out(&residuals))
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

fn standing_out(residuals: &[(&ComparisonRow, f64)]) -> Option<String> {
    let rms = |values: &[f64]| (values.iter().map(|r| r * r).sum::<f64>() / values.len() as f64).sqrt();
    let all: Vec<f64> = residuals.iter().map(|(_, r)| *r).collect();
    let threshold = STANDS_OUT * rms(&all);
    let mut worst: Option<(f64, String)> = None;
    for (name, factor, unit, value) in CONDITIONS {
        let levels = few_levels(residuals.iter().map(|(row, _)| value(row)));
        for level in levels.iter().filter(|_| levels.len() > 1) {
            let of_level = residuals.iter().filter(|(row, _)| level.holds(value(row)));
            let of_level: Vec<f64> = of_level.map(|(_, r)| *r).collect();
            let mean = of_level.iter().sum::<f64>() / of_level.len() as f64;
            let error = rms(&of_level);
            if error > worst.as_ref().map_or(threshold, |(largest, _)| *largest) {
                let middle = 0.5 * (level.from + level.to) * factor;
                let direction = match mean {
                    m if m > 0.5 * error => ", under-predicted there",
                    m if m < -0.5 * error => ", over-predicted there",
                    _ => "",
                };
                let level = number::significant(middle, 2);
                worst = Some((error, format!("most at {name} {level}{unit}{direction}")));
            }
        }
    }
    worst.map(|(_, words)| words)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    /// Describes the pull of runs at the given slips with the given residuals.
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
        place(Channel::DrawbarPull, &rows.iter().collect::<Vec<_>>(), &[])
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
