//! Cross-validation: models fitted without some of the data, and their prediction of these.

use crate::laplace::fit::{FitStep, LaplaceFit};
use crate::laplace::point::FitPoint;
use crate::search::query::{QueriedModel, Query};
use statistics::likelihood::Likelihood;

/// Refits begin at the fit to all data, so a few steps suffice.
const PLAN: [FitStep; 2] = [FitStep::Differences, FitStep::Trials(6)];

/// A model to compare: its effects, the number of parameters of its last one, and its fit to all data.
pub(super) type ComparedModel<'a> = (Vec<usize>, usize, &'a LaplaceFit);

/// One model fitted without one level.
#[derive(Debug, Clone)]
struct Refit {
    model: usize,
    effects: Vec<usize>,
    part: Likelihood,
    /// Index of each of the part's values among all.
    places: Vec<usize>,
    fit: LaplaceFit,
    /// All predicted values at the fit's point.
    all_values: Vec<f64>,
    /// The positions that the fit waits for.
    waiting: Vec<Vec<f64>>,
}

/// The data of one level of the design.
#[derive(Debug, Clone)]
struct LeftOutLevel {
    left: Likelihood,
    places: Vec<usize>,
    /// Of each model; `None` where it cannot be fitted without the level.
    refits: Vec<Option<Refit>>,
}

/// The cross-validation over all levels.
#[derive(Debug, Clone)]
pub(super) struct CrossValidation {
    levels: Vec<LeftOutLevel>,
    models: usize,
}

impl CrossValidation {
    /// Empty levels and those with all data are left out.
    pub(super) fn new(likelihood: &Likelihood, levels: &[Vec<usize>], models: &[ComparedModel]) -> Self {
        let count = likelihood.data().len();
        let level = |left: &Vec<usize>| {
            let kept: Vec<usize> = (0..count).filter(|i| !left.contains(i)).collect();
            if kept.is_empty() || left.is_empty() {
                return None;
            }
            let (part, places) = likelihood.subset(&kept).ok()?;
            let refit = |(model, (effects, own, fit)): (usize, &ComparedModel)| {
                let taken = |values: &[f64]| places.iter().map(|&i| values[i]).collect::<Vec<f64>>();
                let point = FitPoint::new(
                    &fit.frame,
                    &part,
                    fit.point.position.clone(),
                    taken(&fit.point.values),
                )?;
                let columns = fit.columns.iter().map(|column| taken(column)).collect();
                let mut refit = LaplaceFit::new(fit.frame.clone(), point, columns, &PLAN);
                // Shapes are held: a threshold that moves with every left-out level does not generalise.
                let first = fit.frame.dimension() - own;
                refit.hold((first..fit.frame.dimension()).filter(|k| !fit.frame.is_strength(*k)));
                Some(Refit {
                    model,
                    effects: effects.clone(),
                    fit: refit,
                    part: part.clone(),
                    places: places.clone(),
                    all_values: fit.point.values.clone(),
                    waiting: Vec::new(),
                })
            };
            let refits = models.iter().enumerate().map(refit).collect();
            let (left, places) = likelihood.subset(left).ok()?;
            Some(LeftOutLevel { left, places, refits })
        };
        Self {
            levels: levels.iter().filter_map(level).collect(),
            models: models.len(),
        }
    }

    fn refits(&mut self) -> impl Iterator<Item = &mut Refit> {
        self.levels
            .iter_mut()
            .flat_map(|level| level.refits.iter_mut().flatten())
    }

    /// The queries of the next round; none once all fits are complete.
    pub(super) fn queries(&mut self) -> Vec<Query> {
        let mut queries = Vec::new();
        for refit in self.refits() {
            refit.waiting = refit.fit.ask(&refit.part);
            queries.extend(refit.waiting.iter().map(|position| Query {
                model: QueriedModel::With(refit.effects.clone()),
                is_proposed: false,
                theta: refit.fit.frame.theta(position),
            }));
        }
        queries
    }

    /// Takes the answers of a round.
    pub(super) fn take(&mut self, answers: Vec<Option<Vec<f64>>>) {
        let mut answers = answers.into_iter();
        for refit in self.refits() {
            let waiting = std::mem::take(&mut refit.waiting);
            if waiting.is_empty() {
                continue;
            }
            let all: Vec<Option<Vec<f64>>> = answers.by_ref().take(waiting.len()).collect();
            let taken = |values: &Vec<f64>| refit.places.iter().map(|&i| values[i]).collect::<Vec<f64>>();
            let parts = all.iter().map(|values| values.as_ref().map(taken)).collect();
            refit.fit.tell(&refit.part, parts);
            let at = waiting.iter().position(|w| *w == refit.fit.point.position);
            if let Some(Some(values)) = at.map(|i| &all[i]) {
                refit.all_values.clone_from(values);
            }
        }
    }

    /// Log predictive density of each model over that of the first, summed over the levels that all of them predict; `None` without
    /// such a level.
    pub(super) fn gains(&self) -> Option<Vec<f64>> {
        let mut sums = vec![0.0; self.models];
        let mut levels = 0;
        for level in &self.levels {
            let density = |refit: &Option<Refit>| {
                let refit = refit.as_ref()?;
                let theta = refit.fit.theta();
                let values: Vec<f64> = level.places.iter().map(|&i| refit.all_values[i]).collect();
                let scored = level.left.log_likelihood(&values, &theta).ok()?.value();
                scored.is_finite().then_some((refit.model, scored))
            };
            let densities: Option<Vec<(usize, f64)>> = level.refits.iter().map(density).collect();
            if let Some(densities) = densities {
                levels += 1;
                for (model, scored) in densities {
                    sums[model] += scored;
                }
            }
        }
        let first = *sums.first()?;
        (levels > 0).then(|| sums.iter().map(|sum| sum - first).collect())
    }
}
