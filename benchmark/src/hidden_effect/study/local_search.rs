//! The search of the farm on the thread of the caller.

use std::collections::BTreeMap;

use coordinator::embedded::Evaluate;
use discovery::{
    Conclusion, DiscoverySearch, EffectRanking, EffectRequest, EffectSearch, QueriedModel, Query,
};
use search::SearchModels;
use shared::file::FileSet;
use shared::model::RunCondition;
use shared::outcome::{Observables, Outcome};
use statistics::Likelihood;

use crate::error::StudyError;

/// A search of a job and an experiment.
pub struct LocalSearch {
    pub models: SearchModels,
    evaluates: BTreeMap<String, Evaluate>,
}

impl LocalSearch {
    /// # Arguments
    /// - `max_effects`: the largest number of effects in a combination.
    pub fn new(job: &FileSet, experiment: &FileSet, max_effects: usize) -> Result<Self, StudyError> {
        Ok(Self {
            models: SearchModels::new(job, experiment, max_effects)?,
            evaluates: BTreeMap::new(),
        })
    }

    /// Predicts the values of a query; `None` if the model rejects the parameters.
    fn evaluate(&mut self, query: &Query) -> Result<Option<Vec<f64>>, StudyError> {
        let (hash, variant) = self.models.variant(query)?.clone();
        let theta = self.models.model_theta(query, &variant);
        if !self.evaluates.contains_key(&hash) {
            self.evaluates.insert(hash.clone(), Evaluate::new(&variant)?);
        }
        Ok(match self.evaluates[&hash].evaluate(&theta) {
            Outcome::Evaluated(observables) => Some(self.models.values(query, &observables)),
            Outcome::Rejected(_) | Outcome::Fault(_) => None,
        })
    }

    /// Predicts with effects under other conditions; `None` for parameters that the model rejects.
    pub fn predict(
        &mut self,
        effects: &[usize],
        conditions: &[RunCondition],
        thetas: &[Vec<f64>],
    ) -> Result<Vec<Option<Observables>>, StudyError> {
        let query = |theta: &Vec<f64>| Query {
            model: QueriedModel::With(effects.to_vec()),
            is_proposed: false,
            is_low_fidelity: false,
            theta: theta.clone(),
        };
        let Some(first) = thetas.first() else {
            return Ok(Vec::new());
        };
        let mut variant = self.models.variant(&query(first))?.1.clone();
        // Conditions have a density only if an effect of the variant needs it. The predicted runs take the order of the first run.
        let first = variant.conditions.first();
        let (density_kg_m3, order) = (first.and_then(|c| c.density_kg_m3), first.and_then(|c| c.order));
        let condition = |condition: &RunCondition| RunCondition {
            density_kg_m3,
            order,
            ..condition.clone()
        };
        variant.conditions = conditions.iter().map(condition).collect();
        let evaluate = Evaluate::new(&variant)?;
        let predicted = thetas.iter().map(|theta| {
            match evaluate.evaluate(&self.models.model_theta(&query(theta), &variant)) {
                Outcome::Evaluated(observables) => Some(observables),
                Outcome::Rejected(_) | Outcome::Fault(_) => None,
            }
        });
        Ok(predicted.collect())
    }

    /// Searches for the effects that the model is missing.
    pub fn run(&mut self) -> Result<Conclusion, StudyError> {
        let mut search = DiscoverySearch::new(self.models.task())?;
        loop {
            if let Some(conclusion) = search.conclusion() {
                return Ok(conclusion.clone());
            }
            if let Some(failure) = search.failure() {
                return Err(failure.to_string().into());
            }
            if let Some(request) = search.wanted_formulas().cloned() {
                search.offer_formulas(self.models.offer(&request))?;
            }
            for index in 0..search.pending().len() {
                let query = search.query(index).cloned().ok_or("no query is pending")?;
                let values = self.evaluate(&query)?;
                search.tell(index, values.as_deref())?;
            }
        }
    }

    /// Ranks the effects of the library for other data of the same runs.
    pub fn library(&mut self, likelihood: Likelihood) -> Result<EffectRanking, StudyError> {
        let task = self.models.task();
        let search = EffectSearch::new(&task.prior, likelihood, &task.library, &task.settings)?;
        run(search, |request| {
            self.evaluate(&Query {
                model: QueriedModel::With(request.candidate.into_iter().collect()),
                is_proposed: false,
                is_low_fidelity: request.is_low_fidelity,
                theta: request.theta.clone(),
            })
        })
    }
}

/// Runs a search to its end.
///
/// # Arguments
/// - `evaluate`: predicts the base, or the base with a candidate, at a parameter vector.
pub fn run(
    mut search: EffectSearch,
    mut evaluate: impl FnMut(&EffectRequest) -> Result<Option<Vec<f64>>, StudyError>,
) -> Result<EffectRanking, StudyError> {
    loop {
        if let Some(ranking) = search.ranking() {
            return Ok(ranking.clone());
        }
        let pending: Vec<_> = search.pending().collect();
        if pending.is_empty() {
            return Err("the search neither ends nor has pending requests".into());
        }
        for (index, request) in pending.iter().enumerate() {
            let values = evaluate(request)?;
            search.tell(index, values.as_deref())?;
        }
    }
}
