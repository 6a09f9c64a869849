//! The search as the farm runs it, on this thread.

use std::collections::BTreeMap;

use coordinator::discovery::Models;
use coordinator::embedded::Evaluate;
use inference::discovery::inquiry::{Answer, Asked, Inquiry};
use shared::file::FileSet;
use shared::outcome::Outcome;

/// Most effects that are looked for together.
pub(crate) const MAX_EFFECTS: usize = 3;

/// Searches an experiment for what the model of a job is missing, blind.
pub(crate) fn inquire(job: &FileSet, experiment: &FileSet) -> Result<(Models, Answer), String> {
    let mut models = Models::new(job, experiment, MAX_EFFECTS).map_err(|e| e.to_string())?;
    let mut inquiry = Inquiry::new(models.task()).map_err(|e| e.to_string())?;
    let mut evaluates: BTreeMap<String, Evaluate> = BTreeMap::new();
    loop {
        if let Some(answer) = inquiry.answer() {
            let answer = answer.clone();
            return Ok((models, answer));
        }
        if let Some(failure) = inquiry.failure() {
            return Err(failure.to_string());
        }
        for index in 0..inquiry.pending().len() {
            let asked: Asked = inquiry.asked(index).cloned().ok_or("nothing is asked")?;
            let (hash, variant) = models.variant(&asked).map_err(|e| e.to_string())?.clone();
            let theta = models.model_theta(&asked, &variant);
            if !evaluates.contains_key(&hash) {
                evaluates.insert(hash.clone(), Evaluate::new(&variant)?);
            }
            let values = match evaluates[&hash].evaluate(&theta) {
                Outcome::Evaluated(observables) => Some(models.values(&asked, &observables)),
                Outcome::Rejected(_) | Outcome::Fault(_) => None,
            };
            inquiry
                .tell(index, values.as_deref())
                .map_err(|e| e.to_string())?;
        }
    }
}
