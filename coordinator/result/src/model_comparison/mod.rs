//! Comparison of the models of a job: which is the most probable, which predicts best, and whether any of them explains the data.
//!
//! # Layout
//! - here: the comparison and its sentence.
//! - `left_out`: predictions of each condition from the others.

mod left_out;

use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

use crate::diagnostics::channels::chi_square;
use crate::diagnostics::posterior_draws;
use crate::finished_calibration::FinishedCalibration;
use crate::study::Study;
use crate::table::errors::ErrorTable;
use crate::table::row::rows_of;
use crate::words::number;
use crate::words::probability::{LEVEL, p_words, probability};
use left_out::LeftOut;
use shared::experiment::RunUse;

/// The comparison of the models of a job, with equal prior odds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct ModelComparison {
    /// The models, in the order of the job.
    pub models: Vec<ComparedModel>,
    /// Prior probability of each model.
    pub prior: f64,
    /// The calibration of the most probable model, with which the study continues.
    pub best: i64,
    /// The calibration of the model that predicts left-out data best; null if no model predicts any, or if the models predict different
    /// numbers of them.
    pub best_predicting: Option<i64>,
    /// Whether even the most probable model leaves residuals that its noise does not explain (chi-square, p < 0.01); null if all noise is
    /// inferred from the misfit.
    pub none_of_these: Option<bool>,
    /// The same in a sentence.
    pub text: String,
}

/// A model of the comparison.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct ComparedModel {
    /// Id of the model's calibration.
    pub calibration: i64,
    /// Kind of the model, with a number if another model has the same kind.
    pub name: String,
    /// Kind of the model.
    pub kind: String,
    /// Effects of the model.
    pub effects: Vec<String>,
    /// Log-evidence `[nats]`.
    pub log_evidence: Option<f64>,
    /// Standard error of the log-evidence.
    pub log_evidence_se: Option<f64>,
    /// Posterior probability among these models, from equal prior probabilities.
    pub probability: f64,
    /// Probability of a chi-square of the fitted data at least this large; null if no noise is known.
    pub chi_square_p: Option<f64>,
    /// Which data are left out for the predictive errors.
    pub left_out_by: LeftOutBy,
    /// Errors of the prediction of left-out data, by channel.
    pub left_out: Option<ErrorTable>,
    /// Sum of the log-densities of each condition's data given the other conditions; null if the draws cannot give it.
    pub log_predictive: Option<f64>,
}

/// Which data are left out to judge a model's predictions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum LeftOutBy {
    /// The holdout runs of the experiment.
    Holdout,
    /// One condition at a time, by weighting the draws.
    Condition,
}

impl Study {
    /// Compares the models of the job; `None` if it has only one model, or if one is not finished.
    pub fn model_comparison(&self) -> Option<ModelComparison> {
        let mut compared: Vec<&FinishedCalibration> = self.other_models.iter().chain([&self.lead]).collect();
        if self.models == 1 || compared.len() != self.models {
            return None;
        }
        compared.sort_by_key(|calibration| calibration.row.id);
        let sigmas = self.fixed_sigmas();
        let probabilities = probabilities(compared.iter().map(|calibration| calibration.row.log_evidence));
        let models = compared
            .iter()
            .zip(probabilities)
            .map(|(calibration, probability)| {
                let comparison = calibration.comparison();
                let left_out = LeftOut::new(calibration);
                let (by, errors) = match comparison.holdout {
                    Some(_) => (
                        LeftOutBy::Holdout,
                        ErrorTable::of_model(rows_of(&comparison.rows, RunUse::Holdout)),
                    ),
                    None => {
                        let rows = left_out.as_ref().map(|left_out| left_out.rows(&comparison.rows));
                        (
                            LeftOutBy::Condition,
                            rows.and_then(|rows| ErrorTable::of_model(rows.iter())),
                        )
                    }
                };
                let chi_square = chi_square(calibration, &posterior_draws(calibration), |_| true);
                ComparedModel {
                    calibration: calibration.row.id,
                    name: name(calibration, &compared),
                    kind: calibration.spec.model.kind.name().to_owned(),
                    effects: calibration.effects(),
                    log_evidence: calibration.row.log_evidence,
                    log_evidence_se: calibration.row.log_evidence_se,
                    probability,
                    chi_square_p: chi_square.and_then(|test| test.p),
                    left_out_by: by,
                    left_out: errors.map(|errors| errors.in_fixed_sigmas(&sigmas)),
                    log_predictive: left_out.map(|left_out| left_out.log_density),
                }
            });
        let models: Vec<ComparedModel> = models.collect();
        let best = models
            .iter()
            .find(|model| model.calibration == self.lead.row.id)?;
        let none_of_these = best.chi_square_p.map(|p| p < LEVEL);
        Some(ModelComparison {
            prior: 1.0 / models.len() as f64,
            best: best.calibration,
            best_predicting: best_predicting(&models).map(|model| model.calibration),
            none_of_these,
            text: text(&models, best, none_of_these),
            models,
        })
    }
}

/// Returns posterior probabilities from equal prior ones; a model without evidence has probability 0.
fn probabilities(log_evidences: impl Iterator<Item = Option<f64>> + Clone) -> Vec<f64> {
    let max = log_evidences.clone().flatten().fold(f64::NEG_INFINITY, f64::max);
    let weight = |log: Option<f64>| log.map_or(0.0, |log| libm::exp(log - max));
    let total: f64 = log_evidences.clone().map(weight).sum();
    log_evidences
        .map(|log| if total > 0.0 { weight(log) / total } else { 0.0 })
        .collect()
}

fn name(calibration: &FinishedCalibration, compared: &[&FinishedCalibration]) -> String {
    let kind = calibration.spec.model.kind;
    let mut same = compared.iter().filter(|other| other.spec.model.kind == kind);
    let number = same.clone().position(|other| other.row.id == calibration.row.id);
    match (same.nth(1), number) {
        (Some(_), Some(number)) => format!("{} {}", kind.name(), number + 1),
        _ => kind.name().to_owned(),
    }
}

/// Returns the model with the least error in noise standard deviations; `None` if the models predict different numbers of measurements,
/// because those that a model refuses are the hard ones.
fn best_predicting(models: &[ComparedModel]) -> Option<&ComparedModel> {
    let error = |model: &ComparedModel| model.left_out.as_ref()?.all.rmse_fixed_sigma;
    let mut unpredicted = models
        .iter()
        .filter_map(|model| Some(model.left_out.as_ref()?.all.unpredicted));
    let first = unpredicted.next()?;
    if unpredicted.any(|other| other != first) {
        return None;
    }
    let judged = models.iter().filter_map(|model| Some((model, error(model)?)));
    let best = judged.reduce(|best, model| if model.1 < best.1 { model } else { best })?;
    Some(best.0)
}

fn text(models: &[ComparedModel], best: &ComparedModel, none_of_these: Option<bool>) -> String {
    let log = |model: &ComparedModel| {
        number::or_none(model.log_evidence, |log| match model.log_evidence_se {
            Some(se) => number::with_spread(log, se),
            None => number::fixed(log, 1),
        })
    };
    let mut further: Vec<&ComparedModel> = models
        .iter()
        .filter(|m| m.calibration != best.calibration)
        .collect();
    further.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    let further: Vec<String> = further
        .iter()
        .map(|model| format!("{} {}", model.name, log(model)))
        .collect();
    let mut text = format!(
        "{} is the most probable of {} models, P {} from equal prior odds (ln evidence {}; {})",
        best.name,
        models.len(),
        match best.probability {
            p if p > 0.9995 => "> 0.999".to_owned(),
            p => probability(p),
        },
        log(best),
        further.join(", ")
    );
    let error = |model: &ComparedModel| {
        let sds = model
            .left_out
            .as_ref()
            .and_then(|errors| errors.all.rmse_fixed_sigma);
        number::or_none(sds, |sds| number::significant(sds, 2))
    };
    let data = match best.left_out_by {
        LeftOutBy::Holdout => "held-out runs",
        LeftOutBy::Condition => "each condition from the others",
    };
    match best_predicting(models) {
        Some(model) if model.calibration == best.calibration => {
            text += &format!("; it also predicts {data} best, {} times the noise", error(best));
        }
        Some(other) => {
            text += &format!(
                "; {} predicts {data} better, {} against {} times the noise",
                other.name,
                error(other),
                error(best)
            );
        }
        None => {}
    }
    text + &match (none_of_these, best.chi_square_p) {
        (Some(true), Some(p)) => format!(
            "; yet it is none of these: even {} leaves more than noise explains ({})",
            best.name,
            p_words(p)
        ),
        (Some(false), Some(p)) => format!("; noise explains what it leaves ({})", p_words(p)),
        _ => "; whether it is none of these cannot be said: no noise is declared".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture;

    /// Returns a study of two models, which differ in their evidence only.
    fn study(evidences: [f64; 2]) -> Study {
        let [mut lead, mut other] = [fixture::calibration(), fixture::calibration()];
        (lead.row.id, lead.row.log_evidence) = (2, Some(evidences[0]));
        (other.row.id, other.row.log_evidence) = (1, Some(evidences[1]));
        Study {
            models: 2,
            other_models: vec![other],
            ..Study::from(lead)
        }
    }

    #[test]
    fn probabilities_follow_from_the_evidences_and_sum_to_one() {
        let comparison = study([-10.0, -12.0]).model_comparison().unwrap();
        // The odds are e^2, so the probability is 1 / (1 + e^-2).
        let [first, second] = &comparison.models[..] else {
            panic!("two models")
        };
        assert!((second.probability - 0.880_797_077_977_882_4).abs() < 1e-12);
        assert!((first.probability + second.probability - 1.0).abs() < 1e-15);
        assert_eq!((comparison.best, comparison.prior), (2, 0.5));
        assert_eq!(
            (first.name.as_str(), second.name.as_str()),
            ("quasi_static 1", "quasi_static 2")
        );
        assert!(
            comparison
                .text
                .starts_with("quasi_static 2 is the most probable of 2 models, P 0.88")
        );
    }

    #[test]
    fn the_line_goes_on_with_the_most_probable() {
        let study = study([-10.0, -12.0]);
        assert_eq!(study.ledger().map(|line| line.row.id).collect::<Vec<_>>(), [2]);
    }

    #[test]
    fn a_job_with_one_model_and_one_that_is_not_finished_compare_nothing() {
        assert_eq!(fixture::study().model_comparison(), None);
        let unfinished = Study {
            models: 3,
            ..study([-10.0, -12.0])
        };
        assert_eq!(unfinished.model_comparison(), None);
    }

    #[test]
    fn a_model_that_refuses_more_does_not_predict_better() {
        let comparison = study([-10.0, -12.0]).model_comparison().unwrap();
        let mut models = comparison.models;
        for (model, sds) in models.iter_mut().zip([2.0, 1.0]) {
            let errors = model.left_out.as_mut().unwrap();
            errors.all.rmse_fixed_sigma = Some(sds);
        }
        assert_eq!(
            best_predicting(&models).unwrap().calibration,
            models[1].calibration
        );
        models[1].left_out.as_mut().unwrap().all.unpredicted += 3;
        assert!(best_predicting(&models).is_none());
    }

    #[test]
    fn a_misfit_beyond_the_noise_is_none_of_these() {
        let comparison = study([-10.0, -12.0]).model_comparison().unwrap();
        let worse = |p| {
            let mut models = comparison.models.clone();
            models[1].chi_square_p = p;
            text(&models, &models[1], p.map(|p| p < LEVEL))
        };
        assert!(worse(Some(1e-5)).contains("none of these: even quasi_static 2"));
        assert!(worse(Some(0.3)).contains("noise explains what it leaves (p = 0.30)"));
        assert!(worse(None).contains("cannot be said"));
    }
}
