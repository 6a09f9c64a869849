//! Errors of the sinkage before the steady state, along the recordings.

use job::RunTransient;
use shared::channel::Channel;
use shared::experiment::RunUse;
use shared::model::ModelKind;

use super::comparison::Comparison;
use super::holdout_group::HoldoutGroup;
use super::row::ComparisonRow;
use crate::finished_calibration::FinishedCalibration;

/// The recorded sinkage of a run before it is steady, with its prediction, at K equal steps of travel.
#[derive(Debug, Clone)]
pub struct PredictedTransient<'a> {
    /// The row of the run's steady sinkage.
    pub row: &'a ComparisonRow,
    /// Travel since the beginning of the slip `[m]`, K numbers.
    pub travel_m: Vec<f64>,
    /// Recorded sinkage there `[m]`.
    pub measured_m: Vec<f64>,
    /// Posterior mean of the model `[m]`.
    pub predicted_m: Vec<f64>,
    /// The same, settling to the corrected steady sinkage; `None` if that cannot be estimated.
    pub corrected_m: Option<Vec<f64>>,
}

/// Root mean square errors of the sinkage before the steady state, over all points of a group of runs.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct TransientErrors {
    /// Use of the runs: `fit` or `holdout`.
    #[serde(rename = "use")]
    #[schema(value_type = String)]
    pub usage: RunUse,
    /// Place of holdout runs among the fitted conditions; null for fitted runs.
    #[schema(value_type = Option<String>)]
    pub holdout_group: Option<HoldoutGroup>,
    /// Number of runs.
    pub runs: usize,
    /// Error of the posterior mean `[m]`.
    pub rmse_m: f64,
    /// Error where the prediction settles to the corrected steady sinkage `[m]`; null where no run of the group has a corrected prediction.
    pub corrected_rmse_m: Option<f64>,
}

impl FinishedCalibration {
    /// Returns the transients of the job with their predictions, fitted runs first; a run that is not predicted is left out.
    pub fn predicted_transients<'a>(&self, comparison: &'a Comparison) -> Vec<PredictedTransient<'a>> {
        let transients = &self.spec.transients;
        let mut first = transients.points();
        let mut predicted = Vec::new();
        for run in &transients.fitted {
            let points = run.transient.track().len();
            let draws = self.predictive_draws().iter();
            let draws = draws.filter_map(|draw| draw.fit.as_ref().ok());
            let places = first..first + points;
            let of_run = draws.filter_map(|observables| observables.transient_sinkage_m.get(places.clone()));
            first += points;
            let position = self.spec.fit_runs[run.run];
            predicted.extend(self.predicted_transient(comparison, run, position, of_run));
        }
        let mut first = 0;
        for run in &transients.holdout {
            let points = run.transient.track().len();
            let draws = self
                .predictive_draws()
                .iter()
                .filter_map(|draw| draw.holdout.as_ref());
            let of_run = draws.filter_map(|holdout| {
                let (observables, position) = holdout.run(run.run).ok()?;
                // A run that was simulated alone has its points alone.
                let first = if position == run.run { first } else { 0 };
                observables.transient_sinkage_m.get(first..first + points)
            });
            let position = self.spec.holdout_runs[run.run];
            predicted.extend(self.predicted_transient(comparison, run, position, of_run));
            first += points;
        }
        predicted
    }

    /// Returns the transient of a run, which has a position in the experiment, with the mean of its draws.
    fn predicted_transient<'a, 'd>(
        &self,
        comparison: &'a Comparison,
        run: &RunTransient,
        position: usize,
        draws: impl Iterator<Item = &'d [f64]>,
    ) -> Option<PredictedTransient<'a>> {
        let name = &self.spec.experiment.runs[position].name;
        let is_sinkage = |row: &&ComparisonRow| row.run == *name && row.channel == Channel::Sinkage;
        let row = comparison.rows.iter().find(is_sinkage)?;
        let steady_m = row.predicted?;
        let track = run.transient.track();
        let mut sum = vec![0.0; track.len()];
        let mut count = 0.0;
        for draw in draws {
            sum.iter_mut().zip(draw).for_each(|(sum, z)| *sum += z);
            count += 1.0;
        }
        if count < 1.0 {
            return None;
        }
        let predicted_m: Vec<f64> = sum.iter().map(|sum| sum / count).collect();
        // The three-dimensional wheel rolls from where it stands itself; its first point stands for that.
        let start_m = match self.spec.model.kind {
            ModelKind::Scm => predicted_m[0],
            _ => run.transient.start_sinkage_m,
        };
        let settled = |z: &f64| match steady_m - start_m {
            way if way.abs() > f64::EPSILON => (z - start_m) / way,
            _ => 1.0,
        };
        let corrected = |corrected_m: f64| {
            let shift = |z: &f64| z + settled(z) * (corrected_m - steady_m);
            predicted_m.iter().map(shift).collect()
        };
        Some(PredictedTransient {
            row,
            travel_m: track.iter().map(|[travel_m, _]| *travel_m).collect(),
            measured_m: track.iter().map(|[_, z]| *z).collect(),
            corrected_m: row.corrected.map(corrected),
            predicted_m,
        })
    }
}

impl TransientErrors {
    /// Returns the errors of the fitted runs and of each group of holdout runs; empty without transients.
    pub fn by_group(transients: &[PredictedTransient]) -> Vec<Self> {
        let groups = HoldoutGroup::ALL.into_iter().map(Some);
        let groups = std::iter::once(None).chain(groups);
        groups
            .filter_map(|group| Self::of_group(transients, group))
            .collect()
    }

    fn of_group(transients: &[PredictedTransient], group: Option<HoldoutGroup>) -> Option<Self> {
        let members = || {
            transients
                .iter()
                .filter(|transient| transient.row.holdout_group == group)
        };
        let rmse = |error: &dyn Fn(&PredictedTransient) -> Option<Vec<f64>>| {
            let squares: Vec<f64> = members()
                .filter_map(error)
                .flatten()
                .map(|error| error * error)
                .collect();
            (!squares.is_empty()).then(|| (squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
        };
        let errors = |measured: &[f64], predicted: &[f64]| {
            measured.iter().zip(predicted).map(|(m, p)| m - p).collect()
        };
        Some(TransientErrors {
            usage: match group {
                None => RunUse::Fit,
                Some(_) => RunUse::Holdout,
            },
            holdout_group: group,
            runs: members().count(),
            rmse_m: rmse(&|transient| Some(errors(&transient.measured_m, &transient.predicted_m)))?,
            corrected_rmse_m: rmse(&|transient| {
                Some(errors(&transient.measured_m, transient.corrected_m.as_ref()?))
            }),
        })
    }
}
