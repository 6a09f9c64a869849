//! The base model and every effect of the catalogue that it can express, ready to be asked.

use coordinator::embedded::Evaluate;
use coordinator::spec::Spec;
use formula::catalogue::catalogue;
use inference::Marginal;
use inference::discovery::Candidate;
use shared::file::FileSet;
use shared::outcome::Outcome;

/// A model with its parameters.
pub(crate) struct Model {
    pub(crate) spec: Spec,
    evaluate: Evaluate,
}

/// The base, and the base with each candidate.
pub(crate) struct Models {
    pub(crate) base: Model,
    pub(crate) candidates: Vec<Candidate>,
    pub(crate) extended: Vec<Model>,
    /// Effects that the model cannot express in this experiment, with the reason.
    pub(crate) left_out: Vec<(String, String)>,
}

impl Model {
    fn new(job: &str, experiment: &FileSet) -> Result<Self, String> {
        let job = FileSet {
            toml: job.to_owned(),
            files: Default::default(),
        };
        let spec = Spec::new("job.toml", &job, "experiment.toml", experiment).map_err(|e| e.to_string())?;
        let evaluate = Evaluate::new(&spec.fit_variant)?;
        Ok(Self { spec, evaluate })
    }

    /// The predicted values in the order of the data; `None` where the model refuses.
    pub(crate) fn values(&self, theta: &[f64]) -> Option<Vec<f64>> {
        match self.evaluate.evaluate(self.spec.model_theta(theta)) {
            Outcome::Evaluated(observables) => Some(self.spec.predicted_values(&observables)),
            Outcome::Rejected(_) | Outcome::Fault(_) => None,
        }
    }
}

impl Models {
    /// # Arguments
    /// - `job`: with a line `[model]` and no effects.
    pub(crate) fn new(job: &str, experiment: &FileSet) -> Result<Self, String> {
        let base = Model::new(job, experiment)?;
        let own = base.spec.parameters.len();
        let mut models = Self {
            base,
            candidates: Vec::new(),
            extended: Vec::new(),
            left_out: Vec::new(),
        };
        for effect in catalogue() {
            let with = job.replacen(
                "[model]\n",
                &format!("[model]\neffects = [\"{}\"]\n", effect.name),
                1,
            );
            let model = match Model::new(&with, experiment) {
                Ok(model) => model,
                Err(reason) => {
                    models.left_out.push((effect.name.clone(), reason));
                    continue;
                }
            };
            let free = &model.spec.parameters[own..];
            let strength = effect.parameters.iter().find_map(|p| {
                let name = format!("{}.{}", effect.name, p.name);
                Some((free.iter().position(|f| f.name == name)?, p.neutral?))
            });
            let Some((strength, neutral)) = strength else {
                let reason = "no strength is free".to_owned();
                models.left_out.push((effect.name.clone(), reason));
                continue;
            };
            models.candidates.push(Candidate {
                name: effect.name.clone(),
                parameters: free.iter().map(|p| p.marginal.clone()).collect(),
                strengths: vec![strength],
                neutral,
            });
            models.extended.push(model);
        }
        Ok(models)
    }

    pub(crate) fn model(&self, candidate: Option<usize>) -> &Model {
        candidate.map_or(&self.base, |k| &self.extended[k])
    }

    pub(crate) fn name(&self, candidate: Option<usize>) -> &str {
        candidate.map_or("none", |k| &self.candidates[k].name)
    }

    pub(crate) fn prior(&self) -> Vec<Marginal> {
        self.base
            .spec
            .parameters
            .iter()
            .map(|p| p.marginal.clone())
            .collect()
    }
}
