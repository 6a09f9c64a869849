//! `summary.json`: the contract's summary of a study.

use std::collections::BTreeMap;

use shared::experiment::Campaign;

use super::calibration::CalibrationSummary;
use super::error::CombinedSummary;
use super::point_estimate::PointEstimate;
use crate::discovery::DiscoverySummary;
use crate::finished_calibration::FinishedCalibration;
use crate::flag::kind::Flag;
use crate::model_comparison::ModelComparison;
use crate::study::Study;
use crate::table::fixed_sigma::{FixedSigma, FixedSigmas};

/// The summary of a study; what does not apply is null.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct StudySummary {
    /// Name of the experiment.
    pub experiment: String,
    /// Where the measurements come from; null where the experiment does not say it.
    pub campaign: Option<Campaign>,
    /// Seed of the job.
    pub seed: u64,
    /// Version of the equations and the effects.
    pub model_version: String,
    /// Kind of the model; of several that are compared, the most probable.
    pub model_kind: String,
    /// State of the study.
    pub status: String,
    /// The error ledger: base first, then each extension. Empty for a search by generations, and for a fit without draws.
    pub calibrations: Vec<CalibrationSummary>,
    /// What the ledger's models predict together; null where nothing is corrected.
    pub combined: Option<CombinedSummary>,
    /// The noise sd of each channel that `rmse_fixed_sigma` is in, by name.
    pub fixed_sigma: BTreeMap<String, FixedSigma>,
    /// Deterministic fits.
    pub point_estimates: Vec<PointEstimate>,
    /// The models that the job compares; null where it has one, and until all are finished.
    pub models: Option<ModelComparison>,
    /// The flags.
    pub flags: Vec<Flag>,
    /// Missing effects; null where no search is finished.
    pub discovery: Option<DiscoverySummary>,
}

impl Study {
    /// Effects that the first calibration did not have, of the line of the ledger with the most evidence on the newest data.
    fn added(&self) -> Vec<String> {
        let had = self.lead.effects();
        self.current()
            .map(|best| self.parts(best))
            .unwrap_or_default()
            .into_iter()
            .filter(|effect| !had.contains(effect))
            .collect()
    }

    /// The lines of the error ledger.
    pub(crate) fn ledger_summaries(&self, sigmas: &FixedSigmas) -> Vec<CalibrationSummary> {
        let mut experiments: Vec<i64> = Vec::new();
        for line in self.ledger() {
            if !experiments.contains(&line.row.experiment) {
                experiments.push(line.row.experiment);
            }
        }
        let number = |id: i64| experiments.iter().position(|&other| other == id);
        let line = |calibration: &FinishedCalibration| {
            let line = calibration.calibration_summary()?;
            let effects = self.parts(calibration);
            Some(CalibrationSummary {
                effects,
                data_set: 1 + number(calibration.row.experiment).unwrap_or_default(),
                ..line.in_fixed_sigmas(sigmas)
            })
        };
        self.ledger().filter_map(line).collect()
    }

    /// The point estimates of every model.
    pub(crate) fn point_estimate_summaries(&self, sigmas: &FixedSigmas) -> Vec<PointEstimate> {
        self.line()
            .filter_map(|calibration| Some(calibration.point_estimate()?.in_fixed_sigmas(sigmas)))
            .collect()
    }

    /// What the models of the ledger predict together; `None` where nothing is corrected.
    pub(crate) fn combined_summary(&self, sigmas: &FixedSigmas) -> Option<CombinedSummary> {
        CombinedSummary::of(self.combined(), sigmas)
    }

    /// `summary.json`.
    pub fn summary(&self) -> StudySummary {
        let lead = &self.lead;
        let sigmas = self.fixed_sigmas();
        StudySummary {
            experiment: lead.experiment.clone(),
            campaign: lead.spec.experiment.campaign.clone(),
            seed: lead.spec.algorithm.seed(),
            model_version: lead.row.model_version.clone().unwrap_or_default(),
            model_kind: lead.spec.model.kind.name().to_owned(),
            status: self.state.name().to_owned(),
            calibrations: self.ledger_summaries(&sigmas),
            point_estimates: self.point_estimate_summaries(&sigmas),
            combined: self.combined_summary(&sigmas),
            fixed_sigma: sigmas.by_name(),
            models: self.model_comparison(),
            flags: self.flags(),
            discovery: DiscoverySummary::of(&self.rounds, self.added()),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::fixture;

    #[test]
    fn a_line_of_the_ledger_says_over_which_runs_it_is() {
        let mut study = fixture::grown();
        study.extensions[0] = fixture::with_held_out_runs(5, 0.5);
        study.extensions[0].row.experiment += 1;
        let lines = study.summary().calibrations;
        let runs: Vec<_> = lines
            .iter()
            .map(|line| (line.data_set, line.fitted_runs, line.held_out_runs))
            .collect();
        assert_eq!(runs, [(1, 3, 1), (2, 4, 5)]);
    }

    #[test]
    fn a_sample_is_in_the_ledger_and_a_search_among_the_point_estimates() {
        let summary = fixture::study().summary();
        let algorithms: Vec<&str> = summary.calibrations.iter().map(|c| c.algorithm.name()).collect();
        assert_eq!(algorithms, ["tmcmc"]);
        let estimates: Vec<&str> = summary
            .point_estimates
            .iter()
            .map(|e| e.algorithm.name())
            .collect();
        assert_eq!(estimates, ["ga"]);
        let of_search = summary.flags.iter().filter(|f| f.text.starts_with("ga: "));
        assert!(of_search.count() > 0, "{:?}", summary.flags);
    }
}
