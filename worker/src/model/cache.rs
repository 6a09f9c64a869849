//! Cache of compiled variants.

use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;

use shared::model::{ModelVariant, hash_of};

use super::error::CompileError;
use super::variant::CompiledVariant;
use crate::external::allowed::AllowedModels;

/// Variants by hash, each compiled once; the oldest are evicted.
#[derive(Debug)]
pub struct VariantCache {
    models: Arc<AllowedModels>,
    variants: BTreeMap<String, CachedVariant>,
    by_age: VecDeque<String>,
    /// Total length of the texts of all variants.
    bytes: usize,
}

#[derive(Debug)]
struct CachedVariant {
    compiled: Arc<CompiledVariant>,
    /// Length of the variant's text, with which its compiled size grows.
    bytes: usize,
}

impl VariantCache {
    /// The maximum number of variants: a round of a search needs at most some 400, and the next round almost the same ones.
    pub const MAX_VARIANTS: usize = 512;
    /// The maximum total length of the texts of the variants, unless there is a single variant.
    pub const MAX_BYTES: usize = 64 << 20;

    /// Creates an empty cache; `models` are the external models that may be run.
    pub fn new(models: Arc<AllowedModels>) -> Self {
        VariantCache {
            models,
            variants: BTreeMap::new(),
            by_age: VecDeque::new(),
            bytes: 0,
        }
    }

    /// Returns the compiled variant of a hash, if it is in the cache.
    pub fn get(&self, hash: &str) -> Option<Arc<CompiledVariant>> {
        self.variants.get(hash).map(|cached| cached.compiled.clone())
    }

    /// Compiles a variant and stores it under the requested hash; an error if its hash differs, or it cannot be compiled.
    pub fn add(&mut self, hash: &str, variant: &ModelVariant) -> Result<Arc<CompiledVariant>, CompileError> {
        let text = variant.text();
        let actual = hash_of(&text);
        if actual != hash {
            return Err(CompileError::OtherHash {
                requested: hash.to_owned(),
                actual,
            });
        }
        let compiled = Arc::new(CompiledVariant::new(variant, &self.models)?);
        let cached = CachedVariant {
            compiled: compiled.clone(),
            bytes: text.len(),
        };
        // Equal hashes mean equal texts.
        if self.variants.insert(actual.clone(), cached).is_none() {
            self.by_age.push_back(actual);
            self.bytes += text.len();
        }
        while self.by_age.len() > Self::MAX_VARIANTS
            || (self.bytes > Self::MAX_BYTES && self.by_age.len() > 1)
        {
            let oldest = self
                .by_age
                .pop_front()
                .and_then(|oldest| self.variants.remove(&oldest));
            self.bytes -= oldest.map_or(0, |oldest| oldest.bytes);
        }
        Ok(compiled)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{under_loads, variant};

    /// Returns which of the variants are cached.
    fn cached(variants: &[(String, ModelVariant)]) -> Vec<bool> {
        let mut cache = VariantCache::new(Arc::default());
        for (hash, variant) in variants {
            cache.add(hash, variant).unwrap();
        }
        variants
            .iter()
            .map(|(hash, _)| cache.get(hash).is_some())
            .collect()
    }

    #[test]
    fn the_oldest_make_room() {
        let variants = under_loads(VariantCache::MAX_VARIANTS + 2);
        let cached = cached(&variants);
        assert_eq!(cached[..3], [false, false, true]);
        assert!(cached[2..].iter().all(|is_cached| *is_cached));
    }

    #[test]
    fn a_long_variant_evicts_others_and_stays() {
        let mut long = variant();
        let condition_bytes = serde_json::to_vec(&long.conditions[0]).unwrap().len();
        let count = VariantCache::MAX_BYTES / condition_bytes;
        long.conditions = vec![long.conditions[0].clone(); count].into();
        let mut variants = under_loads(3);
        variants.insert(2, (long.hash(), long));
        assert_eq!(cached(&variants[..3]), [false, false, true]);
        assert_eq!(cached(&variants), [false, false, false, true]);
    }

    #[test]
    fn another_hash_is_refused() {
        let mut cache = VariantCache::new(Arc::default());
        let error = cache.add("0123", &variant()).unwrap_err();
        assert!(matches!(error, CompileError::OtherHash { .. }), "{error}");
    }
}
