//! The search as the farm runs it, on this thread.

use std::collections::BTreeMap;

use coordinator::embedded::Evaluate;
use coordinator::missing_effect::Models;
use discovery::inquiry::{Answer, Asked, Inquiry, Model};
use discovery::{Engine, Finding};
use shared::file::FileSet;
use shared::model::RunCondition;
use shared::outcome::{Observables, Outcome};
use statistics::Likelihood;

/// The models of a job and an experiment, ready to be asked.
pub(crate) struct Asking {
    pub(crate) models: Models,
    evaluates: BTreeMap<String, Evaluate>,
}

impl Asking {
    /// # Arguments
    /// - `max_effects`: most that are looked for together.
    pub(crate) fn new(job: &FileSet, experiment: &FileSet, max_effects: usize) -> Result<Self, String> {
        Ok(Self {
            models: Models::new(job, experiment, max_effects).map_err(|e| e.to_string())?,
            evaluates: BTreeMap::new(),
        })
    }

    /// What the model says; `None` where it refuses.
    fn ask(&mut self, asked: &Asked) -> Result<Option<Vec<f64>>, String> {
        let (hash, variant) = self.models.variant(asked).map_err(|e| e.to_string())?.clone();
        let theta = self.models.model_theta(asked, &variant);
        if !self.evaluates.contains_key(&hash) {
            self.evaluates.insert(hash.clone(), Evaluate::new(&variant)?);
        }
        Ok(match self.evaluates[&hash].evaluate(&theta) {
            Outcome::Evaluated(observables) => Some(self.models.values(asked, &observables)),
            Outcome::Rejected(_) | Outcome::Fault(_) => None,
        })
    }

    /// What a model with effects says of other conditions; `None` where it refuses.
    pub(crate) fn predict(
        &mut self,
        effects: &[usize],
        conditions: &[RunCondition],
        thetas: &[Vec<f64>],
    ) -> Result<Vec<Option<Observables>>, String> {
        let question = |theta: &Vec<f64>| Asked {
            model: Model::With(effects.to_vec()),
            is_proposed: false,
            theta: theta.clone(),
        };
        let Some(first) = thetas.first() else {
            return Ok(Vec::new());
        };
        let own = self.models.variant(&question(first)).map_err(|e| e.to_string())?;
        let mut variant = own.1.clone();
        // The soil's density is there only if an effect of this variant asks for it.
        let density_kg_m3 = variant.conditions.first().and_then(|c| c.density_kg_m3);
        variant.conditions = conditions.to_vec();
        for condition in &mut variant.conditions {
            condition.density_kg_m3 = density_kg_m3;
        }
        let evaluate = Evaluate::new(&variant)?;
        let predicted = thetas.iter().map(|theta| {
            match evaluate.evaluate(&self.models.model_theta(&question(theta), &variant)) {
                Outcome::Evaluated(observables) => Some(observables),
                Outcome::Rejected(_) | Outcome::Fault(_) => None,
            }
        });
        Ok(predicted.collect())
    }

    /// Searches for what the model is missing, blind.
    pub(crate) fn inquire(&mut self) -> Result<Answer, String> {
        let mut inquiry = Inquiry::new(self.models.task()).map_err(|e| e.to_string())?;
        loop {
            if let Some(answer) = inquiry.answer() {
                return Ok(answer.clone());
            }
            if let Some(failure) = inquiry.failure() {
                return Err(failure.to_string());
            }
            for index in 0..inquiry.pending().len() {
                let asked = inquiry.asked(index).cloned().ok_or("nothing is asked")?;
                let values = self.ask(&asked)?;
                inquiry
                    .tell(index, values.as_deref())
                    .map_err(|e| e.to_string())?;
            }
        }
    }

    /// The library alone against other data of the same runs.
    pub(crate) fn library(&mut self, likelihood: Likelihood) -> Result<Finding, String> {
        let task = self.models.task();
        let engine =
            Engine::new(&task.prior, likelihood, task.library, &task.settings).map_err(|e| e.to_string())?;
        run(engine, |candidate, theta| {
            self.ask(&Asked {
                model: Model::With(candidate.into_iter().collect()),
                is_proposed: false,
                theta: theta.to_vec(),
            })
        })
    }
}

/// Runs a search to its end.
///
/// # Arguments
/// - `ask`: the values of the base, or of the base with a candidate, at a parameter vector.
pub(crate) fn run(
    mut engine: Engine,
    mut ask: impl FnMut(Option<usize>, &[f64]) -> Result<Option<Vec<f64>>, String>,
) -> Result<Finding, String> {
    loop {
        if let Some(finding) = engine.finding() {
            return Ok(finding.clone());
        }
        let pending: Vec<_> = engine.pending().collect();
        if pending.is_empty() {
            return Err("the search asks for nothing and has found nothing".into());
        }
        for (index, request) in pending.iter().enumerate() {
            let values = ask(request.candidate, &request.theta)?;
            engine.tell(index, values.as_deref()).map_err(|e| e.to_string())?;
        }
    }
}
