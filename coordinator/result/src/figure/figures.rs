//! All figures of a study.

use super::convergence::{self, Populations, SearchConvergence, StageConvergence};
use super::error::{self, ErrorDensity};
use super::history::{self, ChannelHistory};
use super::posterior::{self, JointPosterior};
use crate::study::Study;

/// The numbers of a study's figures.
#[derive(Debug, Clone, serde::Serialize, utoipa::ToSchema)]
pub struct StudyFigures {
    /// Name of the experiment.
    pub experiment: String,
    /// Convergence of the searches by generations.
    pub searches: Vec<SearchConvergence>,
    /// The stages of the sampler, from the prior on; empty without a sample.
    pub stages: Vec<StageConvergence>,
    /// The populations of some stages in two parameters; null without a sample, or of one parameter.
    pub populations: Option<Populations>,
    /// Joint posterior densities.
    pub posteriors: Vec<JointPosterior>,
    /// Measurement and model over time; null of a model without time.
    pub histories: Option<Vec<ChannelHistory>>,
    /// Prediction errors over the posterior, by channel.
    pub errors: Vec<ErrorDensity>,
}

impl StudyFigures {
    /// Whether there is no figure.
    pub fn is_empty(&self) -> bool {
        // populations stand beside stages
        self.searches.is_empty()
            && self.stages.is_empty()
            && self.posteriors.is_empty()
            && self.histories.is_none()
            && self.errors.is_empty()
    }
}

impl Study {
    /// The figures of the first sample and of its point estimates.
    pub fn figures(&self) -> StudyFigures {
        let sample = self
            .submitted()
            .find(|calibration| calibration.estimate.is_none());
        StudyFigures {
            experiment: self.lead.experiment.clone(),
            searches: self.submitted().filter_map(convergence::search).collect(),
            stages: sample.map(convergence::stages).unwrap_or_default(),
            populations: sample.and_then(convergence::populations),
            posteriors: sample.map(|s| posterior::all(self, s)).unwrap_or_default(),
            histories: history::all(self),
            errors: sample.map(|s| error::all(self, s)).unwrap_or_default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    #[test]
    fn a_study_has_every_figure_that_its_calibrations_allow() {
        let figures = fixture::study().figures();
        assert_eq!(figures.searches.len(), 1);
        assert_eq!(figures.stages.len(), 4);
        assert!(figures.populations.is_some());
        let pairs: Vec<[&str; 2]> = figures
            .posteriors
            .iter()
            .map(|p| [p.parameters[0].name.as_str(), p.parameters[1].name.as_str()])
            .collect();
        assert_eq!(pairs[0], ["n", "friction_angle_deg"]);
        let channels: Vec<&str> = figures.errors.iter().map(|e| e.channel.name()).collect();
        assert_eq!(channels, ["drawbar_pull", "sinkage"]);
        assert!(figures.histories.is_none() && !figures.is_empty());
        assert!(Study::from(fixture::fit()).figures().is_empty());
    }

    #[test]
    fn a_fit_alone_has_no_densities() {
        let figures = Study::from(fixture::search()).figures();
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
            let json = serde_json::to_value(study.figures()).unwrap();
            // serde_json writes null where a number is none: only these may be null.
            let mut nulls = Vec::new();
            find_nulls("", &json, &mut nulls);
            let known = [
                "/histories",
                "/populations",
                "/mean",
                "/log_likelihood",
                "/at/x",
                "/at/y",
            ];
            nulls.retain(|path| !known.iter().any(|k| path.ends_with(k)));
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
