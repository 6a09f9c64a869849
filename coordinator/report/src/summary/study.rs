//! The whole of `summary.json`.

use std::collections::BTreeMap;

use shared::experiment::Campaign;

use super::calibration::CalibrationSummary;
use crate::flag::study::flags;
use crate::summary::calibration::calibration_summary;
use result::discovery::DiscoverySummary;
use result::error_summary::CombinedSummary;
use result::finished_calibration::FinishedCalibration;
use result::flag::Flag;
use result::model_comparison::ModelComparison;
use result::point_estimate::PointEstimate;
use result::rig::{RepeatOffsets, repeat_offsets};
use result::study::Study;
use result::table::fixed_sigma::{FixedSigma, FixedSigmas};

/// The summary of a study; fields that do not apply are null.
#[derive(Debug, Clone, serde::Serialize, serde::Deserialize, utoipa::ToSchema)]
pub struct StudySummary {
    /// Name of the experiment.
    pub experiment: String,
    /// Source of the measurements; null if the experiment does not state it.
    pub campaign: Option<Campaign>,
    /// Seed of the job.
    pub seed: u64,
    /// Version of the equations and the effects.
    pub model_version: String,
    /// Kind of the model; if several are compared, that of the most probable one.
    pub model_kind: String,
    /// State of the study.
    pub status: String,
    /// The error ledger: base first, then each extension. Empty for a search by generations, and for a fit without draws.
    pub calibrations: Vec<CalibrationSummary>,
    /// Errors of the combined predictions of the models; null if no prediction is corrected.
    pub combined: Option<CombinedSummary>,
    /// Noise standard deviation of `rmse_fixed_sigma`, by channel.
    pub fixed_sigma: BTreeMap<String, FixedSigma>,
    /// Results of fits and searches by generations.
    pub point_estimates: Vec<PointEstimate>,
    /// Comparison of the job's models; null if the job has one model, and until all are finished.
    pub models: Option<ModelComparison>,
    /// Offsets of sessions, tarings and operators in the fitted runs of the current model; null if no run states one.
    pub rig: Option<Vec<RepeatOffsets>>,
    /// Flags of the study.
    pub flags: Vec<Flag>,
    /// Results of the searches for missing effects; null if none is finished.
    pub discovery: Option<DiscoverySummary>,
}

/// Returns the effects of the current model that the submitted job does not have.
fn added(study: &Study) -> Vec<String> {
    let had = study.lead.effects();
    study
        .current()
        .map(|best| study.parts(best))
        .unwrap_or_default()
        .into_iter()
        .filter(|effect| !had.contains(effect))
        .collect()
}

/// Returns the lines of the error ledger.
pub(crate) fn ledger_summaries(study: &Study, sigmas: &FixedSigmas) -> Vec<CalibrationSummary> {
    let mut experiments: Vec<i64> = Vec::new();
    for line in study.ledger() {
        if !experiments.contains(&line.row.experiment) {
            experiments.push(line.row.experiment);
        }
    }
    let number = |id: i64| experiments.iter().position(|&other| other == id);
    let line = |calibration: &FinishedCalibration| {
        let line = calibration_summary(calibration)?;
        let effects = study.parts(calibration);
        Some(CalibrationSummary {
            effects,
            data_set: 1 + number(calibration.row.experiment).unwrap_or_default(),
            ..line.in_fixed_sigmas(sigmas)
        })
    };
    study.ledger().filter_map(line).collect()
}

/// Returns the point estimates of every model.
pub(crate) fn point_estimate_summaries(study: &Study, sigmas: &FixedSigmas) -> Vec<PointEstimate> {
    study
        .line()
        .filter_map(|calibration| Some(calibration.point_estimate()?.in_fixed_sigmas(sigmas)))
        .collect()
}

/// Summarises what the models predict together; `None` if nothing is corrected.
pub(crate) fn combined_summary(study: &Study, sigmas: &FixedSigmas) -> Option<CombinedSummary> {
    CombinedSummary::new(study.combined(), sigmas)
}

/// Returns what the rig did in the fitted runs of the current model.
pub(crate) fn study_rig(study: &Study) -> Option<Vec<RepeatOffsets>> {
    let spec = &study.current().unwrap_or(&study.lead).spec;
    repeat_offsets(&spec.experiment, &spec.fit_runs)
}

/// Summarises a study for `summary.json`.
pub fn summary(study: &Study) -> StudySummary {
    let lead = &study.lead;
    let sigmas = study.fixed_sigmas();
    StudySummary {
        experiment: lead.experiment.clone(),
        campaign: lead.spec.experiment.campaign.clone(),
        seed: lead.spec.algorithm.seed(),
        model_version: lead.row.model_version.clone().unwrap_or_default(),
        model_kind: lead.spec.model.kind.name().to_owned(),
        status: study.state.name().to_owned(),
        calibrations: ledger_summaries(study, &sigmas),
        point_estimates: point_estimate_summaries(study, &sigmas),
        combined: combined_summary(study, &sigmas),
        fixed_sigma: sigmas.by_name(),
        models: study.model_comparison(),
        rig: study_rig(study),
        flags: flags(study),
        discovery: DiscoverySummary::new(&study.rounds, added(study)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::ReportPredictions;
    use crate::fixture;

    #[test]
    fn a_line_of_the_ledger_says_over_which_runs_it_is() {
        let mut study = fixture::grown();
        study.extensions[0] = fixture::with_held_out_runs(5, 0.5);
        study.extensions[0].row.experiment += 1;
        let lines = summary(&study).calibrations;
        let runs: Vec<_> = lines
            .iter()
            .map(|line| (line.data_set, line.fitted_runs, line.held_out_runs))
            .collect();
        assert_eq!(runs, [(1, 3, 1), (2, 4, 5)]);
    }

    #[test]
    fn a_sample_is_in_the_ledger_and_a_search_among_the_point_estimates() {
        let summary = summary(&fixture::study());
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

    #[test]
    fn every_compared_model_has_its_files_and_stands_in_the_summary() {
        let mut other = fixture::calibration();
        (other.row.id, other.row.log_evidence) = (2, Some(-12.0));
        let study = Study {
            models: 2,
            other_models: vec![other],
            ..fixture::calibration().into()
        };
        assert!(
            crate::study_file::file(
                &study,
                &ReportPredictions::default(),
                crate::StudyFile::Figures(2)
            )
            .is_some()
        );
        assert_eq!(summary(&study).models, study.model_comparison());
    }
}
