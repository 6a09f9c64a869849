//! What the figures show, as numbers: the source paper's Fig. 5 to 8 of a study.
//!
//! Everything is in SI and carries its unit; the page draws it, and so can any other program.
//!
//! # Layout
//! - `convergence`: how the searches and the sampler came to their results (Fig. 5).
//! - `posterior`: joint densities of two parameters, with what else is known of them (Fig. 6).
//! - `history`: measurement and model over time (Fig. 7).
//! - `error`: how far off the model is over the posterior (Fig. 8).
//! - `mark`: single points in these pictures; `reference`: what an independent test says.

mod convergence;
mod error;
mod history;
mod mark;
mod posterior;
mod reference;

pub use convergence::{Populations, SearchConvergence, StageConvergence};
pub use error::ErrorDensity;
pub use history::{ChannelHistory, ModelSeries, Series};
pub use mark::{Mark, MarkKind, Place};
pub use posterior::{Line, Posterior};

use super::{FinishedCalibration, Study};
use job::FreeParameter;

/// What the figures of a study show.
#[derive(Debug, Clone, serde::Serialize, utoipa::ToSchema)]
pub struct Figures {
    /// Name of the experiment.
    pub experiment: String,
    /// How searches by generations came to their points.
    pub searches: Vec<SearchConvergence>,
    /// The stages of the sampler, from the prior on; empty without a sample.
    pub stages: Vec<StageConvergence>,
    /// The populations of some stages in two parameters; null without a sample, or of one parameter.
    pub populations: Option<Populations>,
    /// Joint posterior densities.
    pub posteriors: Vec<Posterior>,
    /// Measurement and model over time; null of a model that knows no time.
    pub histories: Option<Vec<ChannelHistory>>,
    /// Prediction errors over the posterior, by channel.
    pub errors: Vec<ErrorDensity>,
}

/// A parameter on an axis.
#[derive(Debug, Clone, PartialEq, serde::Serialize, utoipa::ToSchema)]
pub struct AxisParameter {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
}

impl From<&FreeParameter> for AxisParameter {
    fn from(parameter: &FreeParameter) -> Self {
        AxisParameter {
            name: parameter.name.clone(),
            unit: parameter.unit.clone(),
        }
    }
}

impl Figures {
    /// Whether there is nothing to show.
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
    /// What the figures show: of the first sample, and of what stands beside it.
    pub fn figures(&self) -> Figures {
        let sample = self.outcomes().find(|outcome| outcome.estimate.is_none());
        Figures {
            experiment: self.lead.experiment.clone(),
            searches: self.outcomes().filter_map(convergence::search).collect(),
            stages: sample.map(convergence::stages).unwrap_or_default(),
            populations: sample.and_then(convergence::populations),
            posteriors: sample.map(|s| posterior::all(self, s)).unwrap_or_default(),
            histories: history::all(self),
            errors: sample.map(|s| error::all(self, s)).unwrap_or_default(),
        }
    }

    /// The point estimates beside a sample, with their names for people: `GA optimum`.
    fn optima(&self) -> impl Iterator<Item = (String, &FinishedCalibration)> {
        let fitted = self.outcomes().filter(|outcome| outcome.estimate.is_some());
        fitted.map(|outcome| {
            let name = outcome.spec.method.name().to_uppercase();
            (format!("{name} optimum"), outcome)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::report::fixture;
    use super::*;

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
        let channels: Vec<&str> = figures.errors.iter().map(|e| e.channel.as_str()).collect();
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
            Study::from(fixture::all_refused()),
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
