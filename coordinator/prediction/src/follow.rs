//! What further runs change: the answer to a campaign that is followed.

use inference::{UpdateMethod, UpdatedPosterior};
use job::Spec;
use record::{NextRun, Verdict};
use serde::{Deserialize, Serialize};
use shared::api::{SearchLeader, SearchProgress};
use utoipa::ToSchema;

use crate::spread::{interval, mean, variance};
use crate::surprise::Expectation;

/// A campaign with further runs that are not stored.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Followed {
    /// Id of the calibration that is followed.
    pub calibration: i64,
    /// Names of the further runs.
    pub runs: Vec<String>,
    /// The further rows as they were sent, with their header.
    pub rows: String,
    /// Their measurements beside what the runs before them made probable.
    pub expectations: Vec<Expectation>,
    /// The models of the study with all runs, that of the calibration first.
    pub models: Vec<FollowedModel>,
    /// The parameters of the calibration with all runs; empty if it must be calibrated again.
    pub parameters: Vec<FollowedParameter>,
    /// What a search of the calibration's model finds in all runs, as a sentence.
    pub verdict: String,
    /// How far the search went.
    pub search: FollowedSearch,
    /// The runs to make next, the most informative first.
    pub next_runs: Vec<NextRun>,
    /// Why no further run is needed or would help; null while one does.
    pub stop: Option<String>,
}

/// How far the search in all runs went.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct FollowedSearch {
    /// Number of evaluations that it took.
    pub evaluations: usize,
    /// The largest number that it may take.
    pub max_evaluations: usize,
    /// Whether the next step would have taken more, so that there is no verdict.
    pub is_at_bound: bool,
    /// The most probable explanations where it was ended at its bound; else empty.
    pub leaders: Vec<SearchLeader>,
}

/// A model of the study with all runs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct FollowedModel {
    /// Id of the model's calibration.
    pub calibration: i64,
    /// Kind of the model, with its effects.
    pub name: String,
    /// Its posterior probability among the models before the further runs, from equal prior probabilities.
    pub weight_before: f64,
    /// The same with all runs; null if a model must be calibrated again.
    pub weight: Option<f64>,
    /// Log-evidence of all runs; null if it must be calibrated again.
    pub log_evidence: Option<f64>,
    /// `reweighted`, `drawn`, or `calibrate again`: too few draws of the posterior so far agree with all runs.
    pub method: String,
    /// Number of independent draws that the posterior is worth.
    pub ess: Option<f64>,
}

/// A parameter with all runs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct FollowedParameter {
    /// Name.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Posterior mean.
    pub mean: f64,
    /// Posterior standard deviation.
    pub sd: f64,
    /// 90 % interval.
    pub interval: [f64; 2],
}

impl FollowedModel {
    /// States how a posterior was updated; weights follow when all models are.
    pub fn new(
        calibration: i64,
        name: String,
        weight_before: f64,
        updated: Option<&UpdatedPosterior>,
    ) -> Self {
        let method = match updated.map(|updated| updated.method) {
            Some(UpdateMethod::Reweighted) => "reweighted",
            Some(UpdateMethod::Drawn(_)) => "drawn",
            None => "calibrate again",
        };
        FollowedModel {
            calibration,
            name,
            weight_before,
            weight: None,
            log_evidence: updated.map(|updated| updated.log_evidence),
            method: method.to_owned(),
            ess: updated.map(|updated| updated.ess),
        }
    }
}

/// Sets the weights of models from their evidences, if each has one.
pub fn weigh(models: &mut [FollowedModel]) {
    let logs: Option<Vec<f64>> = models.iter().map(|model| model.log_evidence).collect();
    let Some(logs) = logs else {
        return;
    };
    let max = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let total: f64 = logs.iter().map(|log| libm::exp(log - max)).sum();
    for (model, log) in models.iter_mut().zip(logs) {
        model.weight = Some(libm::exp(log - max) / total);
    }
}

/// Returns the parameters of an updated posterior.
pub fn parameters(spec: &Spec, updated: &UpdatedPosterior) -> Vec<FollowedParameter> {
    let of = |(position, parameter): (usize, &job::FreeParameter)| {
        let draws = updated.draws.iter().zip(&updated.weights);
        let values: Vec<(f64, f64)> = draws
            .map(|(draw, weight)| (draw.theta[position], *weight))
            .collect();
        Some(FollowedParameter {
            name: parameter.name.clone(),
            unit: parameter.unit.clone(),
            mean: mean(&values)?,
            sd: variance(&values)?.sqrt(),
            interval: interval(&values)?,
        })
    };
    spec.parameters.iter().enumerate().filter_map(of).collect()
}

/// Returns why a campaign may stop; `None` while a run helps.
///
/// Checked by `tests::a_campaign_stops_when_it_is_settled_or_no_run_helps`.
pub fn stop(verdict: Verdict, next_runs: &[NextRun]) -> Option<String> {
    match verdict {
        Verdict::Named => Some("the matter is settled: what is missing is named".into()),
        Verdict::NotInLibrary => Some(
            "a law outside the catalogue is missing, and its quantity and variable are known".into(),
        ),
        Verdict::Class if next_runs.is_empty() => Some(
            "something of a class of effects is missing, and no run that the rig could make would tell its effects apart".into(),
        ),
        Verdict::NothingDetectable if next_runs.is_empty() => Some(
            "these data show nothing missing, and no explanation is left that a run could separate".into(),
        ),
        Verdict::Undecided if next_runs.is_empty() => {
            Some("no run that the rig could make would tell the explanations apart".into())
        }
        Verdict::NothingDetectable | Verdict::Class | Verdict::Undecided => None,
    }
}

/// Returns the sentence in the place of a verdict where a search was ended at its bound.
///
/// Checked by `tests::a_search_that_was_ended_says_its_bound_and_what_leads`.
pub fn unfinished(max_evaluations: usize, progress: &SearchProgress) -> String {
    let leader = progress.leaders.first().map_or_else(String::new, |leader| {
        let name = match leader.effects.as_slice() {
            [] => "nothing is missing".to_owned(),
            effects => effects.join(" with "),
        };
        format!(
            "; the most probable of what it fitted: {name} (P {:.2})",
            leader.probability
        )
    });
    format!(
        "not known: the search was ended at its bound of {max_evaluations} evaluations, where it {}{leader}",
        progress.doing
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run() -> NextRun {
        NextRun {
            slip: 0.2,
            wheel_load_n: 60.0,
            sled_speed_m_s: 0.02,
            separates: Vec::new(),
            information_nats: 0.3,
            settles: Some(0.5),
        }
    }

    #[test]
    fn a_campaign_stops_when_it_is_settled_or_no_run_helps() {
        assert!(stop(Verdict::Named, &[run()]).unwrap().contains("settled"));
        assert!(stop(Verdict::Undecided, &[]).unwrap().contains("no run"));
        assert_eq!(stop(Verdict::Undecided, &[run()]), None);
        // A run may tell the effects of a class apart.
        assert_eq!(stop(Verdict::Class, &[run()]), None);
        let class = stop(Verdict::Class, &[]).unwrap();
        assert!(class.contains("class") && !class.contains("named"), "{class}");
        let law = stop(Verdict::NotInLibrary, &[run()]).unwrap();
        assert!(law.contains("law outside the catalogue"), "{law}");
    }

    #[test]
    fn a_search_that_was_ended_says_its_bound_and_what_leads() {
        let progress = SearchProgress {
            doing: "tries each effect alone".into(),
            leaders: vec![SearchLeader {
                effects: vec!["slip_sinkage".into()],
                probability: 0.9,
            }],
        };
        let text = unfinished(100, &progress);
        assert!(
            text.contains("bound of 100 evaluations, where it tries each effect alone")
                && text.ends_with("slip_sinkage (P 0.90)"),
            "{text}"
        );
        let nothing = SearchProgress {
            leaders: Vec::new(),
            ..progress
        };
        assert!(unfinished(100, &nothing).ends_with("alone"));
    }

    #[test]
    fn weights_follow_from_evidences_if_all_models_have_one() {
        let model = |log_evidence| FollowedModel {
            log_evidence,
            ..FollowedModel::new(1, "m".into(), 0.5, None)
        };
        let mut models = vec![model(Some(-1000.0)), model(Some(-1000.0 + libm::log(3.0)))];
        weigh(&mut models);
        assert!((models[1].weight.unwrap() - 0.75).abs() < 1e-12);
        models.push(model(None));
        models.iter_mut().for_each(|model| model.weight = None);
        weigh(&mut models);
        assert_eq!(models[0].weight, None);
    }
}
