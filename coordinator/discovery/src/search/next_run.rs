//! The runs to make next: those that together tell most about the explanations.

use crate::laplace::fit::LaplaceFit;
use crate::laplace::spread::{Axis, spread};
use crate::search::query::{QueriedModel, Query};
use crate::search::run_information::{Prediction, Predictive};
use crate::task::{ProposedRuns, SearchTask};

/// Most runs that are proposed.
const MOST: usize = 3;
/// A run that adds less information is not proposed \[nats\].
const LEAST: f64 = 0.005;
/// Of runs that add nearly as much as the best, the one closest to the measured range is proposed.
const NEARLY: f64 = 0.9;

/// An explanation that remains open.
#[derive(Debug, Clone)]
pub(super) struct OpenHypothesis<'a> {
    /// Its effects beyond the base.
    pub(super) effects: Vec<usize>,
    pub(super) probability: f64,
    pub(super) fit: &'a LaplaceFit,
}

/// A run that would distinguish the explanations.
#[derive(Debug, Clone, PartialEq)]
pub struct InformativeRun {
    /// Index among the proposed runs.
    pub run: usize,
    /// Expected information on the explanations beyond that of the runs before it \[nats\].
    pub information_nats: f64,
    /// The most probable explanation and those that the run distinguishes from it: combinations of candidates, empty for the base.
    pub separates: Vec<Vec<usize>>,
}

/// The runs to make next, and what every run would tell.
#[derive(Debug, Clone, Default)]
pub(super) struct RunChoice {
    pub(super) runs: Vec<InformativeRun>,
    /// Index of each proposed run with its information by itself \[nats\].
    pub(super) alone: Vec<(usize, f64)>,
}

/// An explanation with the parameters at which it is asked for its predictions.
#[derive(Debug, Clone)]
struct AskedHypothesis {
    effects: Vec<usize>,
    probability: f64,
    /// `None` once it is told.
    mode: Option<Vec<f64>>,
    /// Whether the companion is asked for the spread: at first, where there is one.
    has_companion: bool,
    /// What the spread is compared with: the prediction of the companion at the mode where that is asked, and of the model elsewhere.
    middle: Option<Vec<f64>>,
    /// Those that are not told yet.
    spread: Vec<Axis>,
    /// `None` before it is told, and where the model rejects the mode.
    prediction: Option<Prediction>,
}

/// The comparison of the explanations on the proposed runs.
#[derive(Debug, Clone)]
pub(super) struct RunSelection {
    asked: Vec<AskedHypothesis>,
    proposed: ProposedRuns,
    seed: u64,
}

impl AskedHypothesis {
    /// The parameters to evaluate, each with whether it is the companion that is asked.
    fn thetas(&self) -> impl Iterator<Item = (bool, &Vec<f64>)> {
        let sides = self.spread.iter().flat_map(|axis| axis.sides.iter().flatten());
        let middle = self.mode.iter().filter(|_| self.has_companion);
        let spread = middle.chain(sides);
        let of_model = self.mode.iter().map(|theta| (false, theta));
        of_model.chain(spread.map(|theta| (self.has_companion, theta)))
    }

    /// Takes the answers to [`thetas`](Self::thetas). Along an axis with one answer its difference from the mode counts; along one
    /// without any the spare side is asked next, and without that nothing counts.
    fn take(&mut self, mut answers: impl Iterator<Item = Option<Vec<f64>>>) {
        if self.mode.take().is_some() {
            self.prediction = answers.next().flatten().map(|mean| Prediction {
                mean,
                columns: Vec::new(),
            });
            self.middle = if self.has_companion {
                answers.next().flatten()
            } else {
                self.prediction.as_ref().map(|own| own.mean.clone())
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
            let told = axis
                .sides
                .each_ref()
                .map(|side| side.as_ref().and_then(|_| answers.next().flatten()));
            let column = match (told, &self.middle) {
                ([Some(above), Some(below)], _) => Some(half_difference(&above, &below, 0.5)),
                ([Some(one), None] | [None, Some(one)], Some(middle)) => {
                    Some(half_difference(&one, middle, 1.0))
                }
                _ => None,
            };
            match column {
                Some(column) => prediction.columns.push(column),
                None if self.has_companion => self.spread.push(axis.one_sided()),
                None => self.spread.extend(axis.spare.map(|spare| Axis {
                    sides: [None, Some(spare)],
                    spare: None,
                })),
            }
        }
        // What the companion did not answer the model is asked.
        self.has_companion = false;
        self.middle = Some(prediction.mean.clone());
    }
}

impl RunSelection {
    /// `None` with fewer than two explanations or without proposed runs.
    pub(super) fn new(task: &SearchTask, explanations: Vec<OpenHypothesis>) -> Option<Self> {
        if explanations.len() < 2 || task.proposed.values() == 0 {
            return None;
        }
        let asked = explanations.into_iter().map(|explanation| AskedHypothesis {
            effects: explanation.effects,
            probability: explanation.probability,
            mode: Some(explanation.fit.theta()),
            has_companion: explanation.fit.frame.has_companion,
            middle: None,
            spread: spread(explanation.fit, &task.likelihood),
            prediction: None,
        });
        Some(Self {
            asked: asked.collect(),
            proposed: task.proposed.clone(),
            seed: task.settings.seed,
        })
    }

    pub(super) fn queries(&self) -> Vec<Query> {
        let of = |asked: &AskedHypothesis| {
            let model = QueriedModel::With(asked.effects.clone());
            let queries = asked.thetas().map(|(is_companion, theta)| Query {
                model: model.clone(),
                is_proposed: true,
                is_companion,
                theta: theta.clone(),
            });
            queries.collect::<Vec<_>>()
        };
        self.asked.iter().flat_map(of).collect()
    }

    pub(super) fn take(&mut self, answers: Vec<Option<Vec<f64>>>) {
        let mut answers = answers.into_iter();
        for asked in &mut self.asked {
            let count = asked.thetas().count();
            let own: Vec<_> = answers.by_ref().take(count).collect();
            asked.take(own.into_iter());
        }
    }

    /// The most informative runs, each given those before it: the first tells most by itself, the next one most beyond the first.
    pub(super) fn best(&self) -> RunChoice {
        let predicted = self
            .asked
            .iter()
            .filter_map(|own| Some((own, own.prediction.as_ref()?)));
        let (asked, predictions): (Vec<&AskedHypothesis>, Vec<_>) = predicted
            .map(|(own, prediction)| (own, (own.probability, prediction)))
            .unzip();
        if asked.len() < 2 {
            return RunChoice::default();
        }
        let predictive = Predictive::new(predictions, &self.proposed.noise_sds, MOST, self.seed);
        let mut runs: Vec<InformativeRun> = Vec::new();
        let mut alone = Vec::new();
        let mut known = 0.0;
        while runs.len() < MOST {
            let chosen: Vec<usize> = runs.iter().map(|run| run.run).collect();
            let gain = |run: usize| {
                let together: Vec<usize> = chosen.iter().copied().chain([run]).collect();
                Some((run, predictive.information(&together)? - known))
            };
            let left = (0..self.proposed.runs).filter(|run| !chosen.contains(run));
            let gains: Vec<(usize, f64)> = left.filter_map(gain).collect();
            if runs.is_empty() {
                alone.clone_from(&gains);
            }
            let most = gains.iter().map(|(_, gain)| *gain).fold(0.0, f64::max);
            if most < LEAST {
                break;
            }
            let nearly = gains.into_iter().filter(|(_, gain)| *gain >= NEARLY * most);
            let beyond = |run: usize| self.proposed.beyond[run];
            let closest = nearly.reduce(|a, b| {
                let order = beyond(b.0).total_cmp(&beyond(a.0)).then(a.1.total_cmp(&b.1));
                if order.is_lt() { b } else { a }
            });
            let Some((run, gain)) = closest else { break };
            known += gain;
            let separated = predictive.separated(run).into_iter();
            runs.push(InformativeRun {
                run,
                information_nats: gain,
                separates: separated.map(|k| asked[k].effects.clone()).collect(),
            });
        }
        RunChoice { runs, alone }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn asked(sides: [Option<f64>; 2], spare: Option<f64>) -> AskedHypothesis {
        let theta = |t: Option<f64>| t.map(|t| vec![t]);
        AskedHypothesis {
            effects: Vec::new(),
            probability: 0.5,
            mode: Some(vec![0.0]),
            has_companion: false,
            middle: None,
            spread: vec![Axis {
                sides: sides.map(theta),
                spare: theta(spare),
            }],
            prediction: None,
        }
    }

    /// Answers with the parameter until nothing is asked; the model rejects what lies above 0.
    fn columns(mut asked: AskedHypothesis) -> Vec<Vec<f64>> {
        while asked.thetas().next().is_some() {
            let answers = asked.thetas().map(|(_, t)| (t[0] <= 0.0).then(|| t.clone()));
            let answers: Vec<_> = answers.collect();
            asked.take(answers.into_iter());
        }
        asked.prediction.unwrap().columns
    }

    #[test]
    fn where_the_model_rejects_the_side_that_is_asked_the_other_one_is_asked() {
        assert_eq!(columns(asked([Some(1.0), None], Some(-1.0))), [[-1.0]]);
        assert_eq!(columns(asked([Some(1.0), Some(-1.0)], None)), [[-1.0]]);
        assert!(columns(asked([Some(1.0), None], None)).is_empty());
    }

    #[test]
    fn the_spread_is_that_of_the_companion_about_the_prediction_of_the_model() {
        let mut asked = AskedHypothesis {
            has_companion: true,
            ..asked([Some(0.5), None], None)
        };
        let answers: Vec<_> = asked
            .thetas()
            .map(|(is_companion, theta)| Some(vec![if is_companion { 3.0 * theta[0] } else { 7.0 }]))
            .collect();
        asked.take(answers.into_iter());
        let prediction = asked.prediction.expect("the mode is answered");
        assert_eq!(
            (prediction.mean, prediction.columns),
            (vec![7.0], vec![vec![1.5]])
        );
    }
}
