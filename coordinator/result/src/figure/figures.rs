//! All figures of one calibration, collected from the other files of this folder.

use super::convergence::{self, Populations, SearchConvergence, StageConvergence};
use super::error::{self, ErrorDensity};
use super::history::{self, ChannelHistory};
use super::joint_posterior::{self, JointPosterior};
use super::marginal::{self, MarginalDensity};
use crate::finished_calibration::FinishedCalibration;
use crate::study::Study;

/// The numbers of a calibration's figures.
#[derive(Debug, Clone, serde::Serialize, utoipa::ToSchema)]
pub struct CalibrationFigures {
    /// Id of the calibration.
    pub calibration: i64,
    /// Convergence of searches by generations: the calibration's own, and for the submitted calibration also those of its point
    /// estimates.
    pub searches: Vec<SearchConvergence>,
    /// The stages of the sampler, beginning with the prior; empty without a sample.
    pub stages: Vec<StageConvergence>,
    /// The populations of selected stages in two parameters; null without a sample or for a single parameter.
    pub populations: Option<Populations>,
    /// Posterior and prior density of each parameter, in the order of the job; empty without draws.
    pub marginals: Vec<MarginalDensity>,
    /// Joint posterior densities of all pairs of parameters, or of the 45 most correlated pairs if there are more.
    pub posteriors: Vec<JointPosterior>,
    /// Measured and simulated histories; null for a model without time.
    pub histories: Option<Vec<ChannelHistory>>,
    /// Prediction errors over the posterior, by channel.
    pub errors: Vec<ErrorDensity>,
}

impl Study {
    /// Returns the figures of one calibration. Only the figures of the submitted model mark the study's point estimates, because extended
    /// models have other parameters.
    pub fn figures_of(&self, calibration: &FinishedCalibration) -> CalibrationFigures {
        let is_submitted = self.submitted().any(|c| c.row.id == calibration.row.id);
        let beside = self
            .submitted()
            .filter(|other| is_submitted && other.row.id != calibration.row.id);
        let sample = Some(calibration).filter(|calibration| calibration.estimate().is_none());
        CalibrationFigures {
            calibration: calibration.row.id,
            searches: std::iter::once(calibration)
                .chain(beside)
                .filter_map(convergence::search)
                .collect(),
            stages: sample.map(convergence::stages).unwrap_or_default(),
            populations: sample.and_then(convergence::populations),
            marginals: sample.map(marginal::all).unwrap_or_default(),
            posteriors: sample.map(|s| joint_posterior::all(self, s)).unwrap_or_default(),
            histories: match is_submitted {
                true => history::all(self),
                false => calibration.histories(),
            },
            errors: sample.map(|s| error::all(self, s)).unwrap_or_default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn a_sample_has_every_figure_that_it_allows() {
        let study = fixture::study();
        let figures = study.figures_of(&study.lead);
        assert_eq!((figures.searches.len(), figures.stages.len()), (1, 4));
        assert!(figures.populations.is_some() && figures.histories.is_none());
        let channels: Vec<&str> = figures.errors.iter().map(|e| e.channel.name()).collect();
        assert_eq!(channels, ["drawbar_pull", "sinkage"]);
    }

    #[test]
    fn a_calibration_s_figures_have_every_pair_and_every_parameter() {
        let study = fixture::grown();
        let figures = study.figures_of(&study.lead);
        let free = study.lead.spec.parameters.len();
        assert_eq!((figures.marginals.len(), figures.searches.len()), (free, 1));
        assert_eq!(figures.posteriors.len(), free * (free - 1) / 2);
        let extension = study.figures_of(&study.extensions[0]);
        assert_eq!((extension.calibration, extension.searches.len()), (3, 0));
        let of_search = study.figures_of(&study.point_estimates[0]);
        assert!(of_search.marginals.is_empty() && of_search.searches.len() == 1);
    }

    #[test]
    fn a_fit_alone_has_no_densities() {
        let study = Study::from(fixture::search());
        let figures = study.figures_of(&study.lead);
        assert_eq!(figures.searches.len(), 1);
        assert!(figures.posteriors.is_empty() && figures.errors.is_empty() && figures.stages.is_empty());
    }

    #[test]
    fn no_figure_has_a_number_that_is_none() {
        for study in [
            fixture::study(),
            Study::from(fixture::all_rejected()),
            Study::from(fixture::fit()),
        ] {
            let json = serde_json::to_value(study.figures_of(&study.lead)).unwrap();
            // serde_json writes a number that is not finite as null. Only these fields may be null.
            let mut nulls = Vec::new();
            find_nulls("", &json, &mut nulls);
            let nullable = [
                "/histories",
                "/populations",
                "/mean",
                "/reference",
                "/bounds",
                "/log_likelihood",
                "/at/x",
                "/at/y",
            ];
            nulls.retain(|path| !nullable.iter().any(|end| path.ends_with(end)));
            assert_eq!(nulls, Vec::<String>::new());
        }
    }

    fn find_nulls(path: &str, value: &serde_json::Value, found: &mut Vec<String>) {
        match value {
            serde_json::Value::Null => found.push(path.to_owned()),
            serde_json::Value::Array(items) => {
                items.iter().for_each(|item| find_nulls(path, item, found));
            }
            serde_json::Value::Object(fields) => {
                for (key, value) in fields {
                    find_nulls(&format!("{path}/{key}"), value, found);
                }
            }
            _ => {}
        }
    }
}
