//! The cache of texts about studies.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use report::StudyFile;
use report::study_file::is_decision;
use store::{Stamp, Store, StoreError, StudyResults};

/// The cache of texts about studies, each under the stamp of the state from which it was computed. The texts are in the store's table of
/// results. A store that is opened for reading alone takes none: then overviews, lines of the list and decisions are kept in memory.
#[derive(Debug, Clone)]
pub(super) struct ResultCache {
    store: Store,
    in_memory: Arc<Mutex<BTreeMap<i64, StudyResults>>>,
}

impl ResultCache {
    pub(super) fn new(store: &Store) -> ResultCache {
        ResultCache {
            store: store.clone(),
            in_memory: Arc::default(),
        }
    }

    fn in_memory(&self) -> MutexGuard<'_, BTreeMap<i64, StudyResults>> {
        self.in_memory.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns a text about a study, if it is kept under this stamp.
    pub(super) async fn text(
        &self,
        study: i64,
        name: &str,
        stamp: &Stamp,
    ) -> Result<Option<String>, StoreError> {
        if let Some(text) = self
            .store
            .reader()
            .result(study, name, &stamp.to_string())
            .await?
        {
            // Another process has stored newer texts than those in memory.
            self.in_memory()
                .retain(|id, kept| *id != study || kept.stamp == *stamp);
            return Ok(Some(text));
        }
        let in_memory = self.in_memory();
        let kept = in_memory.get(&study).filter(|kept| kept.stamp == *stamp);
        Ok(kept.and_then(|kept| kept.files.get(name)).cloned())
    }

    /// Returns the text with one name of every study in a range that has it, with its stamp.
    pub(super) async fn texts(
        &self,
        name: &str,
        studies: &RangeInclusive<i64>,
    ) -> Result<BTreeMap<i64, (String, String)>, StoreError> {
        let mut found = self.store.reader().results(name, studies).await?;
        let in_memory = self.in_memory();
        let kept = in_memory.range(studies.clone()).filter_map(|(study, kept)| {
            let text = kept.files.get(name)?.clone();
            Some((*study, (kept.stamp.to_string(), text)))
        });
        found.extend(kept);
        Ok(found)
    }

    /// Keeps texts and drops those of the study under other stamps. Texts that were computed from an earlier state of the study than the
    /// present one are not kept.
    pub(super) async fn keep(&self, mut results: StudyResults) -> Result<(), StoreError> {
        if !self.store.is_read_only() {
            return self.store.writer().keep_results(results).await;
        }
        let in_lists = [StudyFile::Overview, StudyFile::ListItem].map(StudyFile::name);
        results
            .files
            .retain(|name, _| in_lists.contains(name) || is_decision(name));
        let (present, _) = self
            .store
            .reader()
            .stamped_study(results.study, results.stamp.build())
            .await?;
        if !results.files.is_empty() && results.stamp == present {
            let mut in_memory = self.in_memory();
            let kept = in_memory.remove(&results.study);
            let kept = kept.filter(|kept| kept.stamp == results.stamp);
            // The new texts replace those that were kept under the same names.
            let mut files = kept.map_or_else(BTreeMap::new, |kept| kept.files);
            files.extend(results.files);
            in_memory.insert(results.study, StudyResults { files, ..results });
        }
        Ok(())
    }

    /// Drops the texts in memory of deleted studies.
    pub(super) fn forget_deleted(&self, is_there: impl Fn(i64) -> bool) {
        self.in_memory().retain(|study, _| is_there(*study));
    }
}

#[cfg(test)]
mod tests {
    use shared::api::CalibrationState;
    use store::Doubts;

    use super::*;

    #[tokio::test]
    async fn a_store_that_is_only_read_keeps_overviews_alone_under_their_stamp() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("grouser.db").display().to_string();
        Store::open(&path, 0).await.unwrap().close().await;
        let store = Store::open_read_only(&path).await.unwrap();
        let cache = ResultCache::new(&store);
        let (now, _) = store.reader().stamped_study(1, "b1").await.unwrap();
        let then = Stamp::new("b1", [(1, CalibrationState::Finished)].into_iter(), Doubts::NONE);
        let keep = async |study: i64, stamp: &Stamp, files: &[StudyFile]| {
            let files = files
                .iter()
                .map(|file| (file.name(), format!("text of {study} by {stamp}")));
            let results = StudyResults {
                study,
                stamp: stamp.clone(),
                files: files.collect(),
            };
            cache.keep(results).await.unwrap();
        };
        keep(
            1,
            &now,
            &[StudyFile::Overview, StudyFile::ListItem, StudyFile::Report],
        )
        .await;
        keep(1, &now, &[StudyFile::Report]).await;
        keep(1, &then, &[StudyFile::Overview]).await;
        keep(2, &now, &[StudyFile::ListItem]).await;
        let text = async |file: StudyFile, stamp| cache.text(1, &file.name(), stamp).await.unwrap();
        let overview = text(StudyFile::Overview, &now).await.unwrap();
        assert_eq!(overview, format!("text of 1 by {now}"));
        assert_eq!(text(StudyFile::Overview, &then).await, None);
        assert_eq!(text(StudyFile::Report, &now).await, None);
        let listed = async || cache.texts(&StudyFile::ListItem.name(), &(1..=9)).await.unwrap();
        assert_eq!(listed().await[&2].0, now.to_string());
        cache.forget_deleted(|study| study == 1);
        assert_eq!(listed().await.into_keys().collect::<Vec<_>>(), [1]);
    }
}
