//! The cross-validation of steps 10 to 12: models are fitted without one level of the design, and predict its data.

use std::collections::BTreeMap;

use crate::laplace::correction::Correction;
use crate::laplace::fit::{FitStep, LaplaceFit};
use crate::laplace::point::FitPoint;
use crate::settings::Smoothness;
use crate::stages::query::{QueriedModel, Query};
use statistics::likelihood::Likelihood;

/// Refits begin at the fit to all data, so a few steps suffice.
const PLAN: [FitStep; 2] = [FitStep::Differences, FitStep::Trials(6)];
/// The refit of a rough model keeps the derivatives of the fit to all data: a left-out level moves the parameters little, and each of many
/// models is fitted again without each level.
const PLAN_OF_ROUGH: [FitStep; 1] = [FitStep::Trials(2)];

/// A model to compare: its effects, the number of parameters of the last one, and its fit to all data.
pub(super) type ComparedModel<'a> = (Vec<usize>, usize, &'a LaplaceFit);

/// One model fitted without one level.
#[derive(Debug, Clone)]
struct Refit {
    part: Likelihood,
    /// Index among all data of each value of the part.
    places: Vec<usize>,
    fit: LaplaceFit,
    /// All predicted values at the fit's point.
    all_values: Vec<f64>,
    /// The positions that the fit waits for.
    waiting: Vec<Vec<f64>>,
}

/// Returns numbers as a key that can be compared.
fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|x| x.to_bits()).collect()
}

/// The identity of a refitted model. Likelihood and levels are those of the search, and two fits of one model that end at the same
/// point have the same refits.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct ModelKey {
    effects: Vec<usize>,
    /// Number of parameters of the last effect.
    last_parameters: usize,
    /// The bits of the coordinates of the fit to all data.
    position: Vec<u64>,
}

impl ModelKey {
    fn new((effects, last_parameters, fit): &ComparedModel) -> Self {
        ModelKey {
            effects: effects.clone(),
            last_parameters: *last_parameters,
            position: bits(&fit.point.position),
        }
    }
}

/// One model fitted without each level.
#[derive(Debug, Clone)]
pub(super) struct RefittedModel {
    key: ModelKey,
    /// The refit without each level; `None` where it is impossible.
    refits: Vec<Option<Refit>>,
}

impl RefittedModel {
    fn new(levels: &[LeftOutLevel], model: &ComparedModel) -> Self {
        let (_, last_parameters, fit) = model;
        let refit = |level: &LeftOutLevel| {
            let LeftOutLevel { part, kept, .. } = level;
            let selected = |values: &[f64]| kept.iter().map(|&i| values[i]).collect::<Vec<f64>>();
            let position = fit.point.position.clone();
            let point = FitPoint::new(&fit.frame, part, position, selected(&fit.point.values))?;
            let columns = fit.columns.iter().map(|column| selected(column)).collect();
            let corrections = fit.corrections.iter();
            let part_of = |correction: &Correction| Correction {
                beyond: selected(&correction.beyond),
                ..*correction
            };
            let corrections: Vec<_> = corrections.map(|slot| slot.as_ref().map(part_of)).collect();
            let plan: &[FitStep] = match fit.frame.smoothness {
                Smoothness::Smooth => &PLAN,
                Smoothness::Rough | Smoothness::Unknown => &PLAN_OF_ROUGH,
            };
            let refit = LaplaceFit::new(fit.frame.clone(), point, columns, plan);
            let mut refit = refit.corrected(&corrections);
            // Shapes are held: a threshold that moves with every left-out level does not generalise.
            let first = fit.frame.dimension() - last_parameters;
            refit.hold((first..fit.frame.dimension()).filter(|k| !fit.frame.is_strength(*k)));
            Some(Refit {
                fit: refit,
                part: part.clone(),
                places: kept.clone(),
                all_values: fit.point.values.clone(),
                waiting: Vec::new(),
            })
        };
        RefittedModel {
            key: ModelKey::new(model),
            refits: levels.iter().map(refit).collect(),
        }
    }
}

/// The data of one level of the design.
#[derive(Debug, Clone)]
struct LeftOutLevel {
    left: Likelihood,
    /// Index among all data of each left-out value.
    places: Vec<usize>,
    /// The remaining data, and the index of each of their values.
    part: Likelihood,
    kept: Vec<usize>,
}

impl LeftOutLevel {
    /// Splits the data; `None` if the level has no data, or all.
    fn new(likelihood: &Likelihood, left: &[usize]) -> Option<Self> {
        let count = likelihood.data().len();
        let kept: Vec<usize> = (0..count).filter(|i| !left.contains(i)).collect();
        if kept.is_empty() || left.is_empty() {
            return None;
        }
        let (part, kept) = likelihood.subset(&kept).ok()?;
        let (left, places) = likelihood.subset(left).ok()?;
        Some(LeftOutLevel {
            left,
            places,
            part,
            kept,
        })
    }
}

/// The cross-validation over all levels.
#[derive(Debug, Clone)]
pub(super) struct CrossValidation {
    levels: Vec<LeftOutLevel>,
    models: Vec<RefittedModel>,
    /// The number of the query that answers each position for which a refit waits.
    answered_by: Vec<usize>,
}

impl CrossValidation {
    /// Compares models on all levels; levels with no data or all data are skipped.
    ///
    /// # Arguments
    /// - `earlier`: models that were refitted with the same likelihood and levels, and are not fitted again.
    pub(super) fn new(
        likelihood: &Likelihood,
        levels: &[Vec<usize>],
        models: &[ComparedModel],
        earlier: &BTreeMap<ModelKey, RefittedModel>,
    ) -> Self {
        let levels = levels
            .iter()
            .filter_map(|left| LeftOutLevel::new(likelihood, left));
        let levels: Vec<LeftOutLevel> = levels.collect();
        let refitted = |model: &ComparedModel| {
            let earlier = earlier.get(&ModelKey::new(model)).cloned();
            earlier.unwrap_or_else(|| RefittedModel::new(&levels, model))
        };
        Self {
            models: models.iter().map(refitted).collect(),
            levels,
            answered_by: Vec::new(),
        }
    }

    /// Returns the refitted models, for use in another cross-validation.
    pub(super) fn refitted(&self) -> impl Iterator<Item = (ModelKey, RefittedModel)> {
        self.models.iter().map(|model| (model.key.clone(), model.clone()))
    }

    /// Returns the queries of the next round; none once all fits are complete. Refits of a model that ask for the same
    /// parameters, for example the first differences at the fit to all data, share a query.
    pub(super) fn queries(&mut self) -> Vec<Query> {
        let mut queries = Vec::new();
        self.answered_by.clear();
        let mut numbers: BTreeMap<(Vec<usize>, bool, Vec<u64>), usize> = BTreeMap::new();
        for model in &mut self.models {
            let effects = &model.key.effects;
            for refit in model.refits.iter_mut().flatten() {
                refit.waiting = refit.fit.ask(&refit.part);
                let is_low_fidelity = refit.fit.asks_low_fidelity();
                for position in &refit.waiting {
                    let theta = refit.fit.frame.theta(position);
                    let key = (effects.clone(), is_low_fidelity, bits(&theta));
                    let number = *numbers.entry(key).or_insert(queries.len());
                    self.answered_by.push(number);
                    if number == queries.len() {
                        queries.push(Query {
                            model: QueriedModel::With(effects.clone()),
                            is_proposed: false,
                            is_low_fidelity,
                            theta,
                        });
                    }
                }
            }
        }
        queries
    }

    /// Takes the answers to [`queries`](Self::queries), in their order.
    pub(super) fn take(&mut self, answers: &[Option<Vec<f64>>]) {
        let mut answered_by = std::mem::take(&mut self.answered_by).into_iter();
        let refits = self
            .models
            .iter_mut()
            .flat_map(|model| model.refits.iter_mut().flatten());
        for refit in refits {
            let waiting = std::mem::take(&mut refit.waiting);
            if waiting.is_empty() {
                continue;
            }
            let numbers = answered_by.by_ref().take(waiting.len());
            let all: Vec<Option<&Vec<f64>>> = numbers.map(|number| answers[number].as_ref()).collect();
            let selected = |values: &Vec<f64>| refit.places.iter().map(|&i| values[i]).collect::<Vec<f64>>();
            let parts = all.iter().map(|values| values.map(selected)).collect();
            let is_low_fidelity = refit.fit.asks_low_fidelity();
            refit.fit.tell(&refit.part, parts);
            if is_low_fidelity {
                continue;
            }
            let at = waiting.iter().position(|w| *w == refit.fit.point.position);
            if let Some(Some(values)) = at.map(|i| all[i]) {
                refit.all_values.clone_from(values);
            }
        }
    }

    /// Returns the log predictive density of each model over that of the first, summed over the levels that all models predict;
    /// `None` if there are none.
    pub(super) fn gains(&self) -> Option<Vec<f64>> {
        let mut sums = vec![0.0; self.models.len()];
        let mut predicted = 0;
        for (i, level) in self.levels.iter().enumerate() {
            let density = |model: &RefittedModel| {
                let refit = model.refits[i].as_ref()?;
                let theta = refit.fit.theta();
                let values: Vec<f64> = level
                    .places
                    .iter()
                    .map(|&place| refit.all_values[place])
                    .collect();
                let scored = level.left.log_likelihood(&values, &theta).ok()?.value();
                scored.is_finite().then_some(scored)
            };
            let densities: Option<Vec<f64>> = self.models.iter().map(density).collect();
            if let Some(densities) = densities {
                predicted += 1;
                for (sum, scored) in sums.iter_mut().zip(densities) {
                    *sum += scored;
                }
            }
        }
        let first = *sums.first()?;
        (predicted > 0).then(|| sums.iter().map(|sum| sum - first).collect())
    }
}
