//! The runs to make next: those that together tell most about the explanations.

use crate::laplace::fit::LaplaceFit;
use crate::laplace::spread::spread;
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
    mode: Vec<f64>,
    spread: Vec<[Option<Vec<f64>>; 2]>,
    /// `None` before it is told, and where the model rejects the mode.
    prediction: Option<Prediction>,
}

/// The comparison of the explanations on the proposed runs.
#[derive(Debug, Clone)]
pub(super) struct RunSelection {
    asked: Vec<AskedHypothesis>,
    proposed: ProposedRuns,
    seed: u64,
    is_told: bool,
}

impl AskedHypothesis {
    fn thetas(&self) -> impl Iterator<Item = &Vec<f64>> {
        std::iter::once(&self.mode).chain(self.spread.iter().flatten().flatten())
    }

    /// Takes the answers to [`thetas`](Self::thetas). Along an axis with one answer its difference from the mode counts, along one
    /// without any nothing.
    fn take(&mut self, mut answers: impl Iterator<Item = Option<Vec<f64>>>) {
        let mean = answers.next().flatten();
        let mut columns = Vec::new();
        for sides in &self.spread {
            let [above, below] = sides
                .each_ref()
                .map(|side| side.as_ref().and_then(|_| answers.next().flatten()));
            let half_difference = |a: &[f64], b: &[f64], share: f64| -> Vec<f64> {
                a.iter().zip(b).map(|(a, b)| share * (a - b)).collect()
            };
            columns.extend(match (above, below, &mean) {
                (Some(above), Some(below), _) => Some(half_difference(&above, &below, 0.5)),
                (Some(one), None, Some(mean)) | (None, Some(one), Some(mean)) => {
                    Some(half_difference(&one, mean, 1.0))
                }
                _ => None,
            });
        }
        self.prediction = mean.map(|mean| Prediction { mean, columns });
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
            mode: explanation.fit.theta(),
            spread: spread(explanation.fit, &task.likelihood),
            prediction: None,
        });
        Some(Self {
            asked: asked.collect(),
            proposed: task.proposed.clone(),
            seed: task.settings.seed,
            is_told: false,
        })
    }

    pub(super) fn queries(&self) -> Vec<Query> {
        if self.is_told {
            return Vec::new();
        }
        let of = |asked: &AskedHypothesis| {
            let model = QueriedModel::With(asked.effects.clone());
            let queries = asked.thetas().map(|theta| Query {
                model: model.clone(),
                is_proposed: true,
                theta: theta.clone(),
            });
            queries.collect::<Vec<_>>()
        };
        self.asked.iter().flat_map(of).collect()
    }

    pub(super) fn take(&mut self, answers: Vec<Option<Vec<f64>>>) {
        self.is_told = true;
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
