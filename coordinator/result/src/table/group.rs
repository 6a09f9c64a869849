//! Error groups: errors by level of a condition, and by wheel.

use std::collections::BTreeMap;

use shared::experiment::RunUse;

use super::level::{Level, few_levels};
use super::row::{ComparisonRow, rows_of};
use crate::words::number;

/// A function that reads a condition from a row.
type Condition = fn(&ComparisonRow) -> f64;

/// The errors of the rows at one level of a condition, or of one wheel.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct ErrorGroup {
    /// Use of the runs: `fit` or `holdout`.
    #[serde(rename = "use")]
    #[schema(value_type = String)]
    pub usage: RunUse,
    /// Criterion of the group.
    #[schema(value_type = String)]
    pub by: GroupBy,
    /// The wheel; null for a group by a condition.
    pub wheel: Option<String>,
    /// Smallest value of the condition `[N, m/s, deg; 1 for slip]`; null for a group by wheel.
    pub from: Option<f64>,
    /// Largest value of the condition.
    pub to: Option<f64>,
    /// The errors by channel without unit.
    pub channels: BTreeMap<String, GroupError>,
}

/// Criterion of a group.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GroupBy {
    /// A level of slip.
    Slip,
    /// A level of wheel load.
    WheelLoad,
    /// A level of sled speed.
    SledSpeed,
    /// A level of slip angle.
    SlipAngle,
    /// The wheel.
    Wheel,
}

/// The error of a channel within a group, in units of each row's noise sd.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct GroupError {
    /// Root mean square of (measured - predicted) / noise sd.
    pub rmse_sigma: f64,
    /// Mean of (measured - predicted) / noise sd; positive if the model predicts too little.
    pub mean_sigma: f64,
    /// Number of rows.
    pub runs: usize,
}

impl ErrorGroup {
    /// Names the group: `slip 0.050`, `load 60.0 to 61.2 N`, `wheel w`.
    pub fn words(&self) -> String {
        let (what, scale, decimals, unit) = match self.by {
            GroupBy::WheelLoad => ("load", 1.0, 1, " N"),
            GroupBy::SledSpeed => ("speed", 1000.0, 2, " mm/s"),
            GroupBy::SlipAngle => ("slip angle", 1.0, 1, " deg"),
            GroupBy::Slip | GroupBy::Wheel => ("slip", 1.0, 3, ""),
        };
        let value = |x: f64| number::fixed(scale * x, decimals);
        match (&self.wheel, self.from.map(value), self.to.map(value)) {
            (Some(wheel), ..) => format!("wheel {wheel}"),
            (None, Some(from), Some(to)) if from != to => format!("{what} {from} to {to}{unit}"),
            (None, from, _) => format!("{what} {}{unit}", from.unwrap_or_default()),
        }
    }
}

impl GroupError {
    /// Returns root mean square, mean and number of rows: `1.23 (+0.41) 6`.
    pub fn words(&self) -> String {
        format!("{:.2} ({:+.2}) {}", self.rmse_sigma, self.mean_sigma, self.runs)
    }
}

/// Groups the fitted rows, then the holdout rows, by slip, load, speed, slip angle and wheel; conditions with a single level are left
/// out.
pub fn error_groups(rows: &[ComparisonRow]) -> Vec<ErrorGroup> {
    let conditions: [(GroupBy, Condition); 4] = [
        (GroupBy::Slip, |r| r.slip),
        (GroupBy::WheelLoad, |r| r.wheel_load_n),
        (GroupBy::SledSpeed, |r| r.sled_speed_m_s),
        (GroupBy::SlipAngle, |r| r.slip_angle_deg),
    ];
    let mut groups = Vec::new();
    for usage in [RunUse::Fit, RunUse::Holdout] {
        let selected = || rows_of(rows, usage);
        for (by, value) in conditions {
            // Fitted and holdout rows have the same levels, so that they can be compared.
            let levels = few_levels(rows.iter().map(value));
            for level in levels.iter().filter(|_| levels.len() > 1) {
                let Level { from, to } = *level;
                let channels = errors(selected().filter(|r| level.holds(value(r))));
                groups.push(ErrorGroup {
                    usage,
                    by,
                    wheel: None,
                    from: Some(from),
                    to: Some(to),
                    channels,
                });
            }
        }
        let mut wheels: Vec<&str> = rows.iter().map(|r| r.wheel.as_str()).collect();
        wheels.sort_unstable();
        wheels.dedup();
        for wheel in wheels.iter().filter(|_| wheels.len() > 1) {
            groups.push(ErrorGroup {
                usage,
                by: GroupBy::Wheel,
                wheel: Some((*wheel).to_owned()),
                from: None,
                to: None,
                channels: errors(selected().filter(|r| r.wheel == *wheel)),
            });
        }
    }
    groups.retain(|group| !group.channels.is_empty());
    groups
}

fn errors<'a>(rows: impl Iterator<Item = &'a ComparisonRow>) -> BTreeMap<String, GroupError> {
    let mut residuals: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for row in rows {
        if let Some(residual) = row.residual_sigma {
            residuals
                .entry(row.channel.name().to_owned())
                .or_default()
                .push(residual);
        }
    }
    let error = |residuals: &Vec<f64>| {
        let count = residuals.len() as f64;
        GroupError {
            rmse_sigma: (residuals.iter().map(|r| r * r).sum::<f64>() / count).sqrt(),
            mean_sigma: residuals.iter().sum::<f64>() / count,
            runs: residuals.len(),
        }
    };
    residuals
        .iter()
        .map(|(channel, residuals)| (channel.clone(), error(residuals)))
        .collect()
}

#[cfg(test)]
mod tests {
    use shared::channel::Channel;

    use super::*;
    use crate::fixture;

    /// Returns use, words and figures of every group that has pull.
    fn pulls(rows: &[ComparisonRow]) -> Vec<(String, String, [f64; 3])> {
        let groups = error_groups(rows);
        let pull = |g: &ErrorGroup| {
            let pull = g.channels.get("drawbar_pull")?;
            let figures = [pull.rmse_sigma, pull.mean_sigma, pull.runs as f64];
            Some((g.usage.name().to_owned(), g.words(), figures))
        };
        groups.iter().filter_map(pull).collect()
    }

    #[test]
    fn errors_stand_by_use_and_level_with_their_sign() {
        let mut rows = fixture::calibration().comparison().rows.clone();
        rows.retain(|r| r.channel == Channel::DrawbarPull);
        for (row, (slip, residual)) in
            rows.iter_mut()
                .zip([(0.1, 3.0), (0.101, -1.0), (0.4, 2.0), (0.4, -2.0)])
        {
            (row.slip, row.residual_sigma) = (slip, Some(residual));
        }
        let group = |usage: &str, words: &str, figures: [f64; 3]| (usage.into(), words.into(), figures);
        assert_eq!(
            pulls(&rows),
            [
                group("fit", "slip 0.100 to 0.101", [5.0_f64.sqrt(), 1.0, 2.0]),
                group("fit", "slip 0.400", [2.0, 2.0, 1.0]),
                group("holdout", "slip 0.400", [2.0, -2.0, 1.0]),
            ],
            "load, speed and wheel are the same everywhere"
        );
        (rows[0].wheel, rows[0].wheel_load_n, rows[0].sled_speed_m_s) = ("b".into(), 75.0, 0.02);
        let words: Vec<String> = pulls(&rows).into_iter().map(|g| g.1).collect();
        for expected in ["load 75.0 N", "speed 20.00 mm/s", "wheel b"] {
            assert!(words.contains(&expected.to_owned()), "{expected} in {words:?}");
        }
    }

    #[test]
    fn rows_without_a_prediction_or_noise_do_not_count() {
        let mut rows = fixture::calibration().comparison().rows.clone();
        for row in &mut rows {
            row.residual_sigma = None;
        }
        assert_eq!(error_groups(&rows), []);
    }
}
