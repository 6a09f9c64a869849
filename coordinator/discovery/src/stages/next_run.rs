//! The choice of the runs to make next (step 13): those that together discriminate best between the explanations.

use crate::laplace::fit::LaplaceFit;
use crate::laplace::spread::{Axis, spread};
use crate::stages::query::{QueriedModel, Query};
use crate::stages::run_information::{Prediction, Predictive};
use crate::task::{ProposedRuns, SearchTask};

/// Maximum number of proposed runs.
const MAX_RUNS: usize = 3;
/// A run that adds less information is not proposed \[nats\].
const MIN_INFORMATION: f64 = 0.005;
/// Among runs that add at least this share of the largest information, the one closest to the measured range is proposed.
const NEARLY: f64 = 0.9;

/// An explanation that remains open.
#[derive(Debug, Clone)]
pub(super) struct OpenHypothesis<'a> {
    /// The effects added to the base.
    pub(super) effects: Vec<usize>,
    pub(super) probability: f64,
    pub(super) fit: &'a LaplaceFit,
}

/// A run that would distinguish the explanations.
#[derive(Debug, Clone, PartialEq)]
pub struct InformativeRun {
    /// Index among the proposed runs.
    pub run: usize,
    /// Expected information on the explanations in addition to that of the runs before it \[nats\].
    pub information_nats: f64,
    /// Probability that the run, made alone, raises one of the explanations above 0.9.
    pub settles: f64,
    /// The most probable explanation and those that the run distinguishes from it: combinations of candidates, empty for the base.
    pub separates: Vec<Vec<usize>>,
}

/// The runs to make next, and the information of every run.
#[derive(Debug, Clone, Default)]
pub(super) struct RunChoice {
    pub(super) runs: Vec<InformativeRun>,
    /// Index of each proposed run with its information when made alone \[nats\].
    pub(super) alone: Vec<(usize, f64)>,
}

/// An explanation with the parameters at which its predictions are evaluated.
#[derive(Debug, Clone)]
struct QueriedHypothesis {
    effects: Vec<usize>,
    probability: f64,
    /// The parameters of the mode; `None` once their prediction has arrived.
    mode: Option<Vec<f64>>,
    /// Whether the low-fidelity model is asked for the spread, before the model.
    asks_low_fidelity: bool,
    /// The prediction that the spread is compared with: that of the low-fidelity model at the mode if it is asked, otherwise of
    /// the model.
    middle: Option<Vec<f64>>,
    /// The axes that are not answered yet.
    spread: Vec<Axis>,
    /// `None` before it is answered, and if the model rejects the mode.
    prediction: Option<Prediction>,
}

/// The comparison of the explanations on the proposed runs.
#[derive(Debug, Clone)]
pub(super) struct RunSelection {
    hypotheses: Vec<QueriedHypothesis>,
    proposed: ProposedRuns,
    seed: u64,
}

impl QueriedHypothesis {
    /// Returns the parameters to evaluate, each with whether the low-fidelity model is asked.
    fn thetas(&self) -> impl Iterator<Item = (bool, &Vec<f64>)> {
        let sides = self.spread.iter().flat_map(|axis| axis.sides.iter().flatten());
        let middle = self.mode.iter().filter(|_| self.asks_low_fidelity);
        let spread = middle.chain(sides);
        let of_model = self.mode.iter().map(|theta| (false, theta));
        of_model.chain(spread.map(|theta| (self.asks_low_fidelity, theta)))
    }

    /// Takes the answers to [`thetas`](Self::thetas). Along an axis with one answer, its difference from the mode counts. Along an
    /// axis without an answer the spare side is asked next; if that is rejected too, the axis is left out.
    fn take(&mut self, mut answers: impl Iterator<Item = Option<Vec<f64>>>) {
        if self.mode.take().is_some() {
            self.prediction = answers.next().flatten().map(|mean| Prediction {
                mean,
                columns: Vec::new(),
            });
            self.middle = if self.asks_low_fidelity {
                answers.next().flatten()
            } else {
                self.prediction.as_ref().map(|prediction| prediction.mean.clone())
            };
        }
        let axes = std::mem::take(&mut self.spread);
        let Some(prediction) = &mut self.prediction else {
            return;
        };
        let half_difference = |a: &[f64], b: &[f64], share: f64| -> Vec<f64> {
            a.iter().zip(b).map(|(a, b)| share * (a - b)).collect()
        };
        for axis in axes {
            let answered = axis
                .sides
                .each_ref()
                .map(|side| side.as_ref().and_then(|_| answers.next().flatten()));
            let column = match (answered, &self.middle) {
                ([Some(above), Some(below)], _) => Some(half_difference(&above, &below, 0.5)),
                ([Some(one), None] | [None, Some(one)], Some(middle)) => {
                    Some(half_difference(&one, middle, 1.0))
                }
                _ => None,
            };
            match column {
                Some(column) => prediction.columns.push(column),
                None if self.asks_low_fidelity => self.spread.push(axis.one_sided()),
                None => self.spread.extend(axis.spare.map(|spare| Axis {
                    sides: [None, Some(spare)],
                    spare: None,
                })),
            }
        }
        // Ask the model for the points that the low-fidelity model rejected.
        self.asks_low_fidelity = false;
        self.middle = Some(prediction.mean.clone());
    }
}

impl RunSelection {
    /// Prepares the comparison; `None` if there are fewer than two explanations or no proposed runs.
    pub(super) fn new(task: &SearchTask, explanations: Vec<OpenHypothesis>) -> Option<Self> {
        if explanations.len() < 2 || task.proposed.values() == 0 {
            return None;
        }
        let hypotheses = explanations.into_iter().map(|explanation| QueriedHypothesis {
            effects: explanation.effects,
            probability: explanation.probability,
            mode: Some(explanation.fit.theta()),
            asks_low_fidelity: explanation.fit.frame.has_low_fidelity,
            middle: None,
            spread: spread(explanation.fit, &task.likelihood),
            prediction: None,
        });
        Some(Self {
            hypotheses: hypotheses.collect(),
            proposed: task.proposed.clone(),
            seed: task.settings.seed,
        })
    }

    /// Returns the queries of the next round; none once every explanation has its prediction.
    pub(super) fn queries(&self) -> Vec<Query> {
        let queries_of = |hypothesis: &QueriedHypothesis| {
            let model = QueriedModel::With(hypothesis.effects.clone());
            let queries = hypothesis.thetas().map(|(is_low_fidelity, theta)| Query {
                model: model.clone(),
                is_proposed: true,
                is_low_fidelity,
                theta: theta.clone(),
            });
            queries.collect::<Vec<_>>()
        };
        self.hypotheses.iter().flat_map(queries_of).collect()
    }

    /// Takes the answers to [`queries`](Self::queries), in their order.
    pub(super) fn take(&mut self, answers: Vec<Option<Vec<f64>>>) {
        let mut answers = answers.into_iter();
        for hypothesis in &mut self.hypotheses {
            let count = hypothesis.thetas().count();
            let part: Vec<_> = answers.by_ref().take(count).collect();
            hypothesis.take(part.into_iter());
        }
    }

    /// Returns the most informative runs: the first has the most information alone, each further one adds the most to those
    /// before it.
    pub(super) fn best(&self) -> RunChoice {
        let predicted = self
            .hypotheses
            .iter()
            .filter_map(|hypothesis| Some((hypothesis, hypothesis.prediction.as_ref()?)));
        let (hypotheses, predictions): (Vec<&QueriedHypothesis>, Vec<_>) = predicted
            .map(|(hypothesis, prediction)| (hypothesis, (hypothesis.probability, prediction)))
            .unzip();
        if hypotheses.len() < 2 {
            return RunChoice::default();
        }
        let predictive = Predictive::new(predictions, &self.proposed.noise_sds, MAX_RUNS, self.seed);
        let mut runs: Vec<InformativeRun> = Vec::new();
        let mut alone = Vec::new();
        let mut total = 0.0;
        while runs.len() < MAX_RUNS {
            let chosen: Vec<usize> = runs.iter().map(|run| run.run).collect();
            let gain = |run: usize| {
                let together: Vec<usize> = chosen.iter().copied().chain([run]).collect();
                Some((run, predictive.information(&together)? - total))
            };
            let left = (0..self.proposed.runs).filter(|run| !chosen.contains(run));
            let gains: Vec<(usize, f64)> = left.filter_map(gain).collect();
            if runs.is_empty() {
                alone.clone_from(&gains);
            }
            let highest = gains.iter().map(|(_, gain)| *gain).fold(0.0, f64::max);
            if highest < MIN_INFORMATION {
                break;
            }
            let nearly = gains.into_iter().filter(|(_, gain)| *gain >= NEARLY * highest);
            let beyond = |run: usize| self.proposed.beyond[run];
            let closest = nearly.reduce(|a, b| {
                let order = beyond(b.0).total_cmp(&beyond(a.0)).then(a.1.total_cmp(&b.1));
                if order.is_lt() { b } else { a }
            });
            let Some((run, gain)) = closest else { break };
            total += gain;
            let separated = predictive.separated(run).into_iter();
            runs.push(InformativeRun {
                run,
                information_nats: gain,
                settles: predictive.settles(run),
                separates: separated.map(|k| hypotheses[k].effects.clone()).collect(),
            });
        }
        RunChoice { runs, alone }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hypothesis(sides: [Option<f64>; 2], spare: Option<f64>) -> QueriedHypothesis {
        let theta = |t: Option<f64>| t.map(|t| vec![t]);
        QueriedHypothesis {
            effects: Vec::new(),
            probability: 0.5,
            mode: Some(vec![0.0]),
            asks_low_fidelity: false,
            middle: None,
            spread: vec![Axis {
                sides: sides.map(theta),
                spare: theta(spare),
            }],
            prediction: None,
        }
    }

    /// Answers with the parameter until nothing is asked; the model rejects what lies above 0.
    fn columns(mut hypothesis: QueriedHypothesis) -> Vec<Vec<f64>> {
        while hypothesis.thetas().next().is_some() {
            let answers = hypothesis.thetas().map(|(_, t)| (t[0] <= 0.0).then(|| t.clone()));
            let answers: Vec<_> = answers.collect();
            hypothesis.take(answers.into_iter());
        }
        hypothesis.prediction.unwrap().columns
    }

    #[test]
    fn where_the_model_rejects_the_side_that_is_asked_the_other_one_is_asked() {
        assert_eq!(columns(hypothesis([Some(1.0), None], Some(-1.0))), [[-1.0]]);
        assert_eq!(columns(hypothesis([Some(1.0), Some(-1.0)], None)), [[-1.0]]);
        assert!(columns(hypothesis([Some(1.0), None], None)).is_empty());
    }

    #[test]
    fn the_spread_is_that_of_the_low_fidelity_model_about_the_prediction_of_the_model() {
        let mut hypothesis = QueriedHypothesis {
            asks_low_fidelity: true,
            ..hypothesis([Some(0.5), None], None)
        };
        let answers: Vec<_> = hypothesis
            .thetas()
            .map(|(is_low_fidelity, theta)| Some(vec![if is_low_fidelity { 3.0 * theta[0] } else { 7.0 }]))
            .collect();
        hypothesis.take(answers.into_iter());
        let prediction = hypothesis.prediction.expect("the mode is answered");
        assert_eq!(
            (prediction.mean, prediction.columns),
            (vec![7.0], vec![vec![1.5]])
        );
    }
}
