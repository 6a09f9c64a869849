//! Cache of compiled variants.

use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;

use shared::model::ModelVariant;

use super::error::CompileError;
use super::variant::CompiledVariant;
use crate::external::allowed::AllowedModels;

/// Most variants in the cache; a metamodel brings a new one with every stage.
const MOST_VARIANTS: usize = 64;

/// Variants by hash, each compiled once; the oldest make room.
#[derive(Debug)]
pub struct VariantCache {
    models: Arc<AllowedModels>,
    variants: BTreeMap<String, Arc<CompiledVariant>>,
    by_age: VecDeque<String>,
}

impl VariantCache {
    /// An empty cache; `models` are those that are not ours and may be run.
    pub fn new(models: Arc<AllowedModels>) -> Self {
        VariantCache {
            models,
            variants: BTreeMap::new(),
            by_age: VecDeque::new(),
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
    pub fn add(&mut self, hash: &str, variant: &ModelVariant) -> Result<(), CompileError> {
        let own = variant.hash();
        if own != hash {
            return Err(CompileError::OtherHash {
                asked: hash.to_owned(),
                own,
            });
        }
        let compiled = CompiledVariant::new(variant, &self.models)?;
        let compiled = Arc::new(compiled);
        if self.variants.insert(hash.to_owned(), compiled).is_none() {
            self.by_age.push_back(hash.to_owned());
        }
        if self.by_age.len() > MOST_VARIANTS
            && let Some(oldest) = self.by_age.pop_front()
        {
            self.variants.remove(&oldest);
        }
        Ok(())
    }
}
