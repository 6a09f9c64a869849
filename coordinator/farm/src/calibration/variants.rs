//! The model variants that a calibration evaluates.

use std::collections::BTreeMap;

use job::Spec;
use record::EvaluationKey;
use shared::model::ModelVariant;

/// The variants of a calibration by hash, with their purposes.
#[derive(Debug)]
pub(super) struct Variants {
    by_hash: BTreeMap<String, ModelVariant>,
    /// The hash of the variant for sampling.
    sampled: String,
    /// The hash of the fitted runs.
    fit: String,
    /// The hash of the fitted runs with their histories; `None` for a model without a time axis.
    histories: Option<String>,
    /// The hash of all holdout runs together.
    holdout: Option<String>,
    /// The hashes of the holdout runs one by one; empty until they are needed.
    holdout_runs: Vec<String>,
}

impl Variants {
    pub(super) fn new(spec: &Spec) -> Self {
        let mut by_hash = BTreeMap::new();
        let mut add = |variant| insert(&mut by_hash, variant);
        Variants {
            sampled: add(spec.sampled_variant()),
            fit: add(spec.fit_variant.clone()),
            histories: spec.fit_variant.with_histories().map(&mut add),
            holdout: spec.holdout_variant.clone().map(&mut add),
            holdout_runs: Vec::new(),
            by_hash,
        }
    }

    pub(super) fn get(&self, hash: &str) -> Option<&ModelVariant> {
        self.by_hash.get(hash)
    }

    /// Returns the hash of the fitted runs with all channels.
    pub(super) fn fit(&self) -> &str {
        &self.fit
    }

    /// Returns whether the model has a time axis.
    pub(super) fn has_histories(&self) -> bool {
        self.histories.is_some()
    }

    /// Returns the number of holdout runs that are simulated one by one.
    pub(super) fn holdout_runs(&self) -> usize {
        self.holdout_runs.len()
    }

    /// Returns the hash of the variant of an evaluation.
    pub(super) fn for_key(&self, key: EvaluationKey) -> Option<&str> {
        match key {
            EvaluationKey::Sampling { .. } => Some(&self.sampled),
            EvaluationKey::Prediction { holdout: false, .. } => Some(&self.fit),
            EvaluationKey::Prediction { holdout: true, .. } => self.holdout.as_deref(),
            EvaluationKey::HoldoutRun { run, .. } => self.holdout_runs.get(run).map(String::as_str),
            EvaluationKey::Likeliest => Some(self.histories.as_ref().unwrap_or(&self.fit)),
        }
    }

    /// Makes the variants of the holdout runs one by one.
    pub(super) fn split_holdout(&mut self, holdout: Option<&ModelVariant>) {
        let runs = holdout.into_iter().flat_map(ModelVariant::by_condition);
        self.holdout_runs = runs.map(|variant| insert(&mut self.by_hash, variant)).collect();
    }
}

/// Adds a variant. Returns its hash.
fn insert(by_hash: &mut BTreeMap<String, ModelVariant>, variant: ModelVariant) -> String {
    let hash = variant.hash();
    by_hash.insert(hash.clone(), variant);
    hash
}
