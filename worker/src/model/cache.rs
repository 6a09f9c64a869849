//! Cache of compiled variants.

use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;

use shared::model::ModelVariant;

use super::error::CompileError;
use super::variant::CompiledVariant;
use crate::external::allowed::AllowedModels;

/// Most conditions of all variants in the cache: a variant holds each.
const MOST_CONDITIONS: usize = 100_000;

/// Variants by hash, each compiled once; the oldest make room.
#[derive(Debug)]
pub struct VariantCache {
    models: Arc<AllowedModels>,
    variants: BTreeMap<String, Arc<CompiledVariant>>,
    by_age: VecDeque<String>,
    /// Of all variants.
    conditions: usize,
}

impl VariantCache {
    /// Most variants: a round of a search asks hundreds, and the next round most of them again.
    pub const MOST: usize = 1024;

    /// An empty cache; `models` are those that are not ours and may be run.
    pub fn new(models: Arc<AllowedModels>) -> Self {
        VariantCache {
            models,
            variants: BTreeMap::new(),
            by_age: VecDeque::new(),
            conditions: 0,
        }
    }

    /// The compiled variant of a hash, if it was added.
    pub fn get(&self, hash: &str) -> Option<Arc<CompiledVariant>> {
        self.variants.get(hash).cloned()
    }

    /// Compiles and keeps a variant under the hash it was asked for by.
    ///
    /// # Errors
    /// The variant does not have that hash, or cannot be compiled.
    pub fn add(&mut self, hash: &str, variant: &ModelVariant) -> Result<Arc<CompiledVariant>, CompileError> {
        let own = variant.hash();
        if own != hash {
            return Err(CompileError::OtherHash {
                asked: hash.to_owned(),
                own,
            });
        }
        let compiled = Arc::new(CompiledVariant::new(variant, &self.models)?);
        self.conditions += compiled.runs();
        match self.variants.insert(own, compiled.clone()) {
            Some(same) => self.conditions -= same.runs(),
            None => self.by_age.push_back(hash.to_owned()),
        }
        while self.by_age.len() > Self::MOST || (self.conditions > MOST_CONDITIONS && self.by_age.len() > 1) {
            let oldest = self
                .by_age
                .pop_front()
                .and_then(|oldest| self.variants.remove(&oldest));
            self.conditions -= oldest.map_or(0, |oldest| oldest.runs());
        }
        Ok(compiled)
    }
}
