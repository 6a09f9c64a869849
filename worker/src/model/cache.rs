//! Cache of compiled variants.

use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;

use shared::model::{ModelVariant, hash_of};

use super::error::CompileError;
use super::variant::CompiledVariant;
use crate::external::allowed::AllowedModels;

/// Variants by hash, each compiled once; the oldest make room.
#[derive(Debug)]
pub struct VariantCache {
    models: Arc<AllowedModels>,
    variants: BTreeMap<String, CachedVariant>,
    by_age: VecDeque<String>,
    /// Length of the texts of all variants.
    bytes: usize,
}

#[derive(Debug)]
struct CachedVariant {
    compiled: Arc<CompiledVariant>,
    /// Length of its text: that of a metamodel grows with the particles, and with it what is compiled.
    bytes: usize,
}

impl VariantCache {
    /// Most variants: a round of a search asks hundreds, and the next round most of them again.
    pub const MOST: usize = 1024;
    /// Most of their texts together, where there are several.
    pub const MOST_BYTES: usize = 64 << 20;

    /// An empty cache; `models` are those that are not ours and may be run.
    pub fn new(models: Arc<AllowedModels>) -> Self {
        VariantCache {
            models,
            variants: BTreeMap::new(),
            by_age: VecDeque::new(),
            bytes: 0,
        }
    }

    /// The compiled variant of a hash, if it was added and has not made room.
    pub fn get(&self, hash: &str) -> Option<Arc<CompiledVariant>> {
        self.variants.get(hash).map(|own| own.compiled.clone())
    }

    /// Compiles and keeps a variant under the hash it was asked for by.
    ///
    /// # Errors
    /// The variant does not have that hash, or cannot be compiled.
    pub fn add(&mut self, hash: &str, variant: &ModelVariant) -> Result<Arc<CompiledVariant>, CompileError> {
        let text = variant.text();
        let own = hash_of(&text);
        if own != hash {
            return Err(CompileError::OtherHash {
                asked: hash.to_owned(),
                own,
            });
        }
        let compiled = Arc::new(CompiledVariant::new(variant, &self.models)?);
        let cached = CachedVariant {
            compiled: compiled.clone(),
            bytes: text.len(),
        };
        // The same hash is the same text.
        if self.variants.insert(own.clone(), cached).is_none() {
            self.by_age.push_back(own);
            self.bytes += text.len();
        }
        while self.by_age.len() > Self::MOST || (self.bytes > Self::MOST_BYTES && self.by_age.len() > 1) {
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

    /// Which of them are cached.
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
        let variants = under_loads(VariantCache::MOST + 2);
        let cached = cached(&variants);
        assert_eq!(cached[..3], [false, false, true]);
        assert!(cached[2..].iter().all(|is_cached| *is_cached));
    }

    #[test]
    fn what_is_long_makes_others_go_and_stays_itself() {
        let mut long = variant();
        let of_each = serde_json::to_vec(&long.conditions[0]).unwrap().len();
        let most = VariantCache::MOST_BYTES / of_each;
        long.conditions = vec![long.conditions[0].clone(); most];
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
