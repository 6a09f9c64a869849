//! The errors of predictions of the holdout runs by group.

use std::collections::BTreeSet;

use super::combined_row::CombinedRow;
use super::coverage::Coverage;
use super::errors::ErrorTable;
use super::fixed_sigma::FixedSigmas;
use super::holdout_group::HoldoutGroup;
use super::row::ComparisonRow;

/// The errors of predictions of the holdout runs of a group.
#[derive(Debug, Clone, PartialEq)]
pub struct HoldoutErrors {
    /// The group.
    pub group: HoldoutGroup,
    /// Number of runs with a measurement, predicted or not.
    pub runs: usize,
    /// Errors; `None` if nothing of the group is predicted.
    pub errors: Option<ErrorTable>,
    /// Coverage of the 90 % intervals; `None` without intervals.
    pub coverage: Option<Coverage>,
}

/// A prediction of a row: the value, and whether the 90 % interval contains the measurement.
type Judged = (Option<f64>, Option<bool>);

impl HoldoutErrors {
    /// Returns the errors of the model by group; groups without a run are left out.
    pub fn of_model<'a>(rows: impl Iterator<Item = &'a ComparisonRow>) -> Vec<Self> {
        Self::by_group(rows.map(|row| (row, (row.predicted, row.covered()))))
    }

    /// Returns the errors of the corrected predictions by group; groups without a run are left out.
    pub fn of_corrected<'a>(rows: impl Iterator<Item = &'a ComparisonRow>) -> Vec<Self> {
        Self::by_group(rows.map(|row| (row, (row.corrected, row.covered_corrected()))))
    }

    /// Returns the errors of interpolation by group, on the rows that the model predicts too; groups without a run are left out.
    pub fn of_baseline<'a>(rows: impl Iterator<Item = &'a ComparisonRow>) -> Vec<Self> {
        let interpolated = |row: &ComparisonRow| row.interpolated.filter(|_| row.predicted.is_some());
        Self::by_group(rows.map(|row| (row, (interpolated(row), None))))
    }

    /// Returns the errors of the combined predictions by group; groups without a run are left out.
    pub fn of_combined<'a>(rows: impl Iterator<Item = &'a CombinedRow>) -> Vec<Self> {
        Self::by_group(rows.map(|combined| (&combined.row, (combined.mean, combined.covered()))))
    }

    /// Returns the errors of the predictions that stand beside the rows; rows of fitted runs do not count.
    fn by_group<'a>(rows: impl Iterator<Item = (&'a ComparisonRow, Judged)>) -> Vec<Self> {
        let rows: Vec<(&ComparisonRow, Judged)> = rows.collect();
        let errors = |group: HoldoutGroup| {
            let of_group = || {
                rows.iter()
                    .filter(move |(row, _)| row.holdout_group == Some(group))
            };
            let runs: BTreeSet<&str> = of_group().map(|(row, _)| row.run.as_str()).collect();
            (!runs.is_empty()).then(|| HoldoutErrors {
                group,
                runs: runs.len(),
                errors: ErrorTable::new(of_group().map(|&(row, (predicted, _))| (row, predicted))),
                coverage: Coverage::from_outcomes(of_group().filter_map(|(_, (_, covered))| *covered)),
            })
        };
        HoldoutGroup::ALL.into_iter().filter_map(errors).collect()
    }

    /// Returns the same errors with `rmse_fixed_sigma` in the given noise standard deviations.
    #[must_use]
    pub fn in_fixed_sigmas(self, sigmas: &FixedSigmas) -> Self {
        HoldoutErrors {
            errors: self.errors.map(|table| table.in_fixed_sigmas(sigmas)),
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use shared::channel::Channel;

    use super::*;
    use crate::fixture;

    #[test]
    fn each_group_has_the_errors_and_the_coverage_of_its_runs() {
        let calibration = fixture::with_held_out_runs(4, 1.0);
        let mut rows = calibration.comparison().rows.clone();
        rows.retain(|row| row.channel == Channel::DrawbarPull);
        let mut held_out = rows.iter_mut().filter(|row| row.holdout_group.is_some());
        let cases = [
            (HoldoutGroup::InLevels, Some(3.0), 2.0),
            (HoldoutGroup::Beyond, Some(3.0), 1.0),
            (HoldoutGroup::Beyond, Some(4.0), 9.0),
            (HoldoutGroup::Beyond, None, 1.0),
        ];
        for (group, error, half) in cases {
            let row = held_out.next().unwrap();
            row.holdout_group = Some(group);
            row.predicted = error.map(|error| row.measured + error);
            row.q05 = row.predicted.map(|predicted| predicted - half);
            row.q95 = row.predicted.map(|predicted| predicted + half);
        }
        let groups = HoldoutErrors::of_model(rows.iter());
        let figures = groups.iter().map(|group| {
            let pull = group.errors.as_ref().unwrap().drawbar_pull.unwrap();
            let coverage = group.coverage.unwrap();
            (
                group.group,
                group.runs,
                (pull.rmse, pull.runs),
                (coverage.inside, coverage.total),
            )
        });
        let expected = [
            (HoldoutGroup::InLevels, 1, (3.0, 1), (0, 1)),
            (HoldoutGroup::Beyond, 3, (12.5_f64.sqrt(), 2), (1, 2)),
        ];
        for (figure, expected) in figures.zip(expected) {
            assert!((figure.2.0 - expected.2.0).abs() < 1e-9, "{figure:?}");
            assert_eq!(
                (figure.0, figure.1, figure.2.1, figure.3),
                (expected.0, expected.1, expected.2.1, expected.3)
            );
        }
        assert_eq!(groups.len(), 2);
        assert_eq!(groups[1].errors.as_ref().unwrap().all.unpredicted, 1);
    }

    #[test]
    fn a_group_of_refused_runs_has_no_error_but_its_number_of_runs() {
        let calibration = fixture::with_held_out_runs(2, 1.0);
        let mut rows = calibration.comparison().rows.clone();
        for row in &mut rows {
            (row.predicted, row.q05, row.q95) = (None, None, None);
            row.holdout_group = row.holdout_group.map(|_| HoldoutGroup::Beyond);
        }
        let groups = HoldoutErrors::of_model(rows.iter());
        assert_eq!((groups.len(), groups[0].runs), (1, 2));
        assert_eq!((&groups[0].errors, groups[0].coverage), (&None, None));
    }
}
